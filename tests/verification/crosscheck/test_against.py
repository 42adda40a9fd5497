"""A curve compared with a solution at its own abscissae or with a result, and what explains its errors."""

import json
from dataclasses import replace

import jsonschema
import numpy as np
import pytest

import weakforms
from weakforms import InputError, compare
from weakforms.verification.cases import references
from weakforms.verification.run.requests import answer, schema

LAM = np.linspace(1.05, 3.5, 12)
TUBE = {"alpha": 0.1, "delta1": 1.1, "u_end": 1.6}


def balloon(alpha=0.1):
    """Pressure of the Mooney-Rivlin balloon, in closed form."""
    return 4 * (LAM - LAM**-5 + alpha * (LAM**3 - LAM**-3)) / LAM**2


def checked(verdicts):
    jsonschema.validate(verdicts.to_json(), schema("verdicts"))
    json.dumps(verdicts.to_json(), allow_nan=False)
    return verdicts


def test_the_problem_is_solved_at_the_abscissae_of_the_curve():
    curve = {"lam": LAM, "P": balloon(0.2)}
    right = checked(compare("sphere", curve, against={"alpha": 0.2}, accuracy=1e-9))
    assert (right.status, right.abscissa, right.case, right.partial) == ("passed", "lam", "sphere", False)
    assert right.table_rows == len(LAM)
    wrong = checked(compare("sphere", curve, against={"alpha": 0.1}, accuracy=1e-9))
    assert wrong.status == "failed"
    (column,) = wrong.verdicts
    errors = balloon(0.2) / balloon(0.1) - 1
    np.testing.assert_allclose(column.rows_judged["error"], errors, rtol=1e-8)
    assert column.reached == pytest.approx(errors.max(), rel=1e-6)
    assert "above the table and grow with lam" in column.trend


def test_without_a_claim_there_is_no_verdict_but_the_accuracy_that_is_reached():
    curve = {"lam": LAM, "P": balloon() * (1 + 3e-4 * np.sin(LAM))}
    verdicts = checked(compare("sphere", curve, against={"alpha": 0.1}))
    assert (verdicts.status, verdicts.exit_status) == ("not judged", 5)
    (column,) = verdicts.verdicts
    assert column.asked is None
    assert column.reached == pytest.approx(3e-4, rel=0.01)
    assert compare("sphere", curve, against={"alpha": 0.1}, accuracy=1.01 * column.reached).passed
    assert not compare("sphere", curve, against={"alpha": 0.1}, accuracy=0.99 * column.reached).passed


def test_no_claim_below_what_is_reached_is_judged_in_every_row():
    table = references.load(2, "fig03a_delta1_1").columns
    curve = {"u_max": table["u_max"] + 0.003, "p": table["p"]}  # between the rows the table is less certain
    keep = slice(0, -1)
    curve = {name: values[keep] for name, values in curve.items()}

    def at(accuracy):
        return compare("paper2.fig03", curve, "fig03a_delta1_1", accuracy, only=["p"])

    reached = at(1e-3).verdicts[0].reached
    exact = {name: table[name][keep] for name in ("u_max", "p")}
    best = compare("paper2.fig03", exact, "fig03a_delta1_1", 1e-6, only=["p"]).verdicts[0].reached
    assert 0 < best < reached, "even the table's own values reach no more than the table's uncertainty"
    assert (at(1.001 * reached).status, at(1.001 * reached).unjudged_rows) == ("passed", {"p": 0})
    assert at(0.999 * reached).status == "failed" or at(0.999 * reached).unjudged_rows["p"] > 0


