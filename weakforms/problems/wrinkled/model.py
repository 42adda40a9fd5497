r"""Wrinkled membranes of revolution: one weak form for any thickness law and surface, fitted to its zones.

The meridian is cut into blocks at break points ``b_0 < b_1 < ... < b_n``; each block is a fixed interval of
the mesh, mapped to ``S in [b_k, b_{k+1}]``. A block can be marked taut or wrinkled, and wet or dry. Then the
solution is smooth on every block, and a front or the surface of the liquid is a break point, a scalar unknown
with its own equation. In unmarked blocks a ``conditional`` chooses the state at each point. Both use the same
compiled form.

The unknown is the difference between ``(r/R, z)`` and a given shape. Dirichlet values are then zero, every
parameter is a constant of the form, and no division by ``R``, which is 0 at a pole, occurs.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.forms.loads import liquid_potential
from weakforms.forms.materials import SurfaceLaw, mooney_rivlin_surface, neo_hookean
from weakforms.forms.wrinkling import natural_width, relaxed, wrinkling_function
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meshes import tag_points
from weakforms.problems.wrinkled.body import SHARED, Body
from weakforms.solvers.equilibrium.system import Formulation, System

LOWER, UPPER, BREAK = 1, 2, 3

TAUT_TOLERANCE = 1e-9
"""In unmarked blocks ``gw`` below 1 by up to this counts as taut. A uniform membrane has ``gw = 1`` without
load, and round-off must not choose its state. Because the energy has continuous slopes, this has no other
effect."""

BY_STATE = 0.0
TAUT = WET = 1.0
WRINKLED = DRY = -1.0


class _Entry:
    """A break point with the interface of a load: a number that can be set."""

    def __init__(self, model: WrinkledModel, index: int) -> None:
        self._model, self._index = model, index

    @property
    def value(self) -> float:
        return float(self._model.breaks[self._index])

    @value.setter
    def value(self, value: float) -> None:
        self._model.breaks[self._index] = value
        self._model.move()


class WrinkledModel:
    r"""Weak form on ``blocks`` blocks of ``cells`` cells each, with parameters that can be changed.

    .. math:: \Pi/2\pi = \int \Big[ H R\, W(\lambda_1, \lambda_2) - \tfrac12 P r^2 z' \Big]\, \mathrm{d}S,
              \qquad P = p + \gamma \max(z_w - z, 0)

    with ``W`` the full energy where ``gw = lam2 sqrt(lam1) > 1`` and the relaxed one elsewhere; lengths over
    the reference radius, energies over ``C1 h`` (Patil, Nordmark & Eriksson 2015, equations 10 to 13).

    Loads (each can be set and can be an unknown): the body's parameters, :data:`SHARED`, and ``b1``, ``b2``
    and so on for the inner break points. Marks, one for each block: see :meth:`mark`.

    Args:
        comm: Ranks.
        body: The membrane.
        values: First values of the parameters.
        blocks: Number of blocks of the meridian.
        cells: Number of cells of each block.
        degree: Degree of the elements.
        energy: ``relaxed``, ``modified_gradient`` (the same in another form) or ``standard`` (no wrinkling).
        material: An incompressible law that replaces the Mooney-Rivlin law with ``c2``.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        body: Body,
        values: Mapping[str, float],
        blocks: int,
        cells: int,
        degree: int,
        energy: str = "relaxed",
        material: Chosen | None = None,
    ) -> None:
        self.other_law = material
        self.body, self.blocks, self.cells, self.degree, self.energy = body, blocks, cells, degree, energy
        self.mesh = dmesh.create_interval(comm, blocks * cells, [0.0, float(blocks)])
        element = basix.ufl.element("Lagrange", "interval", degree, shape=(2,))
        self.space = fem.functionspace(self.mesh, element)
        self.unknown = fem.Function(self.space, name="membrane")
        piecewise = fem.functionspace(self.mesh, ("DG", 0))
        names = ("block", "left", "width", "left_rate", "width_rate", "taut", "wet", "here")
        self._by_cell = {name: fem.Function(piecewise) for name in names}
        middles = piecewise.tabulate_dof_coordinates()[:, 0]
        self._middles = middles
        self._block_of = np.floor(middles).astype(int)
        self._by_cell["block"].x.array[:] = self._block_of
        parameters = (*body.parameters, *SHARED)
        constants = {name: fem.Constant(self.mesh, float(values.get(name, 0.0))) for name in parameters}
        self.loads = {name: (constant, ufl.variable(constant)) for name, constant in constants.items()}
        self.q = {name: variable for name, (_, variable) in self.loads.items()}
        self.breaks = np.linspace(0.0, body.length(values), blocks + 1)
        self._rate = ufl.variable(fem.Constant(self.mesh, 0.0))
        self.loads |= {f"b{k}": (_Entry(self, k), self._rate) for k in range(1, blocks)}
        self.tags = tag_points(self.mesh, {LOWER: 0.0, UPPER: float(blocks)})
        self._break_tags = _inner_points(self.mesh, blocks)
        self.move()

    # -- geometry ------------------------------------------------------------------------------

    def mark(self, taut: np.ndarray, wet: np.ndarray) -> None:
        """Mark every block as :data:`TAUT`, :data:`WRINKLED` or :data:`BY_STATE`, and as wet or dry."""
        self._by_cell["taut"].x.array[:] = np.asarray(taut, dtype=float)[self._block_of]
        self._by_cell["wet"].x.array[:] = np.asarray(wet, dtype=float)[self._block_of]

    def move(self) -> None:
        """Write the break points into the form, with the last one at the end of the body."""
        self.breaks[-1] = self.body.length({k: float(self.loads[k][0].value) for k in self.body.parameters})
        self._by_cell["left"].x.array[:] = self.breaks[self._block_of]
        self._by_cell["width"].x.array[:] = np.diff(self.breaks)[self._block_of]

    def aim(self, name: str) -> None:
        """Select one break point for derivatives with respect to break points."""
        rates = np.zeros(self.blocks + 1)
        if name[0] == "b" and name[1:].isdigit():
            rates[int(name[1:])] = 1.0
        self._by_cell["left_rate"].x.array[:] = rates[self._block_of]
        self._by_cell["width_rate"].x.array[:] = np.diff(rates)[self._block_of]

    def look_at(self, node: int, after: bool = False) -> None:
        """Choose the break point or end, and the side, at which :meth:`point` evaluates functionals.

        Args:
            node: Index of the break point, 0 and ``blocks`` for the ends.
            after: Whether the block after it is used instead of the one before.
        """
        after = after or node == 0
        side = node + (0.5 if after else -0.5) / self.cells
        self._by_cell["here"].x.array[:] = np.abs(self._middles - side) < 1e-9

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

    def breaks_of(self, loads: Mapping[str, float]) -> np.ndarray:
        """All break points of a state, including the ends."""
        inner = [loads[f"b{k}"] for k in range(1, self.blocks)]
        return np.array([0.0, *inner, float(self.body.length(loads))])

    # -- the form ------------------------------------------------------------------------------

    def marked(self, name: str, by_state: Expr) -> Expr:
        """Positive where a block is marked so or, in unmarked blocks, where the state is so."""
        mark = self._by_cell[name]
        return ufl.gt(mark + (1 - abs(mark)) * by_state, 0.0)

    @cached_property
    def expressions(self) -> dict[str, Expr]:
        """Position, stretches and other expressions of the unknown, by name."""
        cell, q = self._by_cell, self.q
        x = ufl.SpatialCoordinate(self.mesh)[0]
        width = cell["width"] + self._rate * cell["width_rate"]
        s = cell["left"] + self._rate * cell["left_rate"] + width * (x - cell["block"])
        along = ufl.variable(s)
        radius = ufl.as_ufl(self.body.radius(along, q))
        hoop, z0 = (ufl.as_ufl(part) for part in self.body.shape(along, q))
        u, w = self.unknown
        lam2, z = hoop + u, z0 + w
        r = radius * lam2
        r_s = ufl.diff(radius, along) * lam2 + radius * (ufl.diff(hoop, along) + u.dx(0) / width)
        z_s = ufl.diff(z0, along) + w.dx(0) / width
        lam1 = ufl.sqrt(r_s**2 + z_s**2)
        pressure = q["p"] + ufl.conditional(self.marked("wet", q["zw"] - z), q["gamma"] * (q["zw"] - z), 0.0)
        weight = self.body.thickness(along, q) * radius
        return {
            "S": along,
            "radius": radius,
            "width": width,
            "r": r,
            "z": z,
            "r_s": r_s,
            "z_s": z_s,
            "lam1": lam1,
            "lam2": lam2,
            "gw": wrinkling_function(lam1, lam2),
            "pressure": pressure,
            "weight": weight,
        }

    @cached_property
    def full(self) -> SurfaceLaw:
        """The law without wrinkling, divided by ``C1`` or the stress of its constants."""
        if self.other_law is not None:
            return self.other_law.surface_law(self.mesh)
        return mooney_rivlin_surface(self.q["c2"])

    def law(self, lam1: Expr, lam2: Expr) -> Expr:
        """Energy per reference volume, in the state of each point."""
        full = self.full.stretches
        if self.energy == "standard":
            return full(lam1, lam2)
        taut = self.marked("taut", wrinkling_function(lam1, lam2) - 1 + TAUT_TOLERANCE)
        eps = self.q["residual_stiffness"]
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

    def tension(self) -> Expr:
        r"""Meridional tension per reference arc of hoop angle, :math:`N = H R\, W_{,1}` over ``C1 h``."""
        e = self.expressions
        lam1, lam2 = ufl.variable(e["lam1"]), e["lam2"]
        return e["weight"] * ufl.diff(self.law(lam1, lam2), lam1)

    def point(self, value: Expr) -> ufl.Form:
        """Value at the point chosen by :meth:`look_at`, as a form, so that every rank gets it."""
        seen = self._by_cell["here"] * value
        inner = ufl.Measure("dS", self.mesh, subdomain_data=self._break_tags)
        ends = ufl.Measure("ds", self.mesh)
        return (seen("+") + seen("-")) * inner(BREAK) + seen * ends

    @cached_property
    def system(self) -> System:
        """The discrete equations."""
        return System(self._formulation())

    def _formulation(self) -> Formulation:
        e, q = self.expressions, self.q
        r, z, r_s, z_s, width = (e[name] for name in ("r", "z", "r_s", "z_s", "width"))
        # Products of the unknown and the load are integrated exactly, without spurious asymmetry.
        dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 4 * self.degree})
        strain = e["weight"] * self.law(e["lam1"], e["lam2"])
        volume = r**2 * z_s / 2
        wet = self.marked("wet", q["zw"] - z)
        liquid = liquid_potential(r, r_s, z, q["zw"], q["gamma"], wet)
        test, trial = ufl.TestFunction(self.space), ufl.TrialFunction(self.space)
        tension = self.tension()
        ends = ufl.Measure("ds", self.mesh, subdomain_data=self.tags)
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative((strain - q["p"] * volume + liquid) * width * dx, self.unknown, test),
            loads=self.loads,
            bcs=self._conditions(),
            mass=(e["radius"] ** 2 * trial[0] * test[0] + trial[1] * test[1]) * e["weight"] * width * dx,
            monitors={
                "V": volume * width * dx,
                "Pi": (strain - e["pressure"] * volume) * width * dx,
                "N": tension * ends(UPPER if self.body.pole else LOWER),
                **(
                    {"z_pole": z * ends(LOWER), "lam_pole": e["lam2"] * ends(LOWER)} if self.body.pole else {}
                ),
                "gw": self.point(e["gw"]),
                "gw_slope": self.point(e["gw"].dx(0) / width),
                "z": self.point(z),
            },
            internal=("gw", "gw_slope", "z"),
            locate=self.position,
            aim=self.aim,
            profile=self._profile(tension),
        )

    def _profile(self, tension: Expr) -> dict[str, Expr]:
        e = self.expressions
        axial = tension * e["z_s"] / e["lam1"] - e["pressure"] * e["r"] ** 2 / 2
        slope = {} if self.body.pole else {"slope": e["r_s"] / e["z_s"]}  # horizontal at a pole
        return {
            **{name: e[name] for name in ("r", "z", "lam1", "lam2", "gw")},
            "tension": tension,
            "axial": axial,
            **slope,
        }

    def _conditions(self) -> list[fem.DirichletBC]:
        out = []
        for tag, held in zip((LOWER, UPPER), self.body.held, strict=True):
            for component in (0, 1):
                if held[component]:
                    part = self.space.sub(component)
                    dofs = fem.locate_dofs_topological(part, 0, self.tags.find(tag))
                    out.append(fem.dirichletbc(np.array(0.0), dofs, part))
        return out


def _inner_points(mesh: dmesh.Mesh, blocks: int) -> dmesh.MeshTags:
    """Tags of the vertices between blocks, all equal."""
    found = dmesh.locate_entities(
        mesh,
        0,
        lambda x: (np.abs(x[0] - np.round(x[0])) < 1e-9) & (x[0] > 0.5) & (x[0] < blocks - 0.5),
    )
    vertices = np.sort(found.astype(np.int32))
    mesh.topology.create_connectivity(0, 1)
    return dmesh.meshtags(mesh, 0, vertices, np.full(len(vertices), BREAK, dtype=np.int32))
