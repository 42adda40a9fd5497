"""Uncertainty of a field by region.

One uncertainty in the maximum norm (:func:`refinement.estimate_in_norm`) is that of the field's worst place.
Here the differences of the meshes in a region around each point determine the uncertainty in the same way.
The region reaches one cell of the coarsest mesh to each side: it contains whole periods of what oscillates
within cells, and the cells next to that of the point. Differences of equilibria also contain what the worst
place causes elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from weakforms.solvers.uncertainty.refinement import estimate

HALF = 1.0
"""Half the size of a region, in cells of the coarsest mesh. With 0.5, errors of up to 3.8 uncertainties are
found next to the foot of the bulge of a long tube, where differences have not reached their order yet."""

SAMPLES = 8
"""Points in each cell of the coarsest mesh, in each direction: two in a cell of the third mesh."""


@dataclass(frozen=True)
class Regions:
    """Points of a sheet at which a field is requested, and a grid on which the meshes are compared.

    Positions are in cells of the coarsest mesh: those of the grid are multiples of ``1/SAMPLES``.

    Attributes:
        counts: Numbers of cells of the coarsest mesh in both directions.
        along: Positions of the requested points in the first direction ...
        around: ... and in the second one.
    """

    counts: tuple[int, int]
    along: np.ndarray
    around: np.ndarray

    @property
    def grid(self) -> tuple[np.ndarray, np.ndarray]:
        """Positions of the grid in both directions, flat, the second one running faster."""
        ticks = [np.arange(SAMPLES * n + 1) / SAMPLES for n in self.counts]
        along, around = np.meshgrid(*ticks, indexing="ij")
        return along.ravel(), around.ravel()

    def estimate(self, levels: list[np.ndarray], on_grid: list[np.ndarray], cap: float) -> np.ndarray:
        """Uncertainty at each requested point: of its region, and no more than of the whole field.

        In a region that the coarsest mesh does not resolve, differences may decrease faster than they will on
        finer meshes. The order of a region is thus at most that of the whole field.

        Args:
            levels: Values at the requested points, from coarse to fine; two or more.
            on_grid: Values on the grid, likewise.
            cap: Highest order of the method.
        """
        whole = estimate(_like([np.max(np.abs(b - a)) for a, b in pairwise(levels)], levels[-1]), cap)
        highest = float(np.clip(whole.order, 1.0, cap)) if np.isfinite(whole.order) else cap
        shape = tuple(SAMPLES * n + 1 for n in self.counts)
        windows = [self._window(i) for i in range(len(self.along))]
        steps = []
        for k in range(len(levels) - 1):
            own = np.abs(levels[k + 1] - levels[k])
            near = np.abs(on_grid[k + 1] - on_grid[k]).reshape(shape)
            steps.append(np.maximum(own, [near[window].max() for window in windows]))
        local = estimate(_like(steps, levels[-1]), highest, guard=cap)
        return np.minimum(whole.uncertainty, local.uncertainty)

    def _window(self, i: int) -> tuple[slice, slice]:
        """Rows and columns of the grid in the region of a requested point."""
        places = float(self.along[i]), float(self.around[i])
        return tuple(
            slice(max(0, math.floor((x - HALF) * SAMPLES)), math.ceil((x + HALF) * SAMPLES) + 1)
            for x in places
        )


def _like(steps: Sequence[np.ndarray], finest: np.ndarray) -> list[np.ndarray]:
    """Values of the size of a field, from coarse to fine, with given differences."""
    size = float(np.max(np.abs(finest)))
    return [size + np.sum(np.asarray(steps[k:]), axis=0) for k in range(len(steps) + 1)]
