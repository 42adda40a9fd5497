"""Statements are decided with a margin: wrong, uncertain, non-finite or missing values do not hold."""

from math import inf, nan

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from weakforms.verification.judging import decide
from weakforms.verification.judging.decide import CLEAR, ROUNDING, Number, Stated
from weakforms.verification.judging.numbers import join, number, stack

WORD = Stated(0.05, "nearly equal", "the width of a line in figure 7")
VALUES = st.floats(-1e3, 1e3).filter(lambda v: abs(v) > 1e-3)
SMALL = st.floats(1e-12, 1e-8)
ASKED = 1e-6

RIGHT = {
    "agree": lambda u: decide.agree("x", Number(2.0, u), 2.0, ASKED),
    "zero": lambda u: decide.zero("x", Number(0.0, u), ASKED),
    "constant": lambda u: decide.constant("x", Number([2.0, 2.0], u), ASKED),
    "positive": lambda u: decide.positive("x", Number(2.0, u)),
    "negative": lambda u: decide.negative("x", Number(-2.0, u)),
    "not_negative": lambda u: decide.not_negative("x", Number([0.0, 1.0], u), ASKED, 0.5),
    "rises": lambda u: decide.rises("x", Number([1.0, 2.0, 3.0], u)),
    "falls": lambda u: decide.falls("x", Number([3.0, 2.0, 1.0], u)),
    "less": lambda u: decide.less("x", 1.0, Number(2.0, u), 3.0),
    "at_most": lambda u: decide.at_most("x", Number(0.04, u), WORD),
    "at_least": lambda u: decide.at_least("x", Number(0.06, u), WORD),
    "between": lambda u: decide.between("x", Number(0.5, u), 0.0, 1.0),
    "order": lambda u: decide.order("x", (8, 16), Number([1.6e-1, 1e-2], u), 4),
}
WRONG = {
    "agree": lambda v: decide.agree("x", Number(v, 1e-9), 2.0, ASKED),
    "zero": lambda v: decide.zero("x", Number(v, 1e-9), ASKED),
    "constant": lambda v: decide.constant("x", Number([2.0, v], 1e-9), ASKED),
    "positive": lambda v: decide.positive("x", Number([2.0, v], 1e-9)),
    "negative": lambda v: decide.negative("x", Number([-2.0, v], 1e-9)),
    "not_negative": lambda v: decide.not_negative("x", Number([0.0, v], 1e-9), ASKED, 0.5),
    "rises": lambda v: decide.rises("x", Number([1.0, v, 3.0], 1e-9)),
    "falls": lambda v: decide.falls("x", Number([3.0, v, 1.0], 1e-9)),
    "at_most": lambda v: decide.at_most("x", Number(v, 1e-9), WORD),
    "at_least": lambda v: decide.at_least("x", Number(v, 1e-9), WORD),
    "between": lambda v: decide.between("x", Number(v, 1e-9), 0.0, 1.0),
    "exact": lambda v: decide.exact("x", v, 0.5),
    "order": lambda v: decide.order("x", (8, 16), Number([1e-1, v], 1e-9), 4),
}
SATISFIED = {
    "agree": 2.0, "zero": 0.0, "constant": 2.0, "positive": 2.0, "negative": -2.0, "rises": 2.0, "falls": 2.0,
    "not_negative": -1e-9, "at_most": 0.04, "at_least": 0.06, "between": 0.5, "exact": 0.5,
    "order": 1e-1 / 16,
}  # fmt: skip
VIOLATED = {
    "agree": 2.1, "zero": 0.1, "constant": 2.1, "positive": -1.0, "negative": 1.0, "rises": 4.0, "falls": 4.0,
    "not_negative": -3e-9, "at_most": 0.06, "at_least": 0.04, "between": 1.5, "exact": 0.6,
    "order": 1e-1 / 8,
}  # fmt: skip


@pytest.mark.parametrize("name", RIGHT)
def test_what_holds_does_not_hold_with_a_wide_uncertainty(name):
    assert RIGHT[name](1e-9).holds
    for wide in (10.0, 1e3, inf, nan, -1.0):
        assert not RIGHT[name](wide).holds


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_or_no_number_does_not_hold(name):
    assert WRONG[name](SATISFIED[name]).holds
    for value in (VIOLATED[name], nan):
        assert not WRONG[name](value).holds
    if name not in ("at_least", "not_negative"):
        assert not WRONG[name](-inf if name in ("positive", "rises") else inf).holds


