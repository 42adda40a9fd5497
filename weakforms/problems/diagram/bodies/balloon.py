r"""A balloon in the planes of diagrams, and its displacements along spherical harmonics.

Its potential, over :math:`2\pi r_o^2 h_o S`, is

.. math:: \frac{\Pi}{2\pi} = 2\Big[w(\lambda, \lambda) - \tfrac p3 \lambda^3\Big]

A mode of degree ``n`` moves the sphere by :math:`a P_n(c)\, e_r + b\, \partial_\theta P_n(c)\,
e_\theta`, ``c = cos(theta)``. With :math:`s^2 = 1 - c^2`

.. math:: \lambda_1^2 = (\lambda + a P_n + b\,(s^2 P_n'' - c P_n'))^2 + (a - b)^2 s^2 P_n'^2, \qquad
          \lambda_2 = \lambda + a P_n - b\, c P_n'

The ``2n + 1`` harmonics of one degree have the same second variation. For ``n = 1`` a displacement with
``a = b`` is a translation, and that with ``a = -2b``, to which it is orthogonal, makes a pear.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import ufl
from ufl.core.expr import Expr

from weakforms.problems.diagram.bodies.uniform import Pair, Perturbation, VariedUniform
from weakforms.problems.diagram.bodies.varied import WAVES


class VariedSphere(VariedUniform):
    """The balloon; its load is ``p``, and constants of the law that vary."""

    name, unknowns, depth = "sphere", ("lam",), "lam"

    def stretches(self) -> Pair:
        """The stretch in both directions."""
        return self.unknown[0], self.unknown[0]

    def potential(self, lam1: Expr, lam2: Expr) -> Expr:
        """The total potential at given pressure."""
        return 2 * (self.law(lam1, lam2) - self.q["p"] * lam1**3 / 3)

    def columns(self) -> dict[str, Expr]:
        """The volume."""
        return {"V": 2 * self.unknown[0] ** 3 / 3}

    def stretched(self, columns: Mapping[str, float]) -> tuple[float, float]:
        """Both stretches of a state."""
        return columns["lam"], columns["lam"]

    def perturbations(self, kind: str) -> dict[int, Perturbation]:
        """Modes of the degree ``n``, which are even or odd under a mirror as ``n`` is."""
        numbered = WAVES.fullmatch(kind)
        if numbered is None:
            return {}
        n = int(numbered[1])
        size = 1 if n == 1 else 2
        mode = Perturbation(size, partial(self._harmonic, n), partial(self._harmonic_mass, n), 2 * n)
        return {(-1) ** n: mode}

    def _legendre(self, n: int) -> tuple[Expr, Expr, Expr, Expr]:
        """``c``, and ``P_n`` with two derivatives."""
        c = ufl.variable(2 * ufl.SpatialCoordinate(self.mesh)[0] - 1)
        last, this = ufl.as_ufl(1.0), c
        for k in range(1, n):
            last, this = this, ((2 * k + 1) * c * this - k * last) / (k + 1)
        first = ufl.diff(this, c)
        return c, this, first, ufl.diff(first, c)

    def _displaced(self, n: int, a: tuple[Expr, ...]) -> tuple[Expr, Expr]:
        """Factors of ``P_n`` and of its slope."""
        return (2 * a[0], -a[0]) if n == 1 else (a[0], a[1])

    def _harmonic(self, n: int, amplitudes: tuple[Expr, ...]) -> Expr:
        """The total potential of a displaced sphere per ``dc/2``."""
        (c, value, first, second), (a, b) = self._legendre(n), self._displaced(n, amplitudes)
        lam, across = self.unknown[0], 1 - c**2
        radial, tilt = lam + a * value, (a - b) * b * across * first**2
        along = radial + b * (across * second - c * first)
        lam1 = ufl.sqrt(along**2 + (a - b) ** 2 * across * first**2)
        lam2 = radial - b * c * first
        volume = lam2 * (radial * along - tilt) / 3
        return 2 * (self.law(lam1, lam2) - self.q["p"] * volume)

    def _harmonic_mass(self, n: int, left: tuple[Expr, ...], right: tuple[Expr, ...]) -> Expr:
        c, value, first, _ = self._legendre(n)
        (a, b), (v, y) = self._displaced(n, left), self._displaced(n, right)
        return value**2 * a * v + (1 - c**2) * first**2 * b * y
