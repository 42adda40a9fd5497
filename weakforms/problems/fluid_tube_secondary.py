"""Paper 3: the secondary branch, where the tube bends sideways, on a family of meshes.

See :mod:`weakforms.problems.fluid_tube_branching` for where it starts and how its stability is judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.base import Progress
from weakforms.problems.fluid_tube_branching import AMPLITUDES, SecondaryBranch, secondary_branch
from weakforms.problems.fluid_tube_critical import PrimaryBranch
from weakforms.problems.fluid_tube_surface import SurfaceData
from weakforms.results import Field, Quantity, SpecialPoint
from weakforms.solvers.branch import Solved
from weakforms.solvers.family import BranchFamily
from weakforms.solvers.refinement import estimate, estimate_in_norm
from weakforms.solvers.system import State

if TYPE_CHECKING:
    from weakforms.problems.fluid_tube_problem import FluidTubeNumerics, FluidTubeParameters

CAP, GUARD = 2.0, 4.0
"""Orders of convergence the uncertainties reckon with. The free surface cuts cells: the position's third
derivative jumps inside them, and the quadrature of the load's kink leaves an error of second order and
irregular sign that shows on fine meshes only. On coarse ones it falls at the degree or faster."""

SHARED_GUARD = 6.0
"""The same for several points' positions together, whose largest difference does not vanish by accident."""

FIELD_CAP, FIELD_GUARD = 3.0, 8.0
"""The same for a whole field, whose largest difference does not vanish by accident."""

SLENDER = 12.0
"""Length above which half as many cells around as along are enough."""

GRID = (161, 97)
"""Points along and around of the grid on which the smallest values on a surface are looked for."""

THETAS = np.linspace(0, np.pi, 25)
"""Meridians of a profile."""

COLUMNS = (
    "r_mid_pi",
    *(f"{name}_quarter_{side}" for name in ("x", "z", "T1", "T2") for side in ("0", "pi")),
)
"""Columns of the secondary branch that the primary one has not."""

POSITIONS = ("r_mid", *(name for name in COLUMNS if name[0] in "rxz"))
"""Columns that are coordinates of points on the membrane."""

DERIVED_COLUMNS = (
    "z_min",
    "T_min",
    "Lambda_1",
    "Lambda_2",
    "Lambda_3",
    "Lambda_breaking",
    "Lambda_rotation",
    "LambdaV_1",
    "n_negative_breaking",
    "n_negative_V",
)
"""Numbers of a state of the secondary branch that can be read, not prescribed."""

SLOPES = ("dzw_dV", "dzw_dr2", "dr_mean_dzw")
"""Initial slopes, values of the bifurcation point at which the secondary branch begins."""

SCALES = {
    "r_mid": "radius at Z = L/(2 delta) over A; on the secondary branch at Theta = 0, the bulge's side",
    "r_mid_pi": "radius at Z = L/(2 delta), Theta = pi over A",
    **{
        f"{name}_quarter_{side}": f"{what} at Z = L/(4 delta), Theta = {side}"
        for side in ("0", "pi")
        for name, what in {
            "x": "x over A, from the axis of the disks to the bulge's side,",
            "z": "height over A",
            "T1": "meridional Cauchy resultant over mu H",
            "T2": "circumferential Cauchy resultant over mu H",
        }.items()
    },
    "z_min": "lowest point of the membrane over A",
    "T_min": "smallest principal Cauchy resultant anywhere over mu H",
    **{
        f"Lambda_{i}": f"{i}. lowest eigenvalue at fixed level, mirror-symmetric displacements"
        for i in (1, 2, 3)
    },
    "Lambda_breaking": "lowest eigenvalue at fixed level, displacements that break the mirror symmetry; "
    "without the turn of the pattern",
    "Lambda_rotation": "eigenvalue of the turn of the pattern about the axis: exactly 0, its size is the "
    "error's",
    "LambdaV_1": "lowest eigenvalue at fixed volume, mirror-symmetric displacements",
    "n_negative_breaking": "negative eigenvalues at fixed level among displacements that break the symmetry",
    "n_negative_V": "negative eigenvalues at fixed volume, mirror-symmetric displacements",
    "dzw_dV": "initial slope of the secondary branch, both of second order in its amplitude",
    "dzw_dr2": "initial ratio of the fall of zw and the square of the change of r_mid, times A",
    "dr_mean_dzw": "initial slope over zw of the mean of r_mid and r_mid_pi",
    "Theta": "angle on the stress-free tube from the bulge's side",
    "x": "coordinate across the axis, towards the bulge, over A",
    "y": "coordinate across the axis, normal to the plane of symmetry, over A",
}


