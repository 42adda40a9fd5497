"""Membranes of revolution whose wrinkling is studied: reference surface, thickness, supports."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import ufl

SHARED = ("p", "zw", "gamma", "c2", "residual_stiffness")
"""Parameters of every body: gas pressure, level and weight of the liquid, C2/C1, ``eps`` of the homotopy."""

Values = Mapping[str, Any]
"""Parameters by name: numbers, or expressions of a form."""


@dataclass(frozen=True)
class Body:
    """A membrane of revolution and its supports; all functions accept numbers and expressions."""

    name: str
    parameters: tuple[str, ...]
    """Names of its parameters besides :data:`SHARED`."""
    length: Callable[[Values], Any]
    """Meridional length of the reference surface."""
    radius: Callable[[Any, Values], Any]
    """Radius ``R(S)`` of the reference surface."""
    thickness: Callable[[Any, Values], Any]
    """Thickness ``H(S)`` over its mean."""
    shape: Callable[[Any, Values], tuple[Any, Any]]
    """Shape ``(r/R, z)`` from which the unknowns are measured; it has the prescribed values at the ends."""
    held: tuple[tuple[bool, bool], tuple[bool, bool]] = ((True, True), (True, True))
    """Whether ``r`` and ``z`` are prescribed at the first and at the last end; at a pole ``r`` is 0."""
    easy: tuple[tuple[str, float], ...] = ()
    """Parameters at which the shape is near an unloaded state, the start of the steps to other parameters."""
    pole: bool = False
    """Whether the first end lies on the axis."""


def _cylinder_thickness(s: Any, q: Values) -> Any:
    r""":math:`H/h = M + 2(1-M)\,s/L`: ``M`` at the lower end, ``2 - M`` at the upper one."""
    return q["M"] + 2 * (1 - q["M"]) * s / q["L"]


SAG = 0.05
"""Difference between the cylinder's shape and the stretched one. Without it a state could have zero
displacement, and a Newton step could not be relative to that."""


def _cylinder_shape(s: Any, q: Values) -> tuple[Any, Any]:
    return q["Af"], q["delta"] * s * (1 + SAG * (1 - s / q["L"]))


CYLINDER = Body(
    name="cylinder",
    parameters=("M", "delta", "L", "Af"),
    length=lambda q: q["L"],
    radius=lambda _s, _q: 1.0,
    thickness=_cylinder_thickness,
    shape=_cylinder_shape,
    easy=(("M", 1.0),),
)
"""Paper 4: lengths over the undeformed radius; both ends are clamped at radius ``Af`` and stretched by
``delta``."""

SHAPE_DEPTH = 1.02
"""Depth of the hemisphere's shape, so that no state has zero displacement."""

HEMISPHERE = Body(
    name="hemisphere",
    parameters=(),
    length=lambda _q: math.pi / 2,
    radius=lambda t, _q: ufl.sin(t),
    thickness=lambda _t, _q: 1.0,
    shape=lambda t, _q: (1.0, -SHAPE_DEPTH * ufl.cos(t)),
    held=((False, False), (True, True)),
    pole=True,
)
"""Paper 5: it hangs from its equator. Lengths are divided by its radius, ``S = t`` is the angle from the
pole, and ``z`` is measured upwards from the plane of the equator."""
