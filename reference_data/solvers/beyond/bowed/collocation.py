r"""Second method: the balance of forces, point by point.

.. math:: (h f_a)_{,Z} + (h f_b)_{,\Theta} + \tfrac12 p\, b\times a = 0, \qquad h = 1 + \varepsilon\cos\Theta

with the forces of :mod:`paper3.strong.equations`, at Chebyshev-Lobatto nodes of s = 2 Z/lf and at equidistant
angles of the half circumference, the other half by symmetry. Nothing is integrated but the volume.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev

from reference_data.solvers.core.collocation import Array, differentiation, lobatto
from reference_data.solvers.paper3.strong.equations import forces, rates, spun

EVEN = True, False, True
"""Which of x, y, z are even about Theta = 0 and pi."""


class Collocation:
    """The discrete equations of one tube, with values at nodes ``(3, nodes, angles)`` as unknowns.

    Args:
        lf: Length over the radius.
        degree: Of the polynomials along half the tube.
        waves: Largest wave number around.
    """

    def __init__(self, lf: float, degree: int, waves: int) -> None:
        self.half, self.waves = lf / 2, waves
        self.nodes, self.theta = lobatto(degree), 2 * np.pi * np.arange(waves + 1) / (2 * waves + 1)
        self.shape = len(self.nodes), waves + 1
        size = self.shape[0] * self.shape[1]
        self.along = np.kron(differentiation(self.nodes) / self.half, np.eye(waves + 1))
        m = np.arange(waves + 1)
        cos, sin = np.cos(np.outer(self.theta, m)), np.sin(np.outer(self.theta, m))
        even = -(sin * m) @ np.linalg.inv(cos)
        odd = np.zeros_like(even)
        odd[:, 1:] = (cos * m)[:, 1:] @ np.linalg.inv(sin[1:, 1:])
        self.around = {kind: np.kron(np.eye(len(self.nodes)), d) for kind, d in ((True, even), (False, odd))}
        self.size = size

    @cached_property
    def free(self) -> Array:
        """Whether a value is unknown."""
        out = np.ones((3, *self.shape), bool)
        out[:, -1] = False
        out[2, 0] = False
        out[1, :, 0] = False
        return out.ravel()

    def tube(self, r: Array, z: Array) -> Array:
        """An axisymmetric tube by its meridian at the nodes."""
        one, cos, sin = np.ones_like(self.theta), np.cos(self.theta), np.sin(self.theta)
        return np.stack([np.outer(r, cos), np.outer(r, sin), np.outer(z, one)]).ravel()

    def meridian(self, x: Array) -> tuple[Array, Array]:
        """Its inverse."""
        parts = x.reshape(3, *self.shape)
        return parts[0, :, 0], parts[2, :, 0]

    def _mean(self, weight: Array) -> Array:
        """The row that reads a mean of x over the circumference in the middle."""
        share = np.full(self.waves + 1, 2 / (2 * self.waves + 1))
        share[0] /= 2
        out = np.zeros((3, *self.shape))
        out[0, 0] = share * weight
        return out.ravel()[self.free]

    @property
    def offset(self) -> Array:
        """The row that reads the mean of x in the middle."""
        return self._mean(np.ones(self.waves + 1))

    @property
    def radius(self) -> Array:
        """The row that reads the first cosine of x in the middle: the radius of an axisymmetric tube."""
        return self._mean(2 * np.cos(self.theta))

    def _tangents(self, x: Array) -> tuple[Array, Array]:
        parts = x.reshape(3, -1)
        a = np.stack([self.along @ part for part in parts], axis=-1)
        b = np.stack([self.around[even] @ part for even, part in zip(EVEN, parts, strict=True)], axis=-1)
        return a, b

    def load(self, _place: Array, p: float, _uneven: float) -> tuple[Array, Array, Array, Array]:
        """Pressure over mu at the nodes, its derivatives by p, by the unevenness and by x (nodes, 3)."""
        one = np.ones(self.size)
        return p / 2 * one, one / 2, 0 * one, np.zeros((self.size, 3))

    def thickness(self, uneven: float) -> tuple[Array, Array]:
        """Thickness at the nodes, its derivative by the unevenness."""
        side = np.tile(np.cos(self.theta), self.shape[0])
        return 1 + uneven * side, side

    def evaluate(self, x: Array, p: float, uneven: float) -> tuple[Array, Array, Array, Array]:
        """Residual, its derivatives by x, p and the unevenness, of the free values."""
        a, b = self._tangents(x)
        h, side = self.thickness(uneven)
        pressure, by_p, by_uneven, by_place = self.load(x.reshape(3, -1).T, p, uneven)
        f, d, normal = forces(a, b), rates(a, b), np.cross(b, a)
        turned = self.shape[1]
        matrix = np.zeros((3, self.size, 3, self.size))
        by_a, by_b = spun(b), -spun(a)  # of b x a

        def balance(weight: Array, c: int) -> Array:
            return self.along @ (weight * f[0][:, c]) + self.around[not EVEN[c]] @ (weight * f[1][:, c])

        columns = [(self.along, self.around[EVEN[e]]) for e in range(3)]
        for c in range(3):
            for e in range(3):
                first, second = (
                    (h * d[:, i, c, 0, e])[:, None] * columns[e][0]
                    + (h * d[:, i, c, 1, e])[:, None] * columns[e][1]
                    for i in (0, 1)
                )
                inner = self.along @ first + self.around[not EVEN[c]] @ second
                inner += (pressure * by_a[:, c, e])[:, None] * columns[e][0]
                inner += (pressure * by_b[:, c, e])[:, None] * columns[e][1]
                inner += np.diag(normal[:, c] * by_place[:, e])
                inner[:turned] = first[:turned]  # no force along x and y on the plane of symmetry
                matrix[c, :, e] = inner
        own, by_side = (np.stack([balance(w, c) for c in range(3)]) for w in (h, side))
        push = by_p * normal.T
        own += pressure * normal.T
        by_side += by_uneven * normal.T
        for values, weight in ((own, h), (by_side, side)):
            values[:, :turned] = (weight[:, None] * f[0])[:turned].T
        push[:, :turned] = 0.0
        free, matrix = self.free, matrix.reshape(3 * self.size, -1)
        vectors = (v.ravel()[free] for v in (own, push, by_side))
        residual, load, thick = vectors
        return residual, matrix[np.ix_(free, free)], load, thick

    def enclosed(self, x: Array) -> float:
        """Volume inside of the half circumference."""
        a, b = self._tangents(x)
        place = x.reshape(3, -1).T
        flux = (np.cross(b, a) * place)[:, :2].sum(axis=1).reshape(self.shape) / 2
        share = np.full(self.waves + 1, 2 / (2 * self.waves + 1))
        share[0] /= 2
        rings = np.pi * flux @ share
        series = chebyshev.chebfit(2 * self.nodes - 1, rings, len(self.nodes) - 1)
        whole = chebyshev.chebint(series)
        ends = chebyshev.chebval(np.array([1.0, -1.0]), whole)
        return float(ends[0] - ends[1]) / 2 * self.half

    def volume(self, x: Array) -> float:
        """Volume of this quarter of the tube, less that of the tube at rest."""
        return self.enclosed(x) - np.pi * self.half / 2
