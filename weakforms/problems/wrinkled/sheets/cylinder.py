r"""Problem ``wrinkled_sheet``: the cylinder of Paper 4 as a two-dimensional membrane, without axisymmetry.

The reference surface is the unrolled cylinder, ``X = Theta in [0, pi/2]`` between two planes of symmetry and
``Y = Z in [0, L]``; the unknown is the position in space. The relaxed energy is
:func:`weakforms.forms.wrinkling.surface_tension_field`, by the principal stretches of ``C``. It checks the
axisymmetric form with a few elements around. With many elements, the wrinkled membrane under pressure is
unstable to waves around it (Paper 5).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from pydantic import Field
from ufl.core.expr import Expr

from weakforms.errors import AbsentError
from weakforms.forms.materials import SurfaceLaw, mooney_rivlin_surface
from weakforms.forms.wrinkling import surface_tension_field
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.meridian.body import Body
from weakforms.problems.problem import Numerics, Problem, Requests, Task
from weakforms.problems.quantity_problem import on_two_meshes
from weakforms.problems.wrinkled.body import CYLINDER, SHARED
from weakforms.problems.wrinkled.first_state import first_state
from weakforms.problems.wrinkled.problem import BranchParameters, WrinkledNumerics, wrinkled_membrane
from weakforms.problems.wrinkled.sheets.about import WRINKLED_SHEET
from weakforms.problems.wrinkled.state import ZonedState
from weakforms.results import Absence, Result
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import System

QUARTER = np.pi / 2
CAP = 4.0
"""Highest assumed order of convergence; both directions are refined together."""


class SheetParameters(BranchParameters):
    """The membrane and its load."""

    energy: Literal["relaxed", "modified_gradient"] = Field(
        "relaxed", description="treatment of wrinkling in the first guess; the sheet itself is relaxed"
    )
    at_load: float = Field(4.5, gt=0, le=100, description="load: level zw, or pressure p with load = 'gas'")


class SheetNumerics(Numerics):
    """Meshes of a quarter of the membrane: cells along blocks between fronts, and cells around."""

    degree: int = Field(4, ge=2, le=5, description="polynomial degree of the unknowns")
    along: int = Field(4, ge=2, le=64, multiple_of=2, description="cells of each block on the finest mesh")
    around: int = Field(4, ge=2, le=16, multiple_of=2, description="cells on the quarter on the finest mesh")


@dataclass(frozen=True)
class Sheet:
    """One mesh of a quarter of the membrane, and its first guess."""

    around: int
    along: int
    degree: int
    start: ZonedState
    """Axisymmetric state at the load."""

    def solve(self, comm: MPI.Intracomm) -> dict[str, float]:
        """Solve for the equilibrium: volume, total potential, and distance from a surface of revolution."""
        model = self.start.model
        breaks = model.breaks_of(self.start.state.loads)
        mesh = dmesh.create_rectangle(
            comm,
            [[0.0, 0.0], [QUARTER, float(model.blocks)]],
            [self.around, model.blocks * self.along],
            dmesh.CellType.quadrilateral,
        )
        block = np.minimum(np.floor(mesh.geometry.x[:, 1]).astype(int), model.blocks - 1)
        mesh.geometry.x[:, 1] = breaks[block] + np.diff(breaks)[block] * (mesh.geometry.x[:, 1] - block)
        element = basix.ufl.element("Lagrange", "quadrilateral", self.degree, shape=(3,))
        space = fem.functionspace(mesh, element)
        position = fem.Function(space, name="position")
        places = space.tabulate_dof_coordinates()
        position.x.array[:] = self._revolved(places, comm)
        system = System(self._formulation(mesh, space, position))
        state, _ = ExtendedNewton(system, max_iterations=40).solve(system.initial)
        with system.at(state):
            values = system.monitors()
        owned = places[: system.size // 3]
        x, y, _ = state.u.reshape(-1, 3).T
        twist = np.abs(x * np.sin(owned[:, 0]) - y * np.cos(owned[:, 0])).max(initial=0.0)
        values["twist"] = float(comm.allreduce(twist, op=MPI.MAX))
        return values

    def _revolved(self, places: np.ndarray, comm: MPI.Intracomm) -> np.ndarray:
        """The axisymmetric state at this rank's points of the mesh."""
        everywhere = comm.allgather(places[:, 1])
        found = self.start.sampled(np.clip(np.concatenate(everywhere), 0.0, None))
        first = sum(len(part) for part in everywhere[: comm.rank])
        mine = slice(first, first + len(places))
        r, z = found["r"][mine], found["z"][mine]
        return np.column_stack([r * np.cos(places[:, 0]), r * np.sin(places[:, 0]), z]).ravel()

    def _formulation(self, mesh: dmesh.Mesh, space: fem.FunctionSpace, position: fem.Function) -> Formulation:
        body, loads = self.start.model.body, self.start.state.loads
        names = (*body.parameters, *SHARED)
        q = {name: fem.Constant(mesh, loads[name]) for name in names}
        dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 4 * self.degree})
        x, y, z = position
        material = self.start.model.material_law
        law = None if material is None else material.surface_law(mesh)
        strain, volume, liquid = sheet_densities(mesh, position, q, law, body)
        share = 2 / np.pi  # a quarter of the membrane, per 2 pi
        potential = (strain - q["p"] * volume + liquid) * share * dx
        trial, test = ufl.TrialFunction(space), ufl.TestFunction(space)
        return Formulation(
            unknown=position,
            residual=ufl.derivative(potential, position, test),
            loads={},
            bcs=self._conditions(mesh, space, position),
            mass=ufl.inner(trial, test) * dx,
            monitors={
                "V": volume * share * dx,
                "Pi": (strain - sheet_pressure(z, q) * volume) * share * dx,
                "radius": ufl.sqrt(x**2 + y**2) * share * dx,
            },
        )

    def _conditions(
        self, mesh: dmesh.Mesh, space: fem.FunctionSpace, position: fem.Function
    ) -> list[fem.DirichletBC]:
        """Conditions at the disks and at the planes of symmetry ``y = 0`` and ``x = 0``."""
        length = float(CYLINDER.length(self.start.state.loads))
        mesh.topology.create_connectivity(1, 2)
        ends = dmesh.locate_entities_boundary(
            mesh, 1, lambda p: np.isclose(p[1], 0.0) | np.isclose(p[1], length)
        )
        held = fem.Function(space)
        held.x.array[:] = position.x.array
        out = [fem.dirichletbc(held, fem.locate_dofs_topological(space, 1, ends))]
        for side, component in ((0.0, 1), (QUARTER, 0)):
            edge = dmesh.locate_entities_boundary(mesh, 1, lambda p, side=side: np.isclose(p[0], side))
            part = space.sub(component)
            dofs = fem.locate_dofs_topological(part, 1, edge)
            out.append(fem.dirichletbc(np.array(0.0), dofs, part))
        return out


