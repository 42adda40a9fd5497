"""A thickness given as text: what is allowed, what is refused, and what it gives in every problem."""

import numpy as np
import pytest
import ufl

from weakforms.api import solve_requests
from weakforms.decks.bodies import ONLY
from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.problems.meridian.thickness import LONGEST, Thickness
from weakforms.problems.problem import Requests, StateRequest, validated

PLACES = np.linspace(0.0, 1.0, 201)
COARSE = {"cells": 6, "levels": 2}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("__import__('os')", "unknown function '__import__' at character 1"),
        ("X.real", "'X.real' at character 1 is not allowed"),
        ("1 + y", "unknown name 'y' at character 5; allowed: numbers, X, pi,"),
        ("1 + cos", "a function needs brackets"),
        ("cos(X, X)", "is not allowed"),
        ("cos(x=1)", "is not allowed"),
        ("1 +", "is no expression"),
        ("", "is no expression"),
        ("1\x00", "is no expression"),
        ("True", "'True' at character 1 is not allowed"),
        ("1j", "is not allowed"),
        ("[1]", "is not allowed"),
        ("lambda: 1", "is not allowed"),
        ("1 if X else 2", "is not allowed"),
        ("X < 1", "is not allowed"),
        ("abs(X)", "unknown function 'abs'"),
        ("X @ X", "is not allowed"),
        ("(X := 1)", "is not allowed"),
        ("(" * 150 + "1" + ")" * 150, f"has 301 characters; allowed: up to {LONGEST}"),
    ],
)
def test_a_text_that_is_no_expression_of_the_coordinate_is_refused(text, told):
    with pytest.raises(ValueError, match=r".") as refused:
        Thickness(text, "X")
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("X", "is 0 at X = 0; allowed: from 0.01 to 100 everywhere"),
        ("-1", "is -1 at X = 0"),
        ("1 - 2*X", "is -1 at X = 1"),
        ("101", "is 101 at X = 0"),
        ("1/X", "'1/X' at character 1 is not finite at X = 0"),
        ("1 + 1/(1/X)", "'1/X' at character 8 is not finite at X = 0"),
        ("sqrt(X - 0.5) + 1", "'sqrt(X - 0.5)' at character 1 is not finite at X = 0"),
        ("9**9**9**9", "is not finite"),
        ("1e999", "is not finite"),
        ("0*exp(1e5) + 1", "'exp(1e5)' at character 3 is not finite"),
    ],
)
def test_a_thickness_that_is_not_positive_and_finite_is_refused(text, told):
    with pytest.raises(ValueError, match=r".") as refused:
        Thickness(text, "X").at(PLACES)
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("1 + 0.2*cos(pi*X)", 1 + 0.2 * np.cos(np.pi * PLACES)),
        ("2", 2 + 0 * PLACES),
        ("exp(-X**2)/(1 + X) + sqrt(X + 1)", np.exp(-(PLACES**2)) / (1 + PLACES) + np.sqrt(PLACES + 1)),
        ("+1.5 - -tanh(X) + log(1 + X)/9", 1.5 + np.tanh(PLACES) + np.log1p(PLACES) / 9),
        ("2**X + tan(X)/9", 2**PLACES + np.tan(PLACES) / 9),
    ],
)
def test_numbers_and_forms_have_the_same_values(text, values):
    thickness = Thickness(text, "X")
    np.testing.assert_allclose(thickness.at(PLACES), values, rtol=1e-14)
    for k in (0, 77, 200):
        form = thickness(ufl.as_ufl(float(PLACES[k])), {})
        assert float(form) == pytest.approx(values[k], rel=1e-14)


@pytest.mark.parametrize(
    ("problem", "given", "told"),
    [
        ("circular", {"thickness": "1 + Z"}, "unknown name 'Z' at character 5; allowed: numbers, X, pi"),
        ("circular", {"thickness": "1 - X"}, "is 0 at X = 1; allowed: from 0.01 to 100 everywhere"),
        ("circular", {"thickness": "1", "M": 0.5}, "thickness = '1' replaces M; leave out one of them"),
        ("circular", {"thickness": True}, "must be a text such as '1 + 0.2*cos(pi*X)'"),
        ("wrinkled_tube", {"thickness": "1 - Z/L"}, "is 0 at Z = 8"),
        ("wrinkled_tube", {"thickness": "2 - Z/4.001"}, "allowed: from 0.01 to 100"),
        ("wrinkled_tube", {"thickness": "1", "M": 0.5}, "replaces M"),
        ("wrinkled_sheet", {"thickness": "1", "M": 0.5}, "replaces M"),
        (
            "wrinkled_tube",
            {"thickness": "1 + 0.9*cos(2*pi*Z/L)", "model": "varga", "delta": 6.0},
            "the thin place gives way",
        ),
        ("hemisphere", {"thickness": "1 + Z"}, "unknown name 'Z'"),
        ("hemisphere", {"thickness": "cos(t)"}, "at t = 1.571"),
    ],
)
def test_each_problem_refuses_in_one_line(problem, given, told):
    chosen = registry.get(problem)
    with pytest.raises(InputError) as refused:
        chosen.check(validated(chosen.parameters, given, problem), Requests())
    assert told in str(refused.value)
    assert "thickness" in str(refused.value)
    assert "\n" not in str(refused.value)


