"""Membranes of revolution whose wrinkling is studied: reference surface, thickness, supports."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import ufl

SHARED = ("p", "zw", "gamma", "c2", "residual_stiffness")
"""Parameters every body has: gas pressure, level and weight of the liquid, C2/C1, the homotopy's ``eps``."""

Values = Mapping[str, Any]
"""Parameters by name: numbers, or expressions in a form."""


@dataclass(frozen=True)
class Body:
    """A membrane of revolution and how it is held; all functions work on numbers and on expressions."""

    name: str
    parameters: tuple[str, ...]
    """Names of its own parameters, beside :data:`SHARED`."""
    length: Callable[[Values], Any]
    """Meridional length of the reference surface."""
    radius: Callable[[Any, Values], Any]
    """Radius ``R(S)`` of the reference surface."""
    thickness: Callable[[Any, Values], Any]
    """Thickness ``H(S)`` over its mean."""
    shape: Callable[[Any, Values], tuple[Any, Any]]
    """``(r/R, z)`` that the unknowns are counted from; it has the values prescribed at the ends."""
    held: tuple[tuple[bool, bool], tuple[bool, bool]] = ((True, True), (True, True))
    """Whether ``r`` and ``z`` are held at the first and at the last end; at a pole ``r`` is 0 anyhow."""
    easy: tuple[tuple[str, float], ...] = ()
    """Parameters at which the shape is near an unloaded state: where the walk to any other begins."""
    pole: bool = False
    """Whether the first end lies on the axis."""


def _cylinder_thickness(s: Any, q: Values) -> Any:
    r""":math:`H/h = M + 2(1-M)\,s/L`: ``M`` at the lower end, ``2 - M`` at the upper one."""
    return q["M"] + 2 * (1 - q["M"]) * s / q["L"]


SAG = 0.05
"""Departure of the cylinder's shape from the stretched one: no state has a displacement of zero, to which no
Newton step could be relative."""


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
"""Paper 4: lengths over the undeformed radius; both ends held at radius ``Af`` and stretched by ``delta``."""

DEEPER = 1.02
"""Depth of the hemisphere's shape: no Newton step could be relative to a displacement of zero."""

HEMISPHERE = Body(
    name="hemisphere",
    parameters=(),
    length=lambda _q: math.pi / 2,
    radius=lambda t, _q: ufl.sin(t),
    thickness=lambda _t, _q: 1.0,
    shape=lambda t, _q: (1.0, -DEEPER * ufl.cos(t)),
    held=((False, False), (True, True)),
    pole=True,
)
"""Paper 5: hangs from its equator, lengths over its radius; ``S = t`` is the angle from the pole, ``z``
counts from the equator's plane upwards."""
