"""The fluid-loaded tube on the command line: states on every branch, and refused input."""

import json

import pytest

pytestmark = pytest.mark.paper3
COARSE = ("--mesh", "cells=32", "--mesh", "levels=2", "--mesh", "step=1")
SOLVE = ("solve", "fluid_tube", *COARSE)
ONE = ("--set", "n_max=1")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--set delta=1", ("delta = '1'", "greater than 1")),
        ("--set delta=0.9", ("delta = '0.9'", "greater than 1")),
        ("--set gamma=0", ("gamma = '0'", "greater than 0")),
        ("--set gamma=-0.1", ("gamma = '-0.1'", "greater than 0")),
        ("--set n_max=0", ("n_max = '0'", "greater than or equal to 1")),
        ("--set n_max=7", ("n_max = '7'", "less than or equal to 6")),
        ("--at zw=-0.5", ("zw = -0.5", "zw >= 0")),
        ("--at Lambda_n4=0", ("Lambda_n4", "n_max = 3")),
        ("--at T1=0", ("'T1'", "allowed", "zw")),
        ("--at zw=7 --branch secondary", ("secondary = true",)),
        ("--at zw=7 --branch tertiary", ("tertiary", "primary, secondary")),
        ("--mesh cells=30", ("cells must be a multiple of 4",)),
    ],
)
def test_bad_input_is_refused_before_anything_is_solved(weakforms, solves, words, said):
    called = weakforms("solve", "fluid_tube", *words.split())
    assert (called.status, called.out, solves) == (2, "", [])
    assert called.err.count("\n") == 1
    assert [word for word in said if word not in called.err] == []


def test_a_level_the_branch_never_reaches_is_refused_with_its_range(weakforms):
    called = weakforms(*SOLVE, *ONE, "--set", "zw_end=0.7", "--at", "zw=9")
    assert (called.status, called.out) == (2, "")
    assert "zw = 9 is not taken" in called.err
    assert "8.37" in called.err


def test_a_state_before_and_after_the_limit_point(weakforms):
    for crossing, negative in ((1, 0), (2, 1)):
        called = weakforms(*SOLVE, *ONE, "--at", "zw=8.2", "--crossing", crossing)
        assert called.status == 0
        (state,) = json.loads(called.out)["states"]
        assert state["quantities"]["zw"]["value"] == pytest.approx(8.2, abs=1e-12)
        assert state["quantities"]["n_negative"]["value"] == negative
        assert list(state["fields"][0]["columns"]) == ["Z", "r", "z", "lam1", "lam2", "T1", "T2", "H"]


def test_points_carry_their_wave_number(weakforms):
    called = weakforms(*SOLVE, "--set", "L=24", "--set", "n_max=2")
    points = json.loads(called.out)["special_points"]
    assert [(p["kind"], p["values"].get("n")) for p in points[:2]] == [
        ("limit_point", None),
        ("bifurcation_point", 1.0),
    ]


@pytest.mark.slow
def test_the_secondary_state_is_returned_with_its_lowest_eigenvalues(weakforms):
    surface = ("--mesh", "secondary_cells=12", "--mesh", "secondary_levels=2")
    words = ("--set", "L=8", "--set", "delta=2", "--set", "secondary=true", "--at", "zw=7.336")
    called = weakforms(*SOLVE, *surface, *words)
    assert called.status == 0
    states = {state["branch"]: state["quantities"] for state in json.loads(called.out)["states"]}
    assert list(states) == ["primary", "secondary"]
    lowest = [states["secondary"][f"Lambda_{i}"]["value"] for i in (1, 2, 3)]
    assert lowest[0] < 0 < lowest[1] < lowest[2]