def test_a_result_takes_the_place_of_a_table(tmp_path):
    result = weakforms.solve("sphere", alpha=0.1)
    weakforms.save(result, tmp_path / "r.json")
    inside = {"lam": LAM[:-1], "P": balloon()[:-1]}
    for given in (result, tmp_path / "r.json"):
        assert checked(compare("sphere", inside, against=given, over="lam", accuracy=1e-4)).passed
    assert not compare(
        "sphere", inside | {"P": 1.001 * inside["P"]}, against=result, over="lam", accuracy=1e-4
    ).passed
    with pytest.raises(InputError, match="is a result of sphere, not of tube"):
        compare("tube", {"u_max": [0.1, 0.2], "p": [1, 1.1]}, against=result, over="u_max")
    with pytest.raises(InputError, match="P turns along the branch; compare over lam"):
        compare("sphere", {"P": [1.0, 1.1, 1.2], "lam": [1.1, 1.2, 1.3]}, against=result, over="P")


@pytest.mark.parametrize("falls", [False, True])
def test_states_of_a_result_are_rows_of_its_table(falls):
    """A closed form at the abscissae of a curve is met to 1e-9, which no interpolation gives."""
    result = weakforms.solve("sphere", alpha=0.1, at=[("lam", lam) for lam in LAM])
    if falls:
        of = result.branches[0]
        result.branches[0] = replace(of, columns={name: values[::-1] for name, values in of.columns.items()})
    right = checked(compare("sphere", {"lam": LAM, "P": balloon()}, against=result, accuracy=1e-9))
    assert (right.status, right.unjudged_rows) == ("passed", {"P": 0})
    assert right.table_rows > len(LAM) + 6, "the points of the branch are rows too"
    wrong = compare("sphere", {"lam": LAM, "P": balloon() * (1 + 3e-9)}, against=result, accuracy=1e-9)
    assert wrong.status == "failed"


@pytest.mark.parametrize(
    ("problem", "curve", "how", "said"),
    [
        ("shpere", {"lam": [1.1, 1.2]}, {}, "did you mean 'sphere'"),
        ("sphere", {"stretch": [1.1, 1.2]}, {}, "name yours with --map"),
        ("sphere", {"lam": [1.1, 1.2], "P": [1, 2]}, {"over": "V"}, "the curve has no column 'V'"),
        ("sphere", {"lam": [1.1, 59.0], "P": [1, 2]}, {}, "raise lam_end"),
    ],
)
def test_what_cannot_be_compared_is_refused(problem, curve, how, said):
    with pytest.raises(InputError, match=said):
        compare(problem, curve, against={}, **how)


def test_a_request_compares_with_a_solution(tmp_path):
    data = {"problem": "sphere", "parameters": {"alpha": 0.1}, "accuracy": 1e-9}
    curve = {"lam": LAM.tolist(), "P": balloon().tolist()}
    jsonschema.validate(data | {"curve": curve}, schema("request"))
    status, found = answer(data | {"curve": curve}, tmp_path)
    assert (status, found["status"]) == (0, "passed")


@pytest.fixture(scope="module")
def another():
    """The tube with alpha 0.5 % too large, as another code would give it."""
    at = [("u_max", u) for u in np.linspace(0.3, 1.5, 9)]
    result = weakforms.solve("tube", **(TUBE | {"alpha": 0.1005}), at=at)
    return {n: [float(s.quantities[n].value) for s in result.states] for n in ("u_max", "p", "V")}


@pytest.mark.slow
def test_a_wrong_parameter_is_named_with_its_size(another):
    found = compare("tube", another, against=TUBE, over="u_max", accuracy=1e-6, cause=True)
    assert [v.causes[0] for v in found.verdicts] == ["equals alpha 0.5 % too large"] * 2
    assert not any("pre-stretch" in text or "dead" in text for v in found.verdicts for text in v.causes)
    table = compare("paper2.fig03", another, "fig03a_delta1_1.1", only=["p", "V"], cause=True)
    assert [v.causes[0] for v in table.verdicts] == ["equals alpha 0.5 % too large"] * 2


def gent(shear, jm):
    """Pressure of Gent's balloon, in closed form."""
    return balloon(0.0) * shear / 2 / (1 - (2 * LAM**2 + LAM**-4 - 3) / jm)


