r"""Material laws of sheets with derivatives by hand; energies are divided by the stress of the constants.

A law of an incompressible isotropic material is here a sum of parts of two kinds,

.. math:: w(l_1, l_2) = \Phi(x, y) + \sum_{i=1}^{3} \varphi(l_i), \qquad
          x = I_1 - 3,\ y = I_2 - 3,\ l_3 = 1/(l_1 l_2)

each given by its value and its first and second derivatives, so that only the chain rule is common:

.. math:: x_1 = 2(l_1 - l_1^{-3} l_2^{-2}),\quad y_1 = 2(l_1 l_2^2 - l_1^{-3}),\quad
          \partial_1 l_3 = -l_3/l_1

Energies accept complex stretches (see :mod:`core.contour`); derivatives accept real ones.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_data.solvers.core.langevin import chain, chain_jet

Jet = tuple[Any, Any, Any]
"""Value, first and second derivative of a function of one variable."""
Jet2 = tuple[Any, Any, Any, Any, Any, Any]
"""Value, x-, y-, xx-, xy- and yy-derivative of a function of two variables."""


@dataclass(frozen=True)
class Law:
    """An incompressible isotropic law, from its parts."""

    invariants: Callable[[Any, Any], Jet2] | None = None
    stretch: Callable[[Any], Jet] | None = None

    def energy(self, l1: Any, l2: Any) -> Any:
        """``w``, zero at rest."""
        out = 0.0
        if self.invariants:
            out = self.invariants(*_invariants(l1, l2))[0]
        if self.stretch:
            rest = self.stretch(1.0)[0]
            out = out + sum(self.stretch(x)[0] - rest for x in (l1, l2, 1 / (l1 * l2)))
        return out

    def slope(self, l1: Any, l2: Any) -> Any:
        """``w_1``; ``slope(l2, l1)`` is ``w_2``."""
        out = 0.0
        if self.invariants:
            _, fx, fy, *_ = self.invariants(*_invariants(l1, l2))
            x1, y1 = _slopes(l1, l2)
            out = fx * x1 + fy * y1
        if self.stretch:
            l3 = 1 / (l1 * l2)
            out = out + self.stretch(l1)[1] - self.stretch(l3)[1] * l3 / l1
        return out

    def curvature(self, l1: Any, l2: Any) -> Any:
        """``w_11``; with the arguments swapped ``w_22``."""
        out = 0.0
        if self.invariants:
            _, fx, fy, fxx, fxy, fyy = self.invariants(*_invariants(l1, l2))
            x1, y1 = _slopes(l1, l2)
            out = fx * (2 + 6 / (l1**4 * l2**2)) + fy * (2 * l2**2 + 6 / l1**4)
            out = out + fxx * x1**2 + 2 * fxy * x1 * y1 + fyy * y1**2
        if self.stretch:
            l3 = 1 / (l1 * l2)
            _, d3, dd3 = self.stretch(l3)
            out = out + self.stretch(l1)[2] + dd3 * (l3 / l1) ** 2 + 2 * d3 * l3 / l1**2
        return out

    def mixed(self, l1: Any, l2: Any) -> Any:
        """``w_12``."""
        out = 0.0
        if self.invariants:
            _, fx, fy, fxx, fxy, fyy = self.invariants(*_invariants(l1, l2))
            (x1, y1), (x2, y2) = _slopes(l1, l2), _slopes(l2, l1)
            out = fx * 4 / (l1 * l2) ** 3 + fy * 4 * l1 * l2
            out = out + fxx * x1 * x2 + fxy * (x1 * y2 + x2 * y1) + fyy * y1 * y2
        if self.stretch:
            l3 = 1 / (l1 * l2)
            _, d3, dd3 = self.stretch(l3)
            out = out + (dd3 * l3**2 + d3 * l3) / (l1 * l2)
        return out

    def width(self, length: Any) -> tuple[Any, Any]:
        """Transverse stretch in uniaxial tension and its derivative."""
        return length**-0.5, -0.5 * length**-1.5


def _invariants(l1: Any, l2: Any) -> tuple[Any, Any]:
    a, b = l1 * l1, l2 * l2
    return a + b + 1 / (a * b) - 3, 1 / a + 1 / b + a * b - 3


def _slopes(l1: Any, l2: Any) -> tuple[Any, Any]:
    return 2 * (l1 - 1 / (l1**3 * l2**2)), 2 * (l1 * l2**2 - 1 / l1**3)


# -- the laws ---------------------------------------------------------------------------------------


def mooney_rivlin(alpha: float = 0.0) -> Law:
    """``x + alpha y``; alpha = 0 is neo-Hookean."""
    return Law(invariants=lambda x, y: (x + alpha * y, 1.0, alpha, 0.0, 0.0, 0.0))


def rivlin(**c: float) -> Law:
    """Rivlin's series: the coefficients by name, ``c21`` of ``x^2 y``."""
    powers = [(int(name[1]), int(name[2]), value) for name, value in c.items()]

    def series(x: Any, y: Any) -> Jet2:
        def term(i: int, j: int, di: int, dj: int) -> Any:
            factor = np.prod([i - k for k in range(di)]) * np.prod([j - k for k in range(dj)])
            return factor * x ** max(i - di, 0) * y ** max(j - dj, 0) if factor else 0.0 * x

        orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        return tuple(sum(v * term(i, j, *d) for i, j, v in powers) for d in orders)

    return Law(invariants=series)


