"""The trace is compared with states, with its own neighbouring points and with tables."""

from itertools import islice

import numpy as np
import pytest

from weakforms import tube
from weakforms.results import Branch, Quantity, Result, SpecialPoint, State
from weakforms.results.drawing import critical, draw, seed_of
from weakforms.verification.cases.references import Reference
from weakforms.verification.judging.bounds import Comparison
from weakforms.verification.judging.consistency import table_traces, traces
from weakforms.verification.run.solutions import Solutions

SPEC = tube(alpha=0.1)
TRACE = traces.Trace(SPEC)
U = np.linspace(0.0, 5.0, 120) ** 1.1
COLUMNS = {"u_max": U, "p": 2 * np.tanh(U) - 0.1 * U, "V": 1 + U + U**2}


def stored(**changed: np.ndarray) -> Solutions:
    """A trace through two states; columns of the trace may differ from those of the states."""
    columns = {**COLUMNS, "n_negative": (np.gradient(COLUMNS["p"], U) < 0).astype(int)}
    spread = {name: np.full(len(U), 1e-10) for name in COLUMNS}
    drawn = list(islice(draw(Branch("primary", "p", columns), ["u_max"], 3), 2))
    states = [
        State(
            {"u_max": point.value},
            "primary",
            {n: Quantity(float(v[point.index]), 1e-10 if n in spread else None) for n, v in columns.items()},
        )
        for point in drawn
    ]
    points = [{"index": p.index, "column": p.column, "value": p.value} for p in drawn]
    numerics = {"drawn": {"primary": {"seed": 3, "points": points, "left_out": []}}}
    branch = Branch("primary", "p", columns | changed, spread)
    return Solutions({SPEC: Result("tube", {}, {}, numerics, {}, [branch], states=states)})


def verdicts(solutions: Solutions) -> dict[str, bool]:
    return {v.check.partition(":")[0]: v.passed for v in TRACE.judge(2, solutions)}


def test_a_trace_that_is_its_states_passes():
    assert verdicts(stored()) == {"trace": True}
    assert [v.check for v in TRACE.judge(2, stored())] == TRACE.names(2)


def test_round_off_does_not_decide_which_points_are_drawn():
    """A traction of Mooney-Rivlin's patch that is zero was 0 or 3e-15, by the number of ranks."""
    noise = 3e-15 * np.random.default_rng(7).integers(0, 2, len(U))
    quiet, noisy = (Branch("primary", "p", COLUMNS | {"sigma": sigma}) for sigma in (0 * U, noise))
    for seed in range(10):
        drawn = [list(islice(draw(branch, ["u_max"], seed), 5)) for branch in (quiet, noisy)]
        assert drawn[0] == drawn[1]


@pytest.mark.parametrize("name", COLUMNS)
@pytest.mark.parametrize("factor", [1.01, -1.0, np.nan])
def test_a_column_that_is_off_all_along_fails(name, factor):
    assert not verdicts(stored(**{name: factor * COLUMNS[name]}))["trace"]


def test_what_is_said_is_about_the_worst_of_many_numbers():
    def found(name, error):
        one = np.array([error])
        return name, "u = 1", Comparison(one, np.array([1e-6]), one / 9, 0.0, 1.0)

    numbers = [found("a", 1e-9), found("b", 3e-7), found("z", 2e-9)]
    verdict = traces.worst("trace", "they agree", numbers, "states")
    assert (verdict.where, verdict.error, verdict.passed) == ("b, u = 1", 3e-7, True)


@pytest.mark.parametrize("name", ["n_negative", "n_held", "n_fixed_m", "n_odd_even", "n_B2"])
def test_a_count_is_a_whole_number_and_not_negative(name):
    counts = stored().branch(SPEC).columns["n_negative"]
    assert counts.max() == 1
    for factor, passes in ((1, True), (1.01, False), (-1, False)):
        found = stored(**{name: factor * counts})
        for state in found.result(SPEC).states:
            state.quantities[name] = state.quantities["n_negative"]
        assert verdicts(found)["trace"] == passes


