r"""Lopsided states of a tube that cannot bear compression: taut at first, wrinkled beside a disk further on.

The relaxed energy is that of the law where :math:`g_w = \lambda_2\sqrt{\lambda_1} > 1`, and
:math:`w(\lambda_1, \lambda_1^{-1/2})` elsewhere. Where the branch begins the tube must be taut, so that the
crossing, and what leaves it, are those of the law. The mesh does not follow the fronts of the wrinkled
part: they lie inside of elements, where resultants have kinks, and all numbers converge at a low order.

Wrinkles run along the meridian, whose tension resists every short axisymmetric wave: unlike that of bent
states, the stability of these does not depend on the mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.kinks import FRACTION
from weakforms.problems.problem import Progress
from weakforms.problems.tube.folds import MISFIT, gw_of
from weakforms.problems.tube.model import TubeMesh
from weakforms.problems.tube.parameters import TubeNumerics, TubeParameters
from weakforms.problems.tube.secondary.crossed import begun_taut, require_crossings
from weakforms.problems.tube.secondary.lopsided import (
    ACROSS,
    CROSSED,
    LOST,
    LopsidedBranch,
    LopsidedFamily,
    WholeTube,
)
from weakforms.problems.tube.stability import TubeBranch, TubeFamily, is_wrinkled
from weakforms.problems.tube.waves import TubeModes
from weakforms.results import Branch, Quantity
from weakforms.results import State as BranchState
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.pieces import PiecewiseFamily
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.uncertainty.family import LOCATED

KINK = 1.0
"""Highest assumed order of a wrinkled state. Resultants have kinks inside of cells: errors fall with the
second order in the mean, those of eigenvalues with the first, and depend on where in its cell a front is."""

NEIGHBOURS = 2
"""Points of the trace on either side whose uncertainties count for a wrinkled state, because fronts are
elsewhere in their cells there. Its own may be too small by accident."""


class RelaxedModes(TubeModes):
    """Stability of lopsided states, with the resultants of the relaxed energy and how much is wrinkled.

    Stiffness jumps at a front, inside of a cell: eigenvalues converge at first order, and only their signs
    are told along the branch.

    Args:
        model: The whole tube with the relaxed energy.
        numbers: Wave numbers; 0 stands for axisymmetric waves.
    """

    def __init__(self, model: WholeTube, numbers: tuple[int, ...]) -> None:
        super().__init__(model, numbers, full=True)
        self.columns = ("t_min", FRACTION)
        lam1, lam2 = (model.expressions[name] for name in ("lam1", "lam2"))
        self._verge = Meridian(model, {"gw": gw_of(model), "lam1": lam1, "lam2": lam2})

    def least_resultant(self) -> tuple[float, float]:
        """Smallest ``gw - 1``, with the sign of a hoop resultant that may be negative, and its ``|Z|``."""
        value, x = self._verge.extreme_at("gw", -1)
        return value - 1, self.model.tension.place(x, {})

    def observe(self) -> dict[str, float]:
        """The lowest eigenvalue, the smallest resultant of the relaxed energy, and how much is wrinkled."""
        found = {"eigenvalue_1": super().observe()["eigenvalue_1"]}
        if is_wrinkled(self.least_resultant()[0]):
            return found | {"t_min": self.at_nodes(), FRACTION: self.part()}
        return found | {"t_min": self.model.tension.least()[0], FRACTION: 0.0}

    def part(self) -> float:
        """Fraction of the length that is wrinkled.

        Along a zone ``lam1`` is constant, and its ends are where ``lam2`` has the natural width of it. The
        latter has no kink there, and ``gw``, which is 1, has one.
        """
        at = self._verge.on_cells()
        folded, length = at["gw"].min(axis=1) < 1, 0.0
        for zone in np.split(np.arange(len(folded)), 1 + np.flatnonzero(np.diff(folded))):
            if folded[zone[0]]:
                deepest = at["gw"][zone].argmin()
                width = at["lam1"][zone].flat[deepest] ** -0.5
                steps, low = np.diff(at["x"][zone], axis=1), at["lam2"][zone]
                length += float(np.sum(steps * share_below(low[:, :-1], low[:, 1:], width)))
        return length / self.model.blocks

    def at_nodes(self) -> float:
        """The smallest resultant of the relaxed energy at nodes, because polynomials overshoot at a kink."""
        return self.model.tension.at_nodes()[0]


def share_below(one: np.ndarray, other: np.ndarray, level: float) -> np.ndarray:
    """Share of intervals on which what is linear between two values is below a level."""
    low, high = np.minimum(one, other), np.maximum(one, other)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(high > low, np.clip((level - low) / (high - low), 0.0, 1.0), low < level)


class RelaxedLopsidedBranch(LopsidedBranch):
    """The branch on one mesh.

    Args:
        primary: Free inflation of the whole tube by the energy of the law.
        crossings: Its points at which the mirror symmetry breaks and the tube is taut.
        begin: Index of the one at which the branch begins.
        step: Largest step.
        model: The whole tube with the relaxed energy, on the same mesh.
        most: Volume at which free inflation ends.
    """

    modes: RelaxedModes

    def __init__(
        self,
        primary: TubeBranch,
        crossings: Sequence[Solved],
        begin: int,
        step: float,
        model: WholeTube,
        most: float,
    ) -> None:
        self._most = most
        own = model.system, RelaxedModes(model, primary.modes.numbers)
        super().__init__(primary, crossings, begin, step, own=own)
        volume = self.points[-1].monitors["V"]
        self.end_before(
            self._slack,
            f"tube: at V = {volume:.6g} the meridian of lopsided states is compressed; lower u_end",
        )

    def until(self, primary: TubeBranch, _start: CurvePoint) -> Callable[[CurvePoint], bool]:
        """Whether the branch ends at a point: as any, or because the meridian is compressed."""
        stop = self.ending(primary, self.side, self._most)
        return lambda point: stop(point) or self._slack(point.state)

    def _slack(self, state: State) -> bool:
        with self.system.at(state):
            return self.modes.at_nodes() < -MISFIT

    def _leasts(self) -> np.ndarray:
        """Smallest ``gw - 1`` at each point of the trace, because no resultant is negative."""
        return np.array([self._least(Solved({}, point.state)) for point in self.points])


class RelaxedLopsidedFamily(LopsidedFamily):
    """The branch on all meshes."""

    fine: RelaxedLopsidedBranch

    def smooth_order(self, values: Mapping[str, float]) -> float:
        """Lower than that of the elements if there is a front."""
        return KINK if values[FRACTION] > 0 else np.inf

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All columns; a wrinkled state has the largest uncertainties of its neighbours."""
        found = super().branch(with_uncertainty)
        wrinkled = found.columns[FRACTION] > 0
        for name, own in found.uncertainty.items():
            around = np.lib.stride_tricks.sliding_window_view(
                np.pad(own, NEIGHBOURS, mode="edge"), 2 * NEIGHBOURS + 1
            )
            found.uncertainty[name] = np.where(wrinkled, around.max(axis=1), own)
        return found

    def state(
        self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None
    ) -> BranchState:
        """As for any branch; a wrinkled state has the largest uncertainties of its neighbours."""
        found = super().state(name, value, crossing, profile)
        if name in LOCATED or not found.quantities[FRACTION].value > 0:
            return found
        for other in self._beside(name, value, crossing):
            for column in other.keys() & found.quantities.keys():
                here, there = found.quantities[column], other[column].uncertainty
                found.quantities[column] = replace(here, uncertainty=max(here.uncertainty, there))
        return found

    def _beside(self, name: str, value: float, crossing: int) -> Iterator[Mapping[str, Quantity]]:
        """Columns of the states with the values that points of the trace next to a state have."""
        values = self.fine.over_points(name)
        i = self.fine.crossings(name, value)[crossing - 1]
        for near in values[max(0, i + 1 - NEIGHBOURS) : i + 1 + NEIGHBOURS]:
            try:
                solved = self._at(name, float(near), crossing)
            except (InputError, ConvergenceError):  # past an extremum of the column there is no such state
                continue
            lowest = [s.values["eigenvalue_1"] for s in solved]
            yield {**self._columns(solved, name, {}), "eigenvalue_1": self._quantity(lowest, "eigenvalue_1")}