def secondary_family(
    parameters: FluidTubeParameters, numerics: FluidTubeNumerics, comm: MPI.Intracomm, progress: Progress
) -> SecondaryFamily:
    """The secondary branch from its bifurcation point on all meshes.

    Reads the numerics whose names begin with ``secondary``.

    Raises:
        ConvergenceError: When the primary branch has no ``n = 1`` bifurcation point, or no branch is found
            there.
    """
    primary = PrimaryBranch(comm, parameters.L, parameters.delta, parameters.gamma, parameters.alpha)

    def make(level: int) -> SecondaryBranch:
        progress("secondary branch", level, numerics.secondary_levels)
        coarser = 2 ** (numerics.secondary_levels - 1 - level)
        data = SurfaceData(
            parameters.L,
            parameters.delta,
            parameters.gamma,
            parameters.alpha,
            numerics.secondary_cells // coarser,
            around(parameters.L, numerics) // coarser,
            numerics.secondary_degree,
        )
        return secondary_branch(comm, data, primary, numerics.secondary_step, numerics.secondary_end)

    return SecondaryFamily(make, numerics.secondary_levels, CAP, ("zw", "r_mid"), "secondary")


def around(length: float, numerics: FluidTubeNumerics) -> int:
    """Cells over half the circumference on the finest mesh: as asked for, or fewer on a slender tube."""
    if numerics.secondary_around is not None:
        return numerics.secondary_around
    return numerics.secondary_cells // (1 if length <= SLENDER else 2)


