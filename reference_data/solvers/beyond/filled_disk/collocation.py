r"""Method (b) for a filled disk: collocation of the balance of forces in space, over the radius squared.

With ``x = R^2`` a smooth disk has :math:`r = R\,a(x)` and :math:`z = b(x)`. Forces along the radius and the
axis balance if

.. math:: F + 2 x F' = H w_{,2} + 2 x P\, a\, b', \quad 2\,(x G)' = -P\, a\,(a + 2 x a'), \qquad
          F = H w_{,1} \frac{a + 2 x a'}{l_1}, \quad G = 2 H w_{,1} \frac{b'}{l_1},

with primes for derivatives in ``x``, :math:`l_1^2 = (a + 2 x a')^2 + 4 x b'^2` and :math:`l_2 = a`. Both
functions are Chebyshev series; the equations hold at the roots of the last polynomial.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev

from reference_data.solvers.core.mooney_rivlin import energy, slope
from reference_data.solvers.core.newton import newton

Array = np.ndarray

STEP = 1e-30
"""Step of derivatives in the complex plane."""


@dataclass(frozen=True)
class Collocation:
    """One disk: C2/C1, stretch of the rim, weight of the liquid (0: gas), ``e``, and degree of the series."""

    alpha: float
    delta: float
    gamma: float
    uneven: float
    degree: int

    @cached_property
    def _matrices(self) -> tuple[Array, Array, Array, Array, Array]:
        """Places, values and derivatives of the series there, derivatives between them, weights of a sum."""
        n = self.degree
        t = np.cos(np.pi * (np.arange(n) + 0.5) / n)
        value = chebyshev.chebvander(t, n)
        unit = np.eye(n + 1)
        rate = 2 * np.column_stack([chebyshev.chebval(t, chebyshev.chebder(unit[k])) for k in range(n + 1)])
        inverse = np.linalg.inv(value[:, :n])
        k = np.arange(n)
        whole = np.where(k % 2 == 0, 1 / (1.0 - k**2 + (k == 1)), 0.0)  # of polynomials over [0, 1]
        return (1 + t) / 2, value, rate, rate[:, :n] @ inverse, whole @ inverse

    def _fields(self, y: Array) -> tuple[Array, ...]:
        x, value, rate, *_ = self._matrices
        n = self.degree + 1
        a, b, b_x = value @ y[:n], value @ y[n:-1], rate @ y[n:-1]
        along = a + 2 * x * (rate @ y[:n])
        return a, b, b_x, along, np.sqrt(along**2 + 4 * x * b_x**2)

    def residual(self, y: Array, height: float) -> Array:
        """The equations of coefficients of ``a`` and ``b`` and the load; all of the disk is wet."""
        x, _, _, between, _ = self._matrices
        n = self.degree + 1
        a, b, b_x, along, l1 = self._fields(y)
        thick, push = 1 + self.uneven * x, self.gamma * (b - y[-1]) if self.gamma else y[-1]
        first = thick * slope(l1, a, self.alpha) / l1
        out, up = first * along, 2 * first * b_x
        radial = out + 2 * x * (between @ out) - thick * slope(a, l1, self.alpha) - 2 * x * push * a * b_x
        axial = 2 * (up + x * (between @ up)) + push * a * along
        signs = (-1.0) ** np.arange(n)
        pole = -height if self.gamma else height
        ends = [y[:n].sum() - self.delta, y[n:-1].sum(), signs @ y[n:-1] - pole]
        return np.concatenate([radial, axial, ends])

    def state(self, height: float, guess: Array) -> tuple[dict[str, float], Array]:
        """The state of a height of the centre, down for a liquid, from a guess."""

        def correct(y: Array) -> tuple[float, Callable[[float], Array]]:
            columns = [self.residual(y + 1j * STEP * e, height).imag / STEP for e in np.eye(len(y))]
            step = np.linalg.solve(np.column_stack(columns), self.residual(y, height))
            return float(np.abs(step).max()), lambda share: y - share * step

        y = newton(guess.astype(float), correct, f"disk at w_c = {height:g}")
        return self._numbers(y), y

    def start(self, height: float, load: float) -> Array:
        """A paraboloid over the stretched disk."""
        y = np.zeros(2 * self.degree + 3)
        n, pole = self.degree + 1, -height if self.gamma else height
        y[0], y[n], y[n + 1], y[-1] = self.delta, pole / 2, -pole / 2, load
        return y

    def _numbers(self, y: Array) -> dict[str, float]:
        x, *_, whole = self._matrices
        a, b, _, along, l1 = self._fields(y)
        depth = y[-1] - b if self.gamma else b
        if self.gamma and y[-1] < 0:
            raise RuntimeError(f"the level {y[-1]:g} is below the rim: a part is dry")
        stored = (1 + self.uneven * x) * energy(l1, a, self.alpha)
        amounts = np.pi * (whole @ np.column_stack([depth * a * along, stored]))
        return {"load": float(y[-1]), "amount": float(amounts[0]), "U": float(amounts[1])}