def ogden(**c: float) -> Law:
    """Ogden's law, ``phi = sum mu_i/alpha_i l^alpha_i``."""
    terms = [(c[f"mu{i}"], c[f"alpha{i}"]) for i in (1, 2, 3) if c[f"mu{i}"]]

    def part(x: Any) -> Jet:
        return (
            sum(m / a * x**a for m, a in terms),
            sum(m * x ** (a - 1) for m, a in terms),
            sum(m * (a - 1) * x ** (a - 2) for m, a in terms),
        )

    return Law(stretch=part)


def rivlin_saunders(c10: float, c01: float, q: float) -> Law:
    """``c10 x + c01 q ln(1 + y/q)``."""
    return Law(
        invariants=lambda x, y: (
            c10 * x + c01 * q * np.log1p(y / q),
            c10,
            c01 * q / (q + y),
            0.0,
            0.0,
            -c01 * q / (q + y) ** 2,
        )
    )


def three_chain(nkt: float, links: float) -> Law:
    """``phi = (nkt n/3) e(l/sqrt n)``."""
    root = np.sqrt(links)

    def part(x: Any) -> Jet:
        energy, first, second = chain_jet(x / root)
        return nkt * links / 3 * energy, nkt * root / 3 * first, nkt / 3 * second

    return Law(stretch=part)


def arruda_boyce(nkt: float, links: float) -> Law:
    """``nkt n e(s)``, ``s^2 = (x + 3)/(3 n)``."""
    rest = chain(links**-0.5)

    def network(x: Any, _y: Any) -> Jet2:
        s = np.sqrt((x + 3) / (3 * links))
        first = 1 / (6 * links * s)
        energy, beta, slope = chain_jet(s)
        energy = nkt * links * (energy - rest)
        bent = nkt * links * (slope * first**2 - beta * first**2 / s)
        return energy, nkt * links * beta * first, 0.0, bent, 0.0, 0.0

    return Law(invariants=network)


def beda_chevalier(k1: float, k2: float, k3: float, power: float) -> Law:
    """``k1 x + k2 ln(1 + y/3)`` and a term of Ogden's."""
    return Law(
        invariants=lambda x, y: (
            k1 * x + k2 * np.log1p(y / 3),
            k1,
            k2 / (3 + y),
            0.0,
            0.0,
            -k2 / (3 + y) ** 2,
        ),
        stretch=ogden(mu1=k3, alpha1=power, mu2=0.0, alpha2=1.0, mu3=0.0, alpha3=1.0).stretch,
    )


def varga(shear: float) -> Law:
    """``phi = 2 shear l``."""
    return Law(stretch=lambda x: (2 * shear * x, 2 * shear + 0 * x, 0 * x))


def gent(shear: float, jm: float) -> Law:
    """``-(shear jm/2) ln(1 - x/jm)``."""

    def limited(x: Any, _y: Any) -> Jet2:
        left = jm - x
        return (
            -shear * jm / 2 * np.log1p(-x / jm),
            shear * jm / (2 * left),
            0.0,
            shear * jm / (2 * left**2),
            0.0,
            0.0,
        )

    return Law(invariants=limited)


