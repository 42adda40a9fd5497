"""Waves around wrinkled membranes as users ask for them, and faults of the second variation."""

from pathlib import Path

import numpy as np
import pytest
import ufl

from weakforms import Case, InputError, Points, solve, wrinkled_linear
from weakforms.forms import revolution
from weakforms.problems.wrinkled import state as wrinkled_state
from weakforms.problems.wrinkled.waves import modes as wrinkled_modes
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.run.runner import verify

pytestmark = pytest.mark.paper5
COARSE = {"cells": 6, "levels": 2}
PAPER = {"M": 1.5, "delta": 3.0, "Af": 0.4362}
VALUES = {**PAPER, "c2": 0.01, "L": 8.0}
CELLS = (3, 6)


@pytest.fixture(autouse=True)
def fresh_models():
    """Models are kept between solves: no test may see a form that another test has changed."""
    wrinkled_state.model_on.cache_clear()
    yield
    wrinkled_state.model_on.cache_clear()


# -- the problems -------------------------------------------------------------------------------------


def test_the_papers_crossings():
    result = solve("wrinkled_tube", **PAPER, n="20,50", load_end=6, numerics=COARSE)
    changes = {p.values["n"]: p for p in result.points("stability_change")}
    assert changes[50].values["zw"] == pytest.approx(2.6497876, abs=1e-6)
    assert changes[20].values["zw"] == pytest.approx(3.5948164, abs=1e-6)
    assert all(p.values["direction"] == 1 and p.uncertainty["zw"] < 1e-6 for p in changes.values())
    assert result.failures == []
    assert {"Lambda_n20_1", "Lambda_n50_3"} <= set(result.branch().columns)


def test_a_change_of_stability_is_a_state_one_can_ask_for():
    result = solve("wrinkled_tube", **PAPER, n=50, load_end=4, at=[("stability_change", 1)], numerics=COARSE)
    (state,) = result.states
    assert state.quantities["Lambda_n50_1"].value == pytest.approx(0, abs=1e-8)
    assert [f.name for f in state.fields] == ["profile", "mode_n50"]


def test_no_waves_set_in_where_the_hemispheres_level_is_largest():
    result = solve("hemisphere", n=0, low_end=-0.85, numerics=COARSE | {"step": 0.2})
    (limit,), (change,) = (result.points(kind) for kind in ("limit_point", "stability_change"))
    assert limit.values["zw"] == pytest.approx(-0.47834625, abs=1e-6)
    assert change.values["zw"] == pytest.approx(limit.values["zw"], abs=1e-9)
    assert change.values["n"] == 0
    assert result.failures == []


def test_linearised_theory_is_affine_in_the_wave_number_and_overestimates():
    result = solve("wrinkled_linear", zw=4.0, f=2, numerics=COARSE)
    found = {name: q.value for name, q in result.quantities.items()}
    assert abs(found["curved"]) < 1e-12
    assert found["B"] == pytest.approx(found["B_exact"], rel=1e-9)
    assert found["B"] < 0 < found["A"]
    assert found["n_star"] > found["n_critical"]
    assert found["n_true"] == np.ceil(found["n_critical"])


def test_bending_makes_the_band_finite():
    result = solve("wrinkled_bending", zw=7.0, beta=5e-6, numerics=COARSE)
    found = {name: q.value for name, q in result.quantities.items()}
    assert found["n_minus"] < found["n_c"] < found["n_plus"] < 400
    assert found["beta_c"] > 5e-6
    assert found["Lambda_B1"] > found["Lambda_membrane"]


@pytest.mark.parametrize("wrong", ["-1", "2.5", "many", "401", True, "20,", [20, -3]])
def test_wave_numbers_that_are_none_are_refused(wrong):
    for problem in ("wrinkled_tube", "hemisphere"):
        with pytest.raises(InputError, match="whole numbers from 0 to"):
            solve(problem, n=wrong)


def test_wave_numbers_as_text_and_as_a_list():
    from weakforms.problems.wrinkled.problem import WrinkledParameters

    for given in ("20,50", [20, 50], (20, 50, 20), "20, 50"):
        assert WrinkledParameters(n=given).n == (20, 50)
    assert WrinkledParameters(n=7).n == (7,)


@pytest.mark.parametrize("level", [0.0, 0.3, -1.3])
def test_levels_outside_the_hemisphere_are_refused(level):
    with pytest.raises(InputError, match=r"zw = .* allowed: from"):
        solve("hemisphere", at={"zw": level})


def test_levels_above_the_hemispheres_limit_are_refused():
    with pytest.raises(InputError, match="ranges over"):
        solve("hemisphere", at={"zw": -0.3}, low_end=-0.8, numerics=COARSE)


# -- seeded faults ------------------------------------------------------------------------------------

SENTINEL = Case(
    title="sentinel",
    source="tests",
    checks=(
        Points(
            "quantity",
            reference="linearised",
            base=wrinkled_linear().on(cells=8, levels=2),
            parameters=("zw", "f"),
            where={"zw": 3.0, "f": 2.0},
            asked={"A": 1e-6, "B": 1e-6, "n_star": 1e-6, "n_true": 1e-6},
        ),
    ),
)


def folds_taken_for_taut(monkeypatch):
    monkeypatch.setattr(
        wrinkled_modes.Waves, "_taut", lambda self: ufl.gt(self.model.expressions["lam1"], 0.0)
    )


def half_the_liquid(monkeypatch):
    right = revolution.liquid_energy
    monkeypatch.setattr(revolution, "liquid_energy", lambda *given: right(*given) / 2)


def half_the_waves(monkeypatch):
    right = revolution.around
    monkeypatch.setattr(
        revolution, "around", lambda base, parts, slopes, n: right(base, parts, slopes, n / 2)
    )


def second_invariant_forgotten(monkeypatch):
    monkeypatch.setattr(revolution, "relaxed", lambda *_: lambda a: a**2 + 2 / a - 3)


FAULTS = [folds_taken_for_taut, half_the_liquid, half_the_waves, second_invariant_forgotten]


@pytest.mark.parametrize("fault", [None, *FAULTS])
def test_a_fault_in_the_second_variation_fails_named_checks(fault, monkeypatch, tmp_path):
    if fault is not None:
        fault(monkeypatch)
    found = FoundCase("paper5.sentinel", 5, Path(__file__), SENTINEL, "")
    (outcome,) = verify([found], tmp_path, "full", "").cases
    failed = [v.check for v in outcome.verdicts if not v.passed]
    assert len(outcome.verdicts) == 4
    assert (outcome.status == "passed") == (fault is None)
    assert all(name.startswith("linearised:") for name in failed)


def test_a_level_above_the_one_at_which_the_law_gives_way_is_not_there():
    weak = {"model": "varga", "shear": 0.3287, "M": 0.511, "delta": 2.473, "L": 3.731, "Af": 0.4038}
    (absence,) = solve("wrinkled_linear", zw=6.159, gamma=5.42, **weak).absent
    assert "where the branch ends, its stretches are" in absence.reason
    assert absence.reason.endswith("lower zw")
