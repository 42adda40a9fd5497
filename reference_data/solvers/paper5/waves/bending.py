r"""A bending energy of the incremental hoop curvature in the second variation (not in paper 5).

With D = beta H^3, j = lam1 and the first-order change of curvature

.. math::
   k_{22} = \frac{1}{j R^2}\Big[ z' \Big(-(n^2+1) u - 2 n q + \frac{r r'}{j^2} u'\Big)
            - r' \Big(-n^2 w + \frac{r r'}{j^2} w'\Big)\Big],

2 Pi2_b/pi = int D R k22^2 ds (model B1). The equilibrium does not change. beta = (2/3)(1 + c2)(h/Ao)^2 is
Koiter's value for an incompressible sheet.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.optimize import brentq

from reference_data.solvers.paper5.waves.second_variation import DU, DW, Q, Quadratic, U, W

Array = np.ndarray


def koiter(c2: float, thickness: float) -> float:
    """Koiter's beta of a sheet of a given thickness over Ao."""
    return 2 / 3 * (1 + c2) * thickness**2


class Bent:
    """Matrices of a state with the hoop's bending stiffness."""

    def __init__(self, form: Quadratic) -> None:
        self.form = form

    @cached_property
    def bending(self) -> list[sparse.csc_matrix]:
        """Coefficients of n^0..n^4 of the matrix at beta = 1."""
        f = self.form
        rows = np.zeros((3, *f.s.shape, 6))
        j = f.l1
        slope = f.r * f.dr / j**2
        rows[0, ..., U], rows[0, ..., DU], rows[0, ..., DW] = -f.dz, f.dz * slope, -f.dr * slope
        rows[1, ..., Q] = -2 * f.dz
        rows[2, ..., U], rows[2, ..., W] = -f.dz, f.dr
        rows = rows / (j * f.R**2)[..., None]
        out = np.zeros((5, *f.s.shape, 6, 6))
        for a in range(3):
            for b in range(3):
                out[a + b] += rows[a][..., :, None] * rows[b][..., None, :]
        scale = (f.H**3 * f.R)[..., None, None]
        return [f.assembled(scale * x) for x in out]

    def extra(self, n: float) -> sparse.csc_matrix:
        """The matrix of a wave number at beta = 1."""
        return sum(n**k * x for k, x in enumerate(self.bending))

    def first(self, n: float, beta: float) -> tuple[float, float]:
        """Lowest eigenvalue, and its derivative by beta."""
        extra = self.extra(n)
        values, modes = self.form.lowest(n, 1, beta * extra)
        d = modes[:, 0]
        return float(values[0]), float(d @ (extra @ d))

    def needed(self, n: float) -> float:
        """Smallest beta that stabilises a wave number; 0 if it is stable without bending.

        The eigenvalue is a concave function of beta: Newton's method converges to its zero monotonically from
        below.
        """
        beta = 0.0
        for _ in range(60):
            value, slope = self.first(n, beta)
            if value >= 0 and beta == 0:
                return 0.0
            step = -value / slope
            beta += step
            if abs(step) < 1e-13 + 1e-11 * beta:
                return beta
        raise RuntimeError(f"bending: no beta found for n = {n:g}")

    def tilt(self, n: float, beta: float) -> float:
        """Derivative of the lowest eigenvalue by n."""
        k, m = self.form.stiffness, [i * n ** (i - 1) * x for i, x in enumerate(self.bending) if i]
        d = self.form.lowest(n, 1, beta * self.extra(n))[1][:, 0]
        return float(d @ ((k[1] + 2 * n * k[2] + beta * sum(m)) @ d))

    def critical(self, near: float) -> tuple[float, float]:
        """Largest needed beta over real n, and that n; the first guess is the best of some grid points.

        At the largest needed beta the derivative of the eigenvalue with respect to n is zero.

        Raises:
            RuntimeError: If the maximum is not inside the grid.
        """
        grid = near * np.geomspace(0.6, 1.7, 5)
        values = [self.needed(float(n)) for n in grid]
        k = int(np.argmax(values))
        if not 0 < k < len(grid) - 1:
            raise RuntimeError(f"bending: no maximum of beta about n = {near:g}")
        slope = lambda n: self.tilt(float(n), self.needed(float(n)))  # noqa: E731
        n = float(brentq(slope, grid[k - 1], grid[k + 1], xtol=1e-9))
        return self.needed(n), n

    def lowest(self, beta: float, near: float) -> tuple[float, float]:
        """Smallest eigenvalue over real n at a given beta, and that n, near a guess."""
        n = float(brentq(lambda n: self.tilt(float(n), beta), near / 1.6, near * 1.6, xtol=1e-9))
        return self.first(n, beta)[0], n

    def band(self, beta: float, n_c: float) -> tuple[float, float]:
        """Ends of the band of unstable real n about n_c."""
        low = high = n_c
        while self.first(low, beta)[0] < 0:
            low /= 1.3
        while self.first(high, beta)[0] < 0:
            high *= 1.3
        zero = lambda n: self.first(float(n), beta)[0]  # noqa: E731
        return tuple(
            float(brentq(zero, *ends, xtol=1e-10)) for ends in ((low, low * 1.3), (high / 1.3, high))
        )
