r"""Paper 1: the history of a stuck patch, by collocation in the position of its front.

While the patch grows, nothing jumps at its front (the energy release rate there is zero). The frozen shape
therefore continues the free part with its slopes:

.. math:: \rho_c'(x_f) = \rho'(x_f^+), \qquad F'(x_f) = -\eta'(x_f^+) \qquad \text{for every } x_f

with ``rho_c = x Lc(x)``. ``Lc`` and ``F'/x`` are Chebyshev series in ``x``. Both are even, but they contain a
term ``x^4 log x``, whose coefficients decrease like ``m^-9`` in series in ``x`` and like ``m^-5`` in series
in ``x**2``.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial import chebyshev

from weakforms.errors import ConvergenceError
from weakforms.problems.disk.model import DiskModel
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import State

SWEEPS = 80
"""Largest number of sweeps over the fronts."""

ACCURACY = 2e-11
"""Largest accepted defect of the two conditions."""

ITERATIONS = 12
"""Newton iterations before the history of one substrate counts as not converged."""

ON_THE_WAY = 1e-6
"""The same on the way to the substrate wanted."""

DIFFERENCE = 1e-6
"""Change of a coefficient by which what depends on it is differentiated."""

STIFFER = np.log(4.0)
"""Largest step of the logarithm of the substrate's stiffness."""

Series = tuple[np.ndarray, list[State]]
"""Coefficients of ``Lc`` and values of ``F'/x`` in one array, and the states at the fronts."""