@pytest.mark.parametrize(
    ("pressure", "law", "said"),
    [
        (balloon(0.0), {"alpha": 0.01}, "equals alpha 100 % too small"),
        (balloon(0.0), {"alpha": 0.1}, "equals alpha 100 % too small"),
        (1.02 * gent(2.0, 50.0), {"model": "gent", "shear": 2.0, "jm": 50.0}, "equals shear 2 % too large"),
    ],
)
def test_a_wrong_constant_of_the_law_is_named(pressure, law, said):
    """The pressure is linear in ``alpha``, which is no parameter of the balloon but a constant of its law."""
    found = compare("sphere", {"lam": LAM, "P": pressure}, against=law, accuracy=1e-6, cause=True)
    assert found.verdicts[0].causes[0] == said


def test_a_missing_pre_stretch_is_named():
    table = references.load(2, "fig03a_delta1_1").columns
    inside = (table["u_max"] > 0.2) & (table["u_max"] < 1.5)
    curve = {"u_max": table["u_max"][inside], "p": table["p"][inside]}
    found = compare("tube", curve, against=TUBE, accuracy=1e-6, cause=True)
    assert "equals delta1 = 1: is the pre-stretch missing?" in found.verdicts[0].causes


def test_a_dead_load_is_named():
    curve = {"lam": LAM, "P": balloon() * LAM**2}
    found = compare("sphere", curve, against={"alpha": 0.1}, accuracy=1e-6, cause=True)
    assert any("a dead load" in text for text in found.verdicts[0].causes)


DEAD = {
    "u_max": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0],
    "p": [0.66455, 1.192079, 1.634503, 2.022631, 2.374956, 2.702984, 3.014146, 3.313396, 3.604134, 3.88876],
}
"""The tube of :data:`TUBE` under a radial load per area of the stretched cylinder that neither turns nor
grows, by scipy's boundary value solver."""


@pytest.mark.slow
def test_a_dead_load_is_named_where_stretches_vary():
    found = compare("tube", DEAD, against=TUBE, over="u_max", accuracy=1e-6, cause=True, only=["p"])
    assert found.verdicts[0].causes[0].startswith("is about the table times (1 + u_max)^1: a dead load")
    assert not any("lf" in text for text in found.verdicts[0].causes)


@pytest.mark.slow
def test_a_large_difference_of_a_parameter_is_named_with_its_size():
    """The tube is shorter by a tenth: its sensitivity alone says 13 %."""
    at = [("u_max", u) for u in np.linspace(0.3, 1.5, 7)]
    result = weakforms.solve("tube", **TUBE, lf=5.4, at=at)
    curve = {n: [float(s.quantities[n].value) for s in result.states] for n in ("u_max", "p")}
    found = compare("tube", curve, against=TUBE, over="u_max", accuracy=1e-6, cause=True)
    size = float(found.verdicts[0].causes[0].removeprefix("equals lf ").split(" % too small")[0])
    assert size == pytest.approx(10, rel=0.1)


def test_an_abscissa_of_another_scale_is_named():
    curve = {"lam": 1.002 * LAM, "P": balloon()}
    found = compare("sphere", curve, against={"alpha": 0.1}, accuracy=1e-6, cause=True)
    assert found.verdicts[0].causes[0] == "equals lam 0.2 % too large: is it scaled otherwise?"


def test_errors_are_explained_without_a_claim():
    curve = {"lam": LAM, "P": balloon(0.1005)}
    found = checked(compare("sphere", curve, against={"alpha": 0.1}, cause=True))
    assert (found.status, found.claimed) == ("not judged", None)
    assert found.verdicts[0].causes[0] == "equals alpha 0.5 % too large"
    assert "above the table" in found.verdicts[0].trend
    right = compare("sphere", {"lam": LAM, "P": balloon()}, against={"alpha": 0.1}, cause=True)
    assert (right.verdicts[0].trend, right.verdicts[0].causes) == ("", ())


def test_an_error_of_no_known_kind_has_no_cause():
    curve = {"lam": LAM, "P": balloon() * (1 + 1e-3 * np.cos(40 * LAM))}
    found = compare("sphere", curve, against={"alpha": 0.1}, accuracy=1e-6, cause=True)
    assert found.verdicts[0].causes == ()
