"""Marks of a reference lie on the corresponding lines in the report's figures."""

import numpy as np
import pytest

from weakforms import Axis, Curve, Panel, tube
from weakforms.results import Branch, Quantity, Result, State
from weakforms.verification.cases.references import Reference
from weakforms.verification.judging.consistency import marks
from weakforms.verification.judging.outcome import CurveOutcome, PanelOutcome
from weakforms.verification.judging.panels import _with_states
from weakforms.verification.run.solutions import Solutions


def panel(x, y, at) -> PanelOutcome:
    curve = CurveOutcome("c", "c", list(x), list(y), reference_x=[at[0]], reference_y=[at[1]])
    return PanelOutcome("a", "", "x", "y", "$x$", "$y$", (0.0, 1.0), (0.0, 2.0), [curve])


@pytest.mark.parametrize(
    ("mark", "passes"),
    [((0.5, 1.0), True), ((0.5, 1.02), True), ((0.5, 1.09), False), ((0.5, 9.0), True)],
)
def test_a_mark_off_its_line_by_more_than_its_size_fails(mark, passes):
    (verdict,) = marks.judge(panel([0, 1], [0, 2], mark))
    assert verdict.passed == passes


def test_a_line_that_is_no_number_fails():
    assert not marks.judge(panel([0, 1], [0, np.nan], (0.5, 1.0)))[0].passed


def test_a_verdict_is_expected_where_a_table_has_both_columns_of_a_panel():
    of = tube(alpha=0.1, delta1=1.5)
    curves = {"none": Curve(of, "c"), "one": Curve(of, "c", "fig02b_delta1_1.5")}

    def found(y: str, *names: str) -> list[str]:
        drawn = tuple(curves[name] for name in names)
        return marks.names(2, Panel("a", x=Axis("u_max", 0, 2), y=Axis(y, 0, 2), curves=drawn))

    assert found("p", "none") == []
    assert found("p", "none", "one") == ["marks:a"]
    assert found("lam2_mid", "one") == []


def test_a_panel_without_marks_has_no_verdict():
    empty = panel([0, 1], [0, 2], (0.5, 1.0))
    empty.curves[0].reference_x = []
    assert marks.judge(empty) == []


def test_lines_of_long_steps_go_through_states_past_a_limit_point_too():
    """The trace turns in ``p``; all states of the table come before the turn."""
    s = np.array([0.0, 1.0, 2.0, 3.0])
    columns = {"p": s * (4 - s), "y": s**3, "n_negative": np.array([0, 0, 0, 1])}
    rows = np.array([0.5, 1.0, 3.5, 3.9])
    at = 2 - np.sqrt(4 - rows)
    states = [
        State({"p": p}, "primary", {"p": Quantity(p), "y": Quantity(v**3)})
        for p, v in zip(rows, at, strict=True)
    ]
    spec = tube()
    branches = [Branch("primary", "p", columns)]
    solutions = Solutions({spec: Result("tube", {}, {}, {}, {}, branches, states=states)})
    table = Reference("t", "exact", "", "", "p", {"p": rows, "y": at**3}, {}, {})
    drawn = _with_states(Curve(spec, "c"), table, solutions, ("p", "y"))
    assert np.all(np.diff(drawn["y"]) > 0)
    assert set(rows) <= set(drawn["p"])
    outcome = panel(drawn["p"] / 4, drawn["y"] / 14, (0, 0))
    outcome.curves[0].reference_x, outcome.curves[0].reference_y = list(rows / 4), list(at**3 / 14)
    assert marks.judge(outcome)[0].passed
    outcome.curves[0].x, outcome.curves[0].y = list(columns["p"] / 4), list(columns["y"] / 14)
    assert not marks.judge(outcome)[0].passed
