"""Polynomials through values at points."""

import numpy as np
import pytest

from weakforms.solvers.support.roots import polynomial_through

NODES = np.array([0.0, 0.3, 0.4, 1.0])


def cubic(x):
    return 2 - x + 3 * x**2 - 0.5 * x**3


@pytest.mark.parametrize("at", [-0.2, 0.05, 0.3, 0.77, 1.0])
def test_it_is_exact_for_polynomials_also_at_its_points(at):
    assert polynomial_through(NODES, cubic(NODES))(at) == pytest.approx(cubic(at), rel=1e-13)
    vectors = np.column_stack([cubic(NODES), -2 * cubic(NODES)])
    assert polynomial_through(NODES, vectors)(at) == pytest.approx(cubic(at) * np.array([1, -2]), rel=1e-13)


def test_it_is_the_same_to_the_last_bit_every_time():
    """SciPy's interpolator shuffles its points, so that two runs of a program differ."""
    values = np.random.default_rng(3).normal(size=(12, 50))
    points = (1 - np.cos(np.pi * (np.arange(12) + 0.5) / 12)) / 2
    first, second = (polynomial_through(points, values)(0.3141) for _ in range(2))
    assert np.array_equal(first, second)
