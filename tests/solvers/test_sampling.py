"""Largest values of polynomials on the cells of a mesh."""

import basix.ufl
import numpy as np
import pytest
from dolfinx import fem, mesh
from mpi4py import MPI

from weakforms.solvers.support.sampling import Peak, lowest_on_grid

DENSE = np.linspace(0.0, 1.0, 200_001)

ROUND_OFF = 1e-14
"""Two evaluations of the same polynomial of the sixth degree, near 1, may differ by this much."""


def peak_of(function, cells: int, degree: int) -> tuple[float, float]:
    """The largest value that is found, and that of dense samples of the same polynomials."""
    body = mesh.create_interval(MPI.COMM_SELF, cells, [0.0, 1.0])
    space = fem.functionspace(body, basix.ufl.element("Lagrange", "interval", degree, shape=(2,)))
    u = fem.Function(space)
    u.interpolate(lambda x: np.vstack([0 * x[0] + 9.0, function(x[0])]))
    points = np.column_stack([DENSE, 0 * DENSE, 0 * DENSE])
    cell = np.minimum((DENSE * cells).astype(np.int32), cells - 1)
    return Peak(u, 1)(), float(u.eval(points, cell)[:, 1].max())


SHAPES = {
    "inside of a cell": lambda x: 1 - (x - 0.37) ** 2,
    "between two cells": lambda x: 1 - (x - 0.25) ** 2,
    "just beside a node": lambda x: 1 - (x - 0.2501) ** 2,
    "at the end": lambda x: x + x**3,
    "at the start": lambda x: np.exp(-3 * x),
    "several, nearly equal": lambda x: np.sin(21 * x) * (1 + 1e-4 * x),
    "constant": lambda x: 0 * x + 0.7,
    "constant but for round-off": lambda x: 0.7 + 1e-16 * np.cos(40 * x),
    "negative": lambda x: -2 - np.cos(3 * x),
}


@pytest.mark.parametrize("degree", [1, 2, 4, 6])
@pytest.mark.parametrize("name", SHAPES)
def test_the_largest_value_is_that_of_dense_samples(name, degree):
    found, dense = peak_of(SHAPES[name], 8, degree)
    assert dense - ROUND_OFF <= found <= dense + 1e-8


def test_random_polynomials():
    """Of random waves, some with two peaks in a cell."""
    random = np.random.default_rng(3)
    for _ in range(30):
        a, k = random.standard_normal(4), random.uniform(1, 30, 4)
        found, dense = peak_of(lambda x, a=a, k=k: np.cos(np.outer(x, k) + a) @ a, 4, 5)
        assert dense - ROUND_OFF <= found <= dense + 1e-8


def test_a_value_that_is_no_number_is_infinite():
    assert peak_of(lambda x: np.where(x > 0.5, np.nan, x), 8, 2)[0] == np.inf


def test_the_lowest_value_of_a_grid_lies_between_its_points():
    """Exact for a paraboloid; the uncertainty is the difference from a grid with half as many points."""
    x, y = np.meshgrid(np.linspace(-1, 1, 41), np.linspace(-1, 1, 21), indexing="ij")
    low, apart = lowest_on_grid(2 * (x - 0.113) ** 2 + 3 * (y + 0.271) ** 2 - 0.5)
    assert low == pytest.approx(-0.5, abs=1e-13)
    assert apart < 1e-13
    rough = -np.cos(2 * (x - 0.113)) - np.cos(3 * (y + 0.271))
    low, apart = lowest_on_grid(rough)
    assert abs(low + 2) <= apart < 1e-2
    assert low < rough.min()


def test_the_lowest_value_at_an_edge_of_a_grid_is_that_of_its_point():
    x, y = np.meshgrid(np.linspace(0, 1, 9), np.linspace(0, 1, 9), indexing="ij")
    assert lowest_on_grid(x + (y - 0.3) ** 2)[0] == pytest.approx(0.0, abs=1e-13)
    assert lowest_on_grid((y - 0.3) ** 2 - x)[0] == pytest.approx(-1.0, abs=1e-13)
    assert lowest_on_grid((x - 0.3) ** 2 - y)[0] == pytest.approx(-1.0, abs=1e-13)
