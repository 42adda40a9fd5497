"""Printed numbers: each is classified as stated, and none proves what it cannot prove."""

from math import inf, nan
from types import SimpleNamespace

import pytest

from weakforms import CutOff, Misprint, OnGrid, Printed, PrintedExact, PrintedInput, PrintedState, tube
from weakforms.results import Quantity
from weakforms.verification.cases.specs import At

SPEC, AT = tube(alpha=0.1), At("p", 1.5)
HOSTILE = [(nan, 1e-9), (42.0, 1e-9), (1e9, 1e-9), (inf, 0.0), (nan, nan)]
CUT, GRID = CutOff(), OnGrid("0.05", upwards=True)
WRONG = Misprint("0.5569", "the digits are swapped")


def entry_of(check, **known):
    """Verdict and ledger entry of a check on given solutions."""
    verdict, entry = check.judge(2, SimpleNamespace(**known))
    return verdict.passed, entry.status


def printed(text, reading, value, uncertainty):
    point = SimpleNamespace(values={"p": value}, uncertainty={"p": uncertainty})
    check = Printed("p", text, SPEC, "limit_point", "p", "figure 3", reading=reading)
    return entry_of(check, points=lambda *_: [point])


@pytest.mark.parametrize(
    ("text", "reading", "value", "uncertainty", "passes"),
    [
        ("2.50", None, 2.5, 1e-9, True),
        ("2.50", None, 2.6, 1e-9, False),
        ("0.5568", CUT, 0.55688, 1e-9, True),
        ("0.5568", CUT, 0.55684, 1e-9, False),  # that is rounded
        ("0.5568", CUT, 0.55694, 1e-9, False),
        ("0.5568", CUT, 0.55688, 6e-6, False),  # wider than a tenth of half a digit
        ("-0.5568", CUT, -0.55688, 1e-9, True),
        ("1.25", GRID, 1.265, 1e-9, True),
        ("1.25", GRID, 1.235, 1e-9, False),  # on the other side
        ("1.25", GRID, 1.31, 1e-9, False),  # a step away
        ("1.25", GRID, 1.2501, 1e-9, False),  # that is rounded
        ("1.26", GRID, 1.275, 1e-9, False),  # on no grid of this step
        ("1.25", GRID, 1.265, 6e-4, False),
        ("0.5596", WRONG, 0.55688, 1e-9, True),
        ("0.5596", WRONG, 0.55962, 1e-9, False),
        ("0.5596", WRONG, 0.55678, 1e-9, False),  # nor what it should be
        ("0.5596", WRONG, 0.55688, 6e-6, False),
        ("0.5569", WRONG, 0.55688, 1e-9, False),  # printed as it should be
    ],
)
def test_a_printed_number_is_what_it_is_stated_to_be(text, reading, value, uncertainty, passes):
    passed, status = printed(text, reading, value, uncertainty)
    assert passed is passes
    stated = "reproduced" if reading is None else reading.status
    refused = "not reproduced" if reading is None else f"{reading.status}, not proven"
    assert status == (stated if passes else refused)
    assert stated == {None: "reproduced", CUT: "cut off", GRID: "grid of a scan", WRONG: "misprint"}[reading]


@pytest.mark.parametrize("reading", [None, CUT, GRID, WRONG])
@pytest.mark.parametrize(("value", "uncertainty"), HOSTILE)
def test_no_hostile_number_proves_anything(reading, value, uncertainty):
    assert not printed("1.25", reading, value, uncertainty)[0]


@pytest.mark.parametrize(
    ("text", "reading", "value"),
    [("0.5568", CUT, 0.55688), ("1.25", GRID, 1.265), ("0.5596", WRONG, 0.55688)],
)
@pytest.mark.parametrize("uncertainty", [1e6, nan, inf, -1.0])
def test_no_wide_uncertainty_proves_anything(text, reading, value, uncertainty):
    assert printed(text, reading, value, 1e-9)[0]
    assert not printed(text, reading, value, uncertainty)[0]


@pytest.mark.parametrize(
    ("exact", "reading", "passes"),
    [
        (0.81642, None, True),
        (0.8165, None, False),
        (1.5**-0.5, CUT, True),
        (0.8164, CUT, False),
        (nan, CUT, False),
    ],
)
def test_a_closed_form_is_held_to_the_digits_too(exact, reading, passes):
    check = PrintedExact("delta2", "0.8164", exact, "by hand", "results", reading)
    passed, _ = entry_of(check)
    assert passed is passes


def decoded(value, uncertainty, stated, searched=(0.5, 0.51, 0.52)):
    check = PrintedInput("p", "1.5", SPEC, AT, "t0", searched, 3e-3, "legend", decoded=stated)
    return entry_of(check, quantity=lambda *_: Quantity(value, uncertainty))[0]


def test_an_input_is_decoded_only_at_a_value_searched():
    assert decoded(0.5101, 1e-9, True)
    assert not decoded(0.515, 1e-9, True)
    assert not decoded(0.5101, 1e-3, True)


def test_an_input_is_not_decoded_only_between_values_searched():
    assert decoded(0.515, 1e-9, False)
    assert not decoded(0.5101, 1e-9, False)
    for beyond in (0.49, 0.53, 42.0):
        assert not decoded(beyond, 1e-9, False)
    assert not decoded(0.515, 1e-3, False)
    assert not decoded(0.515, 1e-9, False, searched=(0.5,))


@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize(("value", "uncertainty"), [*HOSTILE, (0.515, nan), (0.51, 1e6), (0.515, -1.0)])
def test_no_hostile_input_is_decoded_or_not(stated, value, uncertainty):
    assert not decoded(value, uncertainty, stated)


@pytest.mark.parametrize(
    ("value", "uncertainty", "negative", "passes"),
    [
        (1.5, 1e-12, 1, True),
        (1.5, 1e-12, 0, False),
        (1.5, 1e-12, nan, False),
        (1.56, 1e-12, 1, False),
        (1.5, 0.1, 1, False),
        (nan, 1e-12, 1, False),
    ],
)
def test_a_state_is_placed_by_its_value_and_its_negative_eigenvalues(value, uncertainty, negative, passes):
    state = SimpleNamespace(quantities={"p": Quantity(value, uncertainty), "n_negative": Quantity(negative)})
    check = PrintedState("p", "1.5", SPEC, AT, "p", ("p",), 1, "figure 7")
    passed, status = entry_of(check, state=lambda *_: state)
    assert passed is passes
    assert status == ("input, placed" if passes else "input, not placed")
