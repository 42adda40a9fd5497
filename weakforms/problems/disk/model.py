"""Paper 1: a flat circular membrane inflated against a bed of springs on a plane, front on the mesh.

Patil, DasGupta & Eriksson (2015), Int. J. Solids Struct. 67-68, 250-262. Lengths are divided by the clamped
radius ``R_f = beta R_0``, stresses by ``C1 h``; ``x in [0, 1/beta]`` is the radius in the unstretched disk.

The disk is mapped from two fixed intervals: the patch ``s in [0, 1]`` to ``x in [0, x_f]``, the free part
``s in [1, 2]`` to ``x = x_f (x_e/x_f)^(s - 1)``, ``x_e = 1/beta``. The front ``x_f`` is a scalar unknown, so
that the kink is never inside an element. The power resolves the boundary layer ``~ x^-2`` around a small
patch.

The unknowns are ``lam2`` and ``eta`` (``rho = x lam2``). Where points have touched and stick, the shape is
known: see :class:`Bond`.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from scipy.interpolate import CubicSpline
from ufl.core.expr import Expr

from weakforms.forms.kinematics import Slope, Stretches, disk_stretches
from weakforms.forms.loads import bed_potential, enclosed_volume, gas_potential
from weakforms.forms.materials import stress_resultants
from weakforms.problems.contact_series import Series
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meshes import tag_points
from weakforms.solvers.equilibrium.system import Formulation, State, System

POLE, FRONT, RIM = 1, 2, 3


@dataclass(frozen=True)
class DiskData:
    """The membrane, its substrate and its mesh."""

    alpha: float
    beta: float
    k: float
    l: float  # noqa: E741  (the paper's symbol)
    cells: int
    degree: int
    material: Chosen | None = None
    """Law of the membrane; by default the paper's, with ``alpha``."""

    @property
    def chosen(self) -> Chosen:
        """The law."""
        return self.material or mooney_rivlin_of(self.alpha)

    @property
    def edge(self) -> float:
        """``x`` at the clamp, 1/beta."""
        return 1 / self.beta


@dataclass(frozen=True)
class Bond:
    """A stuck patch, as a function of the radius at which each point touched.

    ``lam2`` is locked at ``Lc(x)``. With ``rigid``, ``lam1`` is locked too, and the patch only moves up and
    down as a whole: ``eta = e + F(x_f) - F(x)``, where ``e`` is the height of its edge. All are Chebyshev
    series in ``x``; ``I(x_f) = int (F(x_f) - F) rho_c rho_c' dx`` is the moment that occurs in the sum over
    the springs.
    """

    rigid: bool
    terms: int
    span: float


@dataclass
class Geometry:
    """Map from the mesh to the disk and the kinematics on it, as expressions."""

    x: Expr
    jacobian: Expr
    lam2: Expr
    lam2_slope: Expr
    eta: Expr
    eta_slope: Expr
    rho: Expr = field(init=False)
    rho_slope: Expr = field(init=False)
    stretches: Stretches = field(init=False)

    def __post_init__(self) -> None:
        self.rho = self.x * self.lam2
        self.rho_slope = self.lam2 + self.x * self.lam2_slope
        self.stretches = disk_stretches(self.x, self.lam2, self.lam2_slope, self.eta_slope)


