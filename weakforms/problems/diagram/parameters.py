"""Parameters of the problem ``diagram``."""

from __future__ import annotations

from math import inf, pi
from typing import ClassVar, Literal

from pydantic import Field

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.diagram.about import BREAKING, LINES, PLAIN, WAVES, Body
from weakforms.problems.diagram.subjects import SUBJECTS, Subject
from weakforms.problems.diagram.window import Window
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.problem import Needs

USUAL = {
    **{"delta1": (1.0, 2.0), "lf": (4.0, 12.0), "alpha": (0.0, 0.3), "beta": (1.0, 3.0)},
    "angle": (0.4, 2.0),
    **{"force": (0.0, 3.0), "lam1": (1.05, 3.0)},
    **{"delta": (3.0, 6.0), "L": (6.0, 10.0), "gamma": (0.08, 0.2)},
    **{"M": (0.3, 1.0), "Af": (0.5, 1.0)},
}
"""Ranges of the parameters of a plane, if none are given."""

LONGEST_MIRRORED = 12.0
"""Length up to which lines of broken mirror symmetry are looked for. The force that holds a bulge in the
middle falls exponentially with the length: at 18 its eigenvalue is 1e-10 where others are 1, on any mesh."""

ONLY = {name: ({"body": (name,)},) for name in ("tube", "circular", "hemisphere")}
LONG = {"body": ("infinite_tube",)}
WRINKLED, STRETCHED = ({"body": ("wrinkled_tube",)},), ({"body": ("fluid_tube", "wrinkled_tube")},)
FILLED = ({"body": ("fluid_tube",)}, *({"body": ("wrinkled_tube",), axis: ("zw",)} for axis in "xy"))
INFLATED = (
    {"body": ("tube", "circular", "hemisphere", "sphere", "infinite_tube")},
    *({"body": ("wrinkled_tube",), axis: ("p",)} for axis in "xy"),
)


class DiagramNumerics(MeshNumerics):
    """Meshes of a diagram."""

    degree: int = Field(6, ge=2, le=6, description="polynomial degree of the unknowns")