class SecondaryFamily(BranchFamily):
    """The secondary branch on a family of meshes."""

    fine: SecondaryBranch
    levels: list[SecondaryBranch]
    judges_points = False

    def special_points(self) -> list[SpecialPoint]:
        """As for any branch; the bifurcation point carries the branch's initial slopes."""
        points = super().special_points()
        slopes = [level.initial() for level in self.levels]
        fewer = self.fine.initial(len(AMPLITUDES) - 1)  # for the error of the extrapolation
        for name in SLOPES:
            found = estimate([s[name] for s in slopes], CAP, GUARD)
            points[0].values[name] = float(found.value)
            missed = abs(fewer[name] - slopes[-1][name])
            points[0].uncertainty[name] = float(found.uncertainty) + missed
        points[0].values["n"], points[0].uncertainty["n"] = 1.0, 0.0
        return points

    def _at(self, name: str, value: float, crossing: int) -> list[Solved]:
        """On the coarsest mesh by the branch traced there; every other mesh starts from the one before.

        Where that does not lead to the same state, its own trace does.
        """
        solved = [self.levels[0].at(name, value, crossing)]
        for below, level in pairwise(self.levels):
            state = solved[-1].state
            below.system.set_state(state.u, state.loads)
            guess = State(level.model.interpolated(below.model.shape()), dict(state.loads))
            try:
                solved.append(level.at_guess(guess, name, value))
            except ConvergenceError:
                solved.append(level.at(name, value, crossing))
        return solved

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Eigenvalues with uncertainties; the two finest meshes must count the same negative ones.

        The coarsest one is there for the order of convergence: on a long tube it is too coarse for the dry
        part. Where the membrane is compressed it wrinkles as finely as a mesh can show: but for the lowest
        eigenvalue at fixed level, far below the wrinkles', nothing there converges, and nothing is given.
        """
        out = self._lowest(solved)
        least = out["T_min"]
        if least.value + least.uncertainty < 0:
            lowest = [level.stability.lowest(s.state) for level, s in zip(self.levels, solved, strict=True)]
            return out | {"Lambda_1": self._quantity(lowest)}
        spectra = [
            level.stability.spectra(s.state, critical) for level, s in zip(self.levels, solved, strict=True)
        ]
        for name in spectra[-1]:
            values = [spectrum[name] for spectrum in spectra]
            if not name.startswith("n_negative"):
                out[name] = self._quantity(values)
            elif len(set(values[-2:])) > 1:
                raise ConvergenceError(f"stability depends on the mesh: {name} = {values}")
            else:
                out[name] = Quantity(values[-1])
        return out

    def _quantity(self, values: list[float], name: str = "") -> Quantity:
        found = estimate(values, CAP, GUARD)
        order = float(found.order)
        return Quantity(float(found.value), float(found.uncertainty), order if order > 0 else None)

    def _columns(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        """Points of one surface have one uncertainty of position: one's alone may vanish by accident."""
        out = super()._columns(solved)
        shared = estimate_in_norm(
            [np.array([s.values[n] for n in POSITIONS]) for s in solved], CAP, SHARED_GUARD
        )
        return out | {name: Quantity(out[name].value, shared, out[name].order) for name in POSITIONS}

    def _locate(self) -> list[tuple[Solved, ...]]:
        """On a compressed membrane, whose inertia depends on the mesh, the beginning only."""
        if self.compressed:
            return [tuple(level.bifurcation for level in self.levels)]
        return super()._locate()

    @cached_property
    def compressed(self) -> bool:
        """Whether a resultant is negative on the branch: wrinkles there are as fine as a mesh can show."""
        points = [Solved({}, point.state) for point in self.fine.points]
        return min(self._sampled(-1, p, self._grid())["T2"].min() for p in points) < 0

    def _grid(self) -> np.ndarray:
        """Points finer than the meshes, shape ``(n, 2)``."""
        z, theta = np.linspace(0, self.fine.model.data.length, GRID[0]), np.linspace(0, np.pi, GRID[1])
        return np.column_stack([part.ravel() for part in np.meshgrid(z, theta, indexing="ij")])

    def _lowest(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        """Lowest point and smallest resultant, from a grid finer than the meshes and a parabola there.

        What twice as coarse a grid would have found is taken for the error of that, besides the meshes'.
        """
        places = self._grid()
        found: dict[str, list[tuple[float, float]]] = {"z_min": [], "T_min": []}
        for k in range(len(self.levels)):
            sampled = self._sampled(k, solved[k], places)
            for name, column in (("z_min", "z"), ("T_min", "T2")):
                found[name].append(lowest_on_grid(sampled[column].reshape(GRID)))
        out = {}
        for name, rows in found.items():
            quantity = self._quantity([value for value, _ in rows])
            spread = quantity.uncertainty + max(missed for _, missed in rows)
            out[name] = Quantity(quantity.value, spread, quantity.order)
        return out

    def _sampled(self, k: int, solved: Solved, places: np.ndarray) -> dict[str, np.ndarray]:
        """Columns of a profile of one mesh's state at material points."""
        level = self.levels[k]
        level.system.set_state(solved.state.u, solved.state.loads)
        return level.model.readings(self._sampler(k, places)())

    def _profile(self, solved: Sequence[Solved], points: np.ndarray) -> Field:
        """Over ``Z`` and the meridians :data:`THETAS`, meridian after meridian at each ``Z``."""
        heights = np.unique(np.round(points, 12))  # several figures' points, equal but for round-off
        z, theta = (part.ravel() for part in np.meshgrid(heights, THETAS, indexing="ij"))
        grid = np.column_stack([z, theta])
        samples = [self._sampled(k, s, grid) for k, s in enumerate(solved)]
        columns: dict[str, np.ndarray] = {"Z": z, "Theta": theta}
        uncertainty = {"Z": 0.0, "Theta": 0.0}
        for name in samples[-1]:
            columns[name] = samples[-1][name]
            uncertainty[name] = estimate_in_norm([sample[name] for sample in samples], FIELD_CAP, FIELD_GUARD)
        return Field("profile", columns, uncertainty)


def lowest_on_grid(values: np.ndarray) -> tuple[float, float]:
    """Smallest value on a rectangular grid, by parabolas, and its distance from that of half the points."""
    fine, coarse = (_by_parabolas(grid) for grid in (values, values[::2, ::2]))
    return fine, abs(fine - coarse)


def _by_parabolas(values: np.ndarray) -> float:
    i, j = np.unravel_index(int(np.argmin(values)), values.shape)
    reach = 0.0
    for row, k in ((values[:, j], i), (values[i], j)):
        if 0 < k < len(row) - 1:
            left, here, right = row[k - 1 : k + 2]
            reach += (right - left) ** 2 / (8 * (left - 2 * here + right))
    return float(values[i, j] - reach)
