r"""A part of a sphere under gas, clamped at a circle: the hemisphere, and shallower or deeper parts.

The circle lies at the angle ``A`` from the pole, and its radius is 1. The meridian at rest is, with the
fraction ``S`` in ``[0, 1]`` of it from the pole,

.. math:: R = \frac{\sin AS}{\sin A}, \qquad Z = \frac{\cos AS - \cos A}{\sin A}, \qquad
          c = \frac{\mathrm{d}(\text{arc})}{\mathrm{d}S} = \frac{A}{\sin A}

and the potential

.. math:: \frac{\Pi}{2\pi} = \int_0^1 \Big[ c R\, w(\lambda_1, \lambda_2) + \frac p2 \rho^2 \eta_{,S} \Big]
          \mathrm{d}S, \qquad \lambda_1 = \frac1c \sqrt{\rho_{,S}^2 + \eta_{,S}^2}, \quad
          \lambda_2 = \frac{\rho}{R}

For ``A -> 0`` it is that of the flat disk without pre-stretch.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property, partial
from math import sin, tan

import ufl
from ufl.core.expr import Expr

from weakforms.problems.branch_problem import from_rest
from weakforms.problems.diagram.bodies.varied import WAVES, Kind, VariedDisk
from weakforms.problems.diagram.followed import ended_by_law
from weakforms.problems.disk.phases import USUAL_LOAD
from weakforms.problems.meridian.body import Body, Values
from weakforms.problems.meridian.limits import relative_stiffness
from weakforms.problems.meridian.waves import PoleWaves
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.stability.modes import SecondVariation

FIRST_P = 0.25
"""Pressure of the first state over the radius of the sphere at rest, of a neo-Hookean law with ``C1 = 1``.
Without pressure a membrane that is not stretched does not resist a change of its shape; at a small one there
is a layer of width ``sqrt(p/12)`` at the clamp."""

HIGHER = 0.02
"""By which fraction the pole of the first guess is higher than at rest, so that the guess is in tension."""


def _rest(s: Expr, q: Values) -> tuple[float, Expr]:
    """Part of ``rho/R`` that is not unknown, none, and the height at rest."""
    angle = q["angle"]
    return 0.0, (ufl.cos(angle * s) - ufl.cos(angle)) / ufl.sin(angle)


def _rate(q: Values) -> Expr:
    """Derivative of the reference arc by ``S``."""
    return q["angle"] / ufl.sin(q["angle"])


class VariedCap(VariedDisk):
    """The part of a sphere; its loads are ``p``, ``angle``, and constants of the law that vary."""

    name = "hemisphere"
    depth = "t0"
    body_of = Body(
        name="hemisphere",
        parameters=(),
        length=lambda _q: 1.0,
        radius=lambda s, q: ufl.sin(q["angle"] * s) / ufl.sin(q["angle"]),
        thickness=lambda _s, q: _rate(q),
        shape=_rest,
        held=((None, None), (1.0, 0.0)),
        scales=lambda q: (1 / _rate(q), 1.0),
        upwards=-1.0,
        pole=True,
    )

    def mass(self) -> ufl.Form:
        """``int (S^2 u^2 + w^2) S dS``, as of the flat disk: it depends on no parameter."""
        s, _ = self.place()
        (u, w), (v, y) = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        return (s**2 * u * v + w * y) * s * self.dx

    @cached_property
    def _waves(self) -> PoleWaves:
        return PoleWaves(self)

    def operators(self, kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """The second variation in waves around the axis; a part of a sphere has no parity along it."""
        numbered = WAVES.fullmatch(kind)
        return {0: partial(self._waves.held, int(numbered[1]))} if numbered else {}

    def primary(self, end: float, step: float, kind: Kind = EquilibriumBranch) -> EquilibriumBranch:
        """Inflation from a small pressure up to ``t0 = end``, or to the law's end."""
        begin = self.system.initial.copy()
        angle = begin.loads["angle"]
        constants = tuple((n, begin.loads.get(n, value)) for n, value in self.material_law.constants)
        stiffness = relative_stiffness(replace(self.material_law, constants=constants))
        begin.loads["p"] = FIRST_P * sin(angle) * stiffness
        begin.u[1::2] = HIGHER * rest_height(angle) * (1 - self.nodes() ** 2)
        ends = {"usual_load": USUAL_LOAD, "kind": kind, "gives_way": self.gives_way}
        return ended_by_law(from_rest(self.system, "p", "t0", end, step, begin, **ends), self)


def rest_height(angle: float) -> float:
    """Height of the pole at rest."""
    return tan(angle / 2)
