"""Checks fail where they must: each kind of verdict on wrong numbers."""

from math import radians
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import Case, Claim, Constant, Count, Curve, Order, Points, circular, tube
from weakforms.errors import InputError
from weakforms.verification.cases import references
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.references import Reference
from weakforms.verification.cases.specs import At
from weakforms.verification.crosscheck.rows import judge_column
from weakforms.verification.judging import decide
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.runner import verify

SPEC = tube(alpha=0.1)


def point(uncertainty=1e-12, **values):
    return SimpleNamespace(
        kind="limit_point", branch="primary", values=values, uncertainty=dict.fromkeys(values, uncertainty)
    )


class Solutions:
    """Special points and one profile, whatever is requested."""

    def __init__(self, points=lambda _spec: [], profile=None):
        self._points, self._profile = points, profile

    def points(self, spec, _kind):
        """The special points given for a problem."""
        return self._points(spec)

    def column(self, _spec, _at, name):
        """The quantities of the profile given."""
        return decide.Number(self._profile.columns[name], self._profile.uncertainty[name])


def verdicts_of(check, paper=2, **known):
    return [item for item in check.judge(paper, Solutions(**known)) if isinstance(item, Verdict)]


@pytest.mark.parametrize(("found", "passes"), [(0, False), (1, True), (2, False)])
def test_a_count_is_exact(found, passes):
    check = Count("limit_point", {SPEC: 1}, "one limit point")
    (verdict,) = verdicts_of(check, points=lambda _: [point()] * found)
    assert verdict.passed == passes


def test_a_point_that_is_not_there_fails():
    check = Points(
        "limit_point",
        "limit_points_off",
        base=tube(),
        parameters=("alpha", "delta1", "lf"),
        asked={"p": 1e-8},
    )
    verdicts = verdicts_of(check)
    assert verdicts
    assert not any(verdict.passed for verdict in verdicts)


@pytest.mark.parametrize(("observed", "passes"), [(4.0, True), (3.8, True), (3.5, False), (0.0, False)])
def test_an_order_below_theory_fails(observed, passes):
    exact = references.load(1, "free_limit_points").columns["p"][0]
    check = Order(
        quantity="limit pressure",
        of=circular(alpha=0, beta=1),
        expected={2: 4},
        cells=(8, 16),
        kind="limit_point",
        reference="free_limit_points",
        column="p",
    )

    def points(spec):
        return [point(p=exact * (1 + 1e-3 * (8 / dict(spec.numerics)["cells"]) ** observed))]

    (verdict,) = verdicts_of(check, paper=1, points=points)
    assert verdict.passed == passes


@pytest.mark.parametrize(
    ("spread", "uncertainty", "passes"), [(0.0, 1e-9, True), (1e-6, 1e-9, False), (0, 1, False)]
)
def test_a_first_integral_that_varies_fails(spread, uncertainty, passes):
    field = SimpleNamespace(columns={"H": np.array([1.0, 1.0 + spread])}, uncertainty={"H": uncertainty})
    check = Constant("H", SPEC, At("p", 1.0, profile=()), 1e-6, "H is constant")
    (verdict,) = verdicts_of(check, profile=field)
    assert verdict.passed == passes
    assert verdict.reference_uncertainty == 0.0  # the exact solution's spread


@pytest.mark.parametrize("holds", [True, False])
def test_a_claim_that_does_not_hold_fails(holds):
    (verdict,) = verdicts_of(Claim("c", "it holds", (), lambda _: (holds, "this was found")))
    assert verdict.passed == holds


# -- whole cases -----------------------------------------------------------------------------------


def outcome_of(tmp_path, *checks):
    found = FoundCase("paper2.t", 2, Path(__file__), Case("t", "tests", checks=checks), "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    return outcome


def test_what_cannot_be_judged_fails(tmp_path):
    def broken(_solutions):
        raise IndexError("no such point")

    outcome = outcome_of(tmp_path, Claim("c", "it holds", (), broken))
    assert outcome.status == "failed"
    assert [verdict.passed for verdict in outcome.verdicts] == [False]


def test_a_case_with_one_failed_check_fails(tmp_path):
    checks = [Claim(f"c{k}", "it holds", (), lambda _, good=k: (bool(good), "found")) for k in (0, 1)]
    assert outcome_of(tmp_path, *checks).status == "failed"
    assert outcome_of(tmp_path, checks[1]).status == "passed"


def test_a_case_that_judges_nothing_fails(tmp_path):
    assert outcome_of(tmp_path).status == "failed"


# -- tables ----------------------------------------------------------------------------------------


def test_a_table_for_other_parameters_is_refused():
    right = Curve(tube(alpha=0.1, delta1=1.1), "", reference="fig03a_delta1_1.1")
    assert right.table(2).name == right.reference
    with pytest.raises(InputError, match=r"is for delta1 = 1\.1, the case compares delta1 = 1\.3"):
        Curve(tube(alpha=0.1, delta1=1.3), "", reference="fig03a_delta1_1.1").table(2)


def test_a_meridian_is_read_at_its_angle():
    whole, part = (references.load(3, name) for name in ("fig08a", "fig08a@30"))
    rows = np.isclose(whole.columns["Theta"], radians(30))
    assert part.meridian == pytest.approx(radians(30), abs=1e-12)
    assert len(part) == rows.sum() < len(whole)
    np.testing.assert_array_equal(part.columns["z"], whole.columns["z"][rows])


def test_a_wrong_row_fails_where_the_table_is_coarse():
    x = np.linspace(0.0, 3.0, 9)
    table = Reference("t", "independent", "", "", "x", {"x": x, "y": np.sin(5 * x)}, {"x": 0.0, "y": 0.0}, {})
    at = np.array([x[0], x[1], 0.5 * (x[4] + x[5]), x[7]])
    right = np.sin(5 * at)
    assert judge_column(table, "y", at, right, 1e-8, np.arange(1, 5)).verdict.passed
    wrong = right + np.array([0, 0, 30.0, 0])
    assert not judge_column(table, "y", at, wrong, 1e-8, np.arange(1, 5)).verdict.passed
