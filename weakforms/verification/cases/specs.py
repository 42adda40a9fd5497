"""Specifications of solutions as plain values: a problem, its parameters, its meshes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True)
class Spec:
    """A problem at some parameters (without defaults), with numerics if needed."""

    problem: str
    parameters: tuple[tuple[str, Any], ...] = ()
    numerics: tuple[tuple[str, Any], ...] = ()

    def on(self, **numerics: Any) -> Spec:
        """The same problem on other meshes, such as ``on(degree=2, cells=64)``."""
        return replace(self, numerics=_sorted(dict(self.numerics) | numerics))

    def at(self, **parameters: Any) -> Spec:
        """The same problem with some parameters changed."""
        return replace(self, parameters=_sorted(dict(self.parameters) | parameters))

    def __str__(self) -> str:
        given = ", ".join(f"{k}={v}" for k, v in (*self.parameters, *self.numerics))
        return f"{self.problem}({given})"


def _sorted(values: dict[str, Any]) -> tuple[tuple[str, Any], ...]:
    return tuple(sorted(values.items()))


def circular(**parameters: Any) -> Spec:
    """The circular membrane of Paper 1, free or against a deformable substrate."""
    return Spec("circular", _sorted(parameters))


def circular_scheme(**parameters: Any) -> Spec:
    """The circular membrane of Paper 1 by the paper's scheme on a fixed mesh."""
    return Spec("circular_scheme", _sorted(parameters))


def tube(**parameters: Any) -> Spec:
    """The pre-stretched cylindrical membrane of Paper 2."""
    return Spec("tube", _sorted(parameters))


def tube_fold(**parameters: Any) -> Spec:
    """The fold line of the freely inflated tube of Paper 2."""
    return Spec("tube_fold", _sorted(parameters))


def tube_scheme(**parameters: Any) -> Spec:
    """The constrained tube of Paper 2 by the paper's schemes on a fixed mesh."""
    return Spec("tube_scheme", _sorted(parameters))


def fluid_tube(**parameters: Any) -> Spec:
    """The fluid-loaded pre-stretched cylindrical membrane of Paper 3."""
    return Spec("fluid_tube", _sorted(parameters))


def fluid_tube_surface(**parameters: Any) -> Spec:
    """The same membrane as a whole surface near its bifurcation, half or full circumference."""
    return Spec("fluid_tube_surface", _sorted(parameters))


def wrinkled_tube(**parameters: Any) -> Spec:
    """The pre-stretched cylindrical membrane of non-uniform thickness of Paper 4."""
    return Spec("wrinkled_tube", _sorted(parameters))


def wrinkled_sheet(**parameters: Any) -> Spec:
    """The same membrane at one load as a two-dimensional sheet."""
    return Spec("wrinkled_sheet", _sorted(parameters))


def wrinkled_material(**parameters: Any) -> Spec:
    """The energy of a sheet that may wrinkle, at two stretches."""
    return Spec("wrinkled_material", _sorted(parameters))


def wrinkled_tube_threshold(**parameters: Any) -> Spec:
    """The thickness ratios at which that membrane starts to wrinkle without load."""
    return Spec("wrinkled_tube_threshold", _sorted(parameters))


def wrinkled_linear(**parameters: Any) -> Spec:
    """The linearised theory of waves around the cylinder of Paper 5 at a level."""
    return Spec("wrinkled_linear", _sorted(parameters))


def wrinkled_bending(**parameters: Any) -> Spec:
    """Waves around that cylinder at a level, with a small bending stiffness."""
    return Spec("wrinkled_bending", _sorted(parameters))


def wrinkled_patch(**parameters: Any) -> Spec:
    """The flat wrinkled patch under pressure of Paper 5."""
    return Spec("wrinkled_patch", _sorted(parameters))


def hemisphere(**parameters: Any) -> Spec:
    """The hemisphere of Paper 5, which hangs from its equator and holds a liquid."""
    return Spec("hemisphere", _sorted(parameters))


def fluid_tube_coincidence(**parameters: Any) -> Spec:
    """The pre-stretch at which limit point and bifurcation of the tube of Paper 3 coincide."""
    return Spec("fluid_tube_coincidence", _sorted(parameters))


def surface(**parameters: Any) -> Spec:
    """The membrane of Paper 5 on flat triangles in space: tube, hemisphere or a file."""
    return Spec("surface", _sorted(parameters))


def material(**parameters: Any) -> Spec:
    """A material law at two stretches."""
    return Spec("material", _sorted(parameters))


def sphere(**parameters: Any) -> Spec:
    """A spherical balloon of any material law."""
    return Spec("sphere", _sorted(parameters))


def infinite_tube(**parameters: Any) -> Spec:
    """A long tube with closed ends that stays a cylinder, of any material law."""
    return Spec("infinite_tube", _sorted(parameters))


def homogeneous(**parameters: Any) -> Spec:
    """A test piece of any material law: uniaxial, equibiaxial or pure shear."""
    return Spec("homogeneous", _sorted(parameters))


@dataclass(frozen=True)
class At:
    """A requested state of a solution: a column at a value, or the ``value``-th special point of a kind."""

    name: str
    value: float
    crossing: int = 1
    profile: tuple[float, ...] | None = None
    branch: str = "primary"
    theta: float | None = None
    """The meridian of a profile over a surface; ``None`` for the whole surface."""
    field: str = ""
    """Name of the field; the profile by default."""

    def __str__(self) -> str:
        return f"{self.name} = {self.value:g}"
