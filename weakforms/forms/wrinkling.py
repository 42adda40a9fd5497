r"""Wrinkled membranes: relaxed energies, and the modified deformation gradient, of any principal-stretch law.

A sheet that cannot bear compression folds where a stress would become negative. With a law ``w(l1, l2)`` of
an isotropic incompressible sheet (:mod:`weakforms.forms.materials`) and the larger stretch ``l1``, the
natural width in uniaxial tension is :math:`l_2 = l_1^{-1/2}` for every law, because both transverse stretches
are equal. The energy of the wrinkled state is therefore :math:`w_r(l) = w(l, l^{-1/2})` and the sheet is taut
if :math:`l_2 > l_1^{-1/2}` (Patil, Nordmark & Eriksson 2015, section 2 and table 1; Pipkin 1986).

All energies here have continuous first derivatives; the second derivatives jump where the state changes. A
``conditional`` chooses between the smooth expressions of the states. UFL then differentiates only these
expressions, which is exact.
"""

from __future__ import annotations

from collections.abc import Callable

from ufl import And, conditional, det, gt, inv, max_value, sqrt, tr
from ufl.conditional import Condition
from ufl.core.expr import Expr

from weakforms.forms.materials.surface import SurfaceLaw

Law = Callable[[Expr, Expr], Expr]
"""Energy per reference volume as a function of the two principal stretches."""

Width = Callable[[Expr], Expr]
"""Transverse stretch in uniaxial tension as a function of the stretch along it."""

TINY = 1e-6
"""Lower limit of the stretch at which an unused expression is evaluated, so that it stays finite."""

COALESCENCE = 1e-7
"""Difference of the squared principal stretches below which they count as equal."""


def natural_width(l1: Expr) -> Expr:
    r"""Transverse stretch in uniaxial tension, :math:`l_1^{-1/2}`: the width below which a sheet wrinkles."""
    return 1 / sqrt(l1)


def wrinkling_function(lam1: Expr, lam2: Expr) -> Expr:
    r""":math:`g_w = \lambda_2\sqrt{\lambda_1}`: taut above 1, wrinkled (tension along 1) below."""
    return lam2 * sqrt(lam1)


def relaxed(law: Law, width: Width = natural_width) -> Callable[[Expr], Expr]:
    r"""Energy of the wrinkled state, :math:`w_r(l) = w(l, l^{-1/2})`, a function of one stretch.

    Args:
        law: Full energy.
        width: Width in uniaxial tension, if the material is compressible.
    """
    return lambda l1: law(l1, width(l1))


def taut_state(l1: Expr, l2: Expr, width: Width = natural_width) -> Condition:
    r"""Whether neither stress is negative: :math:`l_1 > l_2^{-1/2}` and :math:`l_2 > l_1^{-1/2}`."""
    if width is natural_width:
        return And(gt(l2 * sqrt(l1), 1), gt(l1 * sqrt(l2), 1))
    return And(gt(l2, width(l1)), gt(l1, width(l2)))


def tension_field(law: Law, width: Width = natural_width) -> Law:
    r"""Relaxed energy by the table of states: taut, wrinkled in either direction, or slack.

    ===================  =========================================  ===============
    state                criterion                                  energy
    ===================  =========================================  ===============
    taut                 l1 > l2^(-1/2) and l2 > l1^(-1/2)          w(l1, l2)
    tension along 1      l1 > 1 and l2 <= l1^(-1/2)                 w_r(l1)
    tension along 2      l2 > 1 and l1 <= l2^(-1/2)                 w_r(l2)
    slack                l1 <= 1 and l2 <= 1                        0
    ===================  =========================================  ===============

    (Patil, Nordmark & Eriksson 2015, table 1.) A law of a compressible material has another ``width``.
    """

    def energy(l1: Expr, l2: Expr) -> Expr:
        a, b = max_value(l1, TINY), max_value(l2, TINY)
        wrinkled = relaxed(law, width)
        taut = taut_state(a, b, width)
        slackened = conditional(gt(b, 1), wrinkled(b), 0.0)
        return conditional(taut, law(a, b), conditional(gt(a, 1), wrinkled(a), slackened))

    return energy


def modified_gradient(law: Law, width: Width = natural_width) -> Law:
    r"""Full energy of Roddeman's modified deformation gradient, which removes compression.

    :math:`\tilde F = (I + \beta\, n_2\otimes n_2) F` widens the wrinkled direction, ``beta >= 0``, until the
    stress across the wrinkles vanishes; for an isotropic incompressible sheet

    .. math:: \tilde l_2 = (1+\beta)\, l_2 = \max(l_2, \tilde l_1^{-1/2}), \qquad \tilde l_1 = \max(l_1, 1)

    with ``l1`` the larger stretch (Patil, Nordmark & Eriksson 2015, section 2.3). This is the same function
    as :func:`tension_field`, computed differently.
    """

    def energy(l1: Expr, l2: Expr) -> Expr:
        first = gt(
            l1, l2
        )  # one condition for both: where the stretches are equal, each variable holds one of them
        along = max_value(conditional(first, l1, l2), 1.0)
        across = conditional(first, l2, l1)
        return law(along, max_value(across, width(along)))

    return energy


def principal_stretches(c: Expr) -> tuple[Expr, Expr]:
    r"""Principal stretches ``l1 >= l2`` from the right Cauchy-Green tensor of a surface, 2 x 2.

    .. math:: l_{1,2}^2 = \tfrac12\Big(I \pm \sqrt{\max(I^2 - 4D, \epsilon^2)}\Big), \qquad
              I = \mathrm{tr}\,C,\quad D = \det C

    The lower limit keeps derivatives finite where the stretches coincide. There a membrane is taut or slack,
    and :func:`surface_tension_field` uses neither stretch.
    """
    trace, area = tr(c), det(c)
    spread = sqrt(max_value(trace**2 - 4 * area, COALESCENCE**2))
    return sqrt((trace + spread) / 2), sqrt(max_value((trace - spread) / 2, TINY**2))


def surface_tension_field(c: Expr, law: SurfaceLaw) -> Expr:
    r"""Relaxed energy of a membrane without symmetry, from the right Cauchy-Green tensor.

    The membrane is taut if :math:`D\,l_2^2 > 1` (that is :math:`l_1 l_2^2 > 1`), or with another natural
    width ``n`` if :math:`l_2 > n(l_1)`; else wrinkled with :math:`w_r(l_1)` where :math:`l_1 > 1`; else
    slack.

    Args:
        c: Right Cauchy-Green tensor in an orthonormal frame of the reference surface, 2 x 2.
        law: Energy in both forms: as a function of ``tr C`` and ``det C`` for the taut state, smooth where
            the principal stretches coincide, and as a function of the principal stretches for the wrinkled
            state.
    """
    l1, l2 = principal_stretches(c)
    area = max_value(det(c), TINY**2)
    width = law.width or natural_width
    slackened = conditional(gt(l1, 1), relaxed(law.stretches, width)(l1), 0.0)
    taut = gt(l2, law.width(l1)) if law.width else gt(area * l2**2, 1)
    return conditional(taut, law.where(taut, tr(c), area), slackened)


def metric(tangents: Expr, reference: Expr) -> Expr:
    r"""Right Cauchy-Green tensor :math:`G^{-1/2} F^T F\, G^{-1/2}` for a diagonal reference metric.

    Args:
        tangents: ``F``, 3 x 2: derivatives of the deformed position along the two coordinates.
        reference: ``G^{1/2}``, 2 x 2 diagonal: lengths of the tangents of the reference surface.
    """
    scaled = tangents * inv(reference)
    return scaled.T * scaled
