"""What a sheet under gas or a liquid allows: where its law gives way, and which numbers there are."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ufl.core.expr import Expr

from weakforms.errors import InputError
from weakforms.forms.materials import SurfaceLaw
from weakforms.forms.wrinkling import principal_stretches
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.limits import resistance
from weakforms.problems.meridian.pre_stretch import has_bounded_force
from weakforms.problems.problem import Requests
from weakforms.problems.triangles.readings import LeastStress
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

MEDIA = {"gas": ("p", "V"), "liquid": ("zw", "V_f")}
"""The load and the amount of each medium."""

BOUNDED = {"gamma": 1.0, "stretch": 2.0}
"""Largest weight of a liquid and largest stretch of the supports for a law of bounded force. Beyond, the
places where its sheets give way, and with them the special points, depend on the mesh."""

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


def require_light(problem: str, law: Chosen, gamma: float, stretches: Mapping[str, float]) -> None:
    """Refuse a heavy liquid on, and much stretched supports of, a sheet whose law has a bounded force.

    Args:
        problem: Name of the problem, for the message.
        law: The law.
        gamma: Weight of the liquid.
        stretches: Stretches of the supports, by the names of the parameters.

    Raises:
        InputError: With a message that names the value and what is allowed.
    """
    if not has_bounded_force(law):
        return
    most = {"gamma": BOUNDED["gamma"]} | dict.fromkeys(stretches, BOUNDED["stretch"])
    for name, value in ({"gamma": gamma} | dict(stretches)).items():
        if value > most[name]:
            raise InputError(
                f"{problem}: {name} = {value:g}: the force of model = {law.model!r} is bounded, and a "
                "sheet of it gives way at one place under a liquid; allowed with load = 'liquid': "
                f"{name} up to {most[name]:g}"
            )


def require_own_load(problem: str, load: str, requests: Requests) -> None:
    """Refuse states by the load or the amount of the medium that is not there.

    Raises:
        InputError: With a message that names the allowed ones.
    """
    own, absent = MEDIA[load], {name for pair in MEDIA.values() for name in pair} - {*MEDIA[load]}
    for wanted in requests.states:
        if wanted.name in absent:
            raise InputError(
                f"{problem}: with load = {load!r} there is no {wanted.name}; allowed: {', '.join(own)}"
            )
