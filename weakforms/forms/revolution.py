r"""Second variation of a relaxed membrane of revolution, by wave number around its axis.

This module gives the energy of the *perturbed* surface at an angle ``Theta``; everything else is a derivative
of it. The second variation is quadratic in ``cos(n Theta)`` and ``sin(n Theta)``. Their squares have the same
mean, and their product has mean zero. The integral over ``Theta`` is therefore ``pi`` times the sum of the
values at the two angles ``n Theta = 0`` and ``pi/2`` (:data:`ANGLES`).

A perturbation is the vector ``u cos(n Theta) e_r + q sin(n Theta) e_theta + w cos(n Theta) e_z``; with the
paper's angle ``v``, ``q = r v``. Both forms have the same second variation at an equilibrium; the form with
``q`` is regular at a pole. Lengths over ``Ao``, energies over ``C1 h Ao^2`` (Patil, Nordmark & Eriksson 2016,
J. Mech. Phys. Solids 94, 298-315).
"""

from __future__ import annotations

from collections.abc import Callable

from ufl import as_matrix, conditional, diff, dot, sqrt, tr, variable
from ufl.conditional import Condition
from ufl.core.expr import Expr

from weakforms.forms.fluid import Surface, harmonic, normal
from weakforms.forms.materials import SurfaceLaw
from weakforms.forms.wrinkling import COALESCENCE, Width, natural_width, relaxed

ANGLES = ((1.0, 0.0), (0.0, 1.0))
"""``(cos, sin)`` of the two angles whose values give the mean over ``Theta``."""


def gradient_tensor(at: Surface, radius: Expr, scales: tuple[Expr | float, Expr | float]) -> Expr:
    r"""Right Cauchy-Green tensor of a surface in the orthonormal frame of its reference, 2 x 2.

    .. math:: C_{11} = a^2 g_{11}, \qquad C_{12} = a b\, g_{12}/R, \qquad C_{22} = b^2 g_{22}/R^2

    Args:
        at: The deformed surface.
        radius: ``R(S)`` of the reference surface.
        scales: ``(a, b)``, 1 if ``S`` and ``R`` belong to the stress-free surface
            (:func:`weakforms.forms.kinematics.revolution_stretches`).
    """
    along, around = scales
    a, b = along * at.a, around * at.b / radius
    return as_matrix([[dot(a, a), dot(a, b)], [dot(a, b), dot(b, b)]])


def strain_energy(c: Expr, taut: Condition, law: SurfaceLaw, width: Width = natural_width) -> Expr:
    r"""Energy per reference volume: full where taut, relaxed with tension along 1 elsewhere.

    .. math:: U_F = w(I, D), \qquad U_R = w(\lambda_1, n(\lambda_1)), \qquad n = \lambda_1^{-1/2}

    with ``I = tr C``, ``D = det C``. The taut energy needs no principal stretches and is smooth where they
    coincide. The taut part is *given*: a front that moves with the perturbation changes the energy only at
    third order, because the first derivatives are continuous there. :data:`COALESCENCE` keeps unused
    expressions finite where the stretches coincide, and changes the others by its square.

    Args:
        c: Right Cauchy-Green tensor, :func:`gradient_tensor`.
        taut: Indicator of the taut part, held fixed.
        law: Energy in both forms.
        width: Natural width ``n``, if the material is compressible.
    """
    area = c[0, 0] * c[1, 1] - c[0, 1] ** 2
    spread = sqrt((c[0, 0] - c[1, 1]) ** 2 + 4 * c[0, 1] ** 2 + COALESCENCE**2)
    stretch = sqrt((tr(c) + spread) / 2)
    along = stretch if law.bounded else conditional(taut, 1.0, stretch)
    return conditional(taut, law.where(taut, tr(c), area), relaxed(law.stretches, width)(along))


def gas_energy(at: Surface, p: Expr) -> Expr:
    r"""Potential of a gas, :math:`-\tfrac12 p\,(x e_x + y e_y)\cdot N`: minus pressure times volume."""
    out = normal(at)
    return -p * (at.x[0] * out[0] + at.x[1] * out[1]) / 2


