r"""Laws as functions of the trace and the determinant of a surface's right Cauchy-Green tensor, 2 x 2.

.. math:: I = \mathrm{tr}\,C = \lambda_1^2 + \lambda_2^2, \qquad D = \det C = (\lambda_1\lambda_2)^2

Where the principal stretches of a surface coincide, they are not smooth functions of ``C``; ``I`` and ``D``
are. A membrane without symmetry, or with a perturbation that breaks it, therefore needs laws in ``I`` and
``D``:

* :math:`I_1 = I + 1/D` and :math:`I_2 = I/D + D`: laws in the invariants need no change;
* :math:`\lambda_1 + \lambda_2 = (I + 2\sqrt D)^{1/2}`: neither do laws in the sum and the product of the
stretches; * :math:`\lambda_1^{2p} + \lambda_2^{2p}`, as in Ogden's law, is an analytic function of the mean
  :math:`m = I/2` and of :math:`s = 1 - D/m^2`, the squared relative half difference, for which a series is
  used near ``s = 0``.

The 3-chain law has no such form, because it contains a function of each stretch that is not a power.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ufl import conditional, lt, min_value, sqrt
from ufl.conditional import Condition
from ufl.core.expr import Expr

from weakforms.forms.materials import chains, phenomenological, plane_stress
from weakforms.forms.materials.catalogue import MATERIALS, SERIES

TERMS = 11
"""Number of terms of the series for a pair of powers; its remainder is below round-off up to :data:`NEAR`."""

NEAR, STEEP = 0.04, 0.36
"""The series is used for ``s < min(NEAR, STEEP/p^2)``. Above, the closed form loses at most four digits in
its second derivatives."""


@dataclass(frozen=True)
class SurfaceLaw:
    """One law of a surface in two forms, with the same constants."""

    stretches: Callable[[Expr, Expr], Expr]
    """Energy as a function of the principal stretches."""
    invariants: Callable[[Expr, Expr], Expr]
    """Energy as a function of ``tr C`` and ``det C``."""
    bounded: bool = False
    """Whether it is finite for all positive stretches. If not, it is evaluated at rest where its value is
    not used: UFL multiplies an unused expression by zero, which does not remove an infinity."""
    width: Callable[[Expr], Expr] | None = None
    """Width in uniaxial tension as a function of the stretch along it; none: that of an incompressible law,
    ``lam1^(-1/2)``."""

    def where(self, taken: Condition, trace: Expr, area: Expr) -> Expr:
        """Energy as a function of the invariants where a condition holds; any finite number elsewhere."""
        if not self.bounded:
            trace, area = conditional(taken, trace, 2.0), conditional(taken, area, 1.0)
        return self.invariants(trace, area)


def spread(trace: Expr, area: Expr) -> tuple[Expr, Expr]:
    """Mean ``m`` of the squared principal stretches, and ``s = (half their difference / m)^2``."""
    mean = trace / 2
    return mean, 1 - area / mean**2


def pair_of_powers(trace: Expr, area: Expr, p: Expr) -> Expr:
    r"""Sum :math:`\lambda_1^{2p} + \lambda_2^{2p}`, smooth where the stretches coincide.

    .. math:: m^p\,[(1 + \sqrt s)^p + (1 - \sqrt s)^p] = 2 m^p \sum_k \binom{p}{2k} s^k
    """
    mean, s = spread(trace, area)
    near = lt(s, min_value(NEAR, STEEP / p**2))
    coefficient, series = 1.0, 1.0
    for k in range(TERMS - 1):
        coefficient = coefficient * (p - 2 * k) * (p - 2 * k - 1) / ((2 * k + 1) * (2 * k + 2))
        series = series + coefficient * s ** (k + 1)
    root = sqrt(conditional(near, NEAR, s))
    apart = (1 + root) ** p + (1 - root) ** p
    return mean**p * conditional(near, 2 * series, apart)


def _first(trace: Expr, area: Expr) -> Expr:
    """``I1 - 3``."""
    return trace + 1 / area - 3


def _second(trace: Expr, area: Expr) -> Expr:
    """``I2 - 3``."""
    return trace / area + area - 3


def mooney_rivlin_invariants(trace: Expr, area: Expr, alpha: Expr) -> Expr:
    r"""Mooney-Rivlin energy of a surface over ``C1`` without principal stretches.

    .. math:: w = I + 1/D - 3 + \alpha\,(I/D + D - 3), \qquad I = \mathrm{tr}\,C,\quad D = \det C
    """
    return trace + 1 / area - 3 + alpha * (trace / area + area - 3)


def rivlin(trace: Expr, area: Expr, **c: Expr) -> Expr:
    """Rivlin's series, which includes Biderman's law."""
    terms = [(i, j, c[name]) for (i, j), name in SERIES.items() if name in c]
    return phenomenological.series(_first(trace, area), _second(trace, area), terms)


def ogden(trace: Expr, area: Expr, **c: Expr) -> Expr:
    """Ogden's law."""
    total = 0.0
    for i in (1, 2, 3):
        mu, alpha = c[f"mu{i}"], c[f"alpha{i}"]
        pairs = pair_of_powers(trace, area, alpha / 2)
        total = total + mu / alpha * (pairs + area ** (-alpha / 2) - 3)
    return total


