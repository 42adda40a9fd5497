r"""The weak form of every problem on triangles: relaxed or full energy, and the load's potential.

.. math:: \Pi = \int H\, W(C)\,\mathrm dA + \int [\Phi(z) - \Phi(z_e)]\, N_z\,\mathrm dA, \qquad
          \Phi = -p z + \tfrac12 \gamma (z_w - z)_+^2

The reference surface is the mesh, in a plane or in space, and the elements may have any degree. Where the
edges are held, or move in their plane ``z = z_e``, UFL's derivatives are the exact first and second
variation: the load is that of a pressure normal to the deformed surface, and the tangent is symmetric.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import ufl
from dolfinx import fem
from dolfinx.mesh import Mesh
from ufl.core.expr import Expr

from weakforms.forms.materials import SurfaceLaw
from weakforms.forms.relaxed_surface import (
    Patch,
    full_energy,
    pressure_potential,
    relaxed_energy,
    resultants,
)

RULE = {1: 2, 2: 4}
"""Quadrature degree by the degree of the elements: the load of straight triangles is exact with the first."""

Loads = Mapping[str, tuple[fem.Constant, Expr]]
"""Scalars of a form: the constant, and the ``ufl.variable`` by which it enters."""


def scalars(mesh: Mesh, names: Iterable[str]) -> Loads:
    """New scalars on a mesh, zero at first."""
    constants = {name: fem.Constant(mesh, 0.0) for name in names}
    return {name: (constant, ufl.variable(constant)) for name, constant in constants.items()}


@dataclass(frozen=True)
class Membrane:
    """A membrane of triangles at one position; all expressions are per reference area."""

    position: Expr
    cauchy_green: Expr
    """``C``, 2 x 2, see :class:`weakforms.forms.relaxed_surface.Patch`."""
    normal: Expr
    """``N``: the deformed normal times area."""
    strain: Expr
    """``H W(C)``."""
    height: Expr
    """Height of the position."""
    flux: Expr
    """Upward part of ``N``."""
    load: Expr
    """Potential of gas and liquid."""
    resultants: Expr
    """Stress resultants, see :func:`weakforms.forms.relaxed_surface.resultants`."""

    @classmethod
    def at(
        cls,
        position: Expr,
        mesh: Mesh,
        law: SurfaceLaw | Expr,
        loads: Loads,
        gamma: Expr,
        thickness: Expr | float = 1.0,
        relaxed: bool = True,
        edge: Expr | float | None = None,
        up: Expr | None = None,
    ) -> Membrane:
        """The terms at a position.

        Args:
            position: Deformed position, an expression of the unknown.
            mesh: The reference surface.
            law: The law, or ``C2/C1`` of the Mooney-Rivlin law.
            loads: Scalars ``p`` and ``zw``.
            gamma: Weight of the liquid; negative if it stands on the side that the normal points to.
            thickness: ``H`` over its mean.
            relaxed: Whether the sheet bears no compression.
            edge: Height of the edges, see :func:`weakforms.forms.relaxed_surface.pressure_potential`.
            up: Unit vector along which heights are measured; by default ``e_z``.
        """
        patch = Patch.of(position, mesh)
        c, normal = patch.cauchy_green(), patch.area_vector()
        energy = relaxed_energy if relaxed else full_energy
        height, flux = (v[2] if up is None else ufl.dot(up, v) for v in (position, normal))
        load = pressure_potential(height, flux, loads["p"][1], loads["zw"][1], gamma, edge)
        tension = resultants(patch, lambda c: thickness * energy(c, law))
        return cls(position, c, normal, thickness * energy(c, law), height, flux, load, tension)
