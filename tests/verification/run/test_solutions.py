"""What a run did not solve is said to be missing, and why: no check reads a number that is not there."""

import pickle
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import api, tube
from weakforms.errors import AbsentError, ConvergenceError
from weakforms.results import Branch, Failure, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.audit.coverage.families import FAMILIES
from weakforms.verification.audit.coverage.judged import solved
from weakforms.verification.cases.specs import At
from weakforms.verification.run.solutions import Solutions

SPEC = tube(alpha=0.1)
AT = At("u_max", 2.0, field="profile")
PROFILE = Field(
    "profile", {"Theta": np.array([0.0, 1.0]), "r": np.array([1.0, 2.0])}, {"Theta": 0.0, "r": 0.0}
)


def state(*fields, **at):
    return State(at or {"u_max": 2.0}, "primary", {"p": Quantity(1.0, 0.0)}, fields)


def solutions(*states, failures=(), special=(), branch="primary"):
    result = Result("tube", {}, {}, {}, {}, [Branch(branch, "p", {"p": np.array([0.0])})])
    result.states, result.failures, result.special_points = list(states), list(failures), list(special)
    return Solutions({SPEC: result})


POINT = SpecialPoint("limit_point", "primary", "p", {"p": 2.0}, {"p": 0.0})
TURNED = Failure("special points", "folds disagree")
LOST = Failure("state at u_max = 2", "Newton stalled")

MISSING = {
    "tube(alpha=0.1) was not solved": (Solutions({}), "result", SPEC),
    "tube(alpha=0.1): no branch 'primary'; it has other": (solutions(branch="other"), "branch", SPEC),
    "tube(alpha=0.1): folds disagree": (
        solutions(failures=[TURNED], special=[POINT]),
        "points",
        SPEC,
        "limit_point",
    ),
    "tube(alpha=0.1): no state at u_max = 2: not solved": (solutions(state(u_max=2.1)), "state", SPEC, AT),
    "tube(alpha=0.1): no state at u_max = 2: Newton stalled": (
        solutions(failures=[LOST, TURNED]),
        "state",
        SPEC,
        AT,
    ),
    "tube(alpha=0.1): state at u_max = 2 was stored without a profile": (
        solutions(state()),
        "profile",
        SPEC,
        AT,
    ),
    "tube(alpha=0.1): state at u_max = 2 has no field 'mode'": (
        solutions(state(PROFILE)),
        "profile",
        SPEC,
        replace(AT, field="mode"),
    ),
    "the profile has no meridian at Theta = 0.5": (
        solutions(state(PROFILE)),
        "profile",
        SPEC,
        replace(AT, theta=0.5),
    ),
}


@pytest.mark.parametrize("said", MISSING)
def test_what_is_missing_is_said_to_be(said):
    known, asked, *given = MISSING[said]
    with pytest.raises(ConvergenceError) as caught:
        getattr(known, asked)(*given)
    assert str(caught.value) == said


def test_what_is_there_is_read():
    known = solutions(state(PROFILE), special=[POINT], failures=[LOST])
    assert known.points(SPEC, "limit_point") == [POINT]
    assert known.branch(SPEC).name == "primary"
    assert known.value(SPEC, AT, "p") == 1.0
    assert known.profile(SPEC, replace(AT, theta=1.0)).columns["r"].tolist() == [2.0]


def test_coverage_is_not_counted_on_what_did_not_converge(monkeypatch):
    family = next(family for family in FAMILIES if family.name == "tube")
    answers = iter(([], [LOST]))
    monkeypatch.setattr(api, "solve_requests", lambda *_, **__: SimpleNamespace(failures=next(answers)))
    assert solved(family, {"alpha": 0.1}, {}).failures == []
    with pytest.raises(
        ConvergenceError, match=r"^tube at \{'alpha': 0\.1\}: state at u_max = 2: Newton stalled$"
    ):
        solved(family, {"alpha": 0.1}, {})


def test_what_is_absent_comes_back_from_a_worker():
    error = pickle.loads(pickle.dumps(AbsentError("branch primary", "no state was found")))
    assert (error.what, str(error)) == ("branch primary", "no state was found")
