r"""Weak form of a membrane of any shape under gas or a liquid, on straight or curved triangles in space.

.. math:: \Pi = \int H\, W(C)\,\mathrm dA - \int [\varphi(z) - \varphi(z_e)]\, N_z\,\mathrm dA - \Pi_0, \qquad
          \varphi = p\,z \quad\mathrm{or}\quad \varphi = \tfrac12 \gamma (z_w - z)_+^2

with the stress-free surface as reference, ``H`` its thickness over ``h``, for gas on the side from which the
normals ``N`` point, or a liquid of level ``z_w`` on the side to which they point. ``Pi_0`` is the load's
integral over the reference surface, stretched by ``delta`` about a point. Held edges are on that surface.
Edges on a plane of symmetry, and edges that slide in a plane, stay in the plane; ``z_e`` is the height of a
horizontal one, at which the edges of the membrane then carry no load. Conjugate to ``p`` is the volume ``V``
between the membrane and its stretched reference surface, to ``gamma z_w`` the liquid ``V_f`` between vertical
walls at the edges; above edges that move in their plane the walls are those of the reference surface. The
unknown is the displacement from the stretched surface. Under a liquid whose weight is tilted, ``z`` and
``N_z`` are components along the vertical ``(sin tilt, 0, cos tilt)``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, sin

import numpy as np
import ufl
from dolfinx import fem
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.relaxed_surface import SLACK, WRINKLED, depth, least_stress, state
from weakforms.problems.material_choice import Chosen
from weakforms.problems.membrane.reference import AXES, Reference
from weakforms.problems.meridian.thickness import Thickness
from weakforms.problems.triangles.limits import MEDIA
from weakforms.problems.triangles.meshes import in_space
from weakforms.problems.triangles.readings import corner_weight
from weakforms.problems.triangles.weak_form import RULE, Membrane, scalars
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.support import compat
from weakforms.solvers.uncertainty.recovery import Recovery


@dataclass(frozen=True)
class Motion:
    """A rigid motion of held edges: a turn about a line through :attr:`Reference.pivot`, and a shift."""

    shift: tuple[float, float, float]
    turn: float
    """Angle, counter-clockwise about the line."""
    axis: int
    """The coordinate along the line."""


def vertical(tilt: float) -> np.ndarray:
    """Unit vector upwards, at an angle from the axis ``Z`` towards ``X``."""
    return np.array([sin(tilt), 0.0, cos(tilt)])


@dataclass(frozen=True)
class Body:
    """The membrane on one mesh."""

    reference: Reference
    law: Chosen
    delta: float = 1.1
    """Stretch of the supports about :attr:`Reference.middle`."""
    relaxed: bool = True
    """Whether the membrane bears no compression."""
    degree: int = 2
    """Of the elements, 1 or 2."""
    load: str = "gas"
    """``gas``, which pushes along the normals, or ``liquid``, which pushes against them."""
    gamma: float = 1.0
    """Weight of the liquid."""
    thickness: Thickness | None = None
    """Thickness over ``h``, by the place in the reference surface; by default 1."""
    tilt: float = 0.0
    """Angle from the axis ``Z`` to the vertical, towards ``X``."""
    motion: Motion | None = None
    """Motion of the edges :attr:`Reference.moved`."""

    def refined(self, times: int) -> Body:
        """The same with four triangles for each, so many times."""
        reference = self.reference
        for _ in range(times):
            reference = reference.refined()
        return replace(self, reference=reference)

    @property
    def control(self) -> str:
        """Name of the load: ``p`` or ``zw``."""
        return MEDIA[self.load][0]

    @property
    def sign(self) -> float:
        """Direction of the deflection: 1 along the normals, -1 against them."""
        return 1.0 if self.load == "gas" else -1.0

    @property
    def up(self) -> np.ndarray:
        """Unit vector along which heights are measured."""
        return vertical(self.tilt)

    @property
    def top(self) -> float:
        """Largest height of the stretched reference surface: a level below it wets a part only."""
        given = self.reference
        highest = ((given.middle + self.delta * (given.points - given.middle)) @ self.up).max()
        return float(highest + (max(self.up @ self.motion.shift, 0.0) if self.motion else 0.0))


class MembraneModel:
    """The discrete equations on one mesh. Loads: ``p`` or ``zw``, and the stretch ``delta`` of the supports.

    Attributes:
        system: Residual, tangent and columns.
        direction: Unit vector along which deflections are measured.
        weight: Weight of the liquid in the form, with its sign.
        deflection: The displacement in this direction.
        rule: Degree of the quadrature, with which the load of the gas is exact.
        node: Node of the reference surface that each vertex of this rank's mesh is.
        cells: Triangle of the reference surface that each of this rank's triangles is.
    """

    def __init__(self, comm: MPI.Intracomm, body: Body) -> None:
        self.body = body
        self.mesh = in_space(comm, body.reference.points, body.reference.cells)
        self.node = self._nodes()
        own = self.mesh.topology.index_map(2).size_local
        self.cells = np.asarray(self.mesh.topology.original_cell_index)[:own]
        self.space = fem.functionspace(self.mesh, ("Lagrange", body.degree, (3,)))
        self.unknown = fem.Function(self.space, name="displacement")
        self.law = body.law.surface_law(self.mesh)
        self.scalars = scalars(self.mesh, ("p", "zw", "delta"))
        self.scalars["delta"][0].value = body.delta
        liquid = body.load == "liquid"
        self.weight = fem.Constant(self.mesh, -body.gamma if liquid else 0.0)
        if liquid:
            self.scalars["zw"][0].value = body.top  # of the first guess
        # On curved triangles the position is quadratic, whatever the degree of the displacement.
        self.rule = RULE[max(body.degree, self.mesh.geometry.cmap.degree)]
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": self.rule})
        self.direction = body.sign * body.reference.direction
        self._lifted = self._lift() if body.motion else []
        moved = sum(self._lifted, self.unknown)
        self.deflection = ufl.dot(moved, fem.Constant(self.mesh, self.direction))
        self.membrane = self._at(self.unknown)
        self.least_stress = least_stress(self.membrane.cauchy_green, self.law)
        self.area = comm.allreduce(fem.assemble_scalar(fem.form(ufl.as_ufl(1.0) * self.dx)), op=MPI.SUM)
        self.system = System(self._formulation())

    def _nodes(self) -> np.ndarray:
        mesh = self.mesh
        mesh.topology.create_connectivity(2, 0)
        count = mesh.topology.index_map(2)
        cells = count.size_local + count.num_ghosts
        vertices = mesh.topology.connectivity(2, 0).array.reshape(-1, 3)[:cells]
        corners = mesh.geometry.dofmap[:cells, :3]
        out = np.zeros(vertices.max(initial=-1) + 1, dtype=np.int64)
        out[vertices] = np.asarray(mesh.geometry.input_global_indices)[corners]
        return out

    # -- form ----------------------------------------------------------------------------------

    def stretched(self) -> Expr:
        """The reference surface, stretched by ``delta``."""
        middle = fem.Constant(self.mesh, self.body.reference.middle)
        return middle + self.scalars["delta"][1] * (ufl.SpatialCoordinate(self.mesh) - middle)

    def _lift(self) -> list[Expr]:
        r"""A displacement that is the motion on the edges that are moved, and vanishes on other held ones.

        With the reference place ``v`` from the pivot, a unit vector ``a`` and the angle ``t`` it is
        :math:`\delta\,[(1 - \cos t)\, a\times(a\times v) + \sin t\; a\times v]` and the shift, times a share.
        """
        motion, given = self.body.motion, self.body.reference
        share = self._linear(given.follows)
        pivot, a, shift, back, along = (
            fem.Constant(self.mesh, value)
            for value in (
                given.pivot,
                np.eye(3)[motion.axis],
                motion.shift,
                1 - cos(motion.turn),
                sin(motion.turn),
            )
        )
        across = ufl.cross(a, ufl.SpatialCoordinate(self.mesh) - pivot)
        turned = self._interpolated(share * (back * ufl.cross(a, across) + along * across))
        return [self.scalars["delta"][1] * turned, self._interpolated(share * shift)]

    def _at(self, displacement: Expr | None) -> Membrane:
        start = self.stretched()
        given = (self.mesh, self.law, self.scalars, self.weight)
        position = start if displacement is None else sum(self._lifted, start + displacement)
        edge, own = fem.Constant(self.mesh, self.body.reference.edge), self.body.thickness
        up = fem.Constant(self.mesh, self.body.up) if self.body.tilt else None
        x, y, z = ufl.SpatialCoordinate(self.mesh)
        thick = own(x, {"Y": y, "Z": z}) if own else 1.0
        return Membrane.at(position, *given, thick, self.body.relaxed, edge, up)

    def _formulation(self) -> Formulation:
        at, start = self.membrane, self._at(None)
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        energy = (at.strain + at.load) * self.dx
        mode, area = state(at.cauchy_green, self.law), fem.Constant(self.mesh, self.area)

        def share(value: float) -> ufl.Form:
            return ufl.conditional(ufl.eq(mode, value), 1.0, 0.0) / area * self.dx

        reads = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 2 * self.body.degree})
        given, slid = self.body.reference, {}
        if given.slides:
            inwards = given.points[given.centre] - given.points[given.far]
            inwards /= np.linalg.norm(inwards)
            slid["u_far"] = ufl.dot(self.unknown, fem.Constant(self.mesh, inwards)) * self._at_node(given.far)
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(energy, self.unknown, test),
            loads={name: self.scalars[name] for name in (self.body.control, "delta")},
            bcs=self._conditions(),
            mass=ufl.inner(trial, test) * self.dx,
            monitors={
                "w_c": self.deflection * self._at_node(given.centre) * reads,
                MEDIA[self.body.load][1]: self._amount(at, start) * self.dx,
                "Pi": (at.strain + at.load - start.load) * self.dx,
                "U": at.strain * self.dx,
                **{name: value * reads for name, value in slid.items()},
                "f_w": share(WRINKLED),
                "f_s": share(SLACK),
            },
        )

    def _amount(self, at: Membrane, start: Membrane) -> Expr:
        """The volume under gas, or the liquid, per reference area."""
        if self.body.load == "gas":  # the load's potential is -p times the volume
            return -ufl.diff(at.load - start.load, self.scalars["p"][1])
        zw = self.scalars["zw"][1]
        over = depth(fem.Constant(self.mesh, self.body.reference.edge), zw)
        return (depth(at.height, zw) - over) * at.flux + over * start.flux

    def _at_node(self, node: int) -> fem.Function:
        """The weight that reads a displacement at a corner of the reference surface."""
        cells = self.mesh.topology.index_map(2).size_local
        vertices = self.mesh.topology.connectivity(2, 0).array.reshape(-1, 3)[:cells]
        return corner_weight(self.mesh, self.body.degree, self.node[vertices] == node)

    def raised(self, height: float) -> np.ndarray:
        """Displacement in the direction of deflections by :attr:`Reference.rise` times a height."""
        rise = self._linear(self.body.reference.rise)
        out = self._interpolated(fem.Constant(self.mesh, height * self.direction) * rise)
        values = out.x.array[: self.system.size].copy()
        values[self.system.bc_dofs] = 0.0
        return values

    def _linear(self, values: np.ndarray) -> fem.Function:
        """A function that is linear on the triangles, by its values at nodes of the reference surface."""
        space = fem.functionspace(self.mesh, ("Lagrange", 1))
        out = fem.Function(space)
        cells = self.mesh.topology.connectivity(2, 0).array.reshape(-1, 3)
        out.x.array[space.dofmap.list[: len(cells)]] = values[self.node[cells]]
        return out

    def _interpolated(self, vector: Expr) -> fem.Function:
        """A vector in the space of the displacements."""
        out = fem.Function(self.space)
        out.interpolate(fem.Expression(vector, compat.interpolation_points(self.space.element)))
        out.x.scatter_forward()
        return out

    @cached_property
    def recovery(self) -> Recovery:
        """Where the error of the stress resultants is."""
        return Recovery(self.mesh, self.membrane.resultants, self.body.degree, self.dx)

    # -- supports --------------------------------------------------------------------------------

    def _conditions(self) -> list[fem.DirichletBC]:
        """No displacement of held edges, nor across planes of symmetry and planes in which edges slide."""
        given = self.body.reference
        out = [self._zero(i, given.held) for i in range(3)]
        out += [self._zero(AXES.index(axis), edges) for axis, edges in given.mirrors.items()]
        return out + [self._zero(AXES.index(axis), edges) for axis, edges in given.slides.items()]

    def _zero(self, component: int, edges: np.ndarray) -> fem.DirichletBC:
        part = self.space.sub(component)
        dofs = fem.locate_dofs_topological(part, 1, self.local(edges))
        return fem.dirichletbc(np.array(0.0), dofs, part)

    def local(self, edges: np.ndarray) -> np.ndarray:
        """This rank's edges among edges of the reference surface."""
        self.mesh.topology.create_connectivity(1, 0)
        own = np.sort(self.node[self.mesh.topology.connectivity(1, 0).array.reshape(-1, 2)], axis=1)
        base = len(self.body.reference.points)
        wanted = np.sort(edges, axis=1) @ [base, 1]
        return np.flatnonzero(np.isin(own @ np.array([base, 1]), wanted)).astype(np.int32)
