"""Paper 3: the secondary branch, on which the tube bends sideways, on a family of meshes.

:mod:`weakforms.problems.liquid_tube.bent.bifurcation_point` computes its start,
:mod:`weakforms.problems.liquid_tube.bent.stability` its stability.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property, partial
from itertools import pairwise
from typing import ClassVar

import numpy as np
from mpi4py import MPI
from scipy.interpolate import CubicSpline

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.bifurcation_point import READINGS
from weakforms.problems.liquid_tube.bent.branch import SecondaryBranch, secondary_branch
from weakforms.problems.liquid_tube.bent.columns import RESULTANTS
from weakforms.problems.liquid_tube.bent.slopes import initial_slopes, slopes_beside_another_mode
from weakforms.problems.liquid_tube.bent.surface import SurfaceData
from weakforms.problems.liquid_tube.critical import AxisymmetricState, PrimaryBranch
from weakforms.problems.liquid_tube.parameters import FluidTubeNumerics, FluidTubeParameters
from weakforms.problems.meridian.kinks import EDGE, FRACTION
from weakforms.problems.problem import Progress
from weakforms.results import Field, Quantity, SpecialPoint
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import DIAGNOSTICS, Solved
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import Constraint
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.sampling import Sampler, lowest_on_grid
from weakforms.solvers.uncertainty.family import BranchFamily, Compared
from weakforms.solvers.uncertainty.regions import Regions

SUPERCONVERGENT = 2
"""Assumed order of numbers above the degree of the elements. Values at corners of quadrilaterals have at
least this order; integrals and eigenvalues have up to twice the degree."""

READ = 1
"""The same for resultants evaluated across elements, and for positions anywhere on the surface. Stretches and
resultants there are derivatives, and their order is the degree."""

GRID = (161, 97)
"""Numbers of points, along and around, of the grid for the smallest values on a surface."""

THETAS = np.linspace(0, np.pi, 25)
"""Meridians of a profile."""


def secondary_family(
    parameters: FluidTubeParameters,
    numerics: FluidTubeNumerics,
    comm: MPI.Intracomm,
    progress: Progress,
    kind: type[SecondaryFamily] | None = None,
) -> SecondaryFamily:
    """The secondary branch from its bifurcation point on all meshes.

    It uses the numerics whose names begin with ``secondary``.

    Args:
        parameters: The tube.
        numerics: Meshes.
        comm: Ranks.
        progress: Called for every mesh.
        kind: The class of the family, if it is another one.

    Raises:
        AbsentError: If the primary branch has no ``n = 1`` bifurcation point, or none where this family can
            begin.
        ConvergenceError: If no branch is found there.
    """
    given = parameters.L, parameters.delta, parameters.gamma, parameters.alpha
    primary = PrimaryBranch(comm, *given, parameters.other_law)
    begin = primary.bifurcation(np.linspace(0, parameters.L / parameters.delta, READINGS))
    kind = kind or SecondaryFamily
    kind.require_start(begin)
    made: list[SecondaryBranch] = []

    def make(level: int) -> SecondaryBranch:
        progress("secondary branch", level, numerics.secondary_levels)
        coarser = 2 ** (numerics.secondary_levels - 1 - level)
        data = SurfaceData(
            *given,
            numerics.secondary_cells // coarser,
            around(numerics) // coarser,
            numerics.secondary_degree,
            front=free_surface(begin),
            material=parameters.other_law,
            relaxed=parameters.energy == "relaxed",
        )
        step, end = numerics.secondary_step, numerics.secondary_end
        below = made[-1].trend if made else None
        made.append(secondary_branch(comm, data, primary, step, end, level == 0, below, kind.of))
        return made[-1]

    degree = numerics.secondary_degree
    caps = {column.name: float(degree + READ) for column in RESULTANTS} | {FRACTION: EDGE}
    cap = float(degree + SUPERCONVERGENT)
    return kind(make, numerics.secondary_levels, cap, ("zw", "r_mid"), "secondary", caps)


def around(numerics: FluidTubeNumerics) -> int:
    """Cells over half the circumference on the finest mesh: as requested, or two thirds of those along."""
    return numerics.secondary_around or 2 * numerics.secondary_cells // 3


def free_surface(of: AxisymmetricState) -> float:
    """Material point at which the free surface meets an axisymmetric membrane, or its end if it is full."""
    height = CubicSpline(of.Z, of.z - of.values["zw"])
    return float(height.roots(extrapolate=False).max(initial=0.0)) or float(of.Z[-1])


class SecondaryFamily(BranchFamily):
    """The secondary branch on a family of meshes.

    It is traced on the coarsest mesh. A state is solved for on this mesh, fitted to the state, and then on
    every finer mesh from the one before.
    """

    fine: SecondaryBranch
    levels: list[SecondaryBranch]
    traced_on_finest = False
    judges_points = False
    of: ClassVar[type[SecondaryBranch]] = SecondaryBranch
    """The class of the branch on each mesh."""

    @classmethod
    def require_start(cls, begin: AxisymmetricState) -> None:
        """Refuse a bifurcation at which the branch cannot begin; this one can at any."""

    def _comparisons(self) -> Iterator[Callable[[], Compared]]:
        """The points of the coarsest mesh's trace, each solved for on all meshes in a plane across it."""
        return (partial(self._on_all, point) for point in self.levels[0].points)

    def _on_all(self, point: CurvePoint) -> Compared:
        """A point of the trace on all meshes, with the number of negative eigenvalues on the finest."""
        try:
            solved, marks = self._solved_on_all(point)
        except ConvergenceError as error:
            raise ConvergenceError(f"{error}; raise secondary_cells, or secondary_end") from error
        own = {name: solved[-1].values[name] for name in self.fine.shown}
        return [s.values for s in solved], own | dict(zip(DIAGNOSTICS, map(float, marks), strict=True))

    def _solved_on_all(self, point: CurvePoint) -> tuple[list[Solved], list[float]]:
        fine, first = self.fine, self.levels[0].points[0]
        if point is first:
            record, negative = fine.points[0].record, first.n_negative
            solved = [level.bifurcation for level in self.levels]
        else:
            begin, plane = self.levels[0].across(point, self.across)
            near = point.arclength / self.levels[0].points[-1].arclength
            solved = self._raised(begin, plane, lambda level: level.at_position(point, plane.weights, near))
            record, negative = fine.fitting.record, self._negative_count(point, solved[-1].state)
        return solved, [negative, record.norms[-1], record.iterations]

    def _negative_count(self, point: CurvePoint, state: State) -> int:
        """Number of negative eigenvalues of a point of the trace on the finest mesh, at its state there.

        The last factorised tangent is from an iterate that is at most as far off as the coarser mesh's state.
        If it has as many negative eigenvalues as the coarsest mesh, none is near zero, and the count holds
        for the state too.
        """
        factor = self.fine.solver.factor
        if factor.stiffened is not None or factor.negative_count() != point.n_negative:
            with self.fine.system.at(state):
                factor.update()
        return factor.negative_count()

    def _raised(
        self, begin: Solved, constraint: Constraint, own: Callable[[SecondaryBranch], Solved]
    ) -> list[Solved]:
        """A state of the coarsest mesh on all meshes.

        Args:
            begin: The state.
            constraint: The equation that it satisfies.
            own: Finds it by a trace on the same mesh, if the coarser mesh's state is not a good guess: on a
                slack membrane it may be far off.
        """
        solved = [begin]
        for below, level in pairwise(self.levels):
            guess = level.fitting.taken(below.fitting, solved[-1].state)
            try:
                solved.append(level.at_guess(guess, constraint))
            except ConvergenceError:
                if len(level.points) == 1:
                    level.follow()
                solved.append(own(level))
        return solved

    def special_points(self) -> list[SpecialPoint]:
        """As for any branch; the bifurcation point has the branch's initial slopes as values."""
        points = super().special_points()
        find = initial_slopes if self.levels[0].trend.alone else slopes_beside_another_mode
        slopes = find(self.levels, self.cap)
        for name, (value, uncertainty) in slopes.items():
            points[0].values[name], points[0].uncertainty[name] = value, uncertainty
        points[0].values["n"], points[0].uncertainty["n"] = 1.0, 0.0
        return points

    def _at(self, name: str, value: float, crossing: int) -> list[Solved]:
        """The state on the coarsest mesh by its trace, and on every other mesh from the one before."""
        begin = self.levels[0].at(name, value, crossing)
        return self._raised(begin, Held(name, value), lambda level: level.at(name, value, crossing))

    def _locate(self) -> list[tuple[Solved, ...]]:
        """The first point, and further special points of the coarsest mesh's trace if all meshes have them.

        On a compressed membrane, whose inertia depends on the mesh, only the first point.
        """
        beginning = [tuple(level.bifurcation for level in self.levels)]
        counts = {point.n_negative for point in self.levels[0].points}
        if len(counts) == 1 and not len(self.levels[0].turns()):
            return beginning
        for level in self.levels[1:]:
            level.follow()
        return beginning if self.compressed else super()._locate()

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Lowest point, smallest resultant, and eigenvalues with uncertainties.

        A compressed membrane wrinkles as finely as the mesh allows. Only the lowest eigenvalue at fixed
        level, far below the eigenvalues of the wrinkles, then converges, and no other is given. The same is
        done if a resultant may be negative within its uncertainty, and spectra fail or depend on the mesh.
        """
        out = self._lowest(solved)
        least = out["T_min"]
        if least.value + least.uncertainty < 0:
            return out | self._lowest_eigenvalue(solved)
        try:
            return out | self._spectra(solved, critical)
        except ConvergenceError:
            if least.value - least.uncertainty > 0:
                raise
            return out | self._lowest_eigenvalue(solved)

    def _lowest_eigenvalue(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        at = f"secondary branch, zw = {solved[-1].values['zw']:.6g}"
        self.warnings.append(
            f"{at}: the tube is or may be compressed (T_min); the number of negative eigenvalues depends on "
            "the mesh, and only the lowest one is given"
        )
        lowest = [level.stability.lowest(s.state) for level, s in zip(self.levels, solved, strict=True)]
        return {"Lambda_1": self._quantity(lowest)}

    def _spectra(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Eigenvalues; the two finest meshes must have the same number of negative ones.

        The coarsest mesh serves only for the order of convergence, because on a long tube it is too coarse
        for the dry part.
        """
        spectra: list[dict[str, float]] = []
        for level, s in zip(self.levels, solved, strict=True):
            level.solver.factor.release()  # one factorisation of a large surface at a time
            spectra.append(level.stability.spectra(s.state, critical, spectra[-1] if spectra else None))
        out = {}
        for name in spectra[-1]:
            values = [spectrum[name] for spectrum in spectra]
            if not name.startswith("n_negative"):
                out[name] = self._quantity(values)
            elif len(set(values[-2:])) > 1:
                raise ConvergenceError(f"stability depends on the mesh: {name} = {values}")
            else:
                out[name] = Quantity(values[-1])
        return out

    @cached_property
    def compressed(self) -> bool:
        """Whether a resultant is negative on the branch, so that wrinkles are as fine as the mesh allows."""
        points = [Solved({}, point.state) for point in self.fine.points]
        return min(self._sampled(-1, p, self._grid())["T2"].min() for p in points) < 0

    def _grid(self) -> np.ndarray:
        """Points ``(X, Theta)`` of the original meshes, closer than cells, shape ``(n, 2)``."""
        z, theta = np.linspace(0, self.fine.model.data.length, GRID[0]), np.linspace(0, np.pi, GRID[1])
        return np.column_stack([part.ravel() for part in np.meshgrid(z, theta, indexing="ij")])

    def _lowest(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        """Lowest point and smallest resultant, from a grid finer than the meshes and parabolas.

        The difference from a grid twice as coarse estimates the error of the grid; the error of the meshes is
        added.
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
        """Columns of a profile of one mesh's state at points of the original mesh."""
        level = self.levels[k]
        with level.system.at(solved.state):
            return level.model.readings(self._sampler(k, places)())

    def _sampled_at(self, k: int, solved: Solved, z: np.ndarray, theta: np.ndarray) -> dict[str, np.ndarray]:
        """The same at material points, whose position in the mesh depends on the state."""
        model = self.levels[k].model
        with model.system.at(solved.state):
            places = np.column_stack([model.front.mesh(z, theta), theta])
            return model.readings(Sampler(model.unknown, model.formulation.profile, places)())

    def _profile(self, solved: Sequence[Solved], points: np.ndarray) -> Field:
        """Profile over ``Z`` and the meridians :data:`THETAS`, meridian after meridian at each ``Z``."""
        heights = np.unique(np.round(points, 12))  # points of several figures, equal up to round-off
        z, theta = (part.ravel() for part in np.meshgrid(heights, THETAS, indexing="ij"))
        regions, places = self._regions(solved[0], z, theta)
        samples, grids = (
            [self._sampled_at(k, s, *at) for k, s in enumerate(solved)] for at in ((z, theta), places)
        )
        columns: dict[str, np.ndarray] = {"Z": z, "Theta": theta}
        uncertainty: dict[str, float | np.ndarray] = {"Z": 0.0, "Theta": 0.0}
        for name in samples[-1]:
            columns[name] = samples[-1][name]
            cap = self.fine.model.data.degree + (READ if name in "xyz" else 0)
            levels, on_grid = ([sample[name] for sample in of] for of in (samples, grids))
            uncertainty[name] = regions.estimate(levels, on_grid, float(cap))
        return Field("profile", columns, uncertainty)

    def _regions(
        self, coarse: Solved, z: np.ndarray, theta: np.ndarray
    ) -> tuple[Regions, tuple[np.ndarray, np.ndarray]]:
        """Regions around material points, and the material points of their grid.

        Cells are those of the coarsest mesh, whose row for the free surface is on the surface.
        """
        model = self.levels[0].model
        with model.system.at(coarse.state):
            nodes, angles = model.nodes, np.linspace(0, np.pi, model.data.around + 1)
            numbers = [np.arange(len(t), dtype=float) for t in (nodes, angles)]
            along = np.interp(model.front.mesh(z, theta), nodes, numbers[0])
            regions = Regions((len(nodes) - 1, len(angles) - 1), along, np.interp(theta, angles, numbers[1]))
            x, turned = (
                np.interp(at, n, t) for at, n, t in zip(regions.grid, numbers, (nodes, angles), strict=True)
            )
            return regions, (model.front.material(x, turned), turned)
