r"""Weak form of a flat sheet whose edges are moved in their plane, on triangles.

.. math:: \Pi = \int W(C)\,\mathrm dA, \qquad x = \lambda X + \gamma Y + u_x, \quad y = s\,Y + u_y

over the stress-free rectangle ``[0, c] x [0, 1]``. With ``u = 0`` on all edges the sheet stays homogeneous:
every mesh represents the solution, and Newton's method must find ``u = 0``. The mean nominal stresses are the
derivatives of the energy in ``lambda``, ``s`` and ``gamma`` over the area.

A strip is pulled by its ends, which slide along themselves; its long edge is free, and it finds its width.
"""

from __future__ import annotations

from dataclasses import dataclass
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

CONTROL = {"shear": "gam", "stretch": "lam", "strip": "lam"}
"""The load of each loading."""


@dataclass(frozen=True)
class Sheet:
    """The sheet and its edges."""

    law: Chosen
    loading: Literal["shear", "stretch", "strip"]
    c: float = 1.0
    """Length over width."""
    s: float = 1.0
    """Stretch of the edges in ``Y``."""
    relaxed: bool = True
    """Whether the sheet bears no compression."""

    @property
    def control(self) -> str:
        """Name of the load."""
        return CONTROL[self.loading]


class SheetModel:
    """The discrete equations on one mesh. Loads: ``lam``, ``gam`` and ``s``.

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
        self.scalars = scalars(self.mesh, ("lam", "gam", "s"))
        self.scalars["lam"][0].value = 1.0
        self.scalars["s"][0].value = sheet.s
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": RULE[degree]})
        self.system = System(self._formulation())

    def _formulation(self) -> Formulation:
        place, sheet = ufl.SpatialCoordinate(self.mesh), self.sheet
        lam, gam, s = (self.scalars[name][1] for name in ("lam", "gam", "s"))
        position = ufl.as_vector([lam * place[0] + gam * place[1], s * place[1]]) + self.unknown
        c, law = Patch.of(position, self.mesh).cauchy_green(), sheet.law.surface_law(self.mesh)
        energy = (relaxed_energy if sheet.relaxed else full_energy)(c, law)
        l1, l2 = principal_stretches(c)
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        mode = state(c, law)

        def mean(value: Expr) -> ufl.Form:
            return value / sheet.c * self.dx

        shares = {"f_w": WRINKLED, "f_s": SLACK} if sheet.loading != "strip" else {}
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy * self.dx, self.unknown, test),
            loads=self.scalars,
            bcs=self._conditions(),
            mass=ufl.inner(trial, test) * self.dx,
            monitors={
                "tau": mean(ufl.diff(energy, gam)),
                "T_x": mean(ufl.diff(energy, lam)),
                "T_y": mean(ufl.diff(energy, s)),
                "Pi": energy * self.dx,
                "lam1": mean(l1),
                "lam2": mean(l2),
                "S_least": mean(least_stress(c, law)),
                **{n: mean(ufl.conditional(ufl.eq(mode, v), 1.0, 0.0)) for n, v in shares.items()},
            },
            profile=dict(zip("xy", position, strict=True)),
            abscissa="X",
            locate=lambda x, _loads: np.column_stack([x, np.asarray(x) / sheet.c]),
        )

    def _conditions(self) -> list[fem.DirichletBC]:
        """All edges move as prescribed; of a strip both ends along ``X`` only, and its axis across it."""
        if self.sheet.loading == "strip":
            return [self._zero(0, 0, (0.0, self.sheet.c)), self._zero(1, 1, (0.0,))]
        return [
            self._zero(i, axis, (0.0, end)) for axis, end in enumerate((self.sheet.c, 1.0)) for i in (0, 1)
        ]

    def _zero(self, component: int, axis: int, values: tuple[float, ...]) -> fem.DirichletBC:
        part = self.space.sub(component)
        edges = dmesh.locate_entities_boundary(
            self.mesh, 1, lambda x: np.any([np.isclose(x[axis], value) for value in values], axis=0)
        )
        return fem.dirichletbc(np.array(0.0), fem.locate_dofs_topological(part, 1, edges), part)