class DiagramParameters(MaterialChoice):
    """The membrane, the plane, and what is followed in it."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        **dict.fromkeys(("delta1", "lf", "s", "u_end"), ONLY["tube"]),
        **dict.fromkeys(("beta", "l"), ONLY["circular"]),
        **{"angle": ONLY["hemisphere"], "t_end": ({"body": ("circular", "hemisphere")},)},
        **{"ends": (LONG,), "force": (LONG | {"ends": ("free",)},), "lam1": (LONG | {"ends": ("held",)},)},
        "lam_end": ({"body": ("sphere", "infinite_tube")},),
        **dict.fromkeys(("gamma", "zw_low", "zw_high"), FILLED),
        **dict.fromkeys(("delta", "L", "V_end"), STRETCHED),
        **dict.fromkeys(("M", "Af"), WRINKLED),
        **dict.fromkeys(("p_low", "p_high"), INFLATED),
    }

    body: Body = Field("tube", description="membrane")
    x: str = Field("", description="first axis; default: the first parameter of the membrane, or of its law")
    y: str = Field(
        "p",
        description="second axis; one of both is p, or zw: of the fluid tube, its default, or of the "
        "wrinkled tube under liquid",
    )
    kind: str = Field(
        "all", description=f"kinds of lines, with commas: {', '.join(LINES)}; all: those without waves"
    )
    low: float | None = Field(None, description="smallest value of the parameter that is not p or zw")
    high: float | None = Field(None, description="largest value of that parameter")
    p_low: float = Field(0.0, ge=0, le=50, description="smallest pressure")
    p_high: float | None = Field(None, gt=0, le=50, description="largest pressure; default: none")
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    delta1: float = Field(1.0, ge=1, le=5, description="axial pre-stretch of the tube")
    lf: float = Field(6.0, ge=1, le=30, description="stretched length L_f/R_f of the tube")
    s: float = Field(1.3, gt=1, le=20, description="radius S/R_f of a substrate around the tube")
    u_end: float = Field(5.0, gt=0.05, le=10, description="largest u_max of the tube")
    beta: float = Field(1.0, ge=1, le=10, description="uniform pre-stretch of the disk")
    l: float = Field(0.5, gt=0.06, le=5, description="height L/R_f of a substrate")  # noqa: E741
    angle: float = Field(
        pi / 2, ge=0.2, le=2.6, description="angle from the pole to the clamp, rad; pi/2: the hemisphere"
    )
    t_end: float = Field(3.0, gt=0.06, le=10, description="largest pole height of the disk or the hemisphere")
    ends: Literal["free", "held"] = Field("free", description="ends of the infinite tube")
    force: float = Field(0.0, ge=-5, le=100, description="axial force of free ends over 2 pi R_o h_o C1")
    lam1: float = Field(1.2, ge=1, le=10, description="axial stretch at which ends are held")
    lam_end: float = Field(
        4.0, gt=1.001, le=50, description="largest stretch of the sphere, or around the infinite tube"
    )

    delta: float = Field(4.0, ge=1.05, le=9, description="axial pre-stretch of the fluid or wrinkled tube")
    L: float = Field(
        8.0,
        ge=2,
        le=40,
        description="stretched length of the fluid tube over its radius A; undeformed length of the wrinkled "
        "tube over its radius Ao",
    )
    M: float = Field(
        0.5, ge=0.1, le=1.9, description="thickness at the wrinkled tube's lower end over its mean"
    )
    Af: float = Field(
        1.0, ge=0.1, le=2, description="radius of the wrinkled tube's disks over its undeformed radius"
    )
    gamma: float = Field(
        0.116,
        ge=0.01,
        le=2,
        description="weight of the liquid: rho g A^2/(mu H) of the fluid tube, mu = 2 C1; rho g Ao^2/(C1 h) "
        "of the wrinkled tube",
    )
    V_end: float = Field(
        40.0, gt=0.1, le=1000, description="largest volume in the fluid or wrinkled tube over 2 pi A^3"
    )
    zw_low: float = Field(0.0, ge=0, le=200, description="lowest level of the liquid")
    zw_high: float | None = Field(None, gt=0, le=200, description="highest level; default: none")

    @property
    def subject(self) -> Subject:
        """What the diagram is drawn of."""
        other = "liquid" if "zw" in (self.x, self.y) else self.ends
        return SUBJECTS.get(f"{self.body}, {other}", SUBJECTS[self.body])

    @property
    def axes(self) -> tuple[str, str]:
        """The axes."""
        y = self.y if "y" in self.model_fields_set else self.load
        return self.x or next(iter(self.known), ""), y

    @property
    def load(self) -> str:
        """The load of the membrane: the pressure of a gas, or the level of a liquid."""
        return self.subject.load

    @property
    def vary(self) -> str:
        """The axis that is not the load."""
        return next((name for name in self.axes if name != self.load), self.load)

    @property
    def known(self) -> dict[str, float]:
        """Values of the parameters that may be axes: those of the membrane, and constants of its law."""
        own = {name: getattr(self, name) for name in self.subject.parameters}
        return own | dict(self.material.constants)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of lines that are followed."""
        allowed = [name for name in LINES if name in self.subject.lines]
        named = PLAIN if self.kind == "all" else [word.strip() for word in self.kind.split(",")]
        if self.kind == "all" and self.unheld:
            named = [name for name in named if name != "mirror"]
        return tuple(name for name in allowed if name in named)

    @property
    def unheld(self) -> str:
        """Why no line of broken mirror symmetry of a tube is looked for, as text; empty if it is."""
        name, longest = ("high", self.window.high) if self.vary == "lf" else ("lf", self.lf)
        if self.body != "tube" or longest <= LONGEST_MIRRORED:
            return ""
        return (
            f"{name} = {longest:g}: nothing that can be computed holds a bulge in the middle of so long a "
            f"tube; allowed with lines of kind mirror: {name} up to {LONGEST_MIRRORED:g}"
        )

    @property
    def waves(self) -> tuple[str, ...]:
        """The kinds of waves around the axis among them."""
        return tuple(name for name in self.kinds if name in WAVES)

    @property
    def broken(self) -> tuple[str, ...]:
        """The kinds of broken symmetry that are looked for on lines of other kinds."""
        plain = [name for name in BREAKING if name in self.subject.lines]
        return (*(name for name in plain if name != "mirror" or not self.unheld), *self.waves)

    def range_of(self, name: str) -> tuple[float, float]:
        """Range of a parameter that may be an axis."""
        limits = self.material.material.constants
        if name in limits:
            return limits[name].low, limits[name].high
        given = type(self).model_fields[name].metadata
        low, high = (next(getattr(m, side) for m in given if hasattr(m, side)) for side in ("ge", "le"))
        return low, high

    @property
    def window(self) -> Window:
        """The part of the plane."""
        low, high = USUAL.get(self.vary, (inf, -inf))
        low, high = low if self.low is None else self.low, high if self.high is None else self.high
        bottom, top = (getattr(self, f"{self.load}_{side}") for side in ("low", "high"))
        top, end = inf if top is None else top, getattr(self, self.subject.end)
        return Window(self.vary, low, high, bottom, top, end, self.load)

    @property
    def touch(self) -> float:
        """Value of the membrane's column ``depth`` at first contact."""
        subject = self.subject
        return subject.touch(getattr(self, subject.obstacle)) if subject.obstacle else inf
