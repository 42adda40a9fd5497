"""The uncertainty of a number from meshes holds what it says."""

import numpy as np
import pytest

from weakforms.solvers.refinement import ALGEBRAIC, estimate


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0, 8.0])
@pytest.mark.parametrize("exact", [0.0, 1.0, -250.0])
def test_true_error_lies_within_and_not_far_below(order, exact):
    values = [exact + 0.3 * 0.25**order * 2.0 ** (-order * k) for k in range(3)]
    found = estimate(values, cap=8.0)
    error = abs(values[-1] - exact)
    assert error <= found.uncertainty <= 30 * error + 2 * ALGEBRAIC * max(abs(exact), 1)
    assert found.order == pytest.approx(order, abs=0.02) or error < 1e-8


def test_arrays_are_estimated_point_by_point():
    x = np.linspace(0, 1, 5)
    levels = [np.sin(x) + np.cos(3 * x) * 4.0**-k for k in range(3)]
    found = estimate(levels, cap=4.0)
    assert found.uncertainty.shape == x.shape
    assert np.all(np.abs(levels[-1] - np.sin(x)) <= found.uncertainty)


def test_accidental_agreement_of_two_meshes_does_not_pass_for_accuracy():
    values = [1.0, 1.1, 1.1]
    assert estimate(values, cap=2.0).uncertainty >= 0.1 / 4 / 3


def test_an_order_beyond_theory_is_not_believed():
    assert estimate([1.0, 1.1, 1.1001], cap=2.0).uncertainty >= 0.1 / 4 / 3


def test_divergence_widens():
    assert estimate([1.0, 1.1, 1.4], cap=4.0).uncertainty >= 0.3 * 3


def test_two_meshes_are_taken_to_converge_at_first_order():
    found = estimate([1.0, 1.1], cap=4.0)
    assert found.uncertainty >= 0.3
    assert np.isnan(found.order)


def test_one_mesh_is_refused():
    with pytest.raises(ValueError, match="two meshes"):
        estimate([1.0], cap=4.0)
