"""A curve that claims no accuracy is told what it reaches, and passes once it claims that."""

import re

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weakforms import compare
from weakforms.verification.cases import references
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.crosscheck.claims import _rounded_up
from weakforms.verification.crosscheck.targets import of_case, tables_of
from weakforms.verification.run.requests import schema

CASE, NAME = "paper2.fig03", "fig03a_delta1_1.1"
TABLE = references.load(2, NAME).columns
PIECE = ("closed_form.test_pieces", "uniaxial_neo_hookean")
HEAD = "no accuracy is claimed, and the curve does not reach the {} asked of our own code: it reaches "


def judged(curve, accuracy=None, which=(CASE, NAME), **how):
    verdicts = compare(which[0], curve, which[1], accuracy, **how)
    jsonschema.validate(verdicts.to_json(), schema("verdicts"))
    return verdicts


def only_p(error, rows=slice(None)):
    return {"u_max": TABLE["u_max"][rows], "p": (TABLE["p"] * (1 + error))[rows]}


def proposed(verdict):
    """The accuracy that a verdict proposes."""
    return float(re.search(r"which --accuracy (\S+) claims$", verdict.claim)[1])


def test_a_coarse_curve_is_not_judged_and_is_told_what_to_claim():
    curve = only_p(3.7e-4 * np.sin(TABLE["u_max"]))
    found = judged(curve, only=["p"])
    (column,) = found.verdicts
    assert (found.status, found.exit_status, found.passed, found.claimed) == ("not judged", 5, False, None)
    assert (column.status, column.asked) == ("not judged", None)
    assert column.claim == HEAD.format("1.0e-09") + "3.7e-04, which --accuracy 4e-04 claims"
    assert column.trend == "the errors lie on both sides of the table"
    assert judged(curve, 4e-4, only=["p"]).passed
    less = judged(curve, 3e-4, only=["p"])
    assert (less.status, less.verdicts[0].claim) == ("failed", "")


def test_each_column_has_its_own_verdict():
    curve = TABLE | {"lam1_mid": 1.001 * TABLE["lam1_mid"]}
    found = judged(curve)
    kinds = {v.column: v.status for v in found.verdicts}
    assert kinds == {"p": "passed", "lam1_mid": "not judged", "t1_mid": "passed", "V": "passed"}
    assert found.status == "not judged"
    assert [v.column for v in found.verdicts if v.claim] == ["lam1_mid"]
    worse = judged(curve | {"V": 2 * TABLE["V"]})
    assert {v.column: v.status for v in worse.verdicts} == kinds | {"V": "failed"}
    assert (worse.status, worse.exit_status) == ("failed", 1)


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [
        (5e-10, "passed", ""),
        (2e-9, "not judged", "which --accuracy 2e-09 claims"),
        (0.0999, "not judged", "which --accuracy 1e-01 claims"),
        (0.1001, "failed", "and no more than 0.1 may be claimed"),
        (0.9, "failed", "9.0e-01, and no more than 0.1 may be claimed"),
    ],
)
def test_what_would_pass_with_no_accuracy_that_may_be_claimed_fails(error, status, said):
    (column,) = judged(only_p(error), only=["p"]).verdicts
    assert column.status == status
    assert column.claim.startswith(HEAD.format("1.0e-09")) == (status != "passed")
    assert column.claim.endswith(said)
    assert column.asked == (None if status == "not judged" else 1e-9)
    if status == "failed":
        assert compare(CASE, only_p(error), NAME, 0.1, only=["p"]).status == "failed"


@pytest.mark.parametrize("count", [1, 2])
def test_rows_that_are_too_few_for_any_claim_fail(count):
    (column,) = judged(only_p(1e-4, slice(count)), only=["p"]).verdicts
    assert column.status == "failed"
    assert column.claim == HEAD.format("1.0e-09") + "1.0e-04, but a verdict needs 3 rows"
    assert judged(only_p(1e-4, slice(3)), only=["p"]).status == "not judged"


def test_where_the_table_is_too_coarse_other_rows_say_what_is_reached():
    """Between its first rows a table is known to 1 % only, which is not what the curve reaches."""
    lam = np.sort(np.r_[references.load("closed_form", PIECE[1]).columns["lam"], 1.15, 1.25])
    curve = {"lam": lam, "T": 2 * (lam - lam**-2) * (1 + 2.5e-7)}
    (column,) = judged(curve, which=PIECE).verdicts
    assert column.reached > 1e-5
    assert column.status == "not judged"
    assert "2.5e-07 in the 29 of 31 rows where the table is certain enough" in column.claim
    passed = judged(curve, 3e-7, PIECE)
    assert (passed.status, passed.unjudged_rows) == ("passed", {"T": 2})


def test_what_cannot_be_told_is_not_judged_as_before():
    lam = np.array([1.15, 1.25, 1.35, 1.45])
    (column,) = judged({"lam": lam, "T": 2 * (lam - lam**-2)}, which=PIECE).verdicts
    assert (column.status, column.asked, column.claim) == ("not judged", 5e-10, "")
    assert "claim a lower accuracy" in column.detail


ALL = [(found.id, name) for found in find_cases() for name in tables_of(found)]


@settings(max_examples=25, deadline=None)
@given(st.data())
def test_the_accuracy_that_is_proposed_passes_and_no_much_smaller_one(data):
    which = data.draw(st.sampled_from(ALL))
    target = of_case(*which)
    column = data.draw(st.sampled_from([c for c in target.table.ordinates if c in target.asked]))
    over, rows = target.table.abscissa, len(target.table)
    error = 10 ** data.draw(st.floats(-9, 0.5)) * np.cos(data.draw(st.floats(0, 3)) * np.arange(rows))
    curve = {over: target.table.columns[over], column: target.table.columns[column] * (1 + error)}
    (found,) = judged(curve, which=which, only=[column]).verdicts
    if found.status == "passed" or not found.claim:
        return
    if found.status == "failed":
        assert judged(curve, 0.1, which, only=[column]).status != "passed"
        return
    claim = proposed(found)
    assert judged(curve, claim, which, only=[column]).passed
    assert not judged(curve, 0.49 * claim, which, only=[column]).passed


@pytest.mark.parametrize(
    ("accuracy", "claim"),
    [(3.7e-4, 4e-4), (4e-4, 5e-4), (9.5e-6, 1e-5), (1e-9, 2e-9), (0.0999, 0.1), (0.1, 0.1)],
)
def test_an_accuracy_is_rounded_up_to_one_digit(accuracy, claim):
    """A number of one digit goes to the next one, so that round-off does not refuse it."""
    assert _rounded_up(accuracy) == claim
