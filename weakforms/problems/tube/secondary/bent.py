r"""Bent states of the free tube, and others with ``n`` waves around its axis, symmetric about mid-length.

They leave free inflation where an even wave of wave number ``n`` is neutral. The amplitude is the part of
:math:`\cos n\Theta` in the radial displacement of the mid-plane,

.. math:: ξ = u_{wave} = \frac{2n}\pi \int_0^{\pi/n} (X - 1)\cos n\Theta \,\mathrm d\Theta \quad (Z = 0),

positive here; the branch turned by ``pi/n`` has the opposite sign. The crossing is located anew on each mesh
of the surface: the axisymmetric state at which its own second variation is singular.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from scipy.interpolate import make_interp_spline

from weakforms.problems.gas import Gas, folds_of
from weakforms.problems.meridian.families import EVEN, Wave
from weakforms.problems.meridian.sector import SectorMesh
from weakforms.problems.problem import Progress
from weakforms.problems.tube.parameters import SecondaryNumerics, TubeParameters
from weakforms.problems.tube.secondary.crossed import CrossedFamily, FlaggedBranch, require_crossings
from weakforms.problems.tube.secondary.outside import BentModes
from weakforms.problems.tube.secondary.surface import AMPLITUDE, BentTube
from weakforms.problems.tube.stability import TubeBranch, TubeFamily
from weakforms.results import Field, Quantity
from weakforms.solvers.continuation.amounts import AmountCurve
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.constraints import Plane
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.stability.agreement import same_count
from weakforms.solvers.stability.modes import OwnVariation, Singular
from weakforms.solvers.support.sampling import Sampler
from weakforms.solvers.uncertainty.family import BranchFamily

ACROSS = "V", AMPLITUDE
"""Columns of the plane in which meshes are compared: one of them changes at every point of the branch."""

WRINKLED, FINEST = "wrinkled", 2
"""Name of the flag, and number of meshes that must agree on it."""

READINGS, SPLINE = 400, 5
"""Number of positions at which free inflation is read for a first guess, and degree of the spline."""


class BentBranch(AmountCurve, FlaggedBranch):
    """The branch on one mesh of the surface.

    Args:
        primary: Free inflation of the half tube, on a mesh of the meridian.
        crossings: Its points at which an even wave is neutral.
        begin: Index of the one at which the branch begins.
        step: Largest step.
        model: The surface.
        gas: The gas inside.
    """

    along, amplitude = "V", AMPLITUDE
    modes_of: ClassVar[type[BentModes]] = BentModes

    def __init__(
        self,
        primary: TubeBranch,
        crossings: Sequence[Solved],
        begin: int,
        step: float,
        model: BentTube,
        gas: Gas,
    ) -> None:
        self.kind, self.called = Wave(model.n, EVEN).kind, f"n = {model.n}"
        self.family = {"n": float(model.n), "parity": float(EVEN)}
        located = [on_surface(primary, solved, model) for solved in crossings]
        self._gas = gas
        super().__init__(primary, located, begin, step, own=(model.system, self.modes_of(model, gas)))

    def _placed(self) -> list[tuple[float, Solved]]:
        """Besides, extrema of the volume and of the gas's mass, except crossings, where all rates vanish."""
        found = super()._placed()
        folds = self.folds("p", "V", folds_of(self._gas), (1, -1 if self.joins else None))
        return found + [(self._arclength(i, solved), solved) for i, solved in folds]

    def _onsets(self) -> list[int]:
        """None: the coarsest mesh of a surface does not resolve the smallest resultant, beside the disk."""
        return []