class DiskModel:
    """Weak form of the disk on the front-fitted mesh, with constants that can be changed.

    Loads: ``p``, ``front`` (``x_f``) and ``k``; ``k = 0`` is the free membrane.
    """

    def __init__(self, comm: MPI.Intracomm, data: DiskData, bond: Bond | None = None) -> None:
        self.data, self.bond = data, bond
        self.mesh = dmesh.create_interval(comm, 2 * data.cells, [0.0, 2.0])
        element = basix.ufl.element("Lagrange", "interval", data.degree, shape=(2,))
        self.space = fem.functionspace(self.mesh, element)
        self.unknown = fem.Function(self.space, name="disk")
        values = {"p": 0.0, "front": data.edge / 2, "k": 0.0}
        self.constants = {name: fem.Constant(self.mesh, value) for name, value in values.items()}
        self.loads = {name: (c, ufl.variable(c)) for name, c in self.constants.items()}
        terms = bond.terms if bond else 1
        # The moment is a product of the other two series.
        lengths = {"lam2": terms + 1, "depth": terms + 1, "moment": 2 * terms}
        span = bond.span if bond else 1.0
        self.law = data.chosen.law(self.mesh)
        self.l, self.end, span = (fem.Constant(self.mesh, value) for value in (data.l, data.edge, span))
        self.series = {name: Series(self.mesh, n, span) for name, n in lengths.items()}
        self.patch = fem.Function(fem.functionspace(self.mesh, ("DG", 0)))
        cells = dmesh.locate_entities(self.mesh, 1, lambda x: x[0] <= 1.0 + 1e-12)
        self.patch.x.array[cells] = 1.0
        self.tags = tag_points(self.mesh, {POLE: 0.0, FRONT: 1.0, RIM: 2.0})
        self.dx = ufl.Measure("dx", self.mesh, metadata={"quadrature_degree": 2 * data.degree + 4})
        self.ends = ufl.Measure("ds", self.mesh, subdomain_data=self.tags)
        self.inner = ufl.Measure("dS", self.mesh, subdomain_data=self.tags)
        self._set_flat_state()
        self.geometry = self._geometry()
        self.system = System(self._formulation())

    # -- geometry ------------------------------------------------------------------------------

    def _in_patch(self, inside: Expr | float, outside: Expr | float) -> Expr:
        """Indicator by cell, because at the front the coordinate does not distinguish the sides."""
        return ufl.conditional(ufl.gt(self.patch, 0.5), inside, outside)

    def _side(self, value: Expr, patch: bool) -> Expr:
        """One-sided value at the front, for a form on it."""
        here = self._in_patch(value, 0.0) if patch else self._in_patch(0.0, value)
        return here("+") + here("-")

    def locate(self, big_x: np.ndarray, loads: dict[str, float]) -> np.ndarray:
        """Mesh coordinates of ``X = beta x`` for a state's front."""
        front, x = loads["front"], np.asarray(big_x) * self.data.edge
        outside = 1 + np.log(np.maximum(x, front) / front) / np.log(self.data.edge / front)
        return np.where(x <= front, x / front, outside)

    def like(self, other: DiskModel, state: State) -> State:
        """A state of another mesh of the same disk, as a guess: splines on either side of the front."""
        own, theirs = self._mesh_coordinates(), other._mesh_coordinates()
        u = np.empty(len(own))
        for component in (0, 1):
            parts = self.mesh.comm.allgather((theirs[component::2], state.u[component::2]))
            s, first = np.unique(np.concatenate([p[0] for p in parts]), return_index=True)
            values = np.concatenate([p[1] for p in parts])[first]
            inner, wanted = s <= 1 + 1e-12, own[component::2]
            outer = s >= 1 - 1e-12
            sides = (CubicSpline(s[side], values[side])(wanted) for side in (inner, outer))
            u[component::2] = np.where(wanted <= 1, *sides)
        return State(u, dict(state.loads))

    def _mesh_coordinates(self) -> np.ndarray:
        """``s`` of every degree of freedom of this rank."""
        return np.repeat(self.space.tabulate_dof_coordinates()[: self.system.size // 2, 0], 2)

    def _set_flat_state(self) -> None:
        beta = self.data.beta
        self.unknown.interpolate(lambda s: np.vstack([np.full_like(s[0], beta), np.zeros_like(s[0])]))

    def _geometry(self) -> Geometry:
        """Radius, stretch and height; in a stuck patch from the series, outside continuous with it."""
        s = ufl.SpatialCoordinate(self.mesh)[0]
        front = self.loads["front"][1]
        ratio = ufl.ln(self.end / front)
        outside = front * ufl.exp((s - 1) * ratio)
        x = self._in_patch(front * s, outside)
        jacobian = self._in_patch(front, outside * ratio)
        lam2, eta = self.unknown
        lam2_s, eta_s = lam2.dx(0), eta.dx(0)
        if self.bond is None:
            return Geometry(x, jacobian, lam2, lam2_s / jacobian, eta, eta_s / jacobian)
        locked, locked_slope = self.series["lam2"](front * s)
        at_front, _ = self.series["lam2"](front)
        height, slope = eta, eta_s / jacobian
        if self.bond.rigid:
            depth, depth_slope = self.series["depth"](front * s)
            deepest, _ = self.series["depth"](front)
            height = self._in_patch(eta + deepest - depth, eta)
            slope = self._in_patch(-depth_slope, eta_s / jacobian)
        return Geometry(
            x,
            jacobian,
            self._in_patch(locked, lam2 + at_front * (2 - s)),
            self._in_patch(locked_slope, (lam2_s - at_front) / jacobian),
            height,
            slope,
        )

    # -- the form ------------------------------------------------------------------------------

    def _potential(self) -> Expr:
        r"""Potential per unit of the mesh coordinate.

        .. math:: \Pi/2\pi = \int_0^{1/\beta} \Big[ W x + \frac p2 \rho^2\eta'
                  + \frac k2\,\chi\,(\eta - l)^2 \rho\rho' \Big] \mathrm{d}x
        """
        g = self.geometry
        p, k = self.loads["p"][1], self.loads["k"][1]
        energy = self.law(g.stretches.lam1, g.stretches.lam2) * g.x
        energy += gas_potential(g.rho, Slope(-g.eta_slope), p)
        energy += bed_potential(g.rho, g.rho_slope, g.eta - self.l, k, self._in_patch(1.0, 0.0))
        return energy * g.jacobian

    def _vertex_potential(self) -> ufl.Form:
        """Springs under a rigid patch, which moves only by the height of its edge, up to a constant."""
        front, k = self.loads["front"][1], self.loads["k"][1]
        at_front, _ = self.series["lam2"](front)
        moment, _ = self.series["moment"](front)
        above = ufl.avg(self.unknown[1]) - self.l
        return k * ((front * at_front) ** 2 * above**2 / 4 + moment * above) * self.inner(FRONT)

    def _energy(self) -> ufl.Form:
        """The functional that is made stationary."""
        potential = self._potential()
        if self.bond is None or not self.bond.rigid:
            return potential * self.dx
        # In a rigid patch the unknown height is the height of the edge; a Laplacian makes it constant.
        _, eta = self.unknown
        return self._in_patch(eta.dx(0) ** 2 / 2, potential) * self.dx + self._vertex_potential()

    def _mass(self) -> ufl.Form:
        """``int |dx|^2 x dx``; a rigid patch has the mass of its area at its edge."""
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        g, front = self.geometry, self.loads["front"][1]
        inner = (g.x**2 * trial[0] * test[0] + trial[1] * test[1]) * g.x * g.jacobian
        if self.bond is None or not self.bond.rigid:
            return inner * self.dx
        vertex = ufl.avg(trial[1]) * ufl.avg(test[1]) * front**2 / 2
        return self._in_patch(0.0, inner) * self.dx + vertex * self.inner(FRONT)

    def _formulation(self) -> Formulation:
        g, ends = self.geometry, self.ends
        lam1, lam2 = g.stretches.lam1, g.stretches.lam2
        t1, t2 = self._resultants()
        k = self.loads["k"][1]
        sigma = self._in_patch(-k * (g.eta - self.l), 0.0)
        return Formulation(
            unknown=self.unknown,
            residual=ufl.derivative(self._energy(), self.unknown, ufl.TestFunction(self.space)),
            loads=self.loads,
            bcs=self._conditions(),
            mass=self._mass(),
            monitors={
                "t0": g.eta * ends(POLE),
                "lam_pole": lam2 * ends(POLE),
                "lam1_rim": lam1 * ends(RIM),
                "V": enclosed_volume(g.rho, Slope(-g.eta_slope)) * g.jacobian * self.dx,
                "Pi": self._potential() * self.dx,
                "sigma_pole": sigma * ends(POLE),
                **self._front_monitors(t1, t2, sigma),
            },
            maxima={"minus_t": ufl.max_value(-t1, -t2)},
            derived={"t_min": lambda v: -v["minus_t"]},
            levels={"X_iso": (lam1 - lam2, 1e-4)},
            coordinate=g.x / self.end,
            internal=("front", "k", "minus_t", "gap", "steepness", "rho_slope_outside"),
            locate=self.locate,
            abscissa="X",
            profile={
                "rho": g.rho,
                "eta": g.eta,
                "lam1": lam1,
                "lam2": lam2,
                "t1": t1,
                "t2": t2,
                "sigma": sigma,
            },
        )

    def _resultants(self) -> tuple[Expr, Expr]:
        stretches = self.geometry.stretches
        return stress_resultants(self.law, stretches.lam1, stretches.lam2)

    def _front_monitors(self, t1: Expr, t2: Expr, sigma: Expr) -> dict[str, ufl.Form]:
        """One-sided values at the front."""
        g, at = self.geometry, self.inner(FRONT)
        lam1 = g.stretches.lam1
        p = self.loads["p"][1]
        # x W1 theta' = p rho lam1 - W2 sin(theta), theta the angle below the horizontal
        curvature = (p * g.rho - t2 * g.stretches.cos_beta) / (g.x * t1 * g.lam2)
        return {
            "X_contact": self.loads["front"][1] / self.end * at,
            "rho_contact": self._side(g.rho, patch=False) * at,
            "lam1_contact": self._side(lam1, patch=True) * at,
            "lam1_contact_outer": self._side(lam1, patch=False) * at,
            "sigma_contact": self._side(sigma, patch=True) * at,
            "kappa": self._side(curvature, patch=False) * at,
            "gap": (self._side(g.eta, patch=False) - self.l) * at,
            "steepness": self._steepness(t1) * at,
            "rho_slope_outside": self._side(g.rho_slope, patch=False) * at,
            "G": self._energy_release_rate(t1) * at,
        }

    def _steepness(self, t1: Expr) -> Expr:
        r"""``-eta'/x`` outside the front.

        Next to a rigid patch it comes from the vertical balance, ``x W1 eta'/lam1 + p rho^2/2 - k I = 0`` at
        ``eta = l``, because at a small front the derivative is dominated by round-off.
        """
        g = self.geometry
        if self.bond is None or not self.bond.rigid:
            return self._side(-g.eta_slope / g.x, patch=False)
        moment, _ = self.series["moment"](self.loads["front"][1])
        force = self.loads["p"][1] * g.rho**2 / 2 - self.loads["k"][1] * moment
        return self._side(force * g.stretches.lam1 / (g.x**2 * t1 * g.lam2), patch=False)

    def _energy_release_rate(self, t1: Expr) -> Expr:
        r"""Energy released per deformed area when the edge of the patch peels, in closed form.

        .. math:: G = \frac{W_c - W_o - W_{1o}[\lambda_{1c}\cos\Delta\theta - \lambda_{1o}]}
                           {\lambda_{1c}\lambda_2}
                  + \frac k2 (e - l)^2 \cos\theta_c

        with ``c`` for the side of the patch and ``o`` for the free side. These are the jump of the
        Hamiltonian of the meridian (Long, Shull & Hui 2010) and the energy of the released springs.
        """
        g = self.geometry
        energy = self.law(g.stretches.lam1, g.stretches.lam2)
        k = self.loads["k"][1]
        (w_c, l1_c, r_c, e_c), (w_o, l1_o, r_o, e_o) = (
            [self._side(v, patch) for v in (energy, g.stretches.lam1, g.rho_slope, g.eta_slope)]
            for patch in (True, False)
        )
        lam2 = self._side(g.lam2, patch=False)
        w1_o = self._side(t1, patch=False) * lam2
        along = (r_c * r_o + e_c * e_o) / l1_o  # lam1_c cos(Delta theta)
        gap = self._side(g.eta, patch=False) - self.l
        return (w_c - w_o - w1_o * (along - l1_o)) / (l1_c * lam2) + k * gap**2 / 2 * r_c / l1_c

    def _conditions(self) -> list[fem.DirichletBC]:
        """Clamp at ``rho = 1, eta = 0``; in a stuck patch the stretch is not an unknown."""
        space, mesh = self.space, self.mesh
        rim = fem.locate_dofs_topological(space, 0, self.tags.find(RIM))
        clamp = [fem.dirichletbc(np.array([self.data.beta, 0.0]), rim, space)]
        if self.bond is None:
            return clamp
        mesh.topology.create_connectivity(1, 1)  # needed to locate the conditions
        held = dmesh.locate_entities(mesh, 1, lambda x: x[0] <= 1.0 + 1e-12)
        dofs = fem.locate_dofs_topological(space.sub(0), 1, held)
        return [*clamp, fem.dirichletbc(np.array(0.0), dofs, space.sub(0))]
