"""Parameters and meshes of the problems ``tube`` and ``tube_fold``."""

from __future__ import annotations

from math import ceil, log2
from typing import Annotated, ClassVar, Literal, TypeVar

from pydantic import Field

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.problem import Needs
from weakforms.problems.tube.about import MOST_WAVES
from weakforms.problems.wave_numbers import wave_numbers


class TubeNumerics(MeshNumerics):
    """Meshes of the tube: ``cells`` on the finest half length, half as many on each coarser level."""

    grading: float = Field(0.6, ge=0, lt=1, description="concentration of cells at the disks")


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
        "secondary_from": [{"secondary": (True,)}],
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
        description="that of the law, or relaxed: in free inflation a tube that bears no compression",
    )
    n: Annotated[tuple[int, ...], wave_numbers(MOST_WAVES)] = Field(
        (),
        description="wave numbers for which stability is computed, such as 0,1,2; 0: axisymmetric, also "
        "without the mirror symmetry of half a tube",
    )
    secondary: bool = Field(
        False,
        description="also follow the lopsided states of free inflation (extent = full), on which the bulge "
        "moves to one end; n = 0 is then computed too",
    )
    secondary_from: int = Field(
        1, ge=1, le=9, description="which of the points where the mirror symmetry breaks they begin at"
    )
    uneven: float = Field(
        0.0,
        ge=-0.5,
        le=0.5,
        description="uneven thickness, 1 + uneven Z/(lf/2) over its mean h_o; free inflation of the whole "
        "tube (extent = full). Lopsided states are then those whose bulge is at the other end",
    )

    @property
    def stability(self) -> tuple[int, ...]:
        """Wave numbers that are computed: those asked for, and 0 with lopsided states."""
        return self.n if 0 in self.n or not self.secondary else (0, *self.n)


class TubeFoldParameters(MaterialChoice):
    """A free tube, whose limit points are followed over the pre-stretch."""

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1")
    lf: float = Field(6.0, ge=1, le=60, description="stretched length L_f/R_f")
    delta1_end: float = Field(3.0, gt=1, le=5, description="pre-stretch at which the line ends")
    u_end: float = Field(5.0, gt=0.05, le=10, description="u_max up to which a first limit point is searched")