EMPTY = Number([], [])


@pytest.mark.parametrize(
    "found",
    [
        decide.agree("x", EMPTY, EMPTY, ASKED),
        decide.zero("x", EMPTY, ASKED),
        decide.constant("x", EMPTY, ASKED),
        decide.constant("x", Number([1.0], [1e-9]), ASKED),
        decide.exact("x", [], []),
        decide.positive("x", EMPTY),
        decide.negative("x", EMPTY),
        decide.not_negative("x", EMPTY, ASKED, 1.0),
        decide.rises("x", EMPTY),
        decide.falls("x", Number([1.0], [1e-9])),
        decide.at_most("x", EMPTY, WORD),
        decide.at_least("x", EMPTY, WORD),
        decide.between("x", EMPTY, 0.0, 1.0),
        decide.order("x", (), EMPTY, 2),
        decide.order("x", (8,), Number([1e-3], [1e-9]), 2),
        decide.every("x", []),
        decide.same("x", [], []),
        decide.all_of(),
        decide.all_of([]),
    ],
)
def test_a_statement_about_nothing_does_not_hold(found):
    assert not found.holds


@given(VALUES, SMALL, SMALL, st.floats(0, 4))
def test_agreement_ends_at_twice_the_combined_uncertainty(value, one, two, times):
    assume(abs(times - 2) > 1e-3)
    combined = float(np.hypot(one, two))
    gap = times * combined
    assume(abs(value) * 1e-14 < 1e-4 * combined)
    found = decide.agree("x", Number(value + gap, one), Number(value, two), 1.0)
    assert found.holds is (times < 2)


@given(VALUES, SMALL, st.floats(0.1, 10))
def test_agreement_needs_a_bound_sharper_than_asked(value, uncertainty, share):
    assume(abs(share - 1) > 1e-6)
    bound = 2 * uncertainty / abs(value)
    assert decide.agree("x", Number(value, uncertainty), value, share * bound).holds is (share > 1)


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_what_may_be_zero_needs_an_uncertainty_small_beside_its_scale(share):
    found = decide.not_negative("x", Number([0.0, 1.0], share * ASKED * 3.0 / 2), ASKED, 3.0)
    assert found.holds is (share < 1)
    assert "at least 0, bound " in found.detail


@given(st.floats(-20, 20), SMALL)
def test_a_sign_is_clear_of_zero_by_ten_uncertainties(times, uncertainty):
    assume(abs(abs(times) - CLEAR) > 1e-6)
    found = Number(times * uncertainty, uncertainty)
    assert decide.positive("x", found).holds is (times > CLEAR)
    assert decide.negative("x", found).holds is (times < -CLEAR)
    assert not (decide.positive("x", found).holds and decide.zero("x", found, 1.0).holds)


@given(st.lists(st.floats(-5, 5), min_size=2, max_size=6))
def test_an_order_is_that_of_the_numbers(values):
    assume(np.min(np.abs(np.diff(values))) > 1e-6)
    found = Number(values, 1e-9)
    assert decide.rises("x", found).holds is (values == sorted(values))
    assert decide.falls("x", found).holds is (values == sorted(values, reverse=True))


@given(st.floats(0.5, 6.0), st.integers(1, 6))
def test_an_order_of_convergence_is_measured(rate, expected):
    assume(abs(rate - expected + decide.ORDER_SLACK) > 1e-6)
    errors = np.array([0.1, 0.1 * 2.0**-rate])
    assert decide.order("x", (8, 16), Number(errors, 1e-9), expected).holds is (
        rate > expected - decide.ORDER_SLACK
    )
    assert not decide.order("x", (8, 16), Number(errors, errors / 5), expected).holds


def test_one_failing_statement_fails_all_and_is_named():
    good, bad = decide.same("folds", 2, 2), decide.same("cusps", 1, 2)
    assert decide.all_of(good, [good]).holds
    found = decide.all_of(good, [good, bad])
    assert not found.holds
    assert found.detail == "FAILS: cusps: 1, expected 2"
    assert decide.all_of([good] * 30, decide.same("cusps", 1, 1)).detail == (
        f"{good.detail} (30 times); {decide.same('cusps', 1, 1).detail}"
    ), "what is said again is counted"


