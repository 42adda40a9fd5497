"""Elements of figures: panels on the paper's axes, with their curves, and surfaces in space."""

from __future__ import annotations

from dataclasses import dataclass

from weakforms.problems.registry import symbol
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.checks.path import Path


@dataclass(frozen=True)
class Axis:
    """An axis as printed in the paper."""

    name: str
    low: float
    high: float
    label: str = ""

    @property
    def tex(self) -> str:
        """The label as TeX, for pictures."""
        return self.label or symbol(self.name) or self.name


@dataclass(frozen=True)
class Dashed:
    """Parts of profiles drawn dashed: where a column is below a value."""

    column: str
    below: float
    full: str
    """Meaning of full lines."""
    dashed: str
    """Meaning of dashed lines."""


@dataclass(frozen=True)
class Line:
    """An exact line of a panel, without a solution and without a comparison."""

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
    """Height of a line across the panel, such as an undeformed substrate."""
    markers: str | tuple[str, ...] = ""
    """Kind, or kinds, of special points that are marked on the curves."""
    edge: str = ""
    """Quantity of a state, such as ``X_contact``: the material point that is marked on its profile."""
    mirrored: bool = False
    """Whether profiles of the half body are drawn for the whole body, as in the paper."""
    note: str = ""
    dashed: Dashed | None = None
    lines: tuple[Line, ...] = ()
    """Exact lines, drawn before the curves."""
    counted: tuple[str, ...] = ()
    """Columns of branches whose sum is the number of negative eigenvalues: lines are full where it is 0,
    dashed where it is 1, dotted where it is more. By default ``n_negative``, and lines are full or dashed."""


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
    """Factor of the lowest mode (``u_x, u_y, u_z``, largest length 1) that is added to the shown state."""
