"""The vocabulary case files are written in: what a figure, table or statement of a paper says."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.decide import Finding
from weakforms.verification.run.solutions import Solutions


@dataclass(frozen=True)
class Axis:
    """An axis as printed in the paper."""

    name: str
    low: float
    high: float
    label: str = ""

    @property
    def tex(self) -> str:
        """Label for pictures."""
        return self.label or LABELS.get(self.name, self.name)


LABELS = {
    "p": r"$p$",
    "u_max": r"$u_{max}$",
    "delta1": r"$\delta_1$",
    "lam1": r"$\lambda_1$",
    "lam2": r"$\lambda_2$",
    "rho": r"$\rho$",
    "eta": r"$\eta$",
    "Z": r"$Z$",
    "X_contact": r"$X^*$",
    "G": r"$G$",
    "X_iso": r"$X_{iso}$",
    "rho_contact": r"$\rho^*$",
    "sigma": r"$\sigma$",
    "X": r"$X$",
    "t0": r"$t_0$",
    "zw": r"$z_w$",
    "V": r"$V$",
    "Lambda": r"$\Lambda$",
    "r_mid": r"$r_{mid}$",
    "T1": r"$T_1$",
    "T2": r"$T_2$",
    "r": r"$r$",
    "z": r"$z$",
    "gw": r"$g_w$",
}


@dataclass(frozen=True)
class Curve:
    """A branch drawn over two of its columns, or with ``at`` a profile of one of its states."""

    of: Spec
    label: str
    reference: str | None = None
    at: At | None = None
    y: str | None = None
    """Column drawn, where a panel shows several (``None``: the panel's own)."""
    branch: str = "primary"
    """Branch drawn and compared; a profile is of the branch of its state."""
    asked: Mapping[str, float] | None = None
    """Relative accuracy wanted of the columns of its table, where it is not the case's."""
    columns: Mapping[str, str] = field(default_factory=dict)
    """The solution's column for a column of the table, where it has another name there."""


@dataclass(frozen=True)
class Path:
    """Where material points of a body go over a series of its states; drawn dotted."""

    of: Spec
    over: tuple[At, ...]
    points: tuple[float, ...]
    """Material coordinates, each of them one path."""


@dataclass(frozen=True)
class Dashed:
    """Parts of profiles drawn dashed: where a column is below a value."""

    column: str
    below: float
    full: str
    """What full lines mean ..."""
    dashed: str
    """... and dashed ones."""


@dataclass(frozen=True)
class Line:
    """A line of a panel that is known exactly: nothing is solved for it, and nothing compared."""

    label: str
    x: tuple[float, ...]
    y: tuple[float, ...]


@dataclass(frozen=True)
class Panel:
    """One panel of a figure, on the paper's axes."""

    name: str
    x: Axis
    y: Axis
    curves: tuple[Curve, ...]
    paths: tuple[Path, ...] = ()
    title: str = ""
    level: float | None = None
    """Height of a line across the panel, such as an undeformed substrate's."""
    markers: str | tuple[str, ...] = ""
    """Kind of special point marked on the curves, or several kinds."""
    mirrored: bool = False
    """Profiles of the half body drawn on the whole of it, as the paper does."""
    note: str = ""
    dashed: Dashed | None = None
    lines: tuple[Line, ...] = ()
    """What a panel without curves shows."""


@dataclass(frozen=True)
class Surface:
    """A deformed surface in space: a picture of one state, in which nothing is compared."""

    name: str
    of: Spec
    at: At
    axes: tuple[Axis, Axis, Axis]
    title: str = ""
    note: str = ""
    displaced: float = 0.0
    """Times the lowest mode (``u_x, u_y, u_z``, largest length 1) by which the state is shown displaced."""


@dataclass(frozen=True)
class Count:
    """Number of special points of a kind on the primary branch."""

    kind: str
    expected: Mapping[Spec, int]
    statement: str


@dataclass(frozen=True)
class Points:
    """Special points held against a table with one row a point (kind ``quantity``: the problem's quantities).

    The table's columns that are parameters of the problem select the solution, ``order`` the point on it.
    """

    kind: str
    reference: str
    base: Spec
    parameters: tuple[str, ...]
    asked: Mapping[str, float]
    where: Mapping[str, float] = field(default_factory=dict)
    """Values of columns of the table: only rows that have them are looked at."""
    branch: str = ""
    """Only points of this branch; empty for all."""


@dataclass(frozen=True)
class States:
    """States held against a table with one row a state.

    The table's columns that are parameters of the problem select the solution, ``at`` the state of it.
    """

    reference: str
    base: Spec
    parameters: tuple[str, ...]
    at: At
    asked: Mapping[str, float]


@dataclass(frozen=True)
class Claim:
    """A statement of the paper that is true or false of some solutions.

    ``holds`` looks at the solutions listed in ``wants`` and returns the truth and what was found.
    """

    name: str
    statement: str
    wants: tuple[tuple[Spec, At | None], ...]
    holds: Callable[[Solutions], Finding]
    differs: str = ""
    """Where the paper says otherwise: what it says, and why that does not hold."""


@dataclass(frozen=True)
class Constant:
    """A column of a profile that is constant in the exact solution (a first integral)."""

    column: str
    of: Spec
    at: At
    asked: float
    statement: str


@dataclass(frozen=True)
class Order:
    """Observed order of convergence of a quantity with the mesh, one degree a check."""

    quantity: str
    of: Spec
    expected: Mapping[int, float]
    """Order by polynomial degree."""
    cells: tuple[int, ...]
    at: At | None = None
    kind: str = ""
    """Special point whose value it is, where there is no ``at``."""
    reference: str = ""
    """Table with the exact value; by its ``select`` row."""
    row: int = 0
    column: str = ""
    """Column of the profile or of the point; ``quantity`` is what people read."""


@dataclass(frozen=True)
class CutOff:
    """How a printed number came about: digits were cut off, not rounded."""

    status = "cut off"


@dataclass(frozen=True)
class OnGrid:
    """How a printed number came about: a scan was stopped at a value of its grid."""

    step: str
    """Step of the grid; the printed number is a multiple of it ..."""
    upwards: bool
    """... and the number itself lies above the printed one, less than a step away; or below it."""
    status = "grid of a scan"


@dataclass(frozen=True)
class Misprint:
    """A printed number that is wrong."""

    correct: str
    """What should be printed, with all digits: the computed number must round to it."""
    why: str
    status = "misprint"


Reading = CutOff | OnGrid | Misprint


@dataclass(frozen=True)
class Printed:
    """A number printed in the paper: reproduced to all its digits, or read in another way that is proven."""

    what: str
    printed: str
    of: Spec
    kind: str
    column: str
    source: str
    index: int = 0
    reading: Reading | None = None
    """What it is, where it is stated not to be the number rounded to its digits."""


@dataclass(frozen=True)
class PrintedExact:
    """A printed number with a closed form: reproduced to all its digits, or read in another way."""

    what: str
    printed: str
    exact: float
    evidence: str
    source: str
    reading: Reading | None = None


@dataclass(frozen=True)
class PrintedInput:
    """A printed number that is an input of a figure: what it implies, and whether that is a round value."""

    what: str
    printed: str
    of: Spec
    at: At
    column: str
    searched: tuple[float, ...]
    """Round values, rising, that ``column`` could have there if the number was read off a computation ..."""
    within: float
    """... within this relative distance."""
    source: str
    decoded: bool = True
    """What is stated: that it is decoded, or that it lies between two of the values and is neither."""


@dataclass(frozen=True)
class PrintedState:
    """A printed number at which a figure shows a state: the state is there, on the branch the paper says."""

    what: str
    printed: str
    of: Spec
    at: At
    column: str
    """Whose value is printed; the state is asked for at it."""
    shown: tuple[str, ...]
    """Columns that tell in the ledger which state it is."""
    n_negative: int
    """Negative eigenvalues in the symmetric space, which tell the parts of the branch apart."""
    source: str


Check = (
    Count | Points | States | Claim | Constant | Order | Printed | PrintedExact | PrintedInput | PrintedState
)


@dataclass(frozen=True)
class Case:
    """One figure, table or statement of a paper: what is drawn, what is checked, how accurately."""

    title: str
    source: str
    panels: tuple[Panel, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    checks: tuple[Check, ...] = ()
    asked: Mapping[str, float] = field(default_factory=dict)
    """Relative accuracy wanted of each column of the curves' reference tables."""
    quick: bool = False
    """Part of the quick profile, whose cases take three minutes together."""
    slow: bool = False
    """Takes minutes by itself: left to ``verify`` and to the tests marked slow."""
    tags: tuple[str, ...] = ()
