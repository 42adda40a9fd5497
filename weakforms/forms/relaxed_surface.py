r"""A membrane of flat three-node triangles: stretches of each triangle, relaxed energy, load of a fluid.

The reference surface is the mesh itself. With the Jacobian ``J = dX/dxi`` (3 x 2) of a triangle and the
deformed tangents ``F = dx/dxi`` the reference and deformed metrics are ``G = J^T J`` and ``g = F^T F``, and

.. math:: C = G^{-1} g

has the trace, the determinant and the eigenvalues (squared principal stretches) of the surface's right
Cauchy-Green tensor, whatever the frame (Patil, Nordmark & Eriksson 2016, section 2).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ufl import (
    Jacobian,
    as_vector,
    conditional,
    cross,
    det,
    diff,
    dot,
    grad,
    gt,
    inv,
    min_value,
    sqrt,
    tr,
    variable,
)
from ufl.core.expr import Expr

from weakforms.forms.materials import SurfaceLaw, mooney_rivlin_surface
from weakforms.forms.materials.surface import mooney_rivlin_invariants
from weakforms.forms.wrinkling import (
    principal_stretches,
    surface_tension_field,
)

MIDPOINTS = {
    "quadrature_rule": "custom",
    "quadrature_points": ((0.5, 0.0), (0.5, 0.5), (0.0, 0.5)),
    "quadrature_weights": (1 / 6, 1 / 6, 1 / 6),
    "quadrature_degree": 2,
}
"""Metadata of a measure: edge-midpoint rule on a triangle, exact for polynomials of degree 2."""

TAUT, WRINKLED, SLACK = 1.0, 0.0, -1.0
"""Values of :func:`state`."""


@dataclass(frozen=True)
class Patch:
    """Tangents of the reference and the deformed surface in the reference coordinates of a triangle."""

    reference: Expr
    """``J = dX/dxi``, 3 x 2."""
    deformed: Expr
    """``F = dx/dxi``, 3 x 2."""

    @classmethod
    def of(cls, position: Expr, domain: object) -> Patch:
        """Tangents of a position over the reference surface ``domain`` (its mesh)."""
        jacobian = Jacobian(domain)
        return cls(jacobian, dot(grad(position), jacobian))

    def cauchy_green(self) -> Expr:
        """``G^{-1} g``, 2 x 2; it need not be symmetric."""
        metric = dot(self.reference.T, self.reference)
        return dot(inv(metric), dot(self.deformed.T, self.deformed))

    def area_vector(self) -> Expr:
        r"""Deformed normal times area per reference area, :math:`N = (x_{,1}\times x_{,2})/\sqrt{\det G}`.

        In space it points to the side from which the triangle's vertices appear counterclockwise; over a
        reference surface in the plane it points up where the sheet is not folded over, however its vertices
        are numbered.
        """
        if self.reference.ufl_shape == (2, 2):
            area = det(self.reference)
        else:
            area = sqrt(det(dot(self.reference.T, self.reference)))
        return cross(self.deformed[:, 0], self.deformed[:, 1]) / area


def relaxed_energy(c: Expr, c2: Expr | float | SurfaceLaw) -> Expr:
    r"""Relaxed Mooney-Rivlin energy over ``C1`` per reference volume, for all states of the sheet.

    .. math:: W = I + 1/D - 3 + c_2 (I/D + D - 3), \qquad \lambda_1 \lambda_2^2 > 1 \mathrm{\ (taut)} \\
        W = \lambda_1^2 + 2/\lambda_1 - 3 + c_2 (2\lambda_1 + \lambda_1^{-2} - 3), \qquad
        \lambda_1 > 1 \ge \lambda_1 \lambda_2^2 \mathrm{\ (wrinkled)} \\
        W = 0 \mathrm{\ otherwise\ (slack)}

    with :math:`I = \mathrm{tr}\,C`, :math:`D = \det C` and :math:`\lambda_1 \ge \lambda_2`, for any direction
    of tension. Another law may replace ``c2``; its energy is then divided by the stress of its constants.
    """
    return surface_tension_field(c, c2 if isinstance(c2, SurfaceLaw) else mooney_rivlin_surface(c2))


def resultants(patch: Patch, energy: Callable[[Expr], Expr]) -> Expr:
    r"""Kirchhoff's stress resultants in space, ``C1 h``, of an energy ``W(C)`` per reference area.

    .. math:: \tau = \frac{\partial W}{\partial F}\, F^T = 2 F\, \frac{\partial W}{\partial C}\, F^T

    They do not depend on the frame on the reference surface and are smooth where it has a crease that the
    deformed surface has not.

    Returns:
        The six components ``xx, yy, zz, xy, xz, yz``, the last three times the root of 2, so that the sum of
        squares is that of the tensor.
    """
    f = variable(patch.deformed)
    tau = dot(diff(energy(Patch(patch.reference, f).cauchy_green()), f), f.T)
    shear = [sqrt(2) * tau[i, j] for i, j in ((0, 1), (0, 2), (1, 2))]
    return as_vector([*(tau[i, i] for i in range(3)), *shear])


def full_energy(c: Expr, c2: Expr | float | SurfaceLaw) -> Expr:
    """The same energy without relaxation: the sheet bears compression."""
    if isinstance(c2, SurfaceLaw):
        return c2.invariants(tr(c), det(c))
    return mooney_rivlin_invariants(tr(c), det(c), c2)


def least_stress(c: Expr, law: SurfaceLaw) -> Expr:
    r"""Least principal second Piola-Kirchhoff stress of the full energy ``w(I, D)``, over its modulus.

    .. math:: S_i = 2 \Big(w_I + \frac{D}{\lambda_i^2}\, w_D\Big), \qquad I = \mathrm{tr}\,C,\quad D = \det C

    It is negative exactly where a sheet that bears compression is compressed, and the relaxed one wrinkled.
    """
    trace, area = variable(tr(c)), variable(det(c))
    energy = law.invariants(trace, area)
    by_trace, by_area = diff(energy, trace), diff(energy, area)
    l1, l2 = principal_stretches(c)
    stresses = (2 * (by_trace + area / stretch**2 * by_area) for stretch in (l1, l2))
    return min_value(*stresses)


def state(c: Expr, law: SurfaceLaw | None = None) -> Expr:
    """:data:`TAUT`, :data:`WRINKLED` or :data:`SLACK`, by the same conditions as the energy.

    Args:
        c: Right Cauchy-Green tensor, 2 x 2.
        law: A law with its own width in uniaxial tension; other laws have the same states.
    """
    l1, l2 = principal_stretches(c)
    lax = conditional(gt(l1, 1), WRINKLED, SLACK)
    width = law.width if law else None
    return conditional(gt(l2, width(l1)) if width else gt(det(c) * l2**2, 1), TAUT, lax)


def depth(z: Expr | float, zw: Expr) -> Expr:
    r"""Depth :math:`(z_w - z)_+` of a liquid above a height."""
    return conditional(gt(zw, z), zw - z, 0.0)


def head(z: Expr, p: Expr, zw: Expr, gamma: Expr) -> Expr:
    r"""Potential :math:`\Phi` of a pressure that depends on the height, :math:`\Phi' = -P`.

    .. math:: P = p + \gamma (z_w - z)_+, \qquad \Phi = -p z + \tfrac12 \gamma (z_w - z)_+^2

    Its second derivative is a bounded step, so that no line term arises at the fluid level.
    """
    return -p * z + conditional(gt(zw, z), gamma * (zw - z) ** 2 / 2, 0.0)


def pressure_potential(
    z: Expr, flux: Expr, p: Expr, zw: Expr, gamma: Expr, edge: Expr | float | None = None
) -> Expr:
    r"""Potential :math:`\Phi(z)\,N_z` of gas and liquid inside a surface, per reference area.

    :math:`-\int P\,\mathrm dV = \oint \Phi N_z\,\mathrm dA` as :math:`\nabla\cdot(\Phi e_z) = -P`; the
    surface that closes fixed edges adds a constant. The potential is exact for a polyhedron under gas, and
    exact up to quadrature under a liquid. A liquid of negative weight stands on the other side of the
    surface and pushes against the normal.

    Args:
        z: Height.
        flux: Upward part :math:`N_z` of the outward normal times area per reference area.
        p: Gas pressure.
        zw: Level of the liquid.
        gamma: Its weight.
        edge: Height :math:`z_e` of the edges: with :math:`\Phi(z) - \Phi(z_e)` edges that move in their plane
            carry no load. For held edges the difference is a constant.
    """
    below = 0.0 if edge is None else head(edge, p, zw, gamma)
    return (head(z, p, zw, gamma) - below) * flux


def printed_potential(at: Expr, normal: Expr, p: Expr, zw: Expr, gamma: Expr) -> Expr:
    r"""The same potential by the horizontal flux, :math:`-\tfrac12 P (x N_x + y N_y)`, as in the paper.

    The second variation of this form has a line term at the fluid level, which differentiation of the
    :func:`ufl.conditional` leaves out. Use it only to measure how this choice changes a result.
    """
    pressure = p + conditional(gt(zw, at[2]), gamma * (zw - at[2]), 0.0)
    return -pressure * (at[0] * normal[0] + at[1] * normal[1]) / 2
