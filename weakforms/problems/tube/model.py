"""Paper 2: inflation of a pre-stretched cylindrical membrane held by two rigid disks.

Patil, Nordmark & Eriksson (2014), Proc. R. Soc. A 470, 20140282. Lengths are divided by the disk radius
``R_f = R_o/sqrt(delta1)``, stresses by ``C1 h_o``; ``Z = delta1 z`` in ``[0, l_f/2]`` is measured from the
mid-plane on the axially stretched tube.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import basix.ufl
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.mesh import Mesh
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.errors import InputError
from weakforms.forms.kinematics import Stretches, tube_stretches
from weakforms.forms.loads import enclosed_volume, gas_potential
from weakforms.forms.materials import stress_resultants
from weakforms.forms.wrinkling import Law
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meshes import graded_interval, tag_points
from weakforms.solvers.continuation.branch import EquilibriumBranch, FoldLine
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Fold, Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import Formulation, State, System

MIDPLANE, DISK, FAR_DISK = 1, 2, 3

START_STRETCH = 1.3
"""Pre-stretch at which the steps to a first state start. At ``delta1 = 1`` and ``p = 0`` the tube is slack
and its tangent singular, and a direct guess may converge to a folded state."""

FIRST_U = 0.02
"""Mid-plane displacement of the first state, if the tube without pressure is slack or nearly slack."""

TAUT = 1.02
"""Pre-stretch above which the branch starts at ``p = 0`` (the layer at the disk is then resolved)."""

STEEPEST = 1 - 1e-6
"""If the pressure's share in the direction of the branch exceeds this, the membrane is nearly inextensible: a
law of limited stretch is nearly at its limit, and the branch continues to any pressure."""

LEAST_RESISTANCE = 0.02
"""Lower limit of ``lam1 w,11 / w,1`` at the mid-plane; below it no mesh resolves the meridional stretch
there."""


@dataclass(frozen=True)
class TubeMesh:
    """One mesh of the tube: cells on half the length, polynomial degree, grading towards the disks."""

    cells: int
    degree: int
    grading: float
    full: bool = False


def potential(rho: Expr, eta: Expr, p: Expr, law: Law, delta1: Expr) -> Expr:
    r"""Total potential per unit of ``Z`` and over :math:`2\pi C_1 h_o R_f^2`.

    .. math:: \Pi/2\pi = \int_0^{l_f/2} \Big[ \frac{w(\lambda_1,\lambda_2)}{\sqrt{\delta_1}}
              - \frac p2 \rho^2 \eta_{,Z} \Big] \mathrm{d}Z

    (equation 8 of the paper without substrate; ``r0 dz = dZ/sqrt(delta1)``).
    """
    stretches = tube_stretches(rho, eta, delta1)
    energy = law(stretches.lam1, stretches.lam2)
    return energy / ufl.sqrt(delta1) + gas_potential(rho, eta, p)


def formulation(
    comm: MPI.Intracomm, material: Chosen | float, delta1: float, lf: float, at: TubeMesh
) -> Formulation:
    """Weak form of free inflation, with the pressure and the pre-stretch as loads.

    If the material is a number, it is C2/C1 of the paper's Mooney-Rivlin law.
    """
    half = lf / 2
    mesh = graded_interval(comm, at.cells, half, at.grading, mirrored=at.full)
    space = fem.functionspace(mesh, basix.ufl.element("Lagrange", "interval", at.degree, shape=(2,)))
    unknown = fem.Function(space, name="tube")
    unknown.interpolate(lambda x: np.vstack([np.ones_like(x[0]), x[0]]))
    rho, eta = unknown
    constants = {name: fem.Constant(mesh, value) for name, value in (("p", 0.0), ("delta1", delta1))}
    loads = {name: (constants[name], ufl.variable(constants[name])) for name in ("p", "delta1")}
    p, d1 = (variable for _, variable in loads.values())
    law = (material if isinstance(material, Chosen) else mooney_rivlin_of(material)).law(mesh)

    dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 2 * at.degree + 2})
    energy = potential(rho, eta, p, law, d1) * dx
    stretches = tube_stretches(rho, eta, d1)
    t1, _ = stress_resultants(law, stretches.lam1, stretches.lam2)
    middle = _midplane(mesh, at.full)
    return Formulation(
        unknown=unknown,
        residual=ufl.derivative(energy, unknown, ufl.TestFunction(space)),
        loads=loads,
        bcs=_clamps(space, half, at.full),
        mass=ufl.inner(ufl.TrialFunction(space), ufl.TestFunction(space)) * dx,
        monitors={
            "u_max": middle(rho - 1),
            "lam1_mid": middle(stretches.lam1),
            "t1_mid": middle(t1),
            "V": enclosed_volume(rho, eta) * dx,
            "Pi": energy,
            "resistance": middle(resistance(law, stretches)),
        },
        internal=("resistance",),
        profile=_profile(unknown, stretches, p, d1, law),
    )


def resistance(law: Law, stretches: Stretches) -> Expr:
    r"""``λ₁ w,₁₁ - LEAST_RESISTANCE w,₁``: negative if the law hardly resists more meridional stretch.

    In free inflation :math:`H = w - \lambda_1 w_{,1}` is constant, and its derivative with respect to the
    stretch is :math:`-\lambda_1 w_{,11}`. If this is nearly zero (for laws of linear growth, such as
    Varga's), the stretch of the mid-plane becomes unbounded at a finite displacement, and beyond it there is
    no solution of finite stretch.
    """
    l1 = ufl.variable(stretches.lam1)
    slope = ufl.diff(law(l1, stretches.lam2), l1)
    return l1 * ufl.diff(slope, l1) - LEAST_RESISTANCE * slope


def _profile(unknown: fem.Function, stretches: Stretches, p: Expr, delta1: Expr, law: Law) -> dict[str, Expr]:
    r"""Columns along the meridian, including the two first integrals of free inflation.

    .. math:: F = r_0 w_{,1}\cos\beta - \tfrac12 p\rho^2, \qquad H = w - \lambda_1 w_{,1}
    """
    rho, eta = unknown
    lam1, lam2 = stretches.lam1, stretches.lam2
    t1, t2 = stress_resultants(law, lam1, lam2)
    w1 = t1 * lam2
    return {
        "rho": rho,
        "eta": eta,
        "lam1": lam1,
        "lam2": lam2,
        "t1": t1,
        "t2": t2,
        "F_axial": ufl.sqrt(delta1) * w1 * stretches.cos_beta - p * rho**2 / 2,
        "H": law(lam1, lam2) - lam1 * w1,
    }


def _midplane(mesh: Mesh, full: bool) -> Callable[[Expr], ufl.Form]:
    """Value at ``Z = 0`` as a form, so that every rank gets it like an integral."""
    tags = tag_points(mesh, {MIDPLANE: 0.0})
    if full:
        inner = ufl.Measure("dS", mesh, subdomain_data=tags)
        return lambda value: ufl.avg(value) * inner(MIDPLANE)
    outer = ufl.Measure("ds", mesh, subdomain_data=tags)
    return lambda value: value * outer(MIDPLANE)


def _clamps(space: fem.FunctionSpace, half: float, full: bool) -> list[fem.DirichletBC]:
    """Disks at ``rho = 1, eta = ±l_f/2``; on the half tube ``eta = 0`` at the mid-plane by symmetry."""
    mesh = space.mesh
    tags = tag_points(mesh, {MIDPLANE: 0.0, DISK: half, FAR_DISK: -half})

    def fixed(tag: int, axial: float) -> fem.DirichletBC:
        dofs = fem.locate_dofs_topological(space, 0, tags.find(tag))
        return fem.dirichletbc(np.array([1.0, axial]), dofs, space)

    if full:
        return [fixed(DISK, half), fixed(FAR_DISK, -half)]
    dofs = fem.locate_dofs_topological(space.sub(1), 0, tags.find(MIDPLANE))
    return [fixed(DISK, half), fem.dirichletbc(np.array(0.0), dofs, space.sub(1))]


def first_state(solver: ExtendedNewton, delta1: float) -> tuple[State, Held]:
    """First state of the branch and its condition: unloaded if the tube is taut, else slightly inflated.

    The latter is reached from a taut tube by decreasing the pre-stretch in steps.

    Raises:
        InputError: If the pre-stretch is beyond the largest stretch of the law.
    """
    system = solver.system
    state = system.state()
    if delta1 >= TAUT:
        forces = system.residual()
        if not np.isfinite(system.dot(forces, forces)):
            raise InputError(
                f"delta1 = {delta1:g} alone stretches the membrane beyond what its law allows; lower delta1 "
                "(delta1_end of tube_fold), or raise the constant that limits stretches (jm, or links)"
            )
        return state, Held("p", 0.0)
    inflated = Held("u_max", FIRST_U)
    for stretch in np.linspace(START_STRETCH, delta1, 7):
        state.loads["delta1"] = float(stretch)
        state, _ = solver.solve(state, [inflated])
    return state, inflated


def free_branch(system: System, delta1: float, u_end: float, step: float) -> EquilibriumBranch:
    """Free inflation at fixed pre-stretch by arc length, up to ``u_max = u_end``."""
    solver = ExtendedNewton(system, ["p"])
    continuation = Continuation(solver, control=StepControl(first=step / 4, largest=step))
    state, held = first_state(solver, delta1)
    start = continuation.start(state, held, towards={"u_max": 1.0})

    def stop(point: CurvePoint) -> bool:
        return point.monitors["u_max"] > u_end or yields(point) or point.tangent.loads["p"] > STEEPEST

    branch = EquilibriumBranch(continuation, "p", start, stop)
    last = branch.points[-1]
    followed = (
        f"free inflation was followed up to u_max = {last.monitors['u_max']:.6g}, "
        f"p = {last.state.loads['p']:.6g}"
    )
    if yields(last):
        branch.ended = f"free inflation ends: {yielding(last)}"
    elif last.monitors["u_max"] < u_end and branch.stalled is None:
        branch.ended = f"{followed}: there the membrane is all but inextensible"
    elif last.monitors["u_max"] < u_end:
        branch.stalled = f"{followed}: {branch.stalled}"
    return branch


def yields(point: CurvePoint) -> bool:
    """Whether the law hardly resists more meridional stretch at the mid-plane (:func:`resistance`)."""
    return point.monitors["resistance"] < 0


def yielding(point: CurvePoint) -> str:
    """Explanation of this end of the branch, as text."""
    return (
        f"at u_max = {point.monitors['u_max']:.6g} the law hardly resists meridional stretch any more "
        f"({point.monitors['lam1_mid']:.3g} at the mid-plane), which grows without bound from there on"
    )


def fold_line(branch: EquilibriumBranch, ends: tuple[float, float], step: float) -> FoldLine:
    """The first limit point of a branch, followed in ``delta1`` until it returns or reaches an end.

    Args:
        branch: Free inflation at one of the ends.
        ends: Range of pre-stretches of the line.
        step: Largest arc-length step.
    """
    begin = branch.special()[0].state
    middle = branch.points[int(branch.turns()[0])]
    fold = Fold("p", branch.system.mass_times(middle.tangent.u))
    solver = ExtendedNewton(branch.system, ["p", "delta1"])
    low, high = ends
    at = begin.loads["delta1"]
    continuation = Continuation(solver, [fold], StepControl(first=step / 4, largest=step), shift=1e-6)
    inwards = 1.0 if at < (low + high) / 2 else -1.0
    start = continuation.start(begin, Held("delta1", at), towards={"delta1": inwards})
    return FoldLine(
        continuation, "delta1", start, stop=lambda point: not low < point.state.loads["delta1"] < high
    )
