r"""Paper 2: inflation of a pre-stretched cylindrical membrane held by two rigid disks.

Patil, Nordmark & Eriksson (2014), Proc. R. Soc. A 470, 20140282. Lengths are divided by the disk radius
``R_f = R_o/sqrt(delta1)``, stresses by ``C1 h_o``; ``Z = delta1 z`` in ``[0, l_f/2]`` is measured from the
mid-plane on the axially stretched tube. The total potential over :math:`2\pi C_1 h_o R_f^2` is

.. math:: \frac{\Pi}{2\pi} = \int_0^{l_f/2} \Big[ \frac{w(\lambda_1,\lambda_2)}{\sqrt{\delta_1}}
          - \frac p2 \rho^2 \eta_{,Z} + \frac k2\,\chi\,\rho\,(\rho - s)^2\,\eta_{,Z} \Big] \mathrm{d}Z

(equation 8 of the paper; ``r0 dz = dZ/sqrt(delta1)``). A whole tube may be of uneven thickness; ``w`` is then
multiplied by ``1 + uneven Z/(l_f/2)``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import ufl
from mpi4py import MPI
from ufl.core.expr import Expr

from weakforms.errors import InputError
from weakforms.forms.loads import substrate_potential
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.blocks import BREAK, LOWER, Blocks, mirrored, one_end
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.compression import PrincipalResultants
from weakforms.problems.meridian.limits import resistance
from weakforms.problems.meridian.model import MeridianModel
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.continuation.line import CriticalLine, fold_line
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

START_STRETCH = 1.3
"""Pre-stretch at which the steps to a first state start. At ``delta1 = 1`` and ``p = 0`` the tube is slack
and its tangent singular, and a direct guess may converge to a folded state."""

FIRST_U = 0.02
"""Mid-plane displacement of the first state, if the tube without pressure is slack or nearly slack."""

TAUT = 1.02
"""Pre-stretch above which the branch starts at ``p = 0`` (the layer at the disk is then resolved)."""

UNEVEN, EVENLY = "uneven", 0.025
"""The load that makes the thickness uneven, and the largest step of it."""

USUAL_LOAD = 20.0
"""Pressure above which steps grow with it: it dominates the arc length of laws that stiffen."""

KINKED = 6
"""Degree of the quadrature over that of the elements, if resultants have kinks inside of cells. Errors are
then mainly the quadrature's: with twice the degree, as elsewhere, they are five times as large."""

STEEPEST = 1 - 1e-6
"""If the pressure's share in the direction of the branch exceeds this, the membrane is nearly inextensible: a
law of limited stretch is nearly at its limit, and the branch continues to any pressure."""


@dataclass(frozen=True)
class TubeMesh:
    """One mesh of the tube: cells on half the length, polynomial degree, grading towards the disks."""

    cells: int
    degree: int
    grading: float
    full: bool = False