class History:
    """Series of a model's bond, from the conditions at fronts at Chebyshev points of ``(0, span]``.

    Args:
        model: Model with a bond, whose series are set.
    """

    def __init__(self, model: DiskModel) -> None:
        self.model, self.bond = model, model.bond
        count, span = self.bond.terms, self.bond.span
        # Radau points in t = 2 x/span - 1: they include the end, but not the pole, where there is no free
        # part.
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

        If ``Lc`` at the front increases by ``d``, the slope ``rho'`` outside decreases by about the same
        amount (the mode ``1/x`` of the free part), and a plain fixed-point iteration would not converge. Each
        sweep therefore uses ``rho' + Lc`` of the sweep before.

        Args:
            guesses: States of the free part at the fronts.
            lam2: First guess of ``Lc`` at the fronts.
            steepness: First guess of ``F'/x`` there.

        Raises:
            ConvergenceError: If the sweeps do not converge.
        """
        self._states = list(guesses)
        coefficients = np.linalg.solve(self._value, lam2)
        for _ in range(SWEEPS):
            self._write(coefficients, steepness)
            radial, axial = self._outside()
            locked = self._value @ coefficients
            defect = np.abs(radial - self._radial @ coefficients).max()
            # The defect of F', not of F'/x, whose round-off at a small front has little effect.
            defect = np.maximum(defect, np.abs(self.fronts * (axial - steepness)).max())  # keeps what is NaN
            if defect < ACCURACY:
                self._found = np.concatenate([coefficients, steepness])
                return
            coefficients = np.linalg.solve(self._radial + self._value, radial + locked)
            steepness = axial
        raise ConvergenceError(f"history of the stuck patch: defect {defect:.1e} after {SWEEPS} sweeps")

    def solve_stiff(self, guesses: list[State], lam2: np.ndarray, steepness: np.ndarray, k: float) -> None:
        """The same for a stiff substrate, from states on a soft one.

        What a patch is pressed in by weighs as much as ``k``, and sweeps diverge: there Newton's method is
        used, with the stiffness raised step by step.

        Args:
            guesses: States of the free part at the fronts, on a soft substrate.
            lam2: First guess of ``Lc`` at the fronts.
            steepness: First guess of ``F'/x`` there.
            k: Stiffness wanted.

        Raises:
            ConvergenceError: When a step does not converge.
        """
        self.solve(guesses, lam2, steepness)

        def stiffer(kept: Series, log_k: float) -> Series:
            x, states = kept
            self._states = [State(s.u, s.loads | {"k": float(np.exp(log_k))}) for s in states]
            return self._newton(x, ON_THE_WAY), list(self._states)

        soft = float(np.log(guesses[0].loads["k"]))
        x, self._states = walk(stiffer, (self._found, list(self._states)), soft, float(np.log(k)), STIFFER)
        self._found = self._newton(x, ACCURACY)

    def solve_like(self, other: History) -> None:
        """The same history as on a coarser mesh, by Newton's method from there.

        Raises:
            ConvergenceError: When it does not converge.
        """
        coefficients, steepness = np.split(other._found, 2)
        t = 2 * self.fronts / other.bond.span - 1
        lam2 = chebyshev.chebval(t, coefficients)
        steep = chebyshev.chebval(t, chebyshev.chebfit(other._t, steepness, other.bond.terms - 1))
        self._states = [self.model.like(other.model, other.at(float(front))) for front in self.fronts]
        self._found = self._newton(np.concatenate([np.linalg.solve(self._value, lam2), steep]), ACCURACY)

    def at(self, front: float) -> State:
        """The state with its front at a place, once the history is known.

        Raises:
            ConvergenceError: When it does not converge.
        """
        nearest = self._states[int(np.argmin(np.abs(self.fronts - front)))]

        def solve(before: State, to: float) -> State:
            return self._solver.solve(before, [Held("gap", 0.0), Held("front", to)])[0]

        begin = nearest.loads["front"]
        return walk(solve, nearest, begin, front, abs(front - begin))

    def _newton(self, x: np.ndarray, accuracy: float) -> np.ndarray:
        """Coefficients of ``Lc`` and values of ``F'/x`` that satisfy the conditions, from a guess."""
        for _ in range(ITERATIONS):
            defects = self._defects(x)
            if np.abs(defects).max() < accuracy:
                return x
            x = x - np.linalg.solve(self._sensitivity(x), defects)
        raise ConvergenceError(f"history of the stuck patch: defect {np.abs(defects).max():.1e}")

    def _defects(self, x: np.ndarray) -> np.ndarray:
        """Of both conditions at all fronts, whose states are solved for."""
        coefficients, steepness = np.split(x, 2)
        self._write(coefficients, steepness)
        radial, axial = self._outside()
        return np.concatenate([radial - self._radial @ coefficients, self.fronts * (axial - steepness)])

    def _sensitivity(self, x: np.ndarray) -> np.ndarray:
        """Derivative of the defects: at each front a linear solve for every coefficient."""
        count, system = len(self.fronts), self.model.system
        out = np.zeros((2 * count, 2 * count))
        names = "rho_slope_outside", "steepness", "gap"
        for j, front in enumerate(self.fronts):
            self._write(*np.split(x, 2))
            system.set_state(self._states[j].u, self._states[j].loads)
            self._solver.factor.update()
            held = [Held("gap", 0.0), Held("front", float(front))]
            bordered = self._solver.border(held)
            rows = [system.monitor_gradient(name, self._solver.scalars) for name in names[:2]]
            forces, values = system.residual(), [system.monitor(name) for name in names]
            for m in range(2 * count):
                moved = x.copy()
                moved[m] += DIFFERENCE
                self._write(*np.split(moved, 2))
                change = (system.residual() - forces) / DIFFERENCE
                direct = [(system.monitor(n) - v) / DIFFERENCE for n, v in zip(names, values, strict=True)]
                u, loads = bordered.solve(-change, [-direct[2], 0.0])
                for i, (row, rates) in enumerate(rows):
                    scalars = zip(self._solver.scalars, loads, strict=True)
                    by_loads = sum(rates.get(name, 0.0) * float(value) for name, value in scalars)
                    out[i * count + j, m] = direct[i] + system.dot(row, u) + by_loads
        out[:count, :count] -= self._radial
        out[count:] *= self.fronts[:, None]
        out[count:, count:] -= np.diag(self.fronts)
        return out

    def _outside(self) -> tuple[np.ndarray, np.ndarray]:
        """``rho'`` and ``-eta'/x`` on the free side at every front, with the current series."""
        radial, axial = np.empty(len(self.fronts)), np.empty(len(self.fronts))
        system = self.model.system
        for j, front in enumerate(self.fronts):
            held = [Held("gap", 0.0), Held("front", float(front))]
            self._states[j], _ = self._solver.solve(self._states[j], held)
            radial[j] = system.monitor("rho_slope_outside")
            axial[j] = system.monitor("steepness")
        return radial, axial

    def _write(self, coefficients: np.ndarray, steepness: np.ndarray) -> None:
        """Write the series of ``Lc``, ``F`` and ``I`` into the model; the latter two are integrals."""
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
