"""Parameters and meshes of the problems ``tube`` and ``tube_fold``."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import Field

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.material_choice import MaterialChoice


class TubeNumerics(MeshNumerics):
    """Meshes of the tube: ``cells`` on the finest half length, half as many on each coarser level."""

    grading: float = Field(0.6, ge=0, lt=1, description="concentration of cells at the disks")


class TubeParameters(MaterialChoice):
    """The tube and its substrate."""

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    delta1: float = Field(1.0, ge=1, le=5, description="axial pre-stretch")
    lf: float = Field(6.0, ge=1, le=60, description="stretched length L_f/R_f")
    k: float = Field(20.0, ge=0, le=1e4, description="substrate stiffness K R_f^2/(C1 h_o)")
    s: float = Field(1.3, gt=1, le=20, description="substrate radius S/R_f")
    contact: Literal["none", "frictionless", "adhesive"] = Field("none", description="contact law")
    phase: Literal["inflation", "deflation"] = Field("inflation", description="loading phase")
    spring: Literal["bilateral", "unilateral"] = Field("bilateral", description="bond in deflation")
    p_end: float = Field(3.0, gt=0, le=20, description="pressure at which constrained inflation ends")
    u_end: float = Field(5.0, gt=0.05, le=10, description="u_max at which free inflation ends")
    extent: Literal["half", "full"] = Field("half", description="symmetric half, or the whole tube")


class TubeFoldParameters(MaterialChoice):
    """A free tube, whose limit points are followed over the pre-stretch."""

    ratio: ClassVar[str] = "alpha"

    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1")
    lf: float = Field(6.0, ge=1, le=60, description="stretched length L_f/R_f")
    delta1_end: float = Field(3.0, gt=1, le=5, description="pre-stretch at which the line ends")
    u_end: float = Field(5.0, gt=0.05, le=10, description="u_max up to which a first limit point is searched")