def rivlin_saunders(trace: Expr, area: Expr, c10: Expr, c01: Expr, q: Expr) -> Expr:
    """Rivlin & Saunders's law with a decreasing slope."""
    return c10 * _first(trace, area) + phenomenological.falling_slope(c01, q)(_second(trace, area))


def arruda_boyce(trace: Expr, area: Expr, nkt: Expr, links: Expr) -> Expr:
    """Arruda & Boyce's network."""
    return chains.eight_chain((trace + 1 / area) / 3, nkt, links)


def beda_chevalier(trace: Expr, area: Expr, k1: Expr, k2: Expr, k3: Expr, power: Expr) -> Expr:
    """Beda & Chevalier's law."""
    stretched = pair_of_powers(trace, area, power / 2) + area ** (-power / 2) - 3
    return k1 * _first(trace, area) + k2 * _log1p(_second(trace, area) / 3) + k3 / power * stretched


def _log1p(x: Expr) -> Expr:
    return phenomenological.falling_slope(1.0, 1.0)(x)


def saint_venant_kirchhoff(trace: Expr, area: Expr, shear: Expr, poisson: Expr) -> Expr:
    r"""Saint Venant-Kirchhoff in plane stress.

    .. math:: \mathrm{tr}\,E = I/2 - 1, \qquad \mathrm{tr}\,E^2 = (I^2 - 2D - 2I + 2)/4
    """
    first, second = (trace - 2) / 2, (trace**2 - 2 * area - 2 * trace + 2) / 4
    return shear * poisson / (1 - poisson) * first**2 + shear * second


def varga(trace: Expr, area: Expr, shear: Expr) -> Expr:
    """Varga's law."""
    return 2 * shear * (_sum(trace, area) + 1 / sqrt(area) - 3)


def harmonic(trace: Expr, area: Expr, shear: Expr, f2: Expr) -> Expr:
    """Harmonic material with the thickness stretch eliminated."""
    return plane_stress.harmonic_of_sum(_sum(trace, area), sqrt(area), shear, f2)


def _sum(trace: Expr, area: Expr) -> Expr:
    """``lam1 + lam2``."""
    return sqrt(trace + 2 * sqrt(area))


def _gent(trace: Expr, area: Expr, shear: Expr, jm: Expr) -> Expr:
    return phenomenological.limited(_first(trace, area), shear, jm)


LAWS: dict[str, Callable[..., Expr]] = {
    "neo_hookean": _first,
    "mooney_rivlin": mooney_rivlin_invariants,
    "rivlin": rivlin,
    "ogden": ogden,
    "biderman": rivlin,
    "rivlin_saunders": rivlin_saunders,
    "arruda_boyce": arruda_boyce,
    "beda_chevalier": beda_chevalier,
    "saint_venant_kirchhoff": saint_venant_kirchhoff,
    "varga": varga,
    "gent": _gent,
    "harmonic": harmonic,
}
"""All laws with such a form, as ``w(tr C, det C, **constants)``."""

BOUNDED = ("neo_hookean", "mooney_rivlin")
"""Laws that are finite for all positive stretches and need no replacement."""


def mooney_rivlin_surface(alpha: Expr) -> SurfaceLaw:
    """The Mooney-Rivlin law of the papers with a given ``C2/C1``."""
    return SurfaceLaw(
        lambda lam1, lam2: phenomenological.mooney_rivlin(lam1, lam2, alpha),
        lambda trace, area: mooney_rivlin_invariants(trace, area, alpha),
        bounded=True,
    )


def surface_law(model: str, constants: Mapping[str, Expr]) -> SurfaceLaw:
    """A law of the catalogue for a surface, with given constants.

    A law that is not in :data:`LAWS` has no energy in the invariants; using it raises a ``KeyError``.
    """
    material = MATERIALS[model]
    return SurfaceLaw(
        material.energy(constants),
        lambda trace, area: LAWS[model](trace, area, **constants),
        model in BOUNDED,
        None if material.incompressible else material.natural_width(constants),
    )
