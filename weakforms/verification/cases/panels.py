"""Elements of figures: panels on the paper's axes, with their curves, and surfaces in space."""

from __future__ import annotations

from dataclasses import dataclass

from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.checks.curve import Curve


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
class Path:
    """Paths of material points of a body over a series of its states; drawn dotted."""

    of: Spec
    over: tuple[At, ...]
    points: tuple[float, ...]
    """Material coordinates, each with one path."""


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
    mirrored: bool = False
    """Whether profiles of the half body are drawn for the whole body, as in the paper."""
    note: str = ""
    dashed: Dashed | None = None
    lines: tuple[Line, ...] = ()
    """Content of a panel without curves."""


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
