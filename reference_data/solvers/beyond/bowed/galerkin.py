r"""First method: the principle of virtual work with trigonometric and Legendre polynomials.

Over the half circumference and the half length of a tube of radius 1, with Z = lf s/2 from the middle,

.. math:: F(x; v) = \iint 2 h\,(f_a \cdot v_{,Z} + f_b \cdot v_{,\Theta}) - p\, v\cdot N \; dZ\, d\Theta,
          \qquad h = 1 + \varepsilon \cos\Theta

with the factors of :mod:`paper3.weak`. x and z are cosines of Theta, y sines; each coefficient is one
polynomial of s by its values at Lobatto nodes. x and y are free at s = 0, z is zero there; at s = 1 all are
held.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from reference_data.solvers.core.collocation import Array, differentiation, lagrange, lobatto
from reference_data.solvers.paper3 import weak


class Galerkin:
    """The discrete equations of one tube.

    Args:
        lf: Length over the radius.
        degree: Of the polynomials along half the tube.
        waves: Largest wave number around.
    """

    def __init__(self, lf: float, degree: int, waves: int) -> None:
        self.half, self.degree, self.waves = lf / 2, degree, waves
        points, weights = np.polynomial.legendre.leggauss(degree + 8)
        nodes, around = lobatto(degree), 2 * waves + 8
        value = lagrange(nodes, (points + 1) / 2)
        along = value @ differentiation(nodes) / self.half
        theta = np.pi * (np.arange(around) + 0.5) / around
        m = np.arange(waves + 1)[:, None]
        cos, sin = np.cos(m * theta), np.sin(m * theta)
        self.theta = np.tile(theta, (len(points), 1)).ravel()
        self.weight = np.repeat(weights / 2 * self.half, around) * np.pi / around
        self.size = len(nodes) * (waves + 1)

        def both(left: Array, right: Array) -> Array:
            return np.einsum("qi,mj->qjim", left, right).reshape(len(self.weight), self.size)

        even = both(along, cos), both(value, -m * sin), both(value, cos)
        odd = both(along, sin), both(value, m * cos), both(value, sin)
        self.rows = even, odd, even  # of x_,Z, x_,Theta and x by components
        self.nodes = nodes

    @cached_property
    def free(self) -> Array:
        """Whether a coefficient is unknown, by component, node and wave number."""
        out = np.ones((3, len(self.nodes), self.waves + 1), bool)
        out[:, -1] = False
        out[2, 0] = False
        out[1, :, 0] = False
        return out.ravel()

    def tube(self, r: Array, z: Array) -> Array:
        """An axisymmetric tube by its meridian at the nodes."""
        x = np.zeros((3, len(self.nodes), self.waves + 1))
        x[0, :, 1] = x[1, :, 1] = r
        x[2, :, 0] = z
        return x.ravel()

    def meridian(self, x: Array) -> tuple[Array, Array]:
        """Its inverse."""
        parts = x.reshape(3, len(self.nodes), -1)
        return parts[0, :, 1], parts[2, :, 0]

    def _place(self, component: int, wave: int) -> Array:
        out = np.zeros((3, len(self.nodes), self.waves + 1))
        out[component, 0, wave] = 1.0
        return out.ravel()[self.free]

    @property
    def offset(self) -> Array:
        """The row that reads the mean of x in the middle."""
        return self._place(0, 0)

    @property
    def radius(self) -> Array:
        """The row that reads the first cosine of x in the middle: the radius of an axisymmetric tube."""
        return self._place(0, 1)

    def _at(self, x: Array) -> tuple[Array, Array, Array]:
        parts = x.reshape(3, -1)
        kinds = zip(
            *([row @ part for row in rows] for rows, part in zip(self.rows, parts, strict=True)), strict=True
        )
        a, b, place = (np.stack(kind, axis=-1) for kind in kinds)
        return a, b, place

    def local(self, at: tuple[Array, Array, Array], p: float, uneven: float) -> tuple[Array, ...]:
        """Factors of (v_,Z, v_,Theta, v), their derivatives by these of x, by p and by the unevenness."""
        a, b, _ = at
        side = np.cos(self.theta)
        strain = 2 * weak.residual(a, b, np.zeros(len(a)))
        push = weak.residual(a, b, np.ones(len(a))) - strain / 2
        stiff = 2 * weak.tangent(a, b, np.zeros(len(a)), np.zeros(len(a)))
        turn = weak.tangent(a, b, np.ones(len(a)), np.zeros(len(a))) - stiff / 2
        h = 1 + uneven * side
        return (
            h[:, None] * strain + p * push,
            h[:, None, None] * stiff + p * turn,
            push,
            side[:, None] * strain,
        )

    def evaluate(self, x: Array, p: float, uneven: float) -> tuple[Array, Array, Array, Array]:
        """Residual, its derivatives by x, p and the unevenness, of the free coefficients."""
        own, d, *others = self.local(self._at(x), p, uneven)
        d = d * self.weight[:, None, None]
        k = np.zeros((3, 3, self.size, self.size))
        for c in range(3):
            for e in range(3):
                for i in range(3):
                    right = sum(d[:, 3 * i + c, 3 * j + e][:, None] * self.rows[e][j] for j in range(3))
                    k[c, e] += self.rows[c][i].T @ right
        matrix = k.transpose(0, 2, 1, 3).reshape(3 * self.size, -1)

        def vector(f: Array) -> Array:
            f = (f * self.weight[:, None]).reshape(-1, 3, 3)
            return np.concatenate([sum(self.rows[c][i].T @ f[:, i, c] for i in range(3)) for c in range(3)])[
                self.free
            ]

        load, thick = (vector(f) for f in others)
        return vector(own), matrix[np.ix_(self.free, self.free)], load, thick

    def enclosed(self, x: Array) -> float:
        """Volume inside of the half circumference."""
        a, b, place = self._at(x)
        return float(self.weight @ weak.flux_of_radius(place, a, b))

    def volume(self, x: Array) -> float:
        """Volume of this quarter of the tube, less that of the tube at rest."""
        return self.enclosed(x) - np.pi * self.half / 2
