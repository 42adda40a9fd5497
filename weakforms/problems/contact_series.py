"""Polynomials whose coefficients are constants of the forms: the history of a patch that sticks."""

from __future__ import annotations

from functools import cache

import numpy as np
from dolfinx import fem
from dolfinx.mesh import Mesh
from numpy.polynomial import chebyshev
from ufl.core.expr import Expr

from weakforms.forms.series import newton_series

ROOM = 24
"""Coefficients are kept in multiples of this many."""


class Series:
    """A Chebyshev series on ``[0, span]``, kept in Newton's form.

    Series of any length share one form, so that it is compiled once and not for every mesh.

    Args:
        mesh: Of the forms.
        count: Coefficients there is to be room for.
        span: Right end, a constant of the forms.
    """

    def __init__(self, mesh: Mesh, count: int, span: fem.Constant) -> None:
        self._nodes = leja_points(max(1, -(-count // ROOM)) * ROOM)
        self._constant = fem.Constant(mesh, np.zeros(len(self._nodes)))
        self._span = span
        self._known: dict[Expr, tuple[Expr, Expr]] = {}

    def __call__(self, x: Expr) -> tuple[Expr, Expr]:
        """Value and derivative at ``x``; the same expressions each time, which are long."""
        if x not in self._known:
            coefficients = [self._constant[m] for m in range(len(self._nodes))]
            self._known[x] = newton_series(coefficients, self._nodes, x, self._span)
        return self._known[x]

    def set(self, coefficients: np.ndarray) -> None:
        """Give it the coefficients of a Chebyshev series.

        Raises:
            ValueError: For more than there is room for.
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
    """Chebyshev points of ``[-2, 2]``, each as far as can be from those before it.

    Divided differences of many points lose no digits in that order.
    """
    left = list(2 * chebyshev.chebpts1(count))
    chosen = [left.pop()]
    while left:
        farthest = int(np.argmax([np.sum(np.log(np.abs(np.array(chosen) - t))) for t in left]))
        chosen.append(left.pop(farthest))
    return tuple(float(t) for t in chosen)
