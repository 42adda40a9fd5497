"""Polynomials whose coefficients are constants of the forms, for the history of a stuck patch."""

from __future__ import annotations

from functools import cache

import numpy as np
from dolfinx import fem
from dolfinx.mesh import Mesh
from numpy.polynomial import chebyshev
from ufl.core.expr import Expr

from weakforms.forms.series import newton_series

CHUNK = 24
"""The number of stored coefficients is a multiple of this, unless another one is given."""


class Series:
    """A Chebyshev series on ``[0, span]``, stored in Newton's form.

    Series of any length share one form, which is compiled once for all meshes.

    Args:
        mesh: Mesh of the forms.
        count: Largest number of coefficients.
        span: Right end of the interval, a constant of the forms.
        chunk: The number of stored coefficients is a multiple of this.
    """

    def __init__(self, mesh: Mesh, count: int, span: fem.Constant, chunk: int = CHUNK) -> None:
        self._nodes = leja_points(max(1, -(-count // chunk)) * chunk)
        self._constant = fem.Constant(mesh, np.zeros(len(self._nodes)))
        self._span = span
        self._known: dict[Expr, tuple[Expr, Expr]] = {}

    def __call__(self, x: Expr) -> tuple[Expr, Expr]:
        """Value and derivative at ``x``; the long expressions are kept for further calls."""
        if x not in self._known:
            coefficients = [self._constant[m] for m in range(len(self._nodes))]
            self._known[x] = newton_series(coefficients, self._nodes, x, self._span)
        return self._known[x]

    def set(self, coefficients: np.ndarray) -> None:
        """Set the coefficients of a Chebyshev series.

        Raises:
            ValueError: If there are more coefficients than the largest number.
        """
        if len(coefficients) > len(self._nodes):
            raise ValueError(f"{len(coefficients)} coefficients, room for {len(self._nodes)}")
        nodes = np.array(self._nodes)
        differences = chebyshev.chebval(nodes / 2, coefficients)
        for m in range(1, len(nodes)):
            differences[m:] = (differences[m:] - differences[m - 1]) / (nodes[m:] - nodes[m - 1])
        self._constant.value[:] = differences


@cache
def leja_points(count: int) -> tuple[float, ...]:
    """Chebyshev points of ``[-2, 2]`` in Leja's order: each as far as possible from those before it.

    In this order, divided differences of many points lose no digits.
    """
    left = list(2 * chebyshev.chebpts1(count))
    chosen = [left.pop()]
    while left:
        farthest = int(np.argmax([np.sum(np.log(np.abs(np.array(chosen) - t))) for t in left]))
        chosen.append(left.pop(farthest))
    return tuple(float(t) for t in chosen)
