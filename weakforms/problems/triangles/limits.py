"""Where a surface of a law of bounded force gives way."""

from __future__ import annotations

from collections.abc import Callable

from ufl.core.expr import Expr

from weakforms.forms.materials import SurfaceLaw
from weakforms.forms.wrinkling import principal_stretches
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.limits import resistance
from weakforms.problems.meridian.pre_stretch import has_bounded_force
from weakforms.problems.triangles.readings import LeastStress
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

GIVES_WAY = (
    "the law hardly resists more stretch at one place, where the stretch grows without bound from there on; "
    "lower w_end to a deflection below it, or choose another law"
)
"""Why a branch ends, and what to change."""


def gives_way(
    system: System, cauchy_green: Expr, chosen: Chosen, law: SurfaceLaw | Expr, rule: int
) -> Callable[[State], bool]:
    """Whether the law hardly resists more stretch at a point of quadrature of a state, as a function of it.

    See :func:`weakforms.problems.meridian.limits.resistance`. Laws whose force grows with the stretch never
    give way.
    """
    if not has_bounded_force(chosen):
        return lambda _: False
    left = resistance(law.stretches, *principal_stretches(cauchy_green))
    least = LeastStress(system.unknown.function_space.mesh, left, rule)

    def yields(state: State) -> bool:
        with system.at(state):
            return least.least()[1] < 0

    return yields
