r"""Weak form of a flat sheet whose edges are moved in their plane, on triangles.

.. math:: \Pi = \int W(C)\,\mathrm dA, \qquad x = \lambda X + \gamma Y + u_x, \quad y = s\,Y + u_y

over the stress-free rectangle ``[0, c] x [0, 1]``. With ``u = 0`` on all edges the sheet stays homogeneous:
every mesh represents the solution, and Newton's method must find ``u = 0``. The mean nominal stresses are the
derivatives of the energy in ``lambda``, ``s`` and ``gamma`` over the area.

A strip is pulled by its ends, which slide along themselves; its long edge is free, and it finds its width.

A sheet is bent by guides along its long edges, concentric arcs at the distance ``s``, whose ends turn by
:math:`\kappa c` towards each other. Its points move along the arcs by ``u_x`` and across them by ``u_y``:

.. math:: r = \lambda_0/\kappa + w, \quad \varphi = \kappa\,(X + u_x), \quad w = s\,(Y - 1/2) + u_y

with the deformation gradient :math:`(\lambda_0 + \kappa w)\,\nabla(X + u_x)` along the arc and
:math:`\nabla w` along its radius. The state is the same at every ``X``, not at every ``Y``. The mean force
along the arcs, and its moment about the arc of the stretch :math:`\lambda_0`, are the derivatives of the
energy in :math:`\lambda_0` and in :math:`\kappa` over the length.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.relaxed_surface import (
    SLACK,
    WRINKLED,
    Patch,
    full_energy,
    least_stress,
    relaxed_energy,
    state,
)
from weakforms.forms.wrinkling import principal_stretches
from weakforms.problems.material_choice import Chosen
from weakforms.problems.triangles.weak_form import RULE, scalars
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System

CONTROL = {"shear": "gam", "stretch": "lam", "strip": "lam", "bend": "kap"}
"""The load of each loading."""

SMALL = 1e-3
"""Angle below which two terms of the series of ``sin(x)/x`` are exact to rounding: the next is x^4/120."""


@dataclass(frozen=True)
class Sheet:
    """The sheet and its edges."""

    law: Chosen
    loading: Literal["shear", "stretch", "strip", "bend"]
    c: float = 1.0
    """Length over width."""
    s: float = 1.0
    """Stretch of the edges in ``Y``."""
    lam0: float = 1.0
    """Stretch in ``X`` at which the motion begins."""
    relaxed: bool = True
    """Whether the sheet bears no compression."""

    @property
    def control(self) -> str:
        """Name of the load."""
        return CONTROL[self.loading]


class SheetModel:
    """The discrete equations on one mesh. Loads: ``lam``, ``gam``, ``s`` and ``kap``.

    Args:
        comm: Ranks.
        sheet: The sheet.
        cells: Squares across the width, each cut into four triangles.
        degree: Degree of the elements, 1 or 2.
    """

    def __init__(self, comm: MPI.Intracomm, sheet: Sheet, cells: int, degree: int) -> None:
        self.sheet = sheet
        self.mesh = dmesh.create_rectangle(
            comm,
            [np.zeros(2), np.array([sheet.c, 1.0])],
            [max(1, round(sheet.c * cells)), cells],
            dmesh.CellType.triangle,
            diagonal=dmesh.DiagonalType.crossed,
        )
        self.space = fem.functionspace(self.mesh, ("Lagrange", degree, (2,)))
        self.unknown = fem.Function(self.space, name="displacement")
        self.scalars = scalars(self.mesh, ("lam", "gam", "s", "kap"))
        self.scalars["lam"][0].value = sheet.lam0
        self.scalars["s"][0].value = sheet.s
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": RULE[degree]})
        self.system = System(self._formulation())

    def _formulation(self) -> Formulation:
        sheet = self.sheet
        patch, position = self._bent() if sheet.loading == "bend" else self._moved()
        c, law = patch.cauchy_green(), sheet.law.surface_law(self.mesh)
        energy = (relaxed_energy if sheet.relaxed else full_energy)(c, law)
        l1, l2 = principal_stretches(c)
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        mode = state(c, law)

        def mean(value: Expr, measure: ufl.Measure = self.dx) -> ufl.Form:
            return value / sheet.c * measure

        def rate(name: str) -> ufl.Form:
            return mean(ufl.diff(energy, self.scalars[name][1]))

        bent = sheet.loading == "bend"
        stresses = {"T_x": "lam", "M": "kap"} if bent else {"tau": "gam", "T_x": "lam", "T_y": "s"}
        shares = {"f_w": WRINKLED, "f_s": SLACK} if sheet.loading != "strip" else {}
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy * self.dx, self.unknown, test),
            loads=self.scalars,
            bcs=self._conditions(),
            mass=ufl.inner(trial, test) * self.dx,
            monitors={
                **{name: rate(load) for name, load in stresses.items()},
                "Pi": energy * self.dx,
                "lam1": mean(l1),
                "lam2": mean(l2),
                "S_least": mean(least_stress(c, law), self._inner if bent else self.dx),
                **{n: mean(ufl.conditional(ufl.eq(mode, v), 1.0, 0.0)) for n, v in shares.items()},
            },
            profile=dict(zip("xy", position, strict=True)),
            abscissa="X",
            locate=lambda x, _loads: np.column_stack([x, np.asarray(x) / sheet.c]),
        )

    def _moved(self) -> tuple[Patch, Expr]:
        """Tangents and position of a sheet whose edges stay straight."""
        place = ufl.SpatialCoordinate(self.mesh)
        lam, gam, s = (self.scalars[name][1] for name in ("lam", "gam", "s"))
        position = ufl.as_vector([lam * place[0] + gam * place[1], s * place[1]]) + self.unknown
        return Patch.of(position, self.mesh), position

    def _bent(self) -> tuple[Patch, Expr]:
        """Tangents in the directions of the arc and of its radius, and position, of a bent sheet."""
        place = ufl.SpatialCoordinate(self.mesh)
        lam0, s, kap = (self.scalars[name][1] for name in ("lam", "s", "kap"))
        along, offset = place[0] + self.unknown[0], s * (place[1] - 0.5) + self.unknown[1]
        jacobian = ufl.Jacobian(self.mesh)
        rows = (lam0 + kap * offset) * ufl.grad(along), ufl.grad(offset)
        angle = kap * along
        position = ufl.as_vector(
            [
                lam0 * along * _sine_over(angle) + offset * ufl.sin(angle),
                offset * ufl.cos(angle) - lam0 * kap * (along * _sine_over(angle / 2)) ** 2 / 2,
            ]
        )
        return Patch(jacobian, ufl.as_tensor([ufl.dot(row, jacobian) for row in rows])), position

    @cached_property
    def _inner(self) -> ufl.Measure:
        """The edge at the inner arc."""
        edges = dmesh.locate_entities_boundary(self.mesh, 1, lambda x: np.isclose(x[1], 0.0))
        tags = dmesh.meshtags(self.mesh, 1, np.sort(edges), np.full(len(edges), 1, dtype=np.int32))
        return ufl.Measure("ds", self.mesh, subdomain_data=tags, subdomain_id=1, metadata=self.dx.metadata())

    def _conditions(self) -> list[fem.DirichletBC]:
        """All edges move as prescribed, but the ends of a bent sheet slide along the radius.

        Of a strip both ends move as prescribed along ``X`` only, and its axis stays.
        """
        if self.sheet.loading == "strip":
            return [self._zero(0, 0, (0.0, self.sheet.c)), self._zero(1, 1, (0.0,))]
        if self.sheet.loading == "bend":
            return [self._zero(0, 0, (0.0, self.sheet.c)), *(self._zero(i, 1, (0.0, 1.0)) for i in (0, 1))]
        return [
            self._zero(i, axis, (0.0, end)) for axis, end in enumerate((self.sheet.c, 1.0)) for i in (0, 1)
        ]

    def _zero(self, component: int, axis: int, values: tuple[float, ...]) -> fem.DirichletBC:
        part = self.space.sub(component)
        edges = dmesh.locate_entities_boundary(
            self.mesh, 1, lambda x: np.any([np.isclose(x[axis], value) for value in values], axis=0)
        )
        return fem.dirichletbc(np.array(0.0), fem.locate_dofs_topological(part, 1, edges), part)


def _sine_over(angle: Expr) -> Expr:
    """``sin(angle)/angle``, also at zero."""
    small = ufl.lt(abs(angle), SMALL)
    return ufl.conditional(small, 1 - angle**2 / 6, ufl.sin(angle) / ufl.conditional(small, 1.0, angle))
