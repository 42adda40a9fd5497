"""Parameters and meshes of the problem ``rectangle``."""

from __future__ import annotations

from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.gas import Gas, GasChoice
from weakforms.problems.problem import Needs, TogetherError
from weakforms.problems.rectangle.model import Sheet

LONGEST_STRIP = 2.0
"""Largest ``c`` of a strip. It stays a cylinder of one cross-section at any length, but of a longer one this
branch is crossed by others with both mirrors."""


class RectangleNumerics(MeshNumerics):
    """Meshes of the rectangle: squares along half the short side, each cut into four triangles."""

    degree: int = Field(2, ge=1, le=2, description="polynomial degree of the unknowns")
    cells: int = Field(16, ge=4, le=512, description="squares along half the short side on the finest mesh")
    step: float = Field(0.2, ge=0.01, le=0.5, description="largest arc-length step")
    start: float = Field(
        0.02,
        ge=1e-4,
        le=0.3,
        description="w_c of the first point; under a liquid at least 0.2 if a stretch is below 1.05",
    )


class RectangleParameters(GasChoice):
    """The sheet, its frame and its load."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        "gamma": [{"load": ("liquid",)}],
        **dict.fromkeys(("kappa", "p_atm", "V_r"), ({"load": ("gas",)},)),
    }
    movable: ClassVar = {"w_end": "le"}

    load: Literal["liquid", "gas"] = Field("liquid", description="liquid on top, or gas from below")
    delta: float = Field(1.1, ge=1, le=3, description="pre-stretch in X, and in Y unless delta_y is given")
    delta_y: float | None = Field(None, ge=1, le=3, description="pre-stretch in Y")
    c: float = Field(1.0, ge=1, le=3, description="long side over short side")
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    gamma: float = Field(1.0, gt=0, le=30, description="rho g a^2/(C1 h), weight of the liquid")
    energy: Literal["relaxed", "full"] = Field(
        "relaxed", description="relaxed: the sheet bears no compression; full: it bears compression"
    )
    edges: Literal["held", "strip"] = Field(
        "held", description="held: all four; strip: y = delta_y Y everywhere, the edges Y = +-c free in x, z"
    )
    symmetry: Literal["quarter", "full"] = Field(
        "quarter", description="mesh: a quarter (perturbations by classes), or the whole sheet"
    )
    w_end: float = Field(1.5, gt=0.3, le=4, description="height of the centre at which the branch ends")

    @model_validator(mode="after")
    def _in_tension(self) -> Self:
        if self.edges == "strip" and self.delta == 1 == self.stretch_y:
            raise TogetherError(
                "delta = 1 with edges = 'strip': a slack strip has no first state; allowed: delta or delta_y "
                "above 1"
            )
        if self.edges == "strip" and self.c > LONGEST_STRIP:
            raise TogetherError(
                f"c = {self.c:g} with edges = 'strip': so long a strip bulges at one place along it, on "
                f"branches that are not followed; allowed: c up to {LONGEST_STRIP:g}, or edges = 'held'"
            )
        return self

    @property
    def gas(self) -> Gas | None:
        """The gas inside, if there is one."""
        return super().gas if self.load == "gas" else None

    @property
    def stretch_y(self) -> float:
        """Pre-stretch in ``Y``."""
        return self.delta if self.delta_y is None else self.delta_y

    def sheet(self, cells: int, degree: int) -> Sheet:
        """The membrane on one mesh."""
        return Sheet(
            self.material,
            self.load,
            self.c,
            self.delta,
            self.stretch_y,
            self.gamma,
            self.energy == "relaxed",
            self.edges == "strip",
            self.symmetry == "full",
            cells,
            degree,
        )
