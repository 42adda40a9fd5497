"""Parameters and meshes of the problem ``membrane``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import AfterValidator, Field

from weakforms.problems.branch_problem import MeshNumerics
from weakforms.problems.gas import Gas, GasChoice
from weakforms.problems.membrane.files import from_file
from weakforms.problems.membrane.model import Body, Motion, vertical
from weakforms.problems.membrane.reference import AXES, Reference
from weakforms.problems.membrane.shapes import airbag, disk, square, tube
from weakforms.problems.meridian.thickness import Thickness, text_over
from weakforms.problems.problem import Needs
from weakforms.problems.triangles.files import SUFFIXES

BUILT_IN = ("disk", "square", "airbag", "tube")


def _known(mesh: str) -> str:
    if mesh not in BUILT_IN and Path(mesh).suffix.lower() not in SUFFIXES:
        given = ", ".join(f"{name!r}" for name in BUILT_IN)
        raise ValueError(f"{given} or a file ending in {', '.join(SUFFIXES)} is required")
    return mesh


def names(text: str) -> list[str]:
    """Names in a list with commas."""
    return [name.strip() for name in text.split(",") if name.strip()]


class MembraneNumerics(MeshNumerics):
    """Meshes of the membrane: a file is the coarsest one, each next mesh has four triangles for each."""

    degree: int = Field(2, ge=1, le=2, description="polynomial degree of the unknowns")
    cells: int = Field(
        16,
        ge=4,
        le=512,
        description="finest mesh: triangles along the radius, half a side or half the circumference",
    )
    refine: int = Field(
        0,
        ge=0,
        le=8,
        description="times that triangles of the coarsest mesh are cut where its error is large",
    )
    step: float = Field(0.2, ge=0.01, le=0.5, description="largest arc-length step")
    start: float = Field(
        0.02,
        ge=1e-4,
        le=0.3,
        description="w_c of the first point; under a liquid at least 0.2 if delta is below 1.05",
    )
    p_start: float = Field(
        5e-3,
        ge=1e-4,
        le=1,
        description="p of the first point, of a liquid at its top, if edges slide or are moved",
    )


class MembraneParameters(GasChoice):
    """The membrane, its supports and its load."""

    ratio: ClassVar[str] = "alpha"
    needs: ClassVar[Needs] = {
        **{name: [{"mesh": ("FILE",)}] for name in ("unit", "held", "mirror", "slide", "moved")},
        **{name: [{"moved": ()}] for name in ("shift_x", "shift_y", "shift_z", "turn")},
        "axis": [{"turn": ()}],
        "lf": [{"mesh": ("tube",)}],
        **dict.fromkeys(("gamma", "tilt"), ({"load": ("liquid",)},)),
        **dict.fromkeys(("kappa", "p_atm", "V_r"), ({"load": ("gas",)},)),
    }
    movable: ClassVar = {"w_end": "le"}

    mesh: Annotated[str, AfterValidator(_known)] = Field(
        "disk",
        description="disk, square, airbag and tube (a quarter), or a file with triangles (msh, vtu, stl)",
        examples=["disk", "square", "airbag", "tube"],
    )
    lf: float = Field(10.0, ge=1, le=40, description="tube: length between its held ends over the radius")
    unit: float = Field(
        1.0, gt=0, le=1e9, description="file: the length, as in the file, by which lengths are divided"
    )
    held: str = Field(
        "", max_length=1000, description="file: held groups of edges, with commas; default all others"
    )
    mirror: str = Field("", max_length=1000, description="file: groups of edges on planes of symmetry")
    slide: str = Field(
        "", max_length=1000, description="file: groups of edges that slide in a plane X, Y or Z = constant"
    )
    moved: str = Field(
        "", max_length=1000, description="file: held groups of edges that are moved as one rigid body first"
    )
    shift_x: float = Field(0.0, ge=-3, le=3, description="displacement of these in X over a")
    shift_y: float = Field(0.0, ge=-3, le=3, description="displacement of these in Y over a")
    shift_z: float = Field(0.0, ge=-3, le=3, description="displacement of these in Z over a")
    turn: float = Field(0.0, ge=-90, le=90, description="turn of these, degrees, about their middle")
    axis: Literal["X", "Y", "Z"] = Field("Z", description="axis of this turn")
    load: Literal["gas", "liquid"] = Field(
        "gas", description="gas along the normals, or a liquid that stands on the surface"
    )
    gamma: float = Field(1.0, gt=0, le=30, description="rho g a^2/(C1 h), weight of the liquid")
    tilt: float = Field(
        0.0, ge=-80, le=80, description="liquid: angle, degrees, from Z to the vertical, towards X"
    )
    delta: float = Field(1.1, ge=1, le=3, description="pre-stretch: stretch of the supports about a point")
    alpha: float = Field(0.1, ge=0, le=1, description="C2/C1 of mooney_rivlin; 0 is neo-Hookean")
    thickness: text_over("X", "Y", "Z") = Field(  # type: ignore[valid-type]
        None, description="thickness over h by the place X, Y, Z over a, such as '1 + 0.2*cos(pi*X)*Y**2'"
    )
    energy: Literal["relaxed", "full"] = Field(
        "relaxed", description="relaxed: the membrane bears no compression; full: it bears compression"
    )
    w_end: float = Field(1.0, gt=0.3, le=10, description="largest deflection w_max at which the branch ends")

    @property
    def is_file(self) -> bool:
        """Whether the mesh is a user's."""
        return self.mesh not in BUILT_IN

    def _has(self, name: str, values: tuple[Any, ...]) -> bool:
        return self.is_file if values == ("FILE",) else super()._has(name, values)

    @property
    def gas(self) -> Gas | None:
        """The gas inside, if there is one."""
        return super().gas if self.load == "gas" else None

    @property
    def is_loose(self) -> bool:
        """Whether edges slide and none is held.

        Raises:
            InputError: If the mesh is a file that is not suitable.
        """
        return self.given().is_loose if self.is_file else self.mesh == "airbag"

    def given(self) -> Reference:
        """The surface in the file.

        Raises:
            InputError: If it is not suitable.
        """
        groups = map(names, (self.held, self.mirror, self.slide, self.moved))
        return from_file(self.mesh, self.unit, *groups)

    @property
    def motion(self) -> Motion | None:
        """The motion of held edges, if any are moved."""
        if not (self.is_file and names(self.moved)):
            return None
        shift = self.shift_x, self.shift_y, self.shift_z
        return Motion(shift, float(np.radians(self.turn)), AXES.index(self.axis))

    @property
    def up(self) -> np.ndarray:
        """Unit vector upwards."""
        return vertical(self._tilt)

    @property
    def _tilt(self) -> float:
        return float(np.radians(self.tilt))

    @property
    def own_thickness(self) -> Thickness | None:
        """The thickness, if one is given."""
        return None if self.thickness is None else Thickness(self.thickness, "X", ("Y", "Z"))

    def surface(self, cells: int, degree: int, level: int) -> Reference:
        """The reference surface on one mesh: a built-in one by its cells, that of a file by the level.

        Raises:
            InputError: If the mesh is a file that is not suitable.
        """
        if self.mesh == "disk":
            return disk(cells, degree)
        if self.mesh == "square":
            return square(cells)
        if self.mesh == "airbag":
            return airbag(cells)
        if self.mesh == "tube":
            return tube(cells, self.lf, degree)
        reference = self.given()
        for _ in range(level):
            reference = reference.refined()
        return reference

    def body(self, numerics: MembraneNumerics, level: int) -> Body:
        """The membrane on one mesh.

        Raises:
            InputError: If the mesh is a file that is not suitable.
        """
        reference = self.surface(numerics.meshes[level], numerics.degree, level)
        if self.load == "liquid":
            reference = reference.upwards(self.up)
        relaxed, load = self.energy == "relaxed", (self.load, self.gamma)
        about = self.material, self.delta, relaxed, numerics.degree, *load, self.own_thickness
        return Body(reference, *about, self._tilt, self.motion)
