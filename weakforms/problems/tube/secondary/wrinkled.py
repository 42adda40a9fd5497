r"""Bent states of a tube that cannot bear compression: taut at first, wrinkled beside the disk further on.

The relaxed energy is that of a tension field on the surface (:mod:`weakforms.forms.wrinkling`). Where the
branch begins the tube must be taut, so that the crossing, and what leaves it, are those of the law. Fronts of
the wrinkled part lie inside of elements, where stresses have kinks: all numbers converge at a low order.

Under pressure a wrinkled membrane resists no wave that changes its width across the tension, and a pressure
does work on it (Patil, Nordmark & Eriksson 2016, section 6): it is unstable to waves that are short over the
wrinkled part. The longest of them fits when this part is large enough, on a finer mesh earlier than on a
coarse one. There the branch ends, because no mesh tells states apart that differ by such waves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

import numpy as np
from dolfinx import fem
from mpi4py import MPI

from weakforms.problems.gas import Gas
from weakforms.problems.meridian.kinks import EDGE, FRACTION, KinkedFamily
from weakforms.problems.problem import Progress
from weakforms.problems.tube.parameters import SecondaryNumerics, TubeParameters
from weakforms.problems.tube.secondary.bent import ACROSS, BentBranch, BentFamily, bent_tube, even_crossings
from weakforms.problems.tube.secondary.crossed import begun_taut
from weakforms.problems.tube.secondary.outside import BentModes
from weakforms.problems.tube.secondary.surface import BentTube
from weakforms.problems.tube.stability import TubeBranch, TubeFamily, is_wrinkled
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.continuation.pieces import PiecewiseFamily
from weakforms.solvers.support.sampling import Interpolant


class WrinkledModes(BentModes):
    """As of any bent state, with the resultants of the relaxed energy and how much is wrinkled.

    Args:
        model: The surface.
        gas: The gas inside, if its mass is to be held.
    """

    columns = ("t_min", FRACTION, "Lambda_rotation", "m")

    def __init__(self, model: BentTube, gas: Gas) -> None:
        super().__init__(model, gas)
        self._relaxed = Interpolant(model.unknown, model.principal_resultants(relaxed=True))
        self._part = fem.form(model.wrinkled_part())

    def observe(self) -> dict[str, float]:
        """As of any bent state; ``t_min`` is that of the relaxed energy."""
        found, comm = super().observe(), self.model.space.mesh.comm
        if is_wrinkled(found["t_min"]):  # at nodes, because polynomials overshoot beside a kink
            found["t_min"] = comm.allreduce(float(self._relaxed.values().min(initial=np.inf)), op=MPI.MIN)
        return found | {FRACTION: comm.allreduce(float(fem.assemble_scalar(self._part)), op=MPI.SUM)}


class WrinkledBranch(BentBranch):
    """The branch on one mesh of the surface, as long as no short wave changes its stability.

    Args:
        primary: Free inflation by the energy of the law, on a mesh of the meridian.
        crossings: Its points at which an even wave is neutral and the tube is taut.
        begin: Index of the one at which the branch begins.
        step: Largest step.
        model: The surface, with the relaxed energy.
        gas: The gas inside.
        most: Volume at which free inflation ends.
    """

    modes_of: ClassVar[type[BentModes]] = WrinkledModes

    def __init__(
        self,
        primary: TubeBranch,
        crossings: list[Solved],
        begin: int,
        step: float,
        model: BentTube,
        gas: Gas,
        most: float,
    ) -> None:
        self._most, self._ripples = most, False
        super().__init__(primary, crossings, begin, step, model, gas)

    def until(self, primary: TubeBranch, start: CurvePoint) -> Callable[[CurvePoint], bool]:
        """Whether the branch ends at a point: as any, or because a wave changes its stability before it."""
        stop, before = self.ending(primary, self.side, self._most), [start]

        def ends(point: CurvePoint) -> bool:
            last, before[0] = before[0], point
            turned = last.tangent.loads[primary.control] * point.tangent.loads[primary.control] < 0
            self._ripples = abs(point.n_negative - last.n_negative) != turned
            return stop(point) or self._ripples

        return ends

    def _insert_limits(self) -> None:
        """As for any branch, up to the last point before a wave changes its stability."""
        if self._ripples:
            del self.points[-1]
            last = self.points[-1]
            self.ended = (
                f"tube: relaxed states with waves were followed up to V = {last.monitors['V']:.6g}: beyond, "
                "their stability changes without a limit point, as by short waves of the wrinkled part, of "
                "which a finer mesh has more; lower u_end"
            )
        super()._insert_limits()


class WrinkledFamily(KinkedFamily, BentFamily):
    """The branch on all meshes of the surface."""

    fine: WrinkledBranch


def wrinkled_family(
    parameters: TubeParameters,
    numerics: SecondaryNumerics,
    primary: TubeFamily,
    relaxed: PiecewiseFamily,
    comm: MPI.Intracomm,
    progress: Progress,
) -> WrinkledFamily:
    """The branch from one taut crossing of free inflation, on all meshes of the surface.

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
    meshes, number, n = numerics.surfaces, parameters.secondary_from, parameters.secondary_n
    crossings = even_crossings(parameters, primary)
    kept, start = begun_taut(crossings, number, f"even waves of n = {n} are neutral")
    taut = [crossings[i] for i in kept]
    most = float(relaxed.pieces[-1].family.fine.points[-1].monitors["V"])

    def make(level: int) -> WrinkledBranch:
        progress(f"branch of n = {n}", level, len(meshes))
        model = bent_tube(parameters, meshes[level], comm)
        return WrinkledBranch(primary.fine, taut, start, numerics.step, model, parameters.gas, most)

    caps = {FRACTION: EDGE}
    return WrinkledFamily(make, len(meshes), numerics.secondary_degree, ACROSS, "secondary", caps)
