"""Paper 3: the primary branch on one mesh, in parts: dry, partially filled, full, partially filled again."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cached_property

import numpy as np
from mpi4py import MPI
from scipy.interpolate import CubicSpline

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.liquid_tube.model import DRY, FULL, PART, TubeData, TubeModel
from weakforms.problems.liquid_tube.modes import TubeModes
from weakforms.problems.meridian.limits import GIVES_WAY, SAMPLED, limit_of, relative_stiffness, resistance
from weakforms.problems.meridian.pre_stretch import has_bounded_force
from weakforms.solvers.continuation.continuation import Continuation, CurvePoint, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.modal import ModalBranch, SinglePoint
from weakforms.solvers.support.sampling import Interpolant, Sampler

EDGE = 1e-4
"""Smallest distance of the front from a ring, as a fraction of the length. Closer to the ring a part of the
mesh would have no length and unbounded stiffness, and the ring leaves no room for the membrane."""

NEARLY_FULL = 0.97
"""Front, as a fraction of the length, from which the tube is filled in steps of equal ratio."""

TOP_STATES = 6
"""Number of the states in these steps."""

ZW_END, STEP = 0.7, 0.5
"""Default end of the branch, as a fraction of its highest level, and default largest step."""

WIDEST = 10.0
"""Mean radius at which the branch ends. The tube of a stiffening law may have no limit point: its level then
rises for ever."""

HEAVIEST, USUAL_LEVEL = 100.0, 40.0
"""Largest pressure of the liquid over the stiffness of the law, at which the branch ends too: a law with a
limit, such as Gent's, never lets its tube become so wide. Level above which steps grow in proportion."""

TRANSFER = 257
"""Number of points by which a state is interpolated to another position of the front, as a guess."""

WALK = 0.05
"""Largest change of ``delta`` per step on the way to a pre-stretch for which no direct guess converges."""


