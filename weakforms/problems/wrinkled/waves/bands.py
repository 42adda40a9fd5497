"""Unstable real wave numbers at a state of a wrinkled membrane, and the stiffness that removes them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.problems.wrinkled.waves.modes import waves_at
from weakforms.solvers.support.roots import root

TOLERANCE = 1e-11
"""Relative accuracy of roots."""

STIFF = 1.0
"""Largest bending stiffness of the search."""

AROUND, NODES = 0.05, 9
"""The largest stiffness is located on a polynomial: number of its wave numbers, and their relative range."""


@dataclass(frozen=True)
class Bands:
    """Real wave numbers at one state, with a bending stiffness."""

    held: ZonedState
    beta: float = 0.0

    def lowest(self, n: float, beta: float | None = None) -> float:
        """The lowest eigenvalue."""
        with waves_at(self.held) as waves:
            return waves.spectrum(n, 1, self.beta if beta is None else beta).eigenvalues[0]

    def unstable(self, n: float) -> bool:
        """Whether it is negative, by inertia."""
        with waves_at(self.held) as waves:
            return waves.negative_count(n, self.beta) > 0

    def first_whole(self, most: int) -> int | None:
        """Smallest unstable whole wave number up to ``most``."""
        return next((n for n in range(1, most + 1) if self.unstable(n)), None)

    def band(self, most: int) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Intervals around both ends of the unstable whole wave numbers; ``None`` if there are none.

        Raises:
            AbsentError: If they reach beyond ``most``.
        """
        unstable = [n for n in range(1, most + 1) if self.unstable(n)]
        if not unstable:
            return None
        if unstable[-1] == most:
            found = f"unstable wave numbers begin at n = {unstable[0]}, and the band reaches beyond {most}"
            raise AbsentError("n_plus", f"{found}, the last one that is looked at")
        return (unstable[0] - 1.0, float(unstable[0])), (float(unstable[-1]), unstable[-1] + 1.0)

    def zero(self, low: float, high: float) -> float:
        """Wave number between two at which the lowest eigenvalue is zero.

        Raises:
            ConvergenceError: If its sign is the same at both.
        """
        low = max(low, 1e-3)
        if self.lowest(low) * self.lowest(high) > 0:
            raise ConvergenceError(f"no change of stability between n = {low:g} and {high:g} on a mesh")
        return root(self.lowest, low, high, "a change of stability in n", xtol=TOLERANCE, rtol=TOLERANCE)

    def stiffness(self, n: float) -> float:
        """Bending stiffness at which the lowest eigenvalue of ``n`` waves is zero; 0 where it is stable.

        Raises:
            AbsentError: If no stiffness up to :data:`STIFF` makes it stable. Displacements that leave the
                hoop curvature as it is have no bending energy, and the law may be unstable along them.
        """
        if not self.unstable(n):
            return 0.0
        stiff = 1e-8
        with waves_at(self.held) as waves:
            while waves.negative_count(n, stiff):
                stiff *= 10
                if stiff > STIFF:
                    reason = f"n = {n:g} is unstable at any bending stiffness up to {STIFF:g}"
                    raise AbsentError("beta_c", reason)
            return waves.stiffness(n, stiff)

    def most_stiffness(self, most: int) -> float | None:
        """Approximate wave number that needs the largest bending stiffness; ``None`` if all are stable."""
        tried = np.unique(np.round(np.geomspace(2, most, 24)))
        found = [self.stiffness(float(n)) for n in tried]
        k = int(np.argmax(found))
        if found[k] == 0.0:
            return None
        bounds = float(tried[max(k - 1, 0)]), float(tried[min(k + 1, len(tried) - 1)])
        best = minimize_scalar(
            lambda n: -self.stiffness(float(n)), bounds=bounds, method="bounded", options={"xatol": 1e-2}
        )
        return float(best.x)

    def peak(self, near: float) -> tuple[float, float]:
        """``(n_c, beta_c)``: the largest stiffness that any real wave number needs, and this wave number."""
        nodes = near * (1 + AROUND * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES))
        values = np.array([self.stiffness(float(n)) for n in nodes])
        if values.min() == 0.0:
            raise ConvergenceError(f"the wave numbers around n = {near:g} are not all unstable")
        fit = np.polynomial.Chebyshev.fit(nodes, values, NODES - 1)
        roots = fit.deriv().roots()
        inside = roots[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real - near) < AROUND * near)].real
        if not len(inside):
            raise ConvergenceError(f"the largest stiffness is not near n = {near:g}")
        best = inside[np.argmax(fit(inside))]
        return float(best), float(fit(best))
