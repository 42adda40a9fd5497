"""Wrinkled membranes for which an audit once got no answer, on coarse meshes."""

import re
from types import SimpleNamespace

import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.problem import validated
from weakforms.problems.wrinkled import first_state as starting
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.fields import TAUT
from weakforms.problems.wrinkled.problem import WrinkledNumerics, wrinkled_membrane
from weakforms.problems.wrinkled.sheets import cylinder as sheet
from weakforms.problems.wrinkled.waves import problem as level


@pytest.mark.parametrize(
    "given",
    [
        {"M": 0.2863, "delta": 4.032, "c2": 0.8524, "L": 2.495, "Af": 1.75, "energy": "modified_gradient"},
        {
            "M": 1.838,
            "delta": 2.142,
            "c2": 0.291,
            "L": 11.9,
            "Af": 1.466,
            "load": "gas",
            "energy": "standard",
        },
    ],
)
def test_membranes_on_wide_disks_are_widened_to_them(given):
    parameters = validated(registry.get("wrinkled_tube").parameters, given, "wrinkled_tube")
    numerics = WrinkledNumerics(cells=8, degree=4, levels=2)
    membrane = wrinkled_membrane(parameters, numerics, MPI.COMM_WORLD)
    state, _ = membrane.by_homotopy(0.0)
    assert state.loads["Af"] == given["Af"]
    assert state.loads["zw" if "load" not in given else "p"] == 0.0
    assert membrane.values["Af"] == given["Af"]
    assert membrane.plain(state).zones.first == TAUT, "at the wide end"


def test_a_membrane_with_nothing_to_perturb_is_answered_in_terms_of_its_parameters():
    """A state exists and is found through narrower disks; it is taut at the lower end."""
    given = {"M": 1.764, "delta": 2.778, "c2": 0.7244, "L": 2.985, "Af": 2.238, "gamma": 7.142}
    result = solve("wrinkled_linear", **given, zw=0.05942, numerics={"cells": 8, "levels": 2})
    (part,) = result.absent
    assert result.quantities == {}
    assert "a smaller Af or a larger M or delta wrinkles it" in part.reason


@pytest.mark.parametrize(
    ("values", "hint"),
    [
        ({"delta": 4.9, "M": 1.3, "Af": 0.3, "c2": 0.0}, "; choose a smaller delta, or another M or Af"),
        ({}, ""),
    ],
)
def test_a_membrane_that_is_not_found_without_load_names_what_to_change(values, hint):
    def by_homotopy(_load):
        raise ConvergenceError("the system is singular")

    branch = WrinkledBranch.__new__(WrinkledBranch)
    branch.membrane = SimpleNamespace(by_homotopy=by_homotopy, values=values)
    with pytest.raises(ConvergenceError) as caught:
        branch._start(None)
    assert str(caught.value) == f"the membrane without load is not found: the system is singular{hint}"


def test_a_level_without_a_state_names_what_to_change(monkeypatch):
    def none(*_):
        raise ConvergenceError("the equilibrium is turned inside out")

    monkeypatch.setattr(level, "_states", none)
    (failure,) = solve("wrinkled_linear", zw=18.0).failures
    assert failure.what == "zw = 18"
    assert failure.reason.startswith("the equilibrium is turned inside out; a lower zw")


@pytest.mark.parametrize("stalled", [None, "steps too small"])
def test_a_sheet_has_no_state_at_a_load_that_its_branch_does_not_reach(stalled, monkeypatch):
    def near(*_):
        raise InputError("p = 32 is not taken on this branch; p ranges over [0, 5.8]")

    trace = SimpleNamespace(stalled=stalled, points=[SimpleNamespace(state=None)])
    branch, model = SimpleNamespace(near=near, trace=trace), SimpleNamespace(material_law=None)
    plain = SimpleNamespace(control="p", plain_model=model, plain=None, meshes=[SimpleNamespace(degree=6)])
    monkeypatch.setattr(sheet, "wrinkled_membrane", lambda *_: plain)
    monkeypatch.setattr(starting, "WrinkledBranch", lambda *_: branch)
    if stalled:
        with pytest.raises(ConvergenceError, match=r"ranges over \[0, 5\.8\]: steps too small"):
            solve("wrinkled_sheet", load="gas", at_load=32.0)
    else:
        (absence,) = solve("wrinkled_sheet", load="gas", at_load=32.0, volume_end=14.0).absent
        assert re.search(r"\[0, 5\.8\], up to 14 times the volume .*; lower at_load", absence.reason)


def test_a_sheet_has_no_energy_without_wrinkling():
    """Its first guess was compressed, and its own form, which is relaxed, did not converge from there."""
    with pytest.raises(InputError, match=r"energy = 'standard': .*relaxed"):
        solve("wrinkled_sheet", energy="standard", at_load=2.0)


@pytest.mark.parametrize("given", [{"Af": 2.1}, {"L": 26.0}])
@pytest.mark.parametrize("problem", ["wrinkled_tube", "wrinkled_sheet"])
def test_membranes_on_very_wide_disks_or_very_long_are_refused(problem, given):
    (name,) = given
    with pytest.raises(InputError, match=rf"{name} = .*{2 if name == 'Af' else 25}"):
        solve(problem, **given)


@pytest.mark.parametrize(
    "problem", ["wrinkled_tube", "wrinkled_sheet", "wrinkled_linear", "wrinkled_bending"]
)
def test_wide_disks_at_which_a_bounded_force_gives_way_are_refused(problem):
    """The stretch at the clamp was 207, and no mesh could be fitted to the zones."""
    with pytest.raises(InputError, match=r"Af = 1\.493: the force of model = 'varga' is bounded.*Af up to 1"):
        solve(problem, model="varga", M=0.7995, delta=2.753, L=5.311, Af=1.493)
