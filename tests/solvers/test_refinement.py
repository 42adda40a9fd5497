"""The uncertainty of a number from several meshes bounds its error."""

from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest

from weakforms.results import Quantity
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.refinement import (
    ALGEBRAIC,
    Estimate,
    Slow,
    doubt,
    estimate,
    order_in_mean,
)


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


def test_an_order_known_from_elsewhere_counts_where_a_lower_one_is_observed():
    values = [1.0, 1.0001, 1.0201]  # the first difference is small by accident
    plain, known = (estimate(values, cap=4.0, least=least).uncertainty for least in (0.0, 3.0))
    assert known == pytest.approx(1.25 * 0.02 / 7, rel=1e-6)
    assert plain == pytest.approx(3 * 0.02, rel=1e-6)
    steady = [1.0 + 0.25**k for k in range(3)]
    assert estimate(steady, cap=4.0, least=1.0) == estimate(steady, cap=4.0)


@pytest.mark.parametrize("width", [1.0, 0.1, 0.01])
def test_a_slow_part_counts_where_it_shows(width):
    """An error of order 6 and a small one of order 1.5, which alone remains on fine meshes."""
    values = [1.0 + 0.3 * h**6 + 1e-9 * (h / width) ** 1.5 for h in width * 0.5 ** np.arange(3)]
    error, slow = values[-1] - 1.0, Slow(size=1e-8, order=2.0)
    found = estimate(values, 6.0, slow=slow).uncertainty
    assert error <= found <= 30 * error
    assert found - estimate(values, 6.0).uncertainty <= 1.25 * slow.size


@pytest.mark.parametrize("order", [1.0, 3.0, 5.5])
def test_order_of_a_field_does_not_heed_where_single_differences_vanish(order):
    x = np.linspace(0, 1, 201)
    levels = [np.cosh(x) + 1e-3 * np.sin((7 + k) * x) * 2.0 ** (-order * k) for k in range(4)]
    assert order_in_mean(levels) == pytest.approx(order, abs=0.3)


def test_order_of_a_field_is_unknown_from_two_meshes_or_from_round_off():
    x = np.linspace(1, 2, 11)
    assert order_in_mean([x, x + 1e-3]) == 0.0
    assert order_in_mean([x, x + 1e-3, x + 1e-3 + 1e-15]) == 0.0


def test_doubt_begins_where_a_field_falls_faster_than_its_elements():
    assert doubt([], 4.0) == doubt([2.0, 4.4], 4.0) == 1.0
    assert doubt([2.0, 4.75], 4.0) == pytest.approx(4**0.75)
    assert doubt([5.0], 4.0) == doubt([7.0], 4.0) == pytest.approx(4.0)


def test_one_mesh_is_refused():
    with pytest.raises(ValueError, match="two meshes"):
        estimate([1.0], cap=4.0)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((0.5, 0.1, 0.0), 1.25 * 0.1 / 3),  # order 2
        ((0.75, 0.25, 0.0), 1.25 * 0.25),  # order 1 exactly
        ((0.25 * (1 + 2**1.005), 0.25, 0.0), 1.25 * 0.25 / (2**1.005 - 1)),
        ((0.55, 0.25, 0.0), 3 * 0.25),  # below 1: divided by 2 - 1
        ((1.7, 0.1, 0.0), 1.25 * 0.1 / 15),  # order 4, the cap, where both differences count the same
        ((3.3, 0.1, 0.0), 1.25 * 0.2 / 15),  # faster than the cap: the first difference over 2^cap
        ((0.1, 0.0), 3 * 0.1),
    ],
)
def test_numbers_of_the_estimate(values, expected):
    assert estimate(list(values), cap=4.0).uncertainty == pytest.approx(expected + ALGEBRAIC, rel=1e-9)
    far = [1000 + v for v in values]
    assert estimate(far, cap=4.0).uncertainty == pytest.approx(expected + 1000 * ALGEBRAIC, rel=1e-9)


def test_a_number_of_a_result_has_the_error_that_is_left():
    found = Estimate(np.array(4.0), np.array(1e-3), np.array(2.0))
    plain, more = found.quantity(), found.quantity(0.01)
    assert (plain.value, plain.uncertainty, plain.order) == (4.0, 1e-3, 2.0)
    assert more.uncertainty == pytest.approx(1e-3 + 0.04, rel=1e-14)
    small = Estimate(np.array(0.5), np.array(0.0), np.array(np.nan)).quantity(0.01)
    assert (small.uncertainty, small.order) == (0.01, None)


def test_round_off_in_the_order_of_a_field():
    """Differences of 4e-11 and 2e-11 are above the round-off of fields up to 1, not of larger ones."""
    steps = np.array([6e-11, 2e-11, 0.0])
    assert order_in_mean([np.full(3, 0.5 + s) for s in steps]) == pytest.approx(1.0, abs=1e-4)
    assert order_in_mean([np.full(3, 8.0 + s) for s in steps]) == 0


def test_the_order_of_a_field_counts_where_that_of_a_point_is_accidental():
    """Differences of order 1 at a point, in a field of order 4; an order that is known is used as it is."""
    family = SimpleNamespace(_cap=lambda *_names: 4.0, least={"other": 4.0}, slow=None)
    values = [1.0 + 0.3, 1.0 + 0.1, 1.0]
    quantity = partial(BranchFamily._quantity, family, values)
    alone = estimate(values, 4.0).uncertainty
    assert quantity("x").uncertainty == pytest.approx(alone)
    assert quantity("x", in_mean=4.0).uncertainty == pytest.approx(
        1.5 * estimate(values, 4.0, None, 4.0).uncertainty
    )
    assert quantity("x", in_mean=4.0).uncertainty < alone / 5
    assert quantity("x", in_mean=0.5).uncertainty == pytest.approx(alone)
    assert quantity("other").uncertainty == pytest.approx(estimate(values, 4.0, least=4.0).uncertainty)
    assert quantity("x", most=2.0).uncertainty == pytest.approx(estimate(values, 2.0).uncertainty)


def test_a_count_that_is_the_same_on_all_meshes_has_no_uncertainty():
    family = SimpleNamespace(_cap=lambda *_names: 4.0, least={}, slow=None)
    assert BranchFamily._quantity(family, [1.0, 1.0], "n_held") == Quantity(1.0)
    assert BranchFamily._quantity(family, [0.0, 1.0], "n_held").uncertainty >= 1.0
    assert BranchFamily._quantity(family, [1.0, 1.0], "V").uncertainty > 0.0


def test_doubt_at_its_ends():
    assert doubt([3.0, 4.5], 4.0) == 1.0
    assert doubt([3.0, 4.502], 4.0) == pytest.approx(4**0.502, rel=1e-12)
    assert doubt([6.0], 4.0) == 4.0
    assert doubt([], 4.0) == 1.0