class TubeModel(MeridianModel):
    """Weak form of the tube; its unknowns are ``rho`` and ``eta``.

    Args:
        comm: Ranks.
        material: The law.
        values: First values of the loads ``p``, ``delta1`` and, with a substrate, ``k`` and ``s``.
        half: Half the length.
        mesh: Its blocks and elements; a whole tube begins at ``-half``.
        energy: See :class:`MeridianModel`.
    """

    name = "tube"

    hidden: tuple[str, ...] = ()
    """Functionals that are zero on free inflation and not shown there."""

    def __init__(
        self,
        comm: MPI.Intracomm,
        material: Chosen,
        values: Mapping[str, float],
        half: float,
        mesh: Blocks,
        energy: str = "standard",
    ) -> None:
        # At the mid-plane eta = 0 by symmetry; a whole tube has a disk at either end.
        disk, middle = (1.0, half), (None, 0.0)
        self.half = half
        body = Body(
            name="tube",
            parameters=(),
            length=lambda _q: half,
            radius=lambda _s, _q: 1.0,
            thickness=lambda s, q: self.thickness(s, q) / ufl.sqrt(q["delta1"]),
            held=((1.0, -half) if mesh.breaks[0] < 0 else middle, disk),
            scales=lambda q: (q["delta1"], 1 / ufl.sqrt(q["delta1"])),
        )
        super().__init__(comm, body, values, mesh, energy, material)
        z = {name: float(self.breaks[k]) for name, k in self.fronts.items()}
        self.unknown.interpolate(lambda x: np.vstack([np.ones_like(x[0]), self.material(x[0], z)]))

    @classmethod
    def free(
        cls,
        comm: MPI.Intracomm,
        material: Chosen,
        delta1: float,
        lf: float,
        at: TubeMesh,
        uneven: float | None = None,
        energy: str = "standard",
    ) -> TubeModel:
        """The tube without a substrate: half of it, or the whole, which may be thicker at one disk."""
        half, disk = lf / 2, one_end(at.grading)
        grading, breaks = [disk], [0.0, half]
        if at.full:
            grading, breaks = [mirrored(disk), disk], [-half, 0.0, half]
        values = {"p": 0.0, "delta1": delta1} | ({} if uneven is None else {UNEVEN: uneven})
        mesh = Blocks(breaks, at.cells, at.degree, 2 * at.degree + 2, grading=grading)
        if energy == "relaxed":
            mesh = replace(mesh, quadrature=KINKED * at.degree + 2)
        return cls(comm, material, values, half, mesh, energy)

    def thickness(self, s: Expr, q: Mapping[str, Expr]) -> Expr | float:
        """Thickness of the stress-free tube over its mean ``h_o``, ``1 + uneven Z/(lf/2)``."""
        return 1 + q[UNEVEN] * s / self.half if UNEVEN in q else 1.0

    @cached_property
    def resultants(self) -> tuple[Expr, Expr]:
        """Cauchy resultants ``t1, t2`` over ``C1 h_o``, of the local thickness."""
        t1, t2 = super().resultants
        own = self.thickness(self.expressions["S"], self.q)
        return own * t1, own * t2

    @cached_property
    def tension(self) -> PrincipalResultants:
        """The same, to be read at states."""
        return PrincipalResultants(self, *self.resultants)

    def mass(self) -> ufl.Form:
        """``int |dx|^2 dZ``."""
        trial, test = ufl.TrialFunction(self.space), ufl.TestFunction(self.space)
        return ufl.inner(trial, test) * self.expressions["width"] * self.dx

    def touching(self) -> Expr | float:
        """Indicator of contact with a substrate."""
        return ufl.conditional(ufl.gt(self.expressions["r"], self.q["s"]), 1.0, 0.0)

    def foundation(self) -> Expr | float:
        """The substrate, if there is one."""
        if "k" not in self.q:
            return super().foundation()
        e, q = self.expressions, self.q
        return substrate_potential(e["r"], e["z_s"], q["k"], q["s"], self.touching())

    def at_middle(self, value: Expr) -> ufl.Form:
        """Value at ``Z = 0`` as a form, so that every rank gets it like an integral."""
        middle = BREAK + self.blocks // 2 - 1
        return ufl.avg(value) * self.inner(middle) if self.breaks[0] < 0 else value * self.ends(LOWER)

    def axial_force(self) -> Expr:
        r"""Of the membrane, :math:`r_0 w_{,1}\cos\beta`."""
        e = self.expressions
        return ufl.sqrt(self.q["delta1"]) * self.resultants[0] * e["lam2"] * e["cos_beta"]

    def formulation(self) -> Formulation:
        r"""The weak form, with columns and with fields that include both first integrals of free inflation.

        ``H`` is one of an even thickness only.

        .. math:: F = r_0 w_{,1}\cos\beta - \tfrac12 p\rho^2, \qquad H = w - \lambda_1 w_{,1}
        """
        e, given = self.expressions, super().formulation()
        rho, lam1, lam2 = e["r"], e["lam1"], e["lam2"]
        t1, _ = self.resultants
        thick = self.thickness(e["S"], self.q)
        return replace(
            given,
            monitors={
                "u_max": self.at_middle(rho - 1),
                "lam1_mid": self.at_middle(lam1),
                "t1_mid": self.at_middle(t1),
                **given.monitors,
                "resistance": self.at_middle(resistance(self.law, lam1, lam2)),
            },
            internal=("resistance",),
            tension=self.tension,
            profile={
                **given.profile,
                "F_axial": self.axial_force() - self.q["p"] * rho**2 / 2,
                "H": self.law(lam1, lam2) - lam1 * t1 / thick * lam2,
            },
        )


