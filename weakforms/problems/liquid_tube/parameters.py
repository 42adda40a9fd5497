"""Parameters and meshes of the problem ``fluid_tube``."""

from __future__ import annotations

from typing import ClassVar, Literal, Self

from pydantic import Field, model_validator

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.liquid_tube.about import MOST_WAVES
from weakforms.problems.liquid_tube.branch import STEP, ZW_END
from weakforms.problems.material_choice import MaterialChoice


class FluidTubeNumerics(MeshNumerics):
    """Meshes of the tube: ``cells`` on the finest one, half of them on each side of the front."""

    degree: int = Field(5, ge=2, le=6, description="polynomial degree of the unknowns")
    cells: int = Field(128, ge=16, le=20_000, description="cells on the finest mesh")
    grading: float = Field(0.6, ge=0, lt=1, description="concentration of cells at rings and front")
    step: float = Field(STEP, ge=0.02, le=1, description="largest arc-length step")
    secondary_cells: int = Field(24, ge=6, le=96, description="cells along the surface")
    secondary_around: int | None = Field(
        None,
        ge=2,
        le=96,
        description="cells around half the circumference; by default two thirds of those along",
    )
    secondary_degree: int = Field(5, ge=2, le=6, description="polynomial degree on the surface")
    secondary_levels: int = Field(
        3, ge=2, le=4, description="meshes of the surface, each twice as fine as the one before"
    )
    secondary_step: float = Field(0.1, ge=0.01, le=0.5, description="largest step on the secondary branch")
    secondary_end: float = Field(
        0.9, ge=0.8, lt=1, description="fraction of the level at the bifurcation at which that branch ends"
    )

    @model_validator(mode="after")
    def _nested_surface(self) -> Self:
        coarsest = 6 * 2 ** (self.secondary_levels - 1)
        if self.secondary_cells % coarsest:
            raise ValueError(
                f"secondary_cells must be a multiple of {coarsest} for {self.secondary_levels} levels"
            )
        if self.secondary_around is not None and self.secondary_around % (coarsest // 3):
            raise ValueError(
                f"secondary_around must be a multiple of {coarsest // 3} for {self.secondary_levels} levels"
            )
        return self

    def scaled(self, factor: float) -> Self:
        """The same with so many times as many cells, also of the surface where it allows this."""
        coarsest = 6 * 2 ** (self.secondary_levels - 1)
        cells = {"secondary_cells": max(coarsest, int(factor * self.secondary_cells))}
        if self.secondary_around is not None:
            cells["secondary_around"] = max(coarsest // 3, int(factor * self.secondary_around))
        return type(self)(**super().scaled(factor).model_dump() | cells)


class FluidTubeParameters(MaterialChoice):
    """The tube and its liquid."""

    ratio: ClassVar[str] = "alpha"
    movable: ClassVar = {"zw_end": "ge"}

    L: float = Field(8.0, ge=2, le=40, description="stretched length over the radius")
    delta: float = Field(2.0, gt=1, le=9, description="axial pre-stretch")
    gamma: float = Field(0.116, gt=0, le=2, description="rho g A^2/(mu H)")
    alpha: float = Field(0.0, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    n_max: int = Field(3, ge=1, le=MOST_WAVES, description="largest wave number whose stability is judged")
    zw_end: float = Field(
        ZW_END, ge=0.3, lt=1, description="fraction of the highest level at which the branch ends"
    )
    energy: Literal["standard", "relaxed"] = Field(
        "standard", description="that of the law, or relaxed: a tube that bears no compression"
    )
    secondary: bool = Field(False, description="also solve for the secondary branch (delta up to 8)")
