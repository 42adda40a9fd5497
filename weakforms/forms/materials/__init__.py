"""Strain energies of membranes as functions of two principal stretches.

A law is one function ``w(lam1, lam2)``. Stresses follow from it by differentiation;
:mod:`weakforms.forms.wrinkling` derives the energy of the wrinkled state. :data:`MATERIALS` lists the laws by
name, with constants and ranges.
"""

from __future__ import annotations

from ufl import diff, variable
from ufl.core.expr import Expr

from weakforms.forms.materials.catalogue import MATERIALS, Constant, Material
from weakforms.forms.materials.phenomenological import mooney_rivlin, neo_hookean
from weakforms.forms.materials.surface import SurfaceLaw, mooney_rivlin_surface, surface_law


def stress_resultants(law, lam1: Expr, lam2: Expr) -> tuple[Expr, Expr]:  # noqa: ANN001
    r"""Cauchy stress resultants, force per deformed length over ``C1 h_o``.

    .. math:: t_1 = w_{,1}/\lambda_2, \qquad t_2 = w_{,2}/\lambda_1

    Args:
        law: Energy ``w(lam1, lam2)``.
        lam1: Meridional stretch.
        lam2: Circumferential stretch.
    """
    l1, l2 = variable(lam1), variable(lam2)
    w = law(l1, l2)
    return diff(w, l1) / l2, diff(w, l2) / l1


__all__ = [
    "MATERIALS",
    "Constant",
    "Material",
    "SurfaceLaw",
    "mooney_rivlin",
    "mooney_rivlin_surface",
    "neo_hookean",
    "stress_resultants",
    "surface_law",
]
