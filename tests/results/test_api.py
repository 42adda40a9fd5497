"""What ``solve`` passes on to a problem, and what it says where something is not installed."""

import builtins
from types import SimpleNamespace

import pytest

from weakforms import EnvironmentLackError, InputError, api
from weakforms.problems import registry
from weakforms.results import Result
from weakforms.solvers.support import compat


@pytest.fixture
def asked(monkeypatch):
    """Requests and meshes that reach the tube's solve, which solves for nothing."""
    found = []

    def solve(_problem, parameters, numerics, requests, comm, progress):
        progress("step", 1, 2)
        found.append(SimpleNamespace(of=parameters, meshes=numerics, requests=requests, comm=comm))
        return Result("tube", {}, {}, {}, {})

    monkeypatch.setattr(type(registry.get("tube")), "solve", solve)
    return found


def test_a_state_is_the_first_crossing_of_the_primary_branch_unless_more_is_said(asked):
    steps = []
    api.solve("tube", at={"p": 1.5}, progress=lambda *step: steps.append(step), numerics={"cells": 24})
    (one,) = asked
    (state,) = one.requests.states
    assert (state.name, state.value, state.crossing, state.branch) == ("p", 1.5, 1, "primary")
    assert state.profile == ()
    assert (one.requests.branch_uncertainty, one.requests.drawn, one.requests.ahead) == (True, 0, True)
    assert (one.meshes.cells, steps) == (24, [("step", 1, 2)])
    api.solve("tube", at=[("p", 1), ("limit_point", 2)], crossing="all", u_end=2)
    states = asked[1].requests.states
    assert [(s.name, s.value, s.crossing) for s in states] == [("p", 1.0, "all"), ("limit_point", 2.0, "all")]
    assert asked[1].of.u_end == 2
    for crossing in (1, 2):
        api.prepare("tube", {}, {}, {"p": 1.0}, crossing)(None)
        assert asked[-1].requests.states[0].crossing == crossing


def test_a_verdict_asks_for_uncertainties_and_points_as_it_says(asked):
    api.solve_requests("tube", {}, {}, ())
    api.solve_requests("tube", {}, {}, (), branch_uncertainty=False, drawn=3)
    told = [(one.requests.branch_uncertainty, one.requests.drawn, one.requests.ahead) for one in asked]
    assert told == [(True, 0, False), (False, 3, False)]
    api.prepared("tube", {}, {}, ())(None)
    assert (asked[2].requests.branch_uncertainty, asked[2].requests.drawn) == (True, 0)


def test_an_accuracy_that_cannot_be_asked_is_refused_before_a_solve(asked):
    for given, said in (({"accuracy": 0.2}, "must lie between"), ({"accuracy": 1e-3}, "exclude each other")):
        with pytest.raises(InputError, match=said):
            api.solve("tube", numerics={"cells": 24}, **given)
    assert asked == []


def test_what_has_no_effect_is_a_warning_of_the_callers_line(asked):
    with pytest.warns(UserWarning, match="^tube: k = 3.0 has no effect") as told:
        result = api.solve("tube", k=3)
    assert [warning.filename for warning in told] == [__file__]
    assert f"tube: {result.warnings[0]}" == str(told[0].message)


@pytest.mark.parametrize(
    ("value", "number"), [("1.5", 1.5), (2, 2.0), (True, None), ("x", None), (None, None)]
)
def test_a_requested_value_is_a_number(value, number):
    if number is not None:
        assert api.state_value("p", value) == number
        return
    with pytest.raises(InputError, match=r"at p = .*: the value must be a number"):
        api.state_value("p", value)
    with pytest.raises(InputError, match=f"at p = '{'x' * 80}':"):
        api.state_value("p", "x" * 90)


@pytest.mark.parametrize(
    ("error", "name"),
    [
        (ImportError("no module", name="slepc4py.lib.SLEPc"), "slepc4py"),
        (ImportError("libpetsc: not found"), "libpetsc: not found"),
    ],
)
def test_what_is_not_installed_is_named(monkeypatch, error, name):
    known = builtins.__import__

    def without(module: str, *rest: object) -> object:
        if module == "petsc4py":
            raise error
        return known(module, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(EnvironmentLackError, match=f"^{name} is not installed here; use ./run"):
        api.require_environment()


@pytest.mark.parametrize(
    ("version", "fits"), [((0, 8), False), ((0, 9), True), ((0, 11), True), ((0, 12), False), ((1, 0), False)]
)
def test_versions_of_dolfinx_are_those_that_are_supported(monkeypatch, version, fits):
    monkeypatch.setattr(compat, "version", lambda: version)
    if fits:
        assert api.require_environment() is registry
        return
    said = rf"dolfinx {version[0]}\.{version[1]} is installed; supported: 0\.9 up to before 0\.12"
    with pytest.raises(EnvironmentLackError, match=said):
        api.require_environment()


def test_a_warning_points_to_the_line_that_asked(asked, monkeypatch):
    with pytest.warns(UserWarning, match="tube: .* no effect") as seen:
        api.solve("tube", k=30.0)
    assert [warning.filename for warning in seen] == [__file__]


def test_a_range_of_one_pre_stretch_is_refused_before_a_solve():
    with pytest.raises(InputError, match="delta_low = 3 must be less than delta_high = 3"):
        api.solve("fluid_tube_coincidence", delta_low=3.0, delta_high=3.0)


def test_progress_tells_of_each_mesh_and_of_each_state():
    said = []
    small = {"cells": 8, "levels": 2}
    states = [("p", 0.5), ("p", 1.0)]
    api.solve("tube", u_end=0.2, at=states, numerics=small, progress=lambda *words: said.append(words))
    for what in ("branch", "states"):
        assert [(done, of) for name, done, of in said if name == what] == [(0, 2), (1, 2)]