def test_a_point_drawn_without_a_state_fails():
    solutions = stored()
    del solutions.result(SPEC).states[0]
    assert not verdicts(solutions)["trace"]


def test_an_uncertainty_that_hides_one_percent_fails():
    solutions = stored()
    solutions.branch(SPEC).uncertainty["V"][:] = 1e-2 * U.max() ** 2
    assert not verdicts(solutions)["trace"]
    solutions.branch(SPEC).uncertainty.clear()
    assert not verdicts(solutions)["trace"]


@pytest.mark.parametrize("factor", [1.01, -1.0])
def test_a_trace_is_held_against_a_table(factor):
    rows = np.linspace(0.0, 4.0, 41)
    columns = {"u_max": rows, "p": 2 * np.tanh(rows) - 0.1 * rows}
    table = Reference("t", "exact", "", "", "u_max", columns, dict.fromkeys(columns, 1e-9), {})
    called = {"u_max": "u_max", "p": "p"}
    (verdict,) = table_traces.against_table(stored().branch(SPEC), table, called)
    assert verdict.passed
    off = stored(p=factor * COLUMNS["p"]).branch(SPEC)
    assert not table_traces.against_table(off, table, called)[0].passed


def test_points_are_drawn_where_columns_speak_and_can_be_prescribed():
    p = np.concatenate([np.linspace(0, 2, 10), np.linspace(1.9, 1.0, 10)])
    u, front = np.linspace(0, 1, 20), np.r_[np.zeros(12), np.linspace(0.1, 1, 8)]
    branch = Branch("primary", "p", {"p": p, "u_max": u, "front": front})
    for seed in range(20):
        points = list(draw(branch, ["p", "u_max"], seed))
        assert points[0].index >= 12
        assert sorted(point.index for point in points) == list(range(1, 19))
        assert all(branch.columns[point.column][point.index] == point.value for point in points)
        # Past the limit point p has each of its values twice: u_max tells the points apart.
        assert all(point.column == "u_max" for point in points if p[point.index] > 1.0 and point.index > 10)
    assert seed_of("a") != seed_of("b")


def test_no_point_is_drawn_where_the_count_of_negative_eigenvalues_jumps():
    p, u = np.array([0.0, 1.0, 1.5, 1.2, 0.5]), np.linspace(0, 1, 5)
    branch = Branch("primary", "p", {"p": p, "u_max": u})
    turn = SpecialPoint("limit_point", "primary", "p", {"p": 1.5, "u_max": 0.5 + 1e-9}, {})
    between = SpecialPoint("bifurcation_point", "primary", "p", {"p": 1.4, "u_max": 0.6}, {})
    elsewhere = SpecialPoint("limit_point", "other", "p", {"p": 1.0, "u_max": 0.25}, {})
    known = critical(branch, [turn, between, elsewhere])
    assert known == {2}
    assert {point.index for point in draw(branch, ["u_max"], 1, known)} == {1, 3}


def test_the_whole_of_it_on_a_solved_tube():
    """A solve is asked for what the verdicts need; an error of 1 % in one column makes one fail."""
    from weakforms.verification.run.solving import solve_spec

    spec = tube(alpha=0.1, delta1=1.1, u_end=1.0)
    result = solve_spec(spec, [])
    judged = list(traces.Trace(spec).judge(2, Solutions({spec: result})))
    assert [v.passed for v in judged] == [True], judged
    result.branches[0].columns["p"] *= 1.01
    (judged,) = traces.Trace(spec).judge(2, Solutions({spec: result}))
    assert not judged.passed


def test_problems_with_traces_are_those_that_trace_paths():
    from weakforms.api import require_environment
    from weakforms.problems.branch_problem import BranchProblem

    problems = require_environment().problems().items()
    found = {name for name, problem in problems if isinstance(problem, BranchProblem)}
    assert found == traces.TRACED