def sheet_pressure(z: Expr, q: dict[str, fem.Constant]) -> Expr:
    """``p + gamma max(zw - z, 0)``."""
    return q["p"] + ufl.conditional(ufl.gt(q["zw"], z), q["gamma"] * (q["zw"] - z), 0.0)


def sheet_densities(
    mesh: dmesh.Mesh,
    position: Expr,
    q: dict[str, fem.Constant],
    law: SurfaceLaw | None = None,
    body: Body = CYLINDER,
) -> tuple[Expr, Expr, Expr]:
    r"""Strain energy, volume and potential of the liquid per unit area of the unrolled cylinder.

    .. math:: \eta W(C), \qquad \tfrac12 (x y_X - y x_X) z_Y - \tfrac12 (x y_Y - y x_Y) z_X, \qquad
              -\Phi(z)\,(x_Y y_X - x_X y_Y)
    """
    along = ufl.SpatialCoordinate(mesh)[1]
    gradient = ufl.grad(position)
    c = gradient.T * gradient
    energy = surface_tension_field(c, law or mooney_rivlin_surface(q["c2"]))
    (x, y, z), (x_x, x_y), (y_x, y_y), (z_x, z_y) = (
        position,
        *((gradient[i, 0], gradient[i, 1]) for i in range(3)),
    )
    volume = ((x * y_x - y * x_x) * z_y - (x * y_y - y * x_y) * z_x) / 2
    head = ufl.conditional(ufl.gt(q["zw"], z), q["gamma"] * (q["zw"] - z) ** 2 / 2, 0.0)
    return body.thickness(along, q) * energy, volume, -head * (x_y * y_x - x_x * y_y)


class WrinkledSheet(Problem):
    """The membrane of Paper 4 at one load, by a form without axial symmetry."""

    about = WRINKLED_SHEET
    parameters = SheetParameters
    numerics = SheetNumerics

    def check(self, parameters: SheetParameters, requests: Requests) -> None:
        """Refuse requests for states, because there is only one, and laws without a two-dimensional form."""
        super().check(parameters, requests)
        require_foldable(f"{self.name}: waves around the axis", parameters, invariants=True)
        parameters.require_carried(self.name)

    def fill(self, result: Result, task: Task) -> None:
        """Solve on two meshes, starting from the axisymmetric state with its fronts, if there is one."""
        parameters, numerics, comm, progress = task.parameters, task.numerics, task.comm, task.progress
        membrane = wrinkled_membrane(parameters, WrinkledNumerics(), comm)
        try:
            hint = "lower at_load, or raise volume_end"
            plain = first_state(membrane, parameters.at_load, hint, parameters.volume_end)
        except AbsentError as error:
            result.absent.append(Absence(error.what, f"{self.name}: {error}"))
            return
        (start,) = membrane.fitted(plain, Held(membrane.control, parameters.at_load), fine_only=True)

        def run(coarser: int) -> dict[str, float]:
            cells = numerics.around // coarser, numerics.along // coarser
            return Sheet(*cells, numerics.degree, start).solve(comm)

        result.quantities |= on_two_meshes(run, CAP, self.name, progress)
