r"""A long tube in the planes of diagrams: with ends that move under a force, and with held ends.

It stays a cylinder. Of unit length at rest it has, over :math:`2\pi R_o^2 h_o S`, the potential

.. math:: \frac{\Pi}{2\pi} = w(\lambda_1, \lambda_2) - \tfrac12 p\,\lambda_1\lambda_2^2 - F\lambda_1

Between held ends, ``F`` does no work. Both stretches of a part of the tube may change at the expense of
others, so that long axisymmetric waves have

.. math:: \delta^2\Pi = \delta^2\big[w - \tfrac12 p \lambda_1\lambda_2^2\big](\delta\lambda_1,
          \delta\lambda_2)

A slope ``a`` of the axis stretches the tube, :math:`\lambda_1^2 + a^2`, which it resists by its axial force
``N``: :math:`\delta^2\Pi = N a^2/\lambda_1` is the limit of long waves of bending.
"""

from __future__ import annotations

from collections.abc import Mapping

import ufl
from ufl.core.expr import Expr

from weakforms.problems.diagram.bodies.uniform import Pair, Perturbation, VariedUniform
from weakforms.problems.homogeneous.problem import under_force
from weakforms.solvers.equilibrium.state import State


class VariedLongTube(VariedUniform):
    """The tube, whatever holds its ends."""

    name, depth = "infinite_tube", "lam2"

    def potential(self, lam1: Expr, lam2: Expr) -> Expr:
        """The total potential at given pressure; the ends may move under a force."""
        own = self.law(lam1, lam2) - self.q["p"] * lam1 * lam2**2 / 2
        return own - self.q["force"] * lam1 if "force" in self.q else own

    def columns(self) -> dict[str, Expr]:
        """The volume."""
        lam1, lam2 = self.stretches()
        return {"V": lam1 * lam2**2 / 2}

    def stretched(self, columns: Mapping[str, float]) -> tuple[float, float]:
        """Both stretches of a state."""
        return columns["lam1"], columns["lam2"]

    def perturbations(self, _kind: str) -> dict[int, Perturbation]:
        """None: where the ends move freely, long waves begin at limit points."""
        return {}


class FreeTube(VariedLongTube):
    """The tube with ends that move under an axial force: loads ``p, force``."""

    unknowns = "lam1", "lam2"

    def stretches(self) -> Pair:
        """Both unknowns."""
        return self.unknown[0], self.unknown[1]

    def begin(self) -> State:
        """The state under the force alone, reached from rest in steps."""
        start, force = self.system.initial.copy(), self.system.initial.loads["force"]
        return under_force(self.system, start, "lam1", force, FORCE_STEP) if force else start


FORCE_STEP = 0.05
"""Largest step in which an axial force is applied."""


class HeldTube(VariedLongTube):
    """The tube with ends that are held at a stretch: loads ``p, lam1``."""

    unknowns = ("lam2",)

    def stretches(self) -> Pair:
        """The load, and the unknown."""
        return self.q["lam1"], self.unknown[0]

    def perturbations(self, kind: str) -> dict[int, Perturbation]:
        """Long waves that are axisymmetric, or that bend the axis."""
        lam1, lam2 = self.stretches()
        if kind == "localisation":
            return {0: Perturbation(2, lambda a: self.potential(lam1 + a[0], lam2 + a[1]), _product)}
        if kind == "n1":
            return {
                0: Perturbation(1, lambda a: self.potential(ufl.sqrt(lam1**2 + a[0] ** 2), lam2), _product)
            }
        return {}

    def begin(self) -> State:
        """The state that is only stretched."""
        start, law = self.system.initial.copy(), self.material_law
        constants = {name: start.loads.get(name, value) for name, value in law.constants}
        start.u[:] = float(law.material.width(start.loads["lam1"], **constants))
        return start


def _product(left: tuple[Expr, ...], right: tuple[Expr, ...]) -> Expr:
    return sum(a * b for a, b in zip(left, right, strict=True))