def on_surface(primary: TubeBranch, crossing: Solved, model: BentTube) -> Solved:
    """The axisymmetric state of a surface's mesh at which its second variation is singular.

    With a force ``mu b`` along the mode, ``R + mu b = 0``, ``g = 0`` and ``b.x = 0`` are regular, and
    ``mu`` is zero by symmetry.

    Raises:
        ConvergenceError: If Newton's method does not converge.
    """
    x = np.linspace(0, 1, READINGS)
    meridian, variation = primary.modes.model, primary.modes.variation
    with primary.system.at(crossing.state):
        e, loads = meridian.expressions, crossing.state.loads
        position = Sampler(meridian.unknown, {"r": e["r"], "z": e["z"]}, x)()
        wave = variation(Wave(model.n, EVEN))
        vector = wave.nearest().vector
        wave.mode.x.array[: wave.size] = vector
        wave.mode.x.scatter_forward()
        mode = Sampler(wave.mode, {name: wave.mode[i] for i, name in enumerate("uqw")}, x)()
        places = meridian.material(x, loads)
    r, z, u, q, w = (
        make_interp_spline(places, values, SPLINE) for values in (*position.values(), *mode.values())
    )
    n, system = model.n, model.system
    guess = model.state_of(lambda s, _: np.vstack([r(s), 0 * s, z(s)]), {"p": loads["p"]})
    displacement = model.interpolated(
        lambda s, t: np.vstack([u(s) * np.cos(n * t), q(s) * np.sin(n * t), w(s) * np.cos(n * t)])
    )
    displacement[system.bc_dofs] = 0.0
    dual = system.mass_times(displacement)
    border = dual / np.sqrt(system.dot(displacement, dual))
    solver = ExtendedNewton(system, ["p"], unfolding=border)
    singular = Singular(lambda: OwnVariation(solver), border)
    state, _ = solver.solve(guess, [singular, Plane(border, {}, 0.0)])
    with system.at(state):
        return Solved({"p": state.loads["p"], **system.monitors()}, state)


class BentFamily(CrossedFamily, TubeFamily):
    """The branch on all meshes of the surface."""

    fine: BentBranch
    levels: list[BentBranch]

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """As for any branch, without what both of the finest meshes, or of a wrinkled state all, contradict.

        A compressed membrane is unstable to short waves, of which a finer mesh has more.

        Raises:
            ConvergenceError: If a number of negative eigenvalues of a taut state depends on the mesh.
        """
        found = BranchFamily._diagnostics(self, solved, critical)
        if critical:
            return found
        rows = [level.counted(s.state) for level, s in zip(self.levels, solved, strict=True)]
        flags = {row[WRINKLED] for row in rows[-FINEST:]}
        if len(flags) == 1:
            found[WRINKLED] = Quantity(rows[-1][WRINKLED])
        for name in (key for key in rows[-1] if key != WRINKLED):
            counts = {row[name] for row in rows}
            if len(counts) == 1 or flags == {0}:
                found[name] = Quantity(same_count(counts))
        return found

    def _profile(self, solved: Sequence[Solved], points: np.ndarray) -> Field:
        """Columns along both meridians that are mirrors, one after the other."""
        meridians = 0.0, np.pi / self.fine.modes.model.n
        z, theta = np.tile(points, 2), np.repeat(meridians, len(points))
        found = super()._profile(solved, np.column_stack([z, theta]))
        keys = {"Z": z, "Theta": theta}
        return Field(found.name, {**found.columns, **keys}, {**found.uncertainty, **dict.fromkeys(keys, 0.0)})


def bent_family(
    parameters: TubeParameters,
    numerics: SecondaryNumerics,
    primary: TubeFamily,
    comm: MPI.Intracomm,
    progress: Progress,
) -> BentFamily:
    """The branch from one crossing of free inflation of the half tube, on all meshes of the surface.

    Raises:
        AbsentError: If there are not as many crossings.
    """
    n, meshes, number = parameters.secondary_n, numerics.surfaces, parameters.secondary_from
    crossings = even_crossings(parameters, primary)

    def make(level: int) -> BentBranch:
        progress(f"branch of n = {n}", level, len(meshes))
        model = bent_tube(parameters, meshes[level], comm)
        return BentBranch(primary.fine, crossings, number - 1, numerics.step, model, parameters.gas)

    # Twice the degree is reached only on meshes that resolve the layer at the disk.
    return BentFamily(make, len(meshes), numerics.secondary_degree, ACROSS, "secondary")


def even_crossings(parameters: TubeParameters, primary: TubeFamily) -> list[Solved]:
    """The points of free inflation, on its finest mesh, at which even waves are neutral.

    Raises:
        AbsentError: If there are not as many as the number of the one that is asked for.
    """
    n = parameters.secondary_n
    every = [same[-1] for same in primary.located(Wave(n, EVEN).kind)]
    crossings = [solved for solved in every if solved.values["parity"] == EVEN]
    where = f"even waves of n = {n} are neutral", "delta1 or lf, or another secondary_n"
    require_crossings(len(crossings), parameters.secondary_from, primary.fine, *where)
    return crossings


def bent_tube(parameters: TubeParameters, at: SectorMesh, comm: MPI.Intracomm) -> BentTube:
    """The surface on a mesh."""
    tube = parameters.material, parameters.delta1, parameters.lf / 2
    return BentTube(comm, *tube, parameters.secondary_n, at, parameters.energy)
