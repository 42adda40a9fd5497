"""Allowed parameters for which an audit once got no answer, on coarse meshes."""

import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.problem import Requests, StateRequest, validated
from weakforms.solvers.continuation.walk import walk


def test_a_walk_shortens_its_steps_and_says_how_far_it_came():
    seen = []

    def solve_near(before, value):
        seen.append(value)
        if abs(value - before) > 0.3 or value > 2.0:
            raise ConvergenceError("too far")
        return value

    assert walk(solve_near, 0.0, 0.0, 1.9, 1.0) == 1.9
    assert seen[:2] == [1.0, 0.5]
    with pytest.raises(ConvergenceError, match=r"followed to 2, not 3: too far"):
        walk(solve_near, 0.0, 0.0, 3.0, 0.25)


def test_a_diagram_ends_where_the_law_of_its_disk_takes_no_more():
    """Branches went on to states without meaning, on which first wrinkling was looked for."""
    law = {"model": "gent", "shear": 8.909, "jm": 19.49}
    given = law | {"body": "circular", "beta": 2.9, "low": 2.8, "high": 3.0, "kind": "wrinkling"}
    result = solve("diagram", **given, l=0.15, t_end=3.1, numerics={"cells": 8, "levels": 2, "step": 0.2})
    assert result.failures == []
    assert "or to where the law is at its limit" in result.absent[0].reason
    with pytest.raises(InputError, match=r"diagram: high = 4: model = 'gent' .* lower high"):
        solve("diagram", **law, body="circular", beta=2.0, low=1.5, high=4.0)


def test_a_long_strip_is_refused_because_it_bulges_along_itself():
    with pytest.raises(InputError, match=r"c = 2\.5 with edges = 'strip': .*allowed: c up to 2, or edges"):
        solve("rectangle", edges="strip", c=2.5)


@pytest.mark.parametrize("name", registry.abouts())
def test_defaults_are_accepted_as_typed_on_a_command_line(name):
    """``surface degree=1`` was refused: "input should be 1"."""
    model = registry.get(name).parameters
    defaults = {key: value for key, value in model().model_dump().items() if key in model.model_fields}
    typed = {key: str(value) for key, value in defaults.items() if value not in (None, "", ())}
    assert validated(model, typed, name) == model(**typed)
    for key, value in defaults.items():
        assert key not in typed or getattr(validated(model, {key: typed[key]}, name), key) == value


@pytest.mark.parametrize("name", registry.abouts())
def test_a_state_at_a_column_that_is_not_there_is_refused_before_anything_is_solved(name):
    problem = registry.get(name)
    wanted = StateRequest("nothing", 1.0, 1, "primary", ())
    with pytest.raises(InputError, match=r"nothing|states"):
        problem.check(problem.parameters(), Requests(states=(wanted,)))


@pytest.mark.parametrize(
    ("problem", "given", "said"),
    [
        (
            "membrane",
            {"model": "varga", "energy": "full", "w_end": 1.7},
            "w_end = 1.7: the force of .*'varga'",
        ),
        ("rectangle", {"model": "varga", "energy": "full"}, "w_end = 1.5: the force of .* w_end up to 1"),
        ("rectangle", {"c": 3.5}, "c = 3.5"),
        ("rectangle", {"gamma": 31.0}, "gamma = 31"),
        ("surface", {"gamma": 11.0}, "gamma = 11: allowed with geometry = 'tube': up to 10"),
    ],
)
def test_sheets_and_tubes_beyond_what_is_followed_are_refused(problem, given, said):
    with pytest.raises(InputError, match=said):
        solve(problem, **given)