class FluidPath:
    """The primary branch on one mesh, starting from the dry tube.

    Args:
        comm: Ranks.
        data: Tube, liquid and mesh.
        n_max: Largest wave number whose eigenvalues are computed.
        zw_end: The branch ends when the level has decreased to this fraction of the highest one.
        step: Largest arc-length step.
        model: The weak form, if there is one already; its initial loads are those of ``data``.
    """

    def __init__(
        self,
        comm: MPI.Intracomm,
        data: TubeData,
        n_max: int,
        zw_end: float = ZW_END,
        step: float = STEP,
        model: TubeModel | None = None,
    ) -> None:
        self.data, self.zw_end, self.step = data, zw_end, step
        self.model = model or TubeModel(comm, data)
        self._n_max = n_max
        self._highest = self._volume = 0.0

    @cached_property
    def modes(self) -> TubeModes:
        """What is computed along the branch."""
        return TubeModes(self.model, self._n_max)

    def _ends(self, point: CurvePoint) -> bool:
        """Whether the level has decreased far enough or, for a stiffening law, increases again."""
        level, volume = point.state.loads["zw"], point.monitors["V"]
        if level > self._highest:
            self._highest, self._volume = level, volume
        rises = volume > self._volume and point.tangent.loads["zw"] > 0
        stiffens = rises and self.data.material is not None
        return level < self.zw_end * self._highest or stiffens or bool(self.locked(point))

    def locked(self, point: CurvePoint) -> str:
        """Why a level that still rises is followed no further, as text; empty if it is followed."""
        if self._volume_of(point) > np.pi * WIDEST**2 * self.data.L:
            return f"the mean radius is {WIDEST:g}"
        if point.state.loads["zw"] > heaviest(self.data):
            return f"the pressure of the liquid is {HEAVIEST:g} times the stiffness of the law"
        return GIVES_WAY if self._yields(point.state) else ""

    def _volume_of(self, point: CurvePoint) -> float:
        """Volume of the liquid over ``A^3``."""
        return point.monitors["V"]

    @cached_property
    def _resistance(self) -> Interpolant | None:
        """The :func:`resistance` along the tube, if the force of the law is bounded."""
        model = self.model
        if self.data.material is None or not has_bounded_force(self.data.material):
            return None
        left = resistance(model.surface_law.stretches, *model.stretches())
        return Interpolant(model.unknown, {"resistance": left})

    def _yields(self, state: State) -> bool:
        """Whether the law hardly resists more meridional stretch somewhere: no mesh resolves what follows."""
        if self._resistance is None:
            return False
        with self.model.system.at(state):
            least = self._resistance.values().min(initial=np.inf)
        return self.model.mesh.comm.allreduce(least, op=MPI.MIN) < 0

    def limit(self, state: State) -> str:
        """Why the law takes hardly any more stretch at some place, as text; empty if it does."""
        if self.data.material is None:
            return ""
        points = np.linspace(0.0, self.data.length, SAMPLED)
        return limit_of(self.data.material, zip(*self.sampled(state, points, ("lam1", "lam2")), strict=True))

    # -- parts --------------------------------------------------------------------------------

    @cached_property
    def pieces(self) -> list[ModalBranch]:
        """Dry, partially filled, and if the level passes the upper ring: full, partially filled again."""
        pieces = [self._dry_piece(), self._filling()]
        while self._left_at_top(pieces[-1]):
            full = self._full(pieces[-1])
            pieces.append(full)
            if full.stalled or full.ended or self._ends(full.points[-1]):
                break
            pieces.append(self._draining(full))
        return pieces

    def _left_at_top(self, piece: ModalBranch) -> bool:
        last = piece.points[-1]
        return (
            piece.stalled is piece.ended is None
            and not self._ends(last)
            and last.state.loads["front"] > NEARLY_FULL
        )

    def _dry_piece(self) -> SinglePoint:
        solver = ExtendedNewton(self.model.system, ["zw"])
        continuation = Continuation(solver, control=self._steps())
        start = continuation.start(self.dry(), Held("zw", 0.0), towards={"zw": 1.0})
        return SinglePoint(continuation, "zw", start, self.modes, hidden=("Z_front", "r_front"))

    def _filling(self) -> ModalBranch:
        return self._partially_filled(self.dry(), EDGE, 1.0)

    def _full(self, before: ModalBranch) -> ModalBranch:
        guess = self.transferred(before.points[-1].state, front=0.5, zw=self.data.L, **FULL)
        solver = ExtendedNewton(self.model.system, ["zw"])
        continuation = Continuation(solver, control=self._steps())
        start = continuation.start(guess, Held("zw", self.data.L), towards={"zw": 1.0})

        def stop(point: CurvePoint) -> bool:
            return self._ends(point) or point.state.loads["zw"] < self.data.L

        branch = self._branch(continuation, start, stop, ("Z_front", "r_front"))
        if branch.points[-1].state.loads["zw"] < self.data.L:
            branch.end_at("zw", self.data.L)
        self._say_end(branch)
        return branch

    def _say_end(self, branch: ModalBranch) -> None:
        """Why the branch ends, if its level has not fallen to where it was to end."""
        last = branch.points[-1]
        level, why = last.state.loads["zw"], self.locked(last)
        if why and level >= self.zw_end * self._highest:
            branch.ended = (
                f"the level comes to zw = {level:.6g} without falling below {self.zw_end:g} of its highest "
                f"value; there {why}"
            )

    def _draining(self, before: ModalBranch) -> ModalBranch:
        return self._partially_filled(before.points[-1].state, 1 - EDGE, -1.0)

    def _partially_filled(self, state: State, front: float, sign: float) -> ModalBranch:
        guess = self.transferred(state, front=front, zw=self.data.L if sign < 0 else 0.0, **PART)
        solver = ExtendedNewton(self.model.system, ["zw", "front"])
        continuation = Continuation(solver, [Held("gap", 0.0)], self._steps(), allowed=_in_order)
        start = continuation.start(guess, Held("front", front), towards={"front": sign})

        def stop(point: CurvePoint) -> bool:
            rising = point.tangent.loads["front"] > 0
            return self._ends(point) or (rising and point.state.loads["front"] > NEARLY_FULL)

        before = self._highest, self._volume
        branch = self._branch(continuation, start, stop)
        if self._left_at_top(branch):
            left = 1 - branch.points[-1].state.loads["front"]
            try:
                for exponent in np.linspace(np.log(left), np.log(EDGE), TOP_STATES)[1:]:
                    branch.extend_to("front", 1 - float(np.exp(exponent)))
                    if np.any(np.diff([point.monitors["V"] for point in branch.points]) < 0):
                        raise ConvergenceError("a tube turned inside out has such a front too")
            except ConvergenceError:  # the front may turn just below the ring
                self._highest, self._volume = before
                branch = self._branch(continuation, start, self._ends)
        self._say_end(branch)
        return branch

    def _branch(
        self,
        continuation: Continuation,
        start: CurvePoint,
        stop: Callable[[CurvePoint], bool],
        hidden: tuple[str, ...] = (),
    ) -> ModalBranch:
        branch = ModalBranch(continuation, "zw", start, stop, self.modes, hidden)
        branch.end_at_limit(self.limit)
        return branch

    def _steps(self) -> StepControl:
        return StepControl(first=self.step / 4, largest=self.step, usual_load=USUAL_LEVEL)

    # -- states --------------------------------------------------------------------------------

    def dry(self) -> State:
        """The pre-stretched tube without liquid.

        It is not a cylinder, because it contracts to the radius ``delta^(-1/2)`` of uniaxial tension. If a
        guess with that shape does not converge, or converges to a tube turned inside out, whose radius is
        negative in the middle, the tube is stretched to ``delta`` step by step.

        Raises:
            AbsentError: If the law gives way before.
        """
        solver, delta = ExtendedNewton(self.model.system), self.data.delta
        with suppress(ConvergenceError):
            state, _ = solver.solve(self._necked(delta))
            if self._is_outward(state):
                return self._holding(state)
        begin = min(delta, 1.5)
        state = self._necked(begin)
        for stretch in np.linspace(begin, delta, 2 + int((delta - begin) / WALK)):
            state.loads["delta"] = float(stretch)
            state = self._holding(solver.solve(state)[0])
        return state

    def _is_outward(self, state: State) -> bool:
        """Whether the radius is positive at every node."""
        least = float(np.min(1 + state.u[::2], initial=np.inf))
        return self.model.mesh.comm.allreduce(least, op=MPI.MIN) > 0

    def _holding(self, state: State) -> State:
        """A dry tube.

        Raises:
            AbsentError: If its law gives way.
        """
        if self._yields(state):
            raise AbsentError(
                "branch primary",
                f"at a pre-stretch of {state.loads['delta']:.4g}, without liquid, {GIVES_WAY}, or a smaller "
                "pre-stretch",
            )
        return state

    def _necked(self, delta: float) -> State:
        loads = {**self.model.system.initial.loads, "front": 0.5, "zw": 0.0, **DRY, "delta": delta}
        length, narrow = self.data.L / delta, delta**-0.5
        z = self.model.points(loads)
        wall = np.cosh(z - length / 2) / np.cosh(length / 2)
        return self.model.state_from(narrow + (1 - narrow) * wall, delta * z, loads)

    def transferred(self, state: State, **loads: float) -> State:
        """A state as a guess for other loads, including another position of the front."""
        points = np.linspace(0.0, self.data.length, TRANSFER)
        r, z = self.sampled(state, points, ("r", "z"))
        given = {**state.loads, **loads}
        nodes = self.model.points(given)
        return self.model.state_from(CubicSpline(points, r)(nodes), CubicSpline(points, z)(nodes), given)

    def sampled(self, state: State, points: np.ndarray, names: tuple[str, ...]) -> list[np.ndarray]:
        """Columns of a state's profile at material points, the same on every rank."""
        columns = {name: self.model.fields[name] for name in names}
        sampler = Sampler(self.model.unknown, columns, self.model.position(points, state.loads))
        with self.model.system.at(state):
            found = sampler()
        return [found[name] for name in names]


def heaviest(data: TubeData) -> float:
    """The level at which the liquid presses as much as :data:`HEAVIEST` says, above the upper ring."""
    law = data.material
    stiffness = 1 + data.alpha if law is None else relative_stiffness(law)
    return max(2 * data.L, HEAVIEST * stiffness / data.gamma)


def _in_order(state: State) -> bool:
    """Whether the front lies between the rings."""
    return 0.0 < state.loads["front"] < 1.0
