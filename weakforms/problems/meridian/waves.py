r"""Waves around an axisymmetric membrane: its second variation for any wave number, by differentiation.

.. math:: d^T K d = \frac2\pi\,\delta^2\Pi, \qquad
          \mathrm dx = u \cos n\Theta\, e_r + q \sin n\Theta\, e_\theta + w \cos n\Theta\, e_z

for any body, law and load of a :class:`MeridianModel`. The membrane is unstable to ``n`` waves if and only if
``K`` has a negative eigenvalue; for ``n >= 1`` each of them counts twice, for ``cos`` and for ``sin``. The
volume does not change to first order, so that the eigenvalues are the same for every control of the load. A
perturbation does not move break points (Patil, Nordmark & Eriksson 2015, section 3; 2016, section 2.3).
"""

from __future__ import annotations

from collections.abc import Sequence

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from ufl.core.expr import Expr

from weakforms.forms import revolution
from weakforms.forms.fluid import axisymmetric
from weakforms.problems.meridian.blocks import LOWER, UPPER
from weakforms.problems.meridian.model import MeridianModel
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.stability.modes import SecondVariation

RADIAL, HOOP, AXIAL = 0, 1, 2
"""Components of a wave."""

CLAMPED = (RADIAL, HOOP, AXIAL)
"""Components that are zero at an edge which is held."""


class MeridianWaves:
    """Second variations of the state that a model is lent to.

    Args:
        model: The model.
    """

    def __init__(self, model: MeridianModel) -> None:
        self.model = model
        element = basix.ufl.element("Lagrange", "interval", model.degree, shape=(3,))
        self.space = fem.functionspace(model.mesh, element)
        self.wave_number = fem.Constant(model.mesh, 0.0)
        self._variations: dict[tuple, SecondVariation] = {}
        e = model.expressions
        self.base = axisymmetric(e["r"], e["z"], (e["r_s"], e["z_s"]))

    # -- the operator --------------------------------------------------------------------------

    def parts(self, d: Expr) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
        """``(u, q, w)`` of the unknowns, and slopes in ``S``."""
        width = self.model.expressions["width"]
        return tuple(d), tuple(d.dx(0) / width)

    def energy(self, parts: tuple[Expr, ...], slopes: tuple[Expr, ...]) -> Expr:
        """Energy of the displaced surface per ``S``, summed over the two angles."""
        model, e, q = self.model, self.model.expressions, self.model.q
        taut, scales = self._taut(), model.body.scales(q)
        total = 0.0
        for at in revolution.around(self.base, parts, slopes, self.wave_number):
            c = revolution.gradient_tensor(at, e["radius"], scales)
            total += e["weight"] * revolution.strain_energy(c, taut, model.full)
            if "p" in q:
                total += revolution.gas_energy(at, model.body.upwards * q["p"])
            if "zw" in q:
                wet = model.marked("wet", q["zw"] - e["z"])
                total += revolution.liquid_energy(at, q["zw"], q["gamma"], wet)
        return total

    def _taut(self) -> Expr:
        if self.model.energy == "standard":
            return ufl.gt(self.model.expressions["lam1"], 0.0)
        return self.model.marked("taut", self.model.expressions["gw"] - 1)

    def density(self) -> Expr | float:
        """Mass per ``S``: that of the reference volume."""
        return self.model.expressions["weight"]

    def formulation(
        self, lower: Sequence[int], upper: Sequence[int] = CLAMPED, everywhere: Sequence[int] = ()
    ) -> Formulation:
        """First variation at the displaced state, mass and conditions.

        Args:
            lower: Components that are zero at the first end.
            upper: At the last end.
            everywhere: Everywhere.
        """
        model, width = self.model, self.model.expressions["width"]
        # The base system keeps derivatives of each operator by the name of its unknown.
        d = fem.Function(self.space, name="_".join(["waves", *map(_digits, (lower, upper, everywhere))]))
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        dx = ufl.Measure("dx", model.mesh, metadata={"quadrature_degree": 4 * model.degree})
        residual = ufl.derivative(self.energy(*self.parts(d)) * width * dx, d, test)
        own, others = (ufl.as_vector(list(self.parts(v)[0])) for v in (trial, test))
        return Formulation(
            unknown=d,
            residual=residual,
            loads=model.loads,
            bcs=self._conditions(lower, upper, everywhere),
            mass=ufl.inner(own, others) * self.density() * width * dx,
            monitors={},
        )

    def _conditions(
        self, lower: Sequence[int], upper: Sequence[int], everywhere: Sequence[int]
    ) -> list[fem.DirichletBC]:
        """Zero components at both ends, and everywhere."""
        tags, mesh = self.model.tags, self.model.mesh
        mesh.topology.create_connectivity(1, 1)  # needed to locate the conditions
        cells = np.arange(mesh.topology.index_map(1).size_local + mesh.topology.index_map(1).num_ghosts)
        held = [(i, 0, tags.find(LOWER)) for i in lower] + [(i, 0, tags.find(UPPER)) for i in upper]
        held += [(i, 1, cells.astype(np.int32)) for i in everywhere]
        out = []
        for component, dimension, entities in held:
            part = self.space.sub(component)
            dofs = fem.locate_dofs_topological(part, dimension, entities)
            out.append(fem.dirichletbc(np.array(0.0), dofs, part))
        return out

    def operator(
        self,
        n: float,
        lower: Sequence[int],
        upper: Sequence[int] = CLAMPED,
        everywhere: Sequence[int] = (),
    ) -> SecondVariation:
        """The operator for ``n`` waves with the conditions of :meth:`formulation`."""
        self.wave_number.value = n
        key = tuple(lower), tuple(upper), tuple(everywhere)
        if key not in self._variations:
            self._variations[key] = SecondVariation(self.formulation(*key), self.model.system)
        return self._variations[key]


class PoleWaves(MeridianWaves):
    """Second variations of a membrane whose first end may be a pole.

    Args:
        model: The model.
    """

    def __init__(self, model: MeridianModel) -> None:
        super().__init__(model)
        self._sheared = fem.Constant(model.mesh, 0.0)

    def parts(self, d: Expr) -> tuple[tuple[Expr, ...], tuple[Expr, ...]]:
        """``(u, q, w)`` of the unknowns ``(u + q, q, w)`` or ``(u, q, w)``, and slopes in ``S``.

        One wave shifts a pole sideways, ``u + q = 0``, which is a condition on the first unknown alone.
        """
        width = self.model.expressions["width"]
        mixed = [ufl.as_vector([v[0] - self._sheared * v[1], v[1], v[2]]) for v in (d, d.dx(0) / width)]
        return tuple(mixed[0]), tuple(mixed[1])

    def held(self, n: float) -> SecondVariation:
        """The operator for ``n`` waves; edges and a pole do not move, but one wave shifts the pole."""
        shifts = self.model.body.pole and n == 1
        self._sheared.value = float(shifts)
        return self.operator(n, (RADIAL, AXIAL) if shifts else CLAMPED)


def _digits(numbers: Sequence[int]) -> str:
    return "".join(map(str, numbers))
