r"""Paper 1: the history of a stuck patch, by collocation in the position of its front.

While the patch grows nothing jumps at its front (the energy release rate there is zero), so what is locked
continues the free part with its slopes:

.. math:: \rho_c'(x_f) = \rho'(x_f^+), \qquad F'(x_f) = -\eta'(x_f^+) \qquad \text{for every } x_f

with ``rho_c = x Lc(x)``. ``Lc`` and ``F'/x`` are Chebyshev series in ``x``. (Not in ``x**2``, though both are
even: they hold a term ``x^4 log x``, whose coefficients would fall as ``m^-5`` there; in ``x`` as ``m^-9``.)
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from weakforms.errors import ConvergenceError
from weakforms.problems.disk.model import DiskModel
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import State

SWEEPS = 80
"""Sweeps over the fronts before the history counts as not converged."""

ACCURACY = 2e-11
"""Largest defect of the two conditions accepted."""


class History:
    """Series of a model's bond that satisfy the front's conditions at Chebyshev points of ``(0, span]``.

    Args:
        model: Model with a bond; its series are written.
    """

    def __init__(self, model: DiskModel) -> None:
        self.model, self.bond = model, model.bond
        count, span = self.bond.terms, self.bond.span
        # Radau points in t = 2 x/span - 1: the end is one, the pole is not (it has no outer problem).
        t = np.cos(2 * np.pi * np.arange(count) / (2 * count - 1))
        self.fronts = span * (1 + t) / 2
        basis = chebyshev.chebvander(t, count - 1)
        slopes = np.stack([chebyshev.chebval(t, chebyshev.chebder(e)) for e in np.eye(count)], axis=1)
        slopes = slopes * 2 / span
        self._t, self._value = t, basis
        self._radial = basis + self.fronts[:, None] * slopes
        """``rho_c' = Lc + x Lc'`` from the coefficients of ``Lc``."""
        self._solver = ExtendedNewton(model.system, ["p", "front"])

    def solve(self, guesses: list[State], lam2: np.ndarray, steepness: np.ndarray) -> None:
        """Sweep over the fronts until the conditions hold.

        With ``Lc`` at the front raised by ``d`` the slope ``rho'`` outside falls by about as much (the mode
        ``1/x`` of the free part), and a plain fixed point would not converge: ``rho' + Lc`` is what a sweep
        takes over.

        Args:
            guesses: States of the free part at the fronts.
            lam2: First guess of ``Lc`` at the fronts.
            steepness: First guess of ``F'/x`` there.

        Raises:
            ConvergenceError: When the sweeps do not converge.
        """
        self._states = list(guesses)
        coefficients = np.linalg.solve(self._value, lam2)
        for _ in range(SWEEPS):
            self._write(coefficients, steepness)
            radial, axial = self._outside()
            locked = self._value @ coefficients
            defect = np.abs(radial - self._radial @ coefficients).max()
            # Of F', not of F'/x: what the round-off of the latter at a small front does is little.
            defect = max(defect, np.abs(self.fronts * (axial - steepness)).max())
            if defect < ACCURACY:
                return
            coefficients = np.linalg.solve(self._radial + self._value, radial + locked)
            steepness = axial
        raise ConvergenceError(f"history of the stuck patch: defect {defect:.1e} after {SWEEPS} sweeps")

    def _outside(self) -> tuple[np.ndarray, np.ndarray]:
        """``rho'`` and ``-eta'/x`` on the free side at every front, with the series as they stand."""
        radial, axial = np.empty(len(self.fronts)), np.empty(len(self.fronts))
        system = self.model.system
        for j, front in enumerate(self.fronts):
            held = [Held("gap", 0.0), Held("front", float(front))]
            self._states[j], _ = self._solver.solve(self._states[j], held)
            radial[j] = system.monitor("rho_slope_outside")
            axial[j] = system.monitor("steepness")
        return radial, axial

    def _write(self, coefficients: np.ndarray, steepness: np.ndarray) -> None:
        """Series of ``Lc``, ``F`` and ``I`` into the model; ``F`` and ``I`` are integrals of the others."""
        span, terms = self.bond.span, self.bond.terms
        lam2 = np.append(coefficients, 0.0)
        x = [span / 2, span / 2]  # as a series in t
        q = chebyshev.chebfit(self._t, steepness, terms - 1)
        falling = chebyshev.chebmul(x, q)  # dF/dx
        depth = chebyshev.chebint(falling, lbnd=-1.0) * span / 2
        radius = chebyshev.chebmul(x, lam2)
        density = chebyshev.chebmul(falling, chebyshev.chebmul(radius, radius)) / 2  # dI/dx
        moment = chebyshev.chebint(density, lbnd=-1.0) * span / 2
        self.model.series["lam2"].set(lam2)
        self.model.series["depth"].set(_shortened(depth, terms + 1))
        self.model.series["moment"].set(_shortened(moment, 2 * terms))


def _shortened(series: np.ndarray, terms: int) -> np.ndarray:
    """A series of fewer terms that interpolates a longer one at Chebyshev points with both ends."""
    t = np.cos(np.pi * np.arange(terms) / (terms - 1))
    return chebyshev.chebfit(t, chebyshev.chebval(t, series), terms - 1)