def relaxed_lopsided_family(
    parameters: TubeParameters,
    numerics: TubeNumerics,
    primary: TubeFamily,
    relaxed: PiecewiseFamily,
    comm: MPI.Intracomm,
    progress: Progress,
) -> RelaxedLopsidedFamily:
    """The branch from one taut crossing of free inflation, on all meshes of the whole tube.

    Args:
        parameters: The tube.
        numerics: Meshes.
        primary: Free inflation by the energy of the law, with its stability.
        relaxed: Free inflation by the relaxed energy.
        comm: Ranks.
        progress: Called for every mesh.

    Raises:
        AbsentError: If there are not as many crossings, or if the tube is wrinkled there.
    """
    crossings, number = primary.located(CROSSED), parameters.secondary_from
    require_crossings(len(crossings), number, primary.fine, *LOST)
    kept, begin = begun_taut([same[-1] for same in crossings], number, LOST[0])
    most = float(relaxed.pieces[-1].family.fine.points[-1].monitors["V"])

    def make(level: int) -> RelaxedLopsidedBranch:
        progress("lopsided branch", level, len(primary.levels))
        at = TubeMesh(numerics.meshes[level], numerics.degree, numerics.grading, full=True)
        tube = comm, parameters.material, parameters.delta1, parameters.lf, at
        model = WholeTube.free(*tube, uneven=0.0, energy="relaxed")
        on_mesh = [crossings[i][level] for i in kept]
        return RelaxedLopsidedBranch(primary.levels[level], on_mesh, begin, numerics.step, model, most)

    caps = {**primary.caps, "eigenvalue_1": KINK}
    return RelaxedLopsidedFamily(make, len(primary.levels), primary.cap, ACROSS, "secondary", caps)
