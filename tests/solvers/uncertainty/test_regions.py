"""A field's uncertainty by region holds at each point, and is small where the meshes resolve the field."""

import numpy as np
import pytest

from weakforms.solvers.uncertainty.refinement import estimate_in_norm
from weakforms.solvers.uncertainty.regions import Regions

DEGREE, CELLS, LEVELS = 4, (6, 4), 3
PLACES = np.linspace(0, 6, 241)[1:-1], np.linspace(0, 4, 7)


def field(x, y):
    """A peak near x = 1, y = 0, on something smooth; positions in cells of the coarsest mesh."""
    return np.sin(x / 3) * np.cos(y / 4) + 1 / (1 + 12 * (x - 1.1) ** 2 + 3 * y**2)


def interpolated(f, x, y, cells):
    """Elements of the mesh with so many times as many cells, through equidistant nodes."""
    nodes = np.arange(DEGREE + 1) / DEGREE
    parts = []
    for at, count in ((x, CELLS[0]), (y, CELLS[1])):
        cell = np.clip(np.floor(at * cells).astype(int), 0, count * cells - 1)
        local = at * cells - cell
        weights = [np.prod([(local - b) / (a - b) for b in nodes if b != a], axis=0) for a in nodes]
        parts.append((cell, np.array(weights)))
    (i, wx), (j, wy) = parts
    return sum(
        wx[a] * wy[b] * f((i + nodes[a]) / cells, (j + nodes[b]) / cells)
        for a in range(DEGREE + 1)
        for b in range(DEGREE + 1)
    )


@pytest.fixture(scope="module")
def found():
    """Positions, error on the finest mesh, uncertainty by region, and of the whole field."""
    x, y = (part.ravel() for part in np.meshgrid(*PLACES, indexing="ij"))
    regions = Regions(CELLS, x, y)
    sampled, on_grid = (
        [interpolated(field, *at, 2**k) for k in range(LEVELS)] for at in ((x, y), regions.grid)
    )
    local = regions.estimate(sampled, on_grid, DEGREE + 1)
    return x, y, np.abs(sampled[-1] - field(x, y)), local, estimate_in_norm(sampled, DEGREE + 1)


def test_errors_are_within_the_uncertainty_of_their_region(found):
    """Also at the peak, where the coarsest mesh is far off and a region's own order would be too high."""
    _, _, error, local, _ = found
    assert np.mean(error <= local) > 0.95
    assert np.all(error <= 2 * local)


def test_it_is_never_above_that_of_the_whole_field_and_far_below_away_from_the_peak(found):
    x, _, _, local, whole = found
    assert np.all(local <= whole)
    assert local.max() == whole
    assert local[x > 4].max() < whole / 1000


def test_a_difference_at_one_point_of_the_grid_counts_in_its_region_only():
    regions = Regions((6, 2), np.array([0.25, 1.0, 4.0]), np.array([1.0, 1.0, 1.0]))
    along, around = regions.grid
    assert len(along) == 49 * 17
    values = [np.zeros(len(along)), np.zeros(len(along))]
    values[1][np.argmin(np.hypot(along - 1.375, around - 1.25))] = 1.0
    local = regions.estimate([np.zeros(3), np.array([0.0, 0.0, 9.0])], values, 4.0)
    assert local[0] < 1e-9  # nothing in its region
    assert local[1] == pytest.approx(3, rel=1e-9)  # only the grid's point
    assert local[2] == pytest.approx(27, rel=1e-9)  # only the point itself


def test_the_order_of_a_region_is_at_least_one_and_at_most_that_of_the_field():
    """At the first point differences fall at the order 3, those of the field at 1/2: it counts as 1."""
    regions = Regions((6, 2), np.array([1.0, 4.0]), np.array([1.0, 1.0]))
    levels = [np.array(x) for x in ((5.9, 5 + 4 * (1 + 2**0.5)), (5.1, 9.0), (5.0, 5.0))]
    grid = [np.full(49 * 17, value) for value in (5.9, 5.1, 5.0)]
    local = regions.estimate(levels, grid, 4.0)
    assert local[0] == pytest.approx(1.25 * 0.1, rel=1e-9)
    assert local[1] == pytest.approx(3 * 4, rel=1e-9)
