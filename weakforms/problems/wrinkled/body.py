"""Membranes of revolution whose wrinkling is studied."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import ufl

from weakforms.problems.meridian.body import Body, Values
from weakforms.problems.meridian.thickness import Thickness

SHARED = ("p", "zw", "gamma", "c2", "residual_stiffness")
"""Parameters of every body: gas pressure, level and weight of the liquid, C2/C1, ``eps`` of the homotopy."""


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


@dataclass(frozen=True)
class Uneven:
    """A thickness given as text, reached from the uniform one: ``1 + uneven (H - 1)``."""

    given: Thickness

    def __call__(self, s: Any, q: Values) -> Any:
        """The thickness at a coordinate."""
        return 1 + q["uneven"] * (self.given(s, q) - 1)


def cylinder(thickness: Thickness | None) -> Body:
    """The cylinder of linear thickness, with the parameter ``M``, or of a given one, with ``uneven`` = 1."""
    if thickness is None:
        return CYLINDER
    own = ("uneven", *CYLINDER.parameters[1:])
    return replace(CYLINDER, parameters=own, thickness=Uneven(thickness), easy=(("uneven", 0.0),))


SHAPE_DEPTH = 1.02
"""Depth of the hemisphere's shape, so that no state has zero displacement."""

HEMISPHERE = Body(
    name="hemisphere",
    parameters=(),
    length=lambda _q: math.pi / 2,
    radius=lambda t, _q: ufl.sin(t),
    thickness=lambda _t, _q: 1.0,
    shape=lambda t, _q: (1.0, -SHAPE_DEPTH * ufl.cos(t)),
    held=((None, None), (0.0, 0.0)),
    pole=True,
)
"""Paper 5: it hangs from its equator. Lengths are divided by its radius, ``S = t`` is the angle from the
pole, and ``z`` is measured upwards from the plane of the equator."""


def hemisphere(thickness: Thickness | None) -> Body:
    """The hemisphere, of uniform or of a given thickness."""
    return HEMISPHERE if thickness is None else replace(HEMISPHERE, thickness=thickness)