def first_state(solver: ExtendedNewton, delta1: float) -> tuple[State, Held]:
    """First state of the branch and its condition: unloaded if the tube is taut, else slightly inflated.

    The latter is reached from a taut tube by decreasing the pre-stretch in steps. An uneven tube is reached
    from an even one.

    Raises:
        InputError: If the pre-stretch is beyond the largest stretch of the law.
    """
    system = solver.system
    state = system.initial.copy()
    uneven = state.loads.get(UNEVEN, 0.0)
    if uneven:
        state.loads[UNEVEN] = 0.0
    if delta1 >= TAUT:
        with system.at(state):
            forces = system.residual()
        if not np.isfinite(system.dot(forces, forces)):
            raise InputError(
                f"delta1 = {delta1:g} alone stretches the membrane beyond what its law allows; lower delta1 "
                "(delta1_end of tube_fold), or choose a law, or constants, that allow more"
            )
        held = Held("p", 0.0)
    else:
        held = Held("u_max", FIRST_U)
        for stretch in np.linspace(START_STRETCH, delta1, 7):
            state.loads["delta1"] = float(stretch)
            state, _ = solver.solve(state, [held])
    return (made_uneven(solver, state, held, uneven) if uneven else state), held


def made_uneven(solver: ExtendedNewton, state: State, held: Held, uneven: float) -> State:
    """The state of an uneven tube that is followed from one of an even tube, while one number is held.

    Raises:
        ConvergenceError: If it is lost on the way.
    """

    def solve(state: State, value: float) -> State:
        return solver.solve(replace(state, loads=state.loads | {UNEVEN: value}), [held])[0]

    return walk(solve, state, state.loads[UNEVEN], uneven, EVENLY)


def free_branch(
    system: System,
    delta1: float,
    u_end: float,
    step: float,
    kind: Callable[..., SolutionCurve] = EquilibriumBranch,
    limit: Callable[[State], str] = lambda _state: "",
    begin: tuple[State, Held] | None = None,
) -> SolutionCurve:
    """Free inflation at fixed pre-stretch by arc length, up to ``u_max = u_end`` or the law's end.

    Args:
        system: The equilibrium equations.
        delta1: Pre-stretch.
        u_end: Value of ``u_max`` at which the branch ends.
        step: Largest step.
        kind: The class of the curve.
        limit: Why the law takes no more than a state, where the trace may stall.
        begin: A guess of its first state and a condition for it; by default the unloaded tube.
    """
    solver = ExtendedNewton(system, ["p"])
    steps = StepControl(first=step / 4, largest=step, usual_load=USUAL_LOAD)
    continuation = Continuation(solver, control=steps)
    state, held = begin or first_state(solver, delta1)
    start = continuation.start(state, held, towards={"u_max": 1.0})

    def stop(point: CurvePoint) -> bool:
        return point.monitors["u_max"] > u_end or yields(point) or point.tangent.loads["p"] > STEEPEST

    branch = kind(continuation, "p", start, stop)
    branch.end_at_limit(limit)
    last = branch.points[-1]
    followed = (
        f"free inflation was followed up to u_max = {last.monitors['u_max']:.6g}, "
        f"p = {last.state.loads['p']:.6g}"
    )
    if yields(last):
        branch.ended = f"free inflation ends: {yielding(last)}"
    elif branch.ended:
        branch.ended = f"{followed}: {branch.ended}"
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


def fold_line_between(branch: EquilibriumBranch, ends: tuple[float, float], step: float) -> CriticalLine:
    """The first limit point of a branch, followed in ``delta1`` until it returns or reaches an end.

    Args:
        branch: Free inflation at one of the ends.
        ends: Range of pre-stretches of the line.
        step: Largest arc-length step.
    """
    low, high = ends
    inwards = 1.0 if branch.points[0].state.loads["delta1"] < (low + high) / 2 else -1.0
    steps = StepControl(first=step / 4, largest=step, usual_load=USUAL_LOAD)
    return fold_line(
        branch, "delta1", inwards, steps, lambda point: not low < point.state.loads["delta1"] < high
    )
