r"""Waves around a wrinkled membrane: its second variation for any wave number, by differentiation.

.. math:: K d = \Lambda M d, \qquad d^T K d = \frac2\pi\,\delta^2\Pi, \qquad
          d^T M d = \int H R\,(u^2 + q^2 + w^2)\,\mathrm dS

The membrane is unstable to ``n`` waves if and only if the lowest ``Lambda`` is negative. Eigenvalues are
divided by ``g/Ao``, for a membrane of density ``C1/(Ao g)`` (Patil, Nordmark & Eriksson 2016, Paper 5). A
perturbation does not move break points.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property

import numpy as np
from dolfinx import fem
from ufl.core.expr import Expr

from weakforms.forms import revolution
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.waves import PoleWaves
from weakforms.problems.wrinkled.model import WrinkledModel, kept_with_model
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modes import SecondVariation, judged
from weakforms.solvers.stability.spectra import Mode, Spectrum, Stability

MODE = ("meridional", "circumferential", "normal")
"""Components of a mode: along the meridian, around the axis, outwards."""


class Waves(PoleWaves):
    """Second variations of the state that a model is lent to, with their spectra and modes.

    Args:
        model: The model.
    """

    def __init__(self, model: WrinkledModel) -> None:
        super().__init__(model)
        self.bending = fem.Constant(model.mesh, 0.0)
        """Name of the load ``beta``: bending stiffness over ``H^3``, for the circumferential curvature
        alone."""

    # -- the operator --------------------------------------------------------------------------

    def energy(self, parts: tuple[Expr, ...], slopes: tuple[Expr, ...]) -> Expr:
        """Energy of the displaced surface per ``S``, with bending, summed over the two angles."""
        model = self.model
        curvature = revolution.hoop_bending(self.base, parts, slopes, self.wave_number)
        thickness, radius = (
            model.body.thickness(model.expressions["S"], model.q),
            model.expressions["radius"],
        )
        bending = self.bending * thickness**3 * curvature**2 / (2 * radius**3)
        return super().energy(parts, slopes) + bending

    def variation(self, n: float, beta: float = 0.0) -> SecondVariation:
        """The operator for ``n`` waves; any real ``n`` except 0, for which the mode is axisymmetric.

        Edges and a pole do not move, except that one wave shifts the pole sideways.
        """
        self.bending.value = beta
        return self.held(n)

    # -- spectra and modes -------------------------------------------------------------------------

    def spectrum(self, n: float, count: int = 3, beta: float = 0.0) -> Spectrum:
        """The lowest eigenvalues at the current state, and the number of negative ones.

        For ``n = 0`` torsion is left out.

        Raises:
            ConvergenceError: If SLEPc and the inertia disagree on the number of negative ones.
        """
        if n == 0:
            system = self.model.system
            with system.weighed_here():
                return judged(Stability(system), system.state(), count)
        return self.variation(n, beta).spectrum(count)

    def negative_count(self, n: float, beta: float = 0.0) -> int:
        """Number of negative eigenvalues at the current state, by inertia."""
        return self.variation(n, beta).negative_count()

    def stiffness(self, n: float, stiff: float) -> float:
        r"""Bending stiffness at which the lowest eigenvalue is zero, from one at which all are positive.

        The operator is linear in the stiffness, :math:`K(\beta) = K_0 + \beta K_1`. The difference from the
        larger stiffness is therefore the lowest eigenvalue :math:`\nu` of :math:`K(\beta) x = \nu K_1 x`.

        Raises:
            ConvergenceError: If there is an instability at the larger stiffness too.
        """
        without = self.variation(n, 0.0).tangent().copy()
        variation = self.variation(n, stiff)
        bending = variation.tangent().copy()
        bending.axpy(-1.0, without)
        bending.scale(1.0 / stiff)
        try:
            return stiff - variation.lowest_against(bending)
        finally:
            bending.destroy()
            without.destroy()

    def near_zero(self, n: float, beta: float = 0.0) -> float:
        """The lowest eigenvalue where it is near zero, with its sign by inertia."""
        variation = self.variation(n, beta)
        return variation.stability.nearest_by_index(State(np.zeros(variation.size), {}), 0)

    def lowest_mode(self, n: float, beta: float = 0.0) -> Mode:
        """The lowest eigenvalue and its mode."""
        variation = self.variation(n, beta)
        lowest = variation.spectrum(1).eigenvalues[0]
        return variation.stability.mode_at(State(np.zeros(variation.size), {}), lowest)

    @cached_property
    def _mode(self) -> tuple[fem.Function, Meridian]:
        """The mode and its sampler."""
        e, d = self.model.expressions, fem.Function(self.space)
        u, q, w = self.parts(d)[0]
        columns = {
            "meridional": (u * e["r_s"] + w * e["z_s"]) / e["lam1"],
            "circumferential": q,
            "normal": (u * e["z_s"] - w * e["r_s"]) / e["lam1"],
        }
        return d, Meridian(self.model, columns)

    def sampled(self, mode: Mode, s: np.ndarray, loads: dict[str, float]) -> dict[str, np.ndarray]:
        """Components of a mode of unit length at material points, with a positive largest normal one."""
        function, meridian = self._mode
        function.x.array[: len(mode.vector)] = mode.vector
        function.x.scatter_forward()
        outwards, inwards = (meridian.extreme("normal", sign) for sign in (1, -1))
        sign = 1.0 if outwards >= -inwards else -1.0
        found = meridian.sampled(s, loads)
        return {name: sign * found[name] for name in MODE}


@kept_with_model
def waves_of(model: WrinkledModel) -> Waves:
    """The waves of a model."""
    return Waves(model)


@contextmanager
def waves_at(held: ZonedState) -> Iterator[Waves]:
    """Context in which the model belongs to a state; gives the waves of the state."""
    with held.lent():
        yield waves_of(held.model)