def numbers(
    problem: str, given: dict, name: str, value: float, numerics: dict | None = None
) -> dict[str, float]:
    """Numbers of a state."""
    wanted = [StateRequest(name, value)]
    result = solve_requests(problem, given, numerics or COARSE, wanted, branch_uncertainty=False)
    assert not result.failures
    return {k: q.value for k, q in result.states[0].quantities.items() if np.isfinite(q.value)}


@pytest.mark.parametrize(
    ("problem", "built_in", "text", "at"),
    [
        ("circular", {"M": 0.5, "beta": 1.25, "t_end": 0.6}, "0.5 + X", ("t0", 0.5)),
        ("circular", {"t_end": 0.6}, "1", ("t0", 0.5)),
        pytest.param(
            *("wrinkled_tube", {"M": 0.5, "load_end": 3.0, "n": [5]}, "0.5 + Z/L", ("zw", 2.5)),
            marks=pytest.mark.slow,
        ),
        pytest.param(*("hemisphere", {"low_end": -0.8, "n": [5]}, "1", ("zw", -0.7)), marks=pytest.mark.slow),
    ],
)
def test_the_expression_of_a_built_in_thickness_gives_its_numbers(problem, built_in, text, at):
    rest = {name: value for name, value in built_in.items() if name != "M"}
    numerics = {"cells": 12 if problem == "circular" else 4, "levels": 2}
    if problem == "hemisphere":
        numerics["step"] = 0.2
    one = numbers(problem, built_in, *at, numerics)
    other = numbers(problem, rest | {"thickness": text}, *at, numerics)
    assert set(one) == set(other)
    for name, value in one.items():
        assert other[name] == pytest.approx(value, rel=1e-9, abs=1e-10), name


def test_twice_the_thickness_carries_twice_the_pressure():
    plain = numbers("circular", {"t_end": 0.6}, "t0", 0.5, {"cells": 12, "levels": 2})
    thick = numbers("circular", {"t_end": 0.6, "thickness": "2"}, "t0", 0.5, {"cells": 12, "levels": 2})
    for name, factor in (("p", 2), ("Pi", 2), ("t_min", 2), ("V", 1), ("lam_pole", 1), ("eigenvalue_1", 1)):
        assert thick[name] == pytest.approx(factor * plain[name], rel=1e-9), name


def test_the_resultants_of_a_disk_are_those_of_its_thickness_there():
    """At the pole both stretches are equal, t = H w_1/lam; the law is neo-Hookean."""
    wanted = [StateRequest("t0", 0.5, profile=())]
    given = {"M": 0.5, "alpha": 0.0, "t_end": 0.6}
    state = solve_requests("circular", given, {"levels": 2}, wanted, branch_uncertainty=False).states[0]
    lam, t1 = (state.fields[0].columns[name][0] for name in ("lam1", "t1"))
    assert t1 == pytest.approx(0.5 * 2 * (lam - lam**-5) / lam, rel=1e-6)


def test_the_sheet_in_two_dimensions_has_the_same_thickness():
    text = "1 + 0.4*cos(2*pi*Z/L)"
    given = {"thickness": text, "Af": 0.65}
    sheet = solve_requests("wrinkled_sheet", given | {"at_load": 3.0}, {"along": 2, "around": 4}, ())
    tube = numbers("wrinkled_tube", given | {"load_end": 4.0}, "zw", 3.0)
    assert sheet.quantities["V"].value == pytest.approx(tube["V"], rel=1e-6)
    assert sheet.quantities["Pi"].value == pytest.approx(tube["Pi"], rel=1e-6)


def test_decks_are_of_a_linear_thickness_only():
    assert ONLY["circular"]["thickness"] is None
    assert ONLY["wrinkled_tube"]["thickness"] is None
