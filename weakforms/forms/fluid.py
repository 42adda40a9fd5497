"""A fluid-loaded membrane as a surface in space: strain energy of two tangent vectors, pressure of a liquid.

All quantities are per unit reference area and divided by ``mu H`` (Patil, Nordmark & Eriksson 2015). Vectors
are given by three components in any right-handed orthonormal frame, fixed or rotating with ``Theta``.
"""

from __future__ import annotations

from dataclasses import dataclass

from ufl import as_matrix, as_vector, cross, diff, dot, inner, max_value, sqrt, variable
from ufl.core.expr import Expr

from weakforms.forms.materials import SurfaceLaw, stress_resultants
from weakforms.forms.wrinkling import surface_tension_field


@dataclass(frozen=True)
class Surface:
    """A position or a displacement of a surface, with its derivatives in ``Z`` and ``Theta``."""

    x: Expr
    a: Expr
    """Derivative in the meridional coordinate ``Z``."""
    b: Expr
    """Derivative in the circumferential coordinate ``Theta``, including the rotation of frame vectors."""

    def __add__(self, other: Surface) -> Surface:
        """Sum of a position and a displacement."""
        return Surface(self.x + other.x, self.a + other.a, self.b + other.b)


def strain_energy(a: Expr, b: Expr, alpha: Expr | float | SurfaceLaw) -> Expr:
    r"""Incompressible Mooney-Rivlin membrane over ``mu H``; ``alpha = 0`` is the paper's neo-Hookean one.

    Another law may replace ``alpha``. The energy is then :math:`w(\mathrm{tr}\,C, \det C)/2`, with ``mu = 2
    S``, twice the stress by which that law is divided, like ``mu = 2 C1``.

    .. math:: w = \tfrac12 \left[ I_1 - 3 + \alpha (I_2 - 3) \right], \quad
              I_1 = g_{11} + g_{22} + 1/J, \quad I_2 = (g_{11} + g_{22})/J + J

    with :math:`g_{11} = a\cdot a`, :math:`g_{22} = b\cdot b`, :math:`g_{12} = a\cdot b`,
    :math:`J = g_{11} g_{22} - g_{12}^2`; the reference metric is the identity (lengths over the radius).
    """
    trace = dot(a, a) + dot(b, b)
    j = dot(a, a) * dot(b, b) - dot(a, b) ** 2
    if isinstance(alpha, SurfaceLaw):
        return alpha.invariants(trace, j) / 2
    return (trace + 1 / j - 3 + alpha * (trace / j + j - 3)) / 2


def relaxed_strain_energy(a: Expr, b: Expr, law: SurfaceLaw) -> Expr:
    r"""The same of a membrane that wrinkles in place of bearing compression, :math:`w_r(C)/2`."""
    g11, g12, g22 = dot(a, a), dot(a, b), dot(b, b)
    return surface_tension_field(as_matrix([[g11, g12], [g12, g22]]), law) / 2


def membrane_work(at: Surface, v: Surface, alpha: Expr | float | SurfaceLaw) -> Expr:
    r"""First variation of the strain energy: :math:`w_{,a}\cdot v_{,Z} + w_{,b}\cdot v_{,\Theta}`."""
    a, b = variable(at.a), variable(at.b)
    w = strain_energy(a, b, alpha)
    return inner(diff(w, a), v.a) + inner(diff(w, b), v.b)


def normal(at: Surface) -> Expr:
    """Outward normal times the current area per reference area, ``N = b x a``."""
    return cross(at.b, at.a)


def pressure_work(at: Surface, v: Surface, pressure: Expr) -> Expr:
    r"""First variation of the liquid's potential, :math:`-P\, v \cdot N`: a pressure on the current surface.

    If ``P`` depends on the height alone, this is the variation of :math:`-\int P\,\mathrm dV`. It is written
    directly and not derived from the printed potential :math:`-\tfrac12 P(z)\, r^2 z'`. The second derivative
    of that potential needs a line term from ``P'' = gamma delta(zw - z)`` at the free surface, which UFL
    leaves out.
    """
    return -pressure * dot(v.x, normal(at))