@dataclass(frozen=True)
class Kirchhoff:
    """Saint Venant-Kirchhoff in plane stress: ``Y/(2 (1 - nu^2)) [E1^2 + E2^2 + 2 nu E1 E2]``."""

    shear: float
    poisson: float

    @property
    def _stiffness(self) -> float:
        return self.shear / (1 - self.poisson)  # Y/(2 (1 - nu^2)), Y = 2 shear (1 + nu)

    def energy(self, l1: Any, l2: Any) -> Any:
        """``w``."""
        e1, e2 = (l1 * l1 - 1) / 2, (l2 * l2 - 1) / 2
        return self._stiffness * (e1 * e1 + e2 * e2 + 2 * self.poisson * e1 * e2)

    def slope(self, l1: Any, l2: Any) -> Any:
        """``w_1``."""
        return self._stiffness * l1 * (l1 * l1 - 1 + self.poisson * (l2 * l2 - 1))

    def curvature(self, l1: Any, l2: Any) -> Any:
        """``w_11``."""
        return self._stiffness * (3 * l1 * l1 - 1 + self.poisson * (l2 * l2 - 1))

    def mixed(self, l1: Any, l2: Any) -> Any:
        """``w_12``."""
        return 2 * self._stiffness * self.poisson * l1 * l2

    def width(self, length: Any) -> tuple[Any, Any]:
        """Transverse stretch in uniaxial tension and its derivative."""
        wide = np.sqrt(1 - self.poisson * (length**2 - 1))
        return wide, -self.poisson * length / wide


@dataclass(frozen=True)
class Harmonic:
    """Harmonic material, ``f = 1 + (i-3) + f2 (i-3)^2/2``, in plane stress.

    With ``i`` eliminated, ``i - 3 = (J - 1)/f2`` and ``J = l1 l2``, the energy over 2 mu is
    ``1 + m + f2 m^2/2 - J (3 + m - l1 - l2)``, ``m = (J - 1)/f2``, whose slope is ``l2 (l1 - l3)``.
    """

    shear: float
    f2: float

    def _thick(self, l1: Any, l2: Any) -> Any:
        return 3 + (l1 * l2 - 1) / self.f2 - l1 - l2

    def energy(self, l1: Any, l2: Any) -> Any:
        """``w``."""
        area = l1 * l2
        more = (area - 1) / self.f2
        return 2 * self.shear * (1 + more + self.f2 * more**2 / 2 - area * self._thick(l1, l2))

    def slope(self, l1: Any, l2: Any) -> Any:
        """``w_1``."""
        return 2 * self.shear * l2 * (l1 - self._thick(l1, l2))

    def curvature(self, l1: Any, l2: Any) -> Any:
        """``w_11``."""
        return 2 * self.shear * l2 * (2 - l2 / self.f2) + 0 * l1

    def mixed(self, l1: Any, l2: Any) -> Any:
        """``w_12``."""
        return 2 * self.shear * (l1 - self._thick(l1, l2) + l2 - l1 * l2 / self.f2)

    def width(self, length: Any) -> tuple[Any, Any]:
        """Transverse stretch in uniaxial tension (equal to the thickness stretch) and its derivative."""
        over, under = 3 - 1 / self.f2 - length, 2 - length / self.f2
        return over / under, (-under + over / self.f2) / under**2


BUILDERS: dict[str, Callable[..., Any]] = {
    "neo_hookean": mooney_rivlin,
    "mooney_rivlin": mooney_rivlin,
    "rivlin": rivlin,
    "ogden": ogden,
    "biderman": rivlin,
    "rivlin_saunders": rivlin_saunders,
    "three_chain": three_chain,
    "arruda_boyce": arruda_boyce,
    "beda_chevalier": beda_chevalier,
    "saint_venant_kirchhoff": Kirchhoff,
    "varga": varga,
    "gent": gent,
    "harmonic": Harmonic,
}

CONSTANTS: dict[str, dict[str, float]] = {
    "neo_hookean": {},
    "mooney_rivlin": {"alpha": 0.1},
    "rivlin": {"c10": 1.0, "c01": 0.1, "c20": 0.01, "c11": 0.001, "c30": 1e-4},
    "ogden": {"mu1": 1.491, "alpha1": 1.3, "mu2": 0.003, "alpha2": 5.0, "mu3": -0.023, "alpha3": -2.0},
    "biderman": {"c10": 1.0, "c01": 0.1, "c20": -0.01, "c30": 0.002},
    "rivlin_saunders": {"c10": 1.0, "c01": 0.2, "q": 3.0},
    "three_chain": {"nkt": 2.0, "links": 26.5},
    "arruda_boyce": {"nkt": 2.0, "links": 26.5},
    "beda_chevalier": {"k1": 1.0, "k2": 2.36, "k3": 1e-3, "power": 5.0},
    "saint_venant_kirchhoff": {"shear": 2.0, "poisson": 0.5},
    "varga": {"shear": 2.0},
    "gent": {"shear": 2.0, "jm": 97.2},
    "harmonic": {"shear": 2.0, "f2": 2.0},
}
"""Constants of the tables."""


def law(model: str, **changed: float) -> Any:
    """A law with the constants of the tables, or with some of them changed."""
    return BUILDERS[model](**(CONSTANTS[model] | changed))
