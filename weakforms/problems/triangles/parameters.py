"""Parameters of the problem ``surface``, with the paper's values for each geometry."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Field

from weakforms.problems.material_choice import MaterialChoice
from weakforms.problems.problem import Needs, Numerics
from weakforms.problems.triangles.files import SUFFIXES
from weakforms.problems.triangles.meshes import (
    Triangulation,
    from_file,
    hemisphere,
    hemisphere_in_columns,
    tube,
)
from weakforms.problems.wrinkled.problem import PAPER_GAMMA

CONTROL = {"fluid": "zw", "gas": "p"}

DEFAULTS: dict[str, dict[str, Any]] = {
    "tube": {"M": 1.5, "delta": 3.0, "Af": 0.4362, "L": 8.0, "c2": 0.01, "gamma": PAPER_GAMMA},
    "hemisphere": {"c2": 0.0, "gamma": 100 * PAPER_GAMMA},
    "file": {"M": 1.0, "delta": 1.0, "Af": 1.0, "c2": 0.0, "gamma": PAPER_GAMMA},
}
"""Parameters of each geometry with their default values, which are the paper's."""

WALK = {("tube", "fluid"): (0.5, 10.5), ("tube", "gas"): (0.0, 0.38), ("hemisphere", "fluid"): (-0.5, -0.95)}
"""Default first and last load of the branch."""

FIRST = {
    ("tube", "fluid"): (0.5, 0.2, 0.1),
    ("tube", "gas"): (0.0,),
    ("hemisphere", "fluid"): (-0.6, -0.75, -0.9),
}
"""Loads of the first solve; the next one is tried if a heavy liquid has no state at the one before."""

HANGING = 2.0, 6.0
"""Smallest and largest weight of the liquid in a hemisphere, for a neo-Hookean law with ``C1 = 1``. A lighter
one hardly stretches the membrane, whose wrinkles then have no stiffness; a heavier one has states at low
levels only."""

HEAVIEST = 10.0
"""Largest weight of the liquid in a tube, two hundred times that of the papers."""

ALLOWED = {("tube", "fluid"): (0.0, 100.0), ("hemisphere", "fluid"): (-1.05, -0.48)}
"""Fluid levels of a hemisphere: it has no state above its limit point near -0.478, and is almost empty below
-1."""


def _known(geometry: str) -> str:
    if geometry not in ("tube", "hemisphere") and Path(geometry).suffix.lower() not in SUFFIXES:
        raise ValueError(f"'tube', 'hemisphere' or a file ending in {', '.join(SUFFIXES)} is required")
    return geometry


def _closes(columns: int) -> int:
    if columns < 3:
        raise ValueError("a mesh of fewer than 3 columns cannot close; allowed: 3 to 2000")
    return columns


class SurfaceParameters(MaterialChoice):
    """The membrane, its mesh (on which results depend here) and its load."""

    ratio: ClassVar[str] = "c2"

    needs: ClassVar[Needs] = {
        "meridional": [{"geometry": ("tube",)}, {"layout": ("columns",)}],
        "circumferential": [{"geometry": ("tube",)}, {"layout": ("columns",)}],
        "layout": [{"geometry": ("hemisphere",)}],
        "size": [{"geometry": ("hemisphere",), "layout": ("free",)}],
        "gamma": [{"load": ("fluid",)}],
    }

    geometry: Annotated[str, AfterValidator(_known)] = Field(
        "tube",
        description="tube, hemisphere, or a file with triangles (msh, vtu, stl)",
        examples=["tube", "hemisphere"],
    )
    meridional: int = Field(120, ge=2, le=2000, description="tube, columns: quadrilaterals along it")
    circumferential: Annotated[int, AfterValidator(_closes)] = Field(
        48, le=2000, description="tube, columns: quadrilaterals around it"
    )
    layout: Literal["free", "columns"] = Field(
        "free",
        description="hemisphere: triangles of one size, or in columns along meridians, which resolve waves",
    )
    degree: int = Field(1, ge=1, le=1, description="of the elements: flat triangles")
    size: float = Field(0.1, ge=0.004, le=0.5, description="hemisphere: length of the triangles' edges")
    M: float | None = Field(
        None, gt=0, lt=2, description="thickness at the lowest point over its mean (tube: 1.5)"
    )
    delta: float | None = Field(None, ge=1, le=6, description="axial pre-stretch (tube: 3)")
    c2: float | None = Field(None, ge=0, le=1, description="C2/C1 of mooney_rivlin (tube: 0.01, else 0)")
    L: float | None = Field(None, ge=1, le=40, description="tube: undeformed length (8)")
    Af: float | None = Field(
        None, ge=0.1, le=3, description="radius of the clamped edges over the undeformed one (tube: 0.4362)"
    )
    load: Literal["fluid", "gas"] = Field("fluid", description="fluid or gas in the membrane")
    gamma: float | None = Field(None, gt=0, le=100, description="weight of the fluid; by default the paper's")
    rule: int = Field(1, ge=1, le=4, description="quadrature of the load: 1 edge midpoints, 2 centroid, ...")
    potential: Literal["vertical", "horizontal"] = Field(
        "vertical", description="the load's potential: flux of Phi(z) e_z, or the printed one"
    )
    load_start: float | None = Field(None, description="first load of the branch")
    load_end: float | None = Field(None, description="last load of the branch")

    @property
    def kind(self) -> str:
        """``tube``, ``hemisphere`` or ``file``."""
        return self.geometry if self.geometry in DEFAULTS else "file"

    @property
    def control(self) -> str:
        """Name of the load."""
        return CONTROL[self.load]

    def filled(self) -> SurfaceParameters:
        """The same parameters with every default value."""
        start, end = WALK.get((self.kind, self.load), (None, None))
        own = DEFAULTS[self.kind] | {"load_start": start, "load_end": end}
        missing = {name: value for name, value in own.items() if getattr(self, name) is None}
        return self.model_copy(update=missing)

    def triangles(self) -> Triangulation:
        """The mesh.

        Raises:
            InputError: If a file does not contain such a surface.
        """
        if self.kind == "tube":
            return tube(self.L or DEFAULTS["tube"]["L"], self.meridional, self.circumferential)
        if self.kind == "hemisphere" and self.layout == "columns":
            return hemisphere_in_columns(self.meridional, self.circumferential)
        return hemisphere(self.size) if self.kind == "hemisphere" else from_file(Path(self.geometry))


class SurfaceNumerics(Numerics):
    """Steps along the branch; the mesh is a parameter."""

    scan: int = Field(
        50, ge=1, le=2000, description="intervals of the load between states counted by inertia"
    )
    shown: int = Field(5, ge=1, le=2000, description="interval between those that are points of the branch")
    eigenvalues: int = Field(3, ge=0, le=20, description="number of lowest eigenvalues at each point")
    tolerance: float = Field(
        1e-6, ge=1e-10, le=1e-2, description="load interval to which a stability change is narrowed"
    )