def hydrostatic(z: Expr, zw: Expr, gamma: Expr, wet: Expr | float) -> Expr:
    r"""Pressure of a liquid of level ``zw``: :math:`P(z) = \gamma\,(z_w - z)` where wet, else zero.

    Args:
        z: Height.
        zw: Level of the free surface, or static head above a full tube.
        gamma: ``rho g A^2/(mu H)``.
        wet: Indicator of the wet part, which ends where ``z = zw``.
    """
    return gamma * wet * (zw - z)


def submerged_flux(at: Surface, zw: Expr, power: int) -> Expr:
    r"""Vertical flux :math:`(z_w - z)_+^m N_z/m` through a surface, for ``m = 1`` and 2.

    Its integral is minus the volume of the liquid for ``m = 1``, and :math:`-\int P\,\mathrm dV/\gamma`, the
    potential of a hydrostatic pressure, for ``m = 2``, both up to the contribution of the disks (divergence
    theorem). For ``m = 2`` the second derivative in ``z`` is a bounded step, so that no line term arises at
    the free surface.

    Args:
        at: Position.
        zw: Level of the free surface, or static head above a full tube.
        power: ``m``.
    """
    return max_value(zw - at.x[2], 0.0) ** power * normal(at)[2] / power


def axisymmetric(r: Expr, z: Expr, slopes: tuple[Expr, Expr]) -> Surface:
    """A surface of revolution in the frame ``(e_r, e_theta, e_z)`` that rotates with ``Theta``.

    Args:
        r: Radius over ``Z``, or a displacement of it.
        z: Height over ``Z``, or a displacement of it.
        slopes: Their derivatives in ``Z``.
    """
    r_z, z_z = slopes
    return Surface(as_vector([r, 0, z]), as_vector([r_z, 0, z_z]), as_vector([0, r, 0]))


def harmonic(q: Expr, slope: Expr, n: Expr | float, c: float, s: float) -> Surface:
    r"""The displacement :math:`u\cos n\Theta\,e_r + \beta\sin n\Theta\,e_\theta + w\cos n\Theta\,e_z`.

    It is given at one angle, in the frame that rotates with ``Theta``.

    Args:
        q: ``(u, beta, w)`` over ``Z``.
        slope: Its derivative in ``Z``.
        n: Number of waves around the circumference.
        c: ``cos(n Theta)`` at the angle.
        s: ``sin(n Theta)`` at the angle.
    """
    u, beta, w = q
    u_z, beta_z, w_z = slope
    return Surface(
        as_vector([c * u, s * beta, c * w]),
        as_vector([c * u_z, s * beta_z, c * w_z]),
        as_vector([-s * (n * u + beta), c * (u + n * beta), -s * n * w]),
    )


def principal_stretches(at: Surface) -> tuple[Expr, Expr]:
    """Larger and smaller principal stretch from the metric of the surface."""
    g11, g22, g12 = dot(at.a, at.a), dot(at.b, at.b), dot(at.a, at.b)
    root = sqrt((g11 - g22) ** 2 + 4 * g12**2)
    return sqrt((g11 + g22 + root) / 2), sqrt((g11 + g22 - root) / 2)


def principal_resultants(lam1: Expr, lam2: Expr, alpha: Expr | float | SurfaceLaw) -> tuple[Expr, Expr]:
    r"""Cauchy stress resultants, force per current length over ``mu H``.

    :func:`strain_energy` describes the scaling for other laws.

    .. math:: T_1 = w_{,1}/\lambda_2, \qquad T_2 = w_{,2}/\lambda_1
    """
    if isinstance(alpha, SurfaceLaw):
        first, second = stress_resultants(alpha.stretches, lam1, lam2)
        return first / 2, second / 2
    l1, l2 = variable(lam1), variable(lam2)
    j = (l1 * l2) ** 2
    w = (l1**2 + l2**2 + 1 / j - 3 + alpha * ((l1**2 + l2**2) / j + j - 3)) / 2
    return diff(w, l1) / l2, diff(w, l2) / l1
