"""Parameters and meshes of the problems ``tube`` and ``tube_fold``."""

from __future__ import annotations

from math import ceil, log2
from typing import Annotated, ClassVar, Literal, Self, TypeVar

from pydantic import Field, model_validator

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.gas import EXPONENT, OUTSIDE, RESERVOIR, Gas
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.meridian.sector import SectorMesh
from weakforms.problems.problem import Needs
from weakforms.problems.tube.about import MOST_WAVES
from weakforms.problems.wave_numbers import wave_numbers


class TubeNumerics(MeshNumerics):
    """Meshes of the tube: ``cells`` on the finest half length, half as many on each coarser level."""

    grading: float = Field(0.6, ge=0, lt=1, description="concentration of cells at the disks")


class SecondaryNumerics(TubeNumerics):
    """Besides, the meshes of the surface with ``secondary_n`` waves, each twice as fine as the one before."""

    secondary_cells: int = Field(
        16, ge=8, le=192, description="cells of the surface of secondary_n along half the tube"
    )
    secondary_around: int = Field(8, ge=4, le=96, description="its cells around half a wave")
    secondary_degree: int = Field(5, ge=2, le=6, description="polynomial degree on that surface")

    @model_validator(mode="after")
    def _nested_surface(self) -> Self:
        coarsest = 2 ** (self.levels - 1)
        for name in ("secondary_cells", "secondary_around"):
            if getattr(self, name) % coarsest:
                raise ValueError(f"{name} must be a multiple of {coarsest} for {self.levels} levels")
        return self

    @property
    def surfaces(self) -> list[SectorMesh]:
        """The meshes of the surface, coarse to fine."""
        counts = [2**k for k in reversed(range(self.levels))]
        return [
            SectorMesh(
                self.secondary_cells // k, self.secondary_around // k, self.secondary_degree, self.grading
            )
            for k in counts
        ]

    def scaled(self, factor: float) -> Self:
        """The same with so many times as many cells, also of the surface where it allows this."""
        coarsest = 2 ** (self.levels - 1)
        surface = {
            name: max(8, coarsest, int(factor * getattr(self, name)))
            for name in ("secondary_cells", "secondary_around")
        }
        return type(self)(**super().scaled(factor).model_dump() | surface)


Meshes = TypeVar("Meshes", bound=MeshNumerics)

LONG = 16.0
"""Length from which on the default meshes have more cells, in proportion. On the coarsest a bulge's edge, as
wide as the tube, would fill less than a cell, and the pressure of a bulge that spreads would waver."""

LONGEST_WHOLE = 30.0
"""Length up to which the whole tube is solved: the force that holds a bulge in its middle falls exponentially
with the length, and beyond that is too near to round-off for its branch to be told from its neighbours."""


def resolving(lf: float, numerics: Meshes) -> Meshes:
    """Default meshes with as many cells as a long tube needs; meshes that are asked for stay."""
    if "cells" in numerics.model_fields_set or lf <= LONG:
        return numerics
    return numerics.model_copy(update={"cells": numerics.cells * 2 ** ceil(log2(lf / LONG))})


class TubeParameters(MaterialChoice):
    """The tube and its substrate."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        **dict.fromkeys(("k", "s", "p_end"), ({"contact": ("frictionless", "adhesive")},)),
        "spring": [{"phase": ("deflation",)}],
        "u_end": [{"contact": ("none",)}],
        "n": [{"contact": ("none",)}],
        "secondary_n": [{"secondary": (True,)}],
        "secondary_from": [{"secondary": (True,)}],
        **dict.fromkeys(("gas_kappa", "p_atm", "V_r"), ({"secondary_n": tuple(range(1, MOST_WAVES + 1))},)),
        "uneven": [{"extent": ("full",), "contact": ("none",)}],
    }
    movable: ClassVar = {"u_end": "le", "p_end": "le"}

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    delta1: float = Field(1.0, ge=1, le=5, description="axial pre-stretch")
    lf: float = Field(
        6.0, ge=1, le=60, description=f"stretched length L_f/R_f; of extent = full up to {LONGEST_WHOLE:g}"
    )
    k: float = Field(20.0, ge=0, le=1e4, description="substrate stiffness K R_f^2/(C1 h_o)")
    s: float = Field(1.3, gt=1, le=10, description="substrate radius S/R_f")
    contact: Literal["none", "frictionless", "adhesive"] = Field("none", description="contact law")
    phase: Literal["inflation", "deflation"] = Field("inflation", description="loading phase")
    spring: Literal["bilateral", "unilateral"] = Field("bilateral", description="bond in deflation")
    p_end: float = Field(
        3.0, gt=0, le=20, description="pressure at which inflation towards and in contact ends"
    )
    u_end: float = Field(5.0, gt=0.05, le=10, description="u_max at which free inflation ends")
    extent: Literal["half", "full"] = Field("half", description="symmetric half, or the whole tube")
    energy: Literal["standard", "relaxed"] = Field(
        "standard",
        description="that of the law, or relaxed: a tube that bears no compression, in free inflation, "
        "lopsided or bent from a taut state on (secondary), or in frictionless contact",
    )
    n: Annotated[tuple[int, ...], wave_numbers(MOST_WAVES)] = Field(
        (),
        description="wave numbers for which stability is computed, such as 0,1,2; 0: axisymmetric, also "
        "without the mirror symmetry of half a tube",
    )
    secondary: bool = Field(
        False,
        description="also follow a secondary branch of free inflation: lopsided states (extent = full), on "
        "which the bulge moves to one end, or those of secondary_n",
    )
    secondary_n: int = Field(
        0,
        ge=0,
        le=MOST_WAVES,
        description="its waves around the axis: 0 for lopsided states; 1 for bent ones, symmetric about "
        "mid-length (extent = half), and so on; stability is computed for this n too",
    )
    secondary_from: int = Field(
        1, ge=1, le=9, description="which of the points that are neutral to these waves it begins at"
    )
    uneven: float = Field(
        0.0,
        ge=-0.5,
        le=0.5,
        description="uneven thickness, 1 + uneven Z/(lf/2) over its mean h_o; free inflation of the whole "
        "tube (extent = full). Lopsided states are then those whose bulge is at the other end",
    )

    gas_kappa: float = EXPONENT
    p_atm: float = OUTSIDE
    V_r: float = RESERVOIR

    @property
    def gas(self) -> Gas:
        """The gas with a given mass."""
        return Gas(self.gas_kappa, self.p_atm, self.V_r)

    @property
    def stability(self) -> tuple[int, ...]:
        """Wave numbers that are computed: those asked for, and that of the secondary branch."""
        own = self.secondary_n
        return self.n if own in self.n or not self.secondary else (own, *self.n)


class TubeFoldParameters(MaterialChoice):
    """A free tube, whose limit points are followed over the pre-stretch."""

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1")
    lf: float = Field(6.0, ge=1, le=60, description="stretched length L_f/R_f")
    delta1_end: float = Field(3.0, gt=1, le=5, description="pre-stretch at which the line ends")
    u_end: float = Field(5.0, gt=0.05, le=10, description="u_max up to which a first limit point is searched")