def liquid_energy(at: Surface, level: Expr, gamma: Expr, wet: Condition) -> Expr:
    r"""Potential of a liquid of a given level, up to a constant, for fixed edges.

    .. math:: \Phi(z)\, N_z, \qquad \Phi = \tfrac12\gamma\,(z_w - z)_+^2,
              \qquad N_z = -r\,(r'\theta_{,\Theta} - r_{,\Theta}\theta')

    Its second derivative in ``z`` has only a step. The printed form ``-p(z) r^2 z'/2`` has a kink at the free
    surface, so that its second derivative needs a line term there. The paper's equations 22 to 25 leave this
    term out, and so does automatic differentiation.

    Args:
        at: The deformed surface.
        level: Level ``z_w``.
        gamma: ``rho g Ao^2/(C1 h)``.
        wet: Indicator of the wet part, held fixed.
    """
    return conditional(wet, gamma, 0.0) * (level - at.x[2]) ** 2 / 2 * normal(at)[2]


def around(base: Surface, parts: tuple[Expr, ...], slopes: tuple[Expr, ...], n: Expr) -> list[Surface]:
    """A surface of revolution with a harmonic displacement, at both :data:`ANGLES`.

    Args:
        base: The axisymmetric surface.
        parts: ``(u, q, w)`` over ``S``.
        slopes: Their derivatives.
        n: Wave number; any real number.
    """
    return [base + harmonic(parts, slopes, n, c, s) for c, s in ANGLES]


def second_order(energy: Callable[[Expr], Expr], zero: Expr) -> Expr:
    r"""Second derivative at 0 of an energy along a *given* perturbation, :math:`\mathrm d^2/\mathrm de^2`.

    Args:
        energy: Energy as a function of the amplitude ``e``.
        zero: The constant 0, the value of ``e``.
    """
    e = variable(zero)
    return diff(diff(energy(e), e), e)


def hoop_bending(base: Surface, parts: tuple[Expr, ...], slopes: tuple[Expr, ...], n: Expr) -> Expr:
    r"""Change of the circumferential curvature to first order, over the reference metric.

    .. math:: j k_{22} = z_0'[-(n^2+1)u - 2nq + r_0 r_0' u'/j^2] - r_0'[-n^2 w + r_0 r_0' w'/j^2],
              \qquad j = \lambda_1

    times :math:`\cos n\Theta / R^2`, the factor :math:`R^{-2}` left to the caller. It contains first
    derivatives only. A sheet with the energy :math:`\tfrac12\int D k_{22}^2` of this *incremental* curvature
    has the same equilibrium as the membrane.

    Args:
        base: The axisymmetric surface.
        parts: ``(u, q, w)`` over ``S``.
        slopes: Their derivatives.
        n: Wave number.
    """
    (u, q, w), (u_s, _, w_s) = parts, slopes
    r, r_s, z_s = base.x[0], base.a[0], base.a[2]
    square = r_s**2 + z_s**2
    turn = r * r_s / square
    radial = -(n**2 + 1) * u - 2 * n * q + turn * u_s
    axial = -(n**2) * w + turn * w_s
    return (z_s * radial - r_s * axial) / square**0.5


def meridional_bending(
    base: Surface, parts: tuple[Expr, ...], slopes: tuple[Expr, ...], second: tuple[Expr, ...], n: Expr
) -> tuple[Expr, Expr, Expr]:
    r"""Changes of meridional curvature and twist to first order, and the meridian's rotation.

    .. math:: j k_{11} = z_0'(u'' - j' u'/j) - r_0'(w'' - j' w'/j), \quad
              j R\,k_{12} = z_0'[-n u' - q' + (r_0'/r_0)(n u + q)] - r_0'[-n w' + (r_0'/r_0)\,n w], \quad
              j \varphi = z_0' u' - r_0' w'

    times ``cos``, ``sin`` and ``cos`` of ``n Theta``; the factor ``1/R`` of the twist is left to the caller.

    Args:
        base: The axisymmetric surface.
        parts: ``(u, q, w)`` over ``S``.
        slopes: Their derivatives.
        second: ``(r0'', z0'', u'', w'')``.
        n: Wave number.
    """
    (u, q, w), (u_s, q_s, w_s) = parts, slopes
    r, r_s, z_s = base.x[0], base.a[0], base.a[2]
    r_ss, z_ss, u_ss, w_ss = second
    j = sqrt(r_s**2 + z_s**2)
    stretching = (r_s * r_ss + z_s * z_ss) / j**2
    k11 = (z_s * (u_ss - stretching * u_s) - r_s * (w_ss - stretching * w_s)) / j
    turn = r_s / r
    twist = z_s * (-n * u_s - q_s + turn * (n * u + q)) - r_s * (-n * w_s + turn * n * w)
    return k11, twist / j, (z_s * u_s - r_s * w_s) / j
