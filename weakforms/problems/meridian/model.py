r"""An axisymmetric membrane: one weak form for any body, law, load and foundation.

.. math:: \frac{\Pi}{2\pi} = \int \Big[ H R\, W(\lambda_1, \lambda_2) - \tfrac12 p\, r^2 z'
          + \text{liquid} + \text{foundation} \Big]\, \mathrm{d}S

The meridian is cut into blocks at break points ``b_0 < b_1 < ... < b_n``. Each block is a fixed unit interval
of the mesh, mapped to ``S in [b_k, b_{k+1}]``. A front (the edge of a zone or of a patch in contact, the
surface of a liquid) is a break point: a scalar unknown with its own equation. The solution is then smooth on
every block, no kink is inside an element, and the order of the elements is kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import NamedTuple

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.kinematics import revolution_stretches
from weakforms.forms.loads import enclosed_volume, gas_potential, liquid_potential
from weakforms.forms.materials import SurfaceLaw, neo_hookean, stress_resultants
from weakforms.forms.wrinkling import natural_width, relaxed, wrinkling_function
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import LOWER, UPPER, Blocks, tags_of
from weakforms.problems.meridian.body import Body
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.system import System

TAUT_TOLERANCE = 1e-9
"""In unmarked blocks ``gw`` below 1 by up to this counts as taut. A uniform membrane has ``gw = 1`` without
load, and round-off must not choose its state. Because the energy has continuous slopes, this has no other
effect."""

BY_STATE = 0.0
TAUT = WET = 1.0
WRINKLED = DRY = -1.0


class Marks(NamedTuple):
    """What every block is marked as: :data:`TAUT`, :data:`WRINKLED` or by its state; wet, dry or by it."""

    taut: np.ndarray
    wet: np.ndarray


class _Front:
    """A break point with the interface of a load: a number that can be set."""

    def __init__(self, model: MeridianModel, index: int) -> None:
        self._model, self._index = model, index

    @property
    def value(self) -> float:
        return float(self._model.breaks[self._index])

    @value.setter
    def value(self, value: float) -> None:
        self._model.breaks[self._index] = value
        self._model.move()


class MeridianModel:
    """Weak form on blocks, with parameters that can be changed.

    Loads (each can be set and can be an unknown): the ``values`` and the fronts. A gas acts if there is a
    value ``p``, a liquid if there are ``zw`` and ``gamma``. Subclasses add what is particular to a problem.

    Args:
        comm: Ranks.
        body: The membrane.
        values: First values of the parameters.
        mesh: Its blocks and elements.
        energy: ``standard`` (no wrinkling), ``relaxed``, or ``modified_gradient`` (the same in another form).
        material: The law.
    """

    name = "membrane"
    patch = 0, 1  # first block of the patch in contact, or of what is wet, and the block after it

    def __init__(
        self,
        comm: MPI.Intracomm,
        body: Body,
        values: Mapping[str, float],
        mesh: Blocks,
        energy: str = "standard",
        material: Chosen | None = None,
    ) -> None:
        self.body, self.energy, self.material_law = body, energy, material
        self.cells, self.degree, self.fronts = mesh.cells, mesh.degree, mesh.fronts
        self.breaks, self.blocks = np.array(mesh.breaks, dtype=float), mesh.count
        self.mesh = mesh.mesh(comm)
        self.space = self.components(2)
        self.unknown = fem.Function(self.space, name=self.name)
        piecewise = fem.functionspace(self.mesh, ("DG", 0))
        names = ("block", "left", "width", "left_rate", "width_rate", "taut", "wet", "here")
        self._by_cell = {name: fem.Function(piecewise) for name in names}
        self._middles = piecewise.tabulate_dof_coordinates()[:, 0]
        self._block_of = np.floor(self._middles).astype(int)
        self._by_cell["block"].x.array[:] = self._block_of
        self.constants = {name: fem.Constant(self.mesh, float(value)) for name, value in values.items()}
        self.loads = {name: (constant, ufl.variable(constant)) for name, constant in self.constants.items()}
        self.q = {name: variable for name, (_, variable) in self.loads.items()}
        self._rate = ufl.variable(fem.Constant(self.mesh, 0.0))
        self.loads |= {name: (_Front(self, k), self._rate) for name, k in self.fronts.items()}
        self.tags = tags_of(self.mesh, self.blocks)
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": mesh.quadrature})
        self.ends = ufl.Measure("ds", self.mesh, subdomain_data=self.tags)
        self.inner = ufl.Measure("dS", self.mesh, subdomain_data=self.tags)
        self.move()

    def components(self, count: int) -> fem.FunctionSpace:
        """Space of functions with some components."""
        element = basix.ufl.element("Lagrange", "interval", self.degree, shape=(count,))
        return fem.functionspace(self.mesh, element)

    # -- blocks --------------------------------------------------------------------------------

    def mark(self, marks: Marks) -> None:
        """Write the marks of a state into the form."""
        self._by_cell["taut"].x.array[:] = np.asarray(marks.taut, dtype=float)[self._block_of]
        self._by_cell["wet"].x.array[:] = np.asarray(marks.wet, dtype=float)[self._block_of]

    def move(self) -> None:
        """Write the break points into the form, with the last one at the end of the body."""
        self.breaks[-1] = self.body.length({k: float(self.constants[k].value) for k in self.body.parameters})
        self._by_cell["left"].x.array[:] = self.breaks[self._block_of]
        self._by_cell["width"].x.array[:] = np.diff(self.breaks)[self._block_of]

    def aim(self, name: str) -> None:
        """Select one break point for derivatives with respect to break points."""
        rates = np.zeros(self.blocks + 1)
        if name in self.fronts:
            rates[self.fronts[name]] = 1.0
        self._by_cell["left_rate"].x.array[:] = rates[self._block_of]
        self._by_cell["width_rate"].x.array[:] = np.diff(rates)[self._block_of]

    def breaks_of(self, loads: Mapping[str, float]) -> np.ndarray:
        """All break points of a state, including the ends."""
        out = self.breaks.copy()
        for name, k in self.fronts.items():
            out[k] = loads[name]
        out[-1] = self.body.length(loads)
        return out

    def position(self, s: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Mesh coordinates of material points for a state's break points."""
        breaks = self.breaks_of(loads)
        k = np.clip(np.searchsorted(breaks, s, side="right") - 1, 0, self.blocks - 1)
        return k + np.clip((s - breaks[k]) / np.diff(breaks)[k], 0.0, 1.0)

    def material(self, x: np.ndarray, loads: Mapping[str, float]) -> np.ndarray:
        """Material points of mesh coordinates, the inverse of :meth:`position`."""
        breaks = self.breaks_of(loads)
        k = np.clip(np.floor(x).astype(int), 0, self.blocks - 1)
        return breaks[k] + np.diff(breaks)[k] * (x - k)

    def nodes(self) -> np.ndarray:
        """Mesh coordinates of the nodes that this rank owns."""
        return self.space.tabulate_dof_coordinates()[: self.system.size // 2, 0]

    @cached_property
    def block(self) -> tuple[Expr, Expr, Expr]:
        """Left end, width, and position in [0, 1] within the block, as expressions."""
        cell, x = self._by_cell, ufl.SpatialCoordinate(self.mesh)[0]
        left = cell["left"] + self._rate * cell["left_rate"]
        return left, cell["width"] + self._rate * cell["width_rate"], x - cell["block"]

    def place(self) -> tuple[Expr, Expr]:
        """``S`` and its derivative in the mesh coordinate."""
        left, width, t = self.block
        return left + width * t, width

    def in_patch(self, inside: Expr | float, outside: Expr | float) -> Expr:
        """One value in the patch, another elsewhere; by cell: a break point's coordinate has no side."""
        (low, high), block = self.patch, self._by_cell["block"]
        within = ufl.conditional(ufl.lt(block, high - 0.5), inside, outside)
        return within if low == 0 else ufl.conditional(ufl.gt(block, low - 0.5), within, outside)

    def beside(self, value: Expr, first: bool) -> Expr:
        """Value at the patch's edge, from inside (``first``) or from the other side, for :attr:`inner`."""
        seen = self.in_patch(value, 0.0) if first else self.in_patch(0.0, value)
        return seen("+") + seen("-")

    @property
    def front(self) -> Expr:
        """``S`` at the patch's upper edge, from either side of it."""
        left, width, _ = self.block
        return self.in_patch(left + width, left)

    def frozen(self, component: int) -> fem.DirichletBC:
        """Zero for a component of the unknown in the patch, where something else determines it."""
        self.mesh.topology.create_connectivity(1, 1)  # needed to locate the conditions
        low, high, part = *self.patch, self.space.sub(component)
        cells = dmesh.locate_entities(self.mesh, 1, lambda x: (low <= x[0] + 1e-9) & (x[0] < high + 1e-9))
        return fem.dirichletbc(np.array(0.0), fem.locate_dofs_topological(part, 1, cells), part)

    # -- kinematics ----------------------------------------------------------------------------

    def marked(self, name: str, by_state: Expr) -> Expr:
        """Positive where a block is marked so or, in unmarked blocks, where the state is so."""
        mark = self._by_cell[name]
        return ufl.gt(mark + (1 - abs(mark)) * by_state, 0.0)

    def displaced(self, along: Expr, width: Expr) -> tuple[Expr, Expr, Expr, Expr]:
        """``r/R`` and ``z``, each with its derivative in ``S``."""
        hoop, z0 = (ufl.as_ufl(part) for part in self.body.shape(along, self.q))
        u, w = self.unknown
        return (
            hoop + u,
            ufl.diff(hoop, along) + u.dx(0) / width,
            z0 + w,
            ufl.diff(z0, along) + w.dx(0) / width,
        )

    @cached_property
    def expressions(self) -> dict[str, Expr]:
        """Position, stretches and other expressions of the unknown, by name."""
        s, width = self.place()
        along, q = ufl.variable(s), self.q
        radius = ufl.as_ufl(self.body.radius(along, q))
        ratio, ratio_s, z, z_s = self.displaced(along, width)
        r, r_s = radius * ratio, ufl.diff(radius, along) * ratio + radius * ratio_s
        stretches = revolution_stretches(ratio, r_s, z_s, self.body.scales(q))
        return {
            "S": along,
            "radius": radius,
            "width": width,
            "r": r,
            "z": z,
            "r_s": r_s,
            "z_s": z_s,
            "lam1": stretches.lam1,
            "lam2": stretches.lam2,
            "cos_beta": self.body.upwards * stretches.cos_beta,
            "volume": enclosed_volume(r, self.body.upwards * z_s),
            "weight": ufl.as_ufl(self.body.thickness(along, q)) * radius,
        }

    # -- energies ------------------------------------------------------------------------------

    @cached_property
    def full(self) -> SurfaceLaw:
        """The law without wrinkling, divided by ``C1`` or the stress of its constants."""
        return self.material_law.surface_law(self.mesh)

    def law(self, lam1: Expr, lam2: Expr) -> Expr:
        """Energy per reference volume, in the state of each point."""
        full = self.full.stretches
        if self.energy == "standard":
            return full(lam1, lam2)
        taut = self.marked("taut", wrinkling_function(lam1, lam2) - 1 + TAUT_TOLERANCE)
        eps = self.q.get("residual_stiffness", 0.0)
        if not self.full.bounded:
            # In wrinkled parts the law may be infinite at the actual stretches. It is therefore evaluated
            # only at the natural width, and the residual stiffness of the homotopy comes from another law.
            across = ufl.conditional(taut, lam2, natural_width(lam1))
            return full(lam1, across) + eps * (neo_hookean(lam1, lam2) - neo_hookean(lam1, across))
        if self.energy == "modified_gradient":
            widened = full(lam1, ufl.conditional(taut, lam2, natural_width(lam1)))
            return widened + eps * (full(lam1, lam2) - widened)
        folded = eps * full(lam1, lam2) + (1 - eps) * relaxed(full)(lam1)
        return ufl.conditional(taut, full(lam1, lam2), folded)

    @cached_property
    def strain(self) -> Expr:
        """Strain energy per ``S``."""
        e = self.expressions
        return e["weight"] * self.law(e["lam1"], e["lam2"])

    @cached_property
    def resultants(self) -> tuple[Expr, Expr]:
        """Cauchy resultants ``t1, t2``."""
        return stress_resultants(self.law, self.expressions["lam1"], self.expressions["lam2"])

    def foundation(self) -> Expr | float:
        """Potential of a substrate per ``S``; none here."""
        return 0.0

    @cached_property
    def potential(self) -> Expr:
        """The potential per ``S`` and over ``2 pi``."""
        e, q = self.expressions, self.q
        total = self.strain + self.foundation()
        if "p" in q:
            total += gas_potential(e["r"], self.body.upwards * e["z_s"], q["p"])
        if "zw" in q:
            wet = self.marked("wet", q["zw"] - e["z"])
            total += liquid_potential(e["r"], e["r_s"], e["z"], q["zw"], q["gamma"], wet)
        return total

    def functional(self) -> ufl.Form:
        """The functional that is made stationary."""
        return self.potential * self.expressions["width"] * self.dx

    def mass(self) -> ufl.Form:
        """``int |dx|^2`` over the reference volume."""
        e = self.expressions
        (u, w), (v, y) = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        return (e["radius"] ** 2 * u * v + w * y) * e["weight"] * e["width"] * self.dx

    def conditions(self) -> list[fem.DirichletBC]:
        """What is held at the ends."""
        out = []
        for tag, held in zip((LOWER, UPPER), self.body.held, strict=True):
            for component, value in enumerate(held):
                if value is not None:
                    part = self.space.sub(component)
                    dofs = fem.locate_dofs_topological(part, 0, self.tags.find(tag))
                    out.append(fem.dirichletbc(np.array(float(value)), dofs, part))
        return out

    # -- the discrete equations ----------------------------------------------------------------

    @cached_property
    def system(self) -> System:
        """The discrete equations."""
        return System(self.formulation())

    def formulation(self) -> Formulation:
        """The weak form; subclasses add columns and fields to it."""
        e, (t1, t2) = self.expressions, self.resultants
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(self.functional(), self.unknown, ufl.TestFunction(self.space)),
            loads=self.loads,
            bcs=self.conditions(),
            mass=self.mass(),
            monitors={
                "V": e["volume"] * e["width"] * self.dx,
                "Pi": self.potential * e["width"] * self.dx,
            },
            locate=self.position,
            aim=self.aim if self.fronts else None,
            profile={
                "rho": e["r"],
                "eta": e["z"],
                "lam1": e["lam1"],
                "lam2": e["lam2"],
                "t1": t1,
                "t2": t2,
            },
        )
