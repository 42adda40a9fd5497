"""What is to be solved, as plain values: a problem, its parameters, its meshes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True)
class Spec:
    """A problem at some parameters (defaults left out) and, where they matter, numerics."""

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
    """The circular membrane of Paper 1 by the paper's own scheme on a fixed mesh."""
    return Spec("circular_scheme", _sorted(parameters))


def tube(**parameters: Any) -> Spec:
    """The pre-stretched cylindrical membrane of Paper 2."""
    return Spec("tube", _sorted(parameters))


def tube_fold(**parameters: Any) -> Spec:
    """The fold line of the freely inflated tube of Paper 2."""
    return Spec("tube_fold", _sorted(parameters))


def tube_scheme(**parameters: Any) -> Spec:
    """The constrained tube of Paper 2 by the paper's own schemes on a fixed mesh."""
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
    """The thickness ratios at which that membrane begins to wrinkle without load."""
    return Spec("wrinkled_tube_threshold", _sorted(parameters))


def fluid_tube_coincidence(**parameters: Any) -> Spec:
    """The pre-stretch at which limit point and bifurcation of the tube of Paper 3 coincide."""
    return Spec("fluid_tube_coincidence", _sorted(parameters))


@dataclass(frozen=True)
class At:
    """A state wanted of a solution: a column at a value, or the ``value``-th special point of a kind."""

    name: str
    value: float
    crossing: int = 1
    profile: tuple[float, ...] | None = None
    branch: str = "primary"
    theta: float | None = None
    """Of a profile over a surface, the meridian looked at; ``None`` for all of it."""

    def __str__(self) -> str:
        return f"{self.name} = {self.value:g}"