def test_a_stated_size_is_told_with_its_reason():
    assert (
        "0.05, for “nearly equal” (the width of a line in figure 7)" in decide.at_most("x", 0.01, WORD).detail
    )


def test_counts_and_masks():
    assert decide.every("stable", np.array([True, True])).holds
    assert not decide.every("stable", [True, False]).holds
    assert not decide.every("stable", np.array([1.0, 2.0])).holds
    assert not decide.same("pattern", [1, nan], [1, 1]).holds


def test_rounding_is_all_that_is_left_of_an_identity():
    assert decide.exact("x", [1 + ROUNDING / 2], [1.0]).holds
    assert not decide.exact("x", [1 + 3 * ROUNDING], [1.0]).holds


# -- numbers ---------------------------------------------------------------------------------------


@given(VALUES, VALUES, SMALL, SMALL)
def test_uncertainties_pass_through_arithmetic_to_first_order(a, b, u, v):
    x, y = Number(a, u), Number(b, v)
    for found, rates in (
        (x + y, (1, 1)),
        (x - y, (1, 1)),
        (x * y, (b, a)),
        (x / y, (1 / b, a / b**2)),
        (x**2, (2 * a, 0)),
        (1 / x, (1 / a**2, 0)),
        (3 - x, (1, 0)),
    ):
        assert found.uncertainty == pytest.approx(np.hypot(rates[0] * u, rates[1] * v), rel=1e-9)
    assert (np.array([1.0, 2.0]) * x).uncertainty == pytest.approx([u, 2 * u])


def test_what_may_be_zero_has_neither_reciprocal_nor_logarithm():
    assert np.isnan((1 / Number(1.0, 2.0)).uncertainty)
    assert np.isnan(Number(1.0, 2.0).log().uncertainty)
    assert Number(2.0, 1e-3).log().uncertainty == pytest.approx(5e-4)


def test_numbers_are_not_compared_without_their_uncertainty():
    x = Number(1.0, 0.1)
    for compare in (lambda: x < 2, lambda: x >= 0, lambda: bool(x), lambda: max(x, x)):
        with pytest.raises(TypeError):
            compare()


def test_numbers_are_stacked_and_joined():
    assert stack([number(1), Number(2.0, 0.1)]).uncertainty.tolist() == [0, 0.1]
    assert join([Number([1, 2], 0.2), 3.0]).value.tolist() == [1, 2, 3]
    assert Number([1.0, 3.0], [0.1, 0.2]).largest().uncertainty == 0.2
    assert Number([1.0, 3.0], [0.1, 0.2]).smallest().value == 1.0


@pytest.mark.parametrize(("value", "holds"), [(0.5, False), (0.7, True), (1.1, False)])
def test_what_lies_between_lies_above_the_lower_end_too(value, holds):
    assert decide.between("x", Number(value, 1e-9), 0.6, 1.0).holds is holds


@pytest.mark.parametrize(
    ("cells", "errors"), [((8, 16), [1e-1, 1e-3]), ((8, 16, 32, 64), [1e-1, 1e-2, 1e-3]), ((), [])]
)
def test_too_few_errors_show_no_mean_order(cells, errors):
    found = decide.mean_order("x", cells, Number(errors, 1e-9), 2.0)
    assert (found.holds, "show no mean order" in found.detail) == (False, True)
    assert decide.mean_order("x", (8, 16, 32), Number([1e-1, 1e-2, 1e-3], 1e-9), 2.0).holds


def test_work_is_the_integral_of_the_force_along_its_path():
    nodes = 2 + np.cos(np.pi * np.arange(8, -1, -1) / 8)
    found = decide.work(nodes, nodes**2, nodes**3)
    assert found.value == pytest.approx(3 / 5 * (3**5 - 1), rel=1e-13)
    assert found.uncertainty < 1e-10
    rough = decide.work(nodes, np.exp(3 * nodes), nodes)
    assert abs(rough.value - (np.exp(9) - np.exp(3)) / 3) < rough.uncertainty
