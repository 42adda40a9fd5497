r"""Waves around a wrinkled membrane with the complete bending energy of a thin shell (not in Paper 5).

.. math:: \frac2\pi\Pi_{2b} = \int D R\,\big[k_{11}^2 + k_{22}^2 + 2\nu k_{11}k_{22} + 2(1-\nu)k_{12}^2\big]
          \,\mathrm dS, \qquad D = \beta H^3,\quad \nu = \tfrac12

It contains second derivatives. The elements are only continuous; a consistent symmetric interior penalty
couples the meridian's rotation across nodes (Engel et al. 2002). Both ends are simply supported.
"""

from __future__ import annotations

import ufl
from dolfinx import fem
from ufl.core.expr import Expr

from weakforms.forms.revolution import hoop_bending, meridional_bending
from weakforms.problems.meridian.waves import CLAMPED
from weakforms.problems.wrinkled.model import WrinkledModel, kept_with_model
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.problems.wrinkled.waves.modes import Waves, waves_of
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.stability.modes import SecondVariation

POISSON = 0.5

PENALTY = 10.0
"""Penalty factor, times the squared degree: stiffness of the coupling at a node over the stiffness of a
cell."""


class ShellWaves:
    """The second variation of membrane and shell bending at the states of a model."""

    def __init__(self, model: WrinkledModel) -> None:
        self.waves: Waves = waves_of(model)
        self.stiffness = fem.Constant(model.mesh, 0.0)
        self.variation = SecondVariation(self._formulation(), model.system)

    def _formulation(self) -> Formulation:
        waves, model = self.waves, self.waves.model
        plain = waves.formulation(CLAMPED)
        d = plain.unknown
        test = ufl.TestFunction(waves.space)
        return Formulation(
            unknown=d,
            residual=plain.residual + ufl.derivative(self._bending(d), d, test),
            loads=model.loads,
            bcs=plain.bcs,
            mass=plain.mass,
            monitors={},
        )

    def _bending(self, d: fem.Function) -> ufl.Form:
        """Bending energy with the penalty at nodes."""
        waves, model, e = self.waves, self.waves.model, self.waves.model.expressions
        width, radius, n = e["width"], e["radius"], waves.wave_number
        parts, slopes = waves.parts(d)

        def slope(value: Expr) -> Expr:
            return value.dx(0) / width

        second = tuple(slope(v) for v in (e["r_s"], e["z_s"], slopes[0], slopes[2]))
        k11, twist, rotation = meridional_bending(waves.base, parts, slopes, second, n)
        k22, k12 = hoop_bending(waves.base, parts, slopes, n) / radius**2, twist / radius
        rigidity = self.stiffness * model.body.thickness(e["S"], model.q) ** 3 * radius
        density = k11**2 + k22**2 + 2 * POISSON * k11 * k22 + 2 * (1 - POISSON) * k12**2
        moment = rigidity * (k11 + POISSON * k22)
        normal = ufl.FacetNormal(model.mesh)[0]
        kink = rotation("+") * normal("+") + rotation("-") * normal("-")
        tie = PENALTY * model.degree**2 * ufl.avg(rigidity * model.cells / width)
        dx = ufl.Measure("dx", model.mesh, metadata={"quadrature_degree": 4 * model.degree})
        inside = ufl.Measure("dS", model.mesh)
        return rigidity * density * width / 2 * dx + (tie * kink**2 / 2 - ufl.avg(moment) * kink) * inside

    def lowest(self, n: float, beta: float) -> float:
        """The lowest eigenvalue at the current state."""
        self.waves.wave_number.value, self.waves.bending.value, self.stiffness.value = n, 0.0, beta
        return self.variation.spectrum(1).eigenvalues[0]


@kept_with_model
def _shell_of(model: WrinkledModel) -> ShellWaves:
    return ShellWaves(model)


def shell_eigenvalue(held: ZonedState, n: float, beta: float) -> float:
    """Lowest eigenvalue for ``n`` waves with the shell's bending stiffness ``beta H^3``."""
    with held.lent():
        return _shell_of(held.model).lowest(n, beta)
