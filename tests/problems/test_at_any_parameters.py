"""Allowed parameters for which an audit once got no answer, on coarse meshes."""

import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.disk.model import DiskData
from weakforms.problems.disk.phases import DiskRun
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.problem import validated
from weakforms.problems.wrinkled.fields import TAUT
from weakforms.problems.wrinkled.problem import WrinkledNumerics, wrinkled_membrane


def test_a_stiff_balloon_is_inflated_to_its_end():
    """``P`` exceeds 1000: with steps of 0.05 the trace would have too many points."""
    result = solve("sphere", alpha=8.995, lam_end=31.7)
    assert result.failures == []
    columns = result.branches[0].columns
    assert columns["lam"][-1] > 31.7
    assert columns["P"].max() > 1000
    assert len(columns["lam"]) < 1500


@pytest.mark.parametrize("force", [57.53, -3.0])
def test_a_tube_under_a_large_force_begins_as_a_strip_in_tension(force):
    """``F = 2 (lam - lam^-2)(1 + alpha/lam)`` without pressure, with ``lam2 = lam^(-1/2)``."""
    alpha = 0.265
    columns = solve("infinite_tube", force=force, alpha=alpha, lam_end=2.5).branches[0].columns
    lam, across = columns["lam1"][0], columns["lam2"][0]
    assert columns["p"][0] == pytest.approx(0, abs=1e-12)
    assert across == pytest.approx(lam**-0.5, rel=1e-10)
    assert 2 * (lam - lam**-2) * (1 + alpha / lam) == pytest.approx(force, rel=1e-10)


def test_a_stiffening_tube_under_a_force_is_not_turned_inside_out():
    given = {"model": "three_chain", "force": 55.43, "nkt": 0.9659, "links": 209600.0}
    columns = solve("infinite_tube", **given, lam_end=1.05).branches[0].columns
    assert min(columns["lam1"].min(), columns["lam2"].min()) > 0


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


def test_a_membrane_with_nothing_to_perturb_is_refused_in_terms_of_its_parameters():
    """A state exists and is found through narrower disks; it is taut at the lower end."""
    given = {"M": 1.764, "delta": 2.778, "c2": 0.7244, "L": 2.985, "Af": 2.238, "gamma": 7.142}
    with pytest.raises(InputError, match="a smaller Af or a larger M or delta wrinkles it"):
        solve("wrinkled_linear", **given, zw=0.05942, numerics={"cells": 8, "degree": 4, "levels": 2})


def test_a_disk_of_large_pre_stretch_reaches_its_substrate():
    given = {"alpha": 0.8089, "beta": 9.496, "k": 88.36, "l": 1.084, "contact": "frictionless"}
    meshes = {"cells": 16, "degree": 3, "levels": 2}
    with pytest.raises(InputError, match=r"first contact at p = 63\d\.\d+; raise p_end above it, or"):
        solve("circular", **given, p_end=0.3871, numerics=meshes)


def test_a_branch_that_ends_before_a_value_says_why():
    run = DiskRun(
        MPI.COMM_WORLD, DiskData(0.1, 1.0, 50.0, 0.5, 8, 3, mooney_rivlin_of(0.1)), "locked", 3, 0.2, 4
    )
    branch = run.free(0.3)
    with pytest.raises(ConvergenceError, match=r"t0 = 0\.9 is not reached"):
        branch.end_at("t0", 0.9)


def test_a_scheme_that_touches_nothing_says_so():
    given = {
        "alpha": 0.6091,
        "delta1": 3.757,
        "lf": 3.978,
        "k": 98.02,
        "s": 3.575,
        "scheme": "pressure_steps",
    }
    with pytest.raises(InputError, match=r"p_end = 0\.05848 is below first contact at p = "):
        solve("tube_scheme", **given, p_end=0.05848, numerics={"cells": 32, "steps": 8})
