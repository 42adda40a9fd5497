"""The vocabulary case files are written in: what a figure, table or statement of a paper says."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from weakforms.verification.solutions import Solutions
from weakforms.verification.specs import At, Spec

Finding = tuple[bool, str]
"""Whether a claim holds, and what was found, with numbers."""


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


@dataclass(frozen=True)
class Panel:
    """One panel of a figure, on the paper's axes."""

    name: str
    x: Axis
    y: Axis
    curves: tuple[Curve, ...]
    title: str = ""
    markers: str = ""
    """Kind of special point marked on the curves."""
    mirrored: bool = False
    """Profiles of the half body drawn on the whole of it, as the paper does."""
    note: str = ""


@dataclass(frozen=True)
class Count:
    """Number of special points of a kind on the primary branch."""

    kind: str
    expected: Mapping[Spec, int]
    statement: str


@dataclass(frozen=True)
class Points:
    """Special points held against a table with one row a point.

    The table's columns that are parameters of the problem select the solution, ``order`` the point on it.
    """

    kind: str
    reference: str
    base: Spec
    parameters: tuple[str, ...]
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
class Printed:
    """A number printed in the paper: reproduced to all its digits, or not."""

    what: str
    printed: str
    of: Spec
    kind: str
    column: str
    source: str
    index: int = 0


@dataclass(frozen=True)
class PrintedExact:
    """A printed number with a closed form: reproduced to all its digits, or a misprint that this shows."""

    what: str
    printed: str
    exact: float
    evidence: str
    source: str
    misprint: bool = False


Check = Count | Points | Claim | Constant | Order | Printed | PrintedExact


@dataclass(frozen=True)
class Case:
    """One figure, table or statement of a paper: what is drawn, what is checked, how accurately."""

    title: str
    source: str
    panels: tuple[Panel, ...] = ()
    checks: tuple[Check, ...] = ()
    asked: Mapping[str, float] = field(default_factory=dict)
    """Relative accuracy wanted of each column of the curves' reference tables."""
    quick: bool = True
    """Part of the quick profile."""
    tags: tuple[str, ...] = ()
