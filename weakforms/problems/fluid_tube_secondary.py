"""Paper 3: the secondary branch, where the tube bends sideways, on a family of meshes.

See :mod:`weakforms.problems.fluid_tube_branching` for where it starts and how its stability is judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError
from weakforms.problems.base import Progress
from weakforms.problems.fluid_tube_branching import SecondaryBranch, secondary_branch
from weakforms.problems.fluid_tube_critical import PrimaryBranch
from weakforms.problems.fluid_tube_surface import SurfaceData
from weakforms.results import Field, Quantity, SpecialPoint
from weakforms.solvers.branch import Solved
from weakforms.solvers.family import BranchFamily
from weakforms.solvers.refinement import estimate, estimate_in_norm

if TYPE_CHECKING:
    from weakforms.problems.fluid_tube_problem import FluidTubeNumerics, FluidTubeParameters

CAP = 3.0
"""Highest order of convergence the uncertainties reckon with. The free surface cuts cells: the position's
third derivative jumps inside them, and the quadrature of the load's kink leaves an error of second order and
irregular sign that shows on fine meshes only."""

GRID = (161, 97)
"""Points along and around of the grid on which the smallest values on a surface are looked for."""

THETAS = np.linspace(0, np.pi, 25)
"""Meridians of a profile."""

COLUMNS = (
    "r_mid_pi",
    *(f"{name}_quarter_{side}" for name in ("x", "z", "T1", "T2") for side in ("0", "pi")),
)
"""Columns of the secondary branch that the primary one has not."""

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

    Reads ``secondary_cells``, ``secondary_degree``, ``secondary_levels``, ``secondary_step`` and
    ``secondary_end`` of the numerics.

    Raises:
        ConvergenceError: When the primary branch has no ``n = 1`` bifurcation point, or no branch is found
            there.
    """
    primary = PrimaryBranch(comm, parameters.L, parameters.delta, parameters.gamma, parameters.alpha)

    def make(level: int) -> SecondaryBranch:
        progress("secondary branch", level, numerics.secondary_levels)
        cells = numerics.secondary_cells // 2 ** (numerics.secondary_levels - 1 - level)
        data = surface_data(parameters, cells, numerics.secondary_degree)
        return secondary_branch(comm, data, primary, numerics.secondary_step, numerics.secondary_end)

    return SecondaryFamily(make, numerics.secondary_levels, CAP, ("zw", "r_mid"), "secondary")


def surface_data(parameters: FluidTubeParameters, cells: int, degree: int) -> SurfaceData:
    """The surface of a tube with so many cells along it, and on half its circumference."""
    given = parameters.L, parameters.delta, parameters.gamma, parameters.alpha
    return SurfaceData(*given, cells, cells, degree)


class SecondaryFamily(BranchFamily):
    """The secondary branch on a family of meshes."""

    fine: SecondaryBranch
    levels: list[SecondaryBranch]

    def special_points(self) -> list[SpecialPoint]:
        """As for any branch; the bifurcation point carries the branch's initial slopes."""
        points = super().special_points()
        slopes = [level.initial() for level in self.levels]
        for name in SLOPES:
            found = estimate([s[name] for s in slopes], self.cap)
            points[0].values[name] = float(found.value)
            points[0].uncertainty[name] = float(found.uncertainty)
        points[0].values["n"], points[0].uncertainty["n"] = 1.0, 0.0
        return points

    def _diagnostics(self, solved: Sequence[Solved], critical: float) -> dict[str, Quantity]:
        """Eigenvalues with uncertainties; the two finest meshes must count the same negative ones.

        The coarsest one is there for the order of convergence: on a long tube it is too coarse for the dry
        part.
        """
        spectra = [level.spectra(s.state, critical) for level, s in zip(self.levels, solved, strict=True)]
        out = self._lowest(solved)
        for name in spectra[-1]:
            values = [spectrum[name] for spectrum in spectra]
            if not name.startswith("n_negative"):
                out[name] = self._quantity(values)
            elif len(set(values[-2:])) > 1:
                raise ConvergenceError(f"stability depends on the mesh: {name} = {values}")
            else:
                out[name] = Quantity(values[-1])
        return out

    def _lowest(self, solved: Sequence[Solved]) -> dict[str, Quantity]:
        """Lowest point and smallest resultant, from a grid finer than the meshes and a parabola there.

        What twice as coarse a grid would have found is taken for the error of that, besides the meshes'.
        """
        z, theta = np.linspace(0, self.fine.model.data.length, GRID[0]), np.linspace(0, np.pi, GRID[1])
        places = np.column_stack([part.ravel() for part in np.meshgrid(z, theta, indexing="ij")])
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
        z, theta = (part.ravel() for part in np.meshgrid(points, THETAS, indexing="ij"))
        grid = np.column_stack([z, theta])
        samples = [self._sampled(k, s, grid) for k, s in enumerate(solved)]
        columns: dict[str, np.ndarray] = {"Z": z, "Theta": theta}
        uncertainty = {"Z": 0.0, "Theta": 0.0}
        for name in samples[-1]:
            columns[name] = samples[-1][name]
            uncertainty[name] = estimate_in_norm([sample[name] for sample in samples], self.cap)
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
