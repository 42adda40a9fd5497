"""Disks for which an audit once got no answer, on coarse meshes."""

import re

import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.contact.guesses import stick_guess
from weakforms.problems.disk.model import DiskData
from weakforms.problems.disk.phases import DiskPhases
from weakforms.problems.disk.scheme import CircularSchemeParameters, FixedDisk
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.problem import validated
from weakforms.solvers.equilibrium.state import State

FAR = {"alpha": 0.8089, "beta": 9.496, "k": 88.36, "l": 1.084, "p_end": 0.3871}
DISK = {"cells": 16, "levels": 2, "step": 0.3}


@pytest.mark.parametrize(
    "given", [{"contact": "frictionless"}, {"contact": "adhesive", "phase": "deflation"}]
)
def test_a_disk_that_does_not_reach_its_substrate_stays_free_and_says_so(given):
    result = solve("circular", **FAR, **given, at={"p": 0.2}, numerics=DISK)
    assert result.failures == []
    assert re.search(
        r"p_end = 0\.3871 is below first contact at p = 63\d\.\d+; choose", result.absent[0].reason
    )
    columns = result.branch().columns
    assert columns["p"].max() == pytest.approx(0.3871, abs=1e-9)
    assert not columns["X_contact"].any()
    assert columns["t0"].max() < 1.084
    free = solve("circular", beta=9.496, alpha=0.8089, t_end=0.07, at={"p": 0.2}, numerics=DISK)
    assert result.states[0].quantities["t0"].value == pytest.approx(
        free.states[0].quantities["t0"].value, rel=1e-6
    )


def test_a_patch_that_is_not_there_does_not_peel():
    given = FAR | {"contact": "adhesive", "phase": "peeling"}
    result = solve("circular", **given, p=0.1, numerics=DISK)
    assert (result.branches, result.failures) == ([], [])
    assert "needs a patch, and p_end = 0.3871 is below first contact" in result.absent[0].reason
    with pytest.raises(AbsentError, match=r"needs a patch, and p_end = 0.3871 is below first contact"):
        solve("circular", **given, at={"p": 0.1}, numerics=DISK)


def test_a_branch_that_ends_before_a_value_says_why():
    run = DiskPhases(
        MPI.COMM_WORLD, DiskData(mooney_rivlin_of(0.1), 1.0, 50.0, 0.5, 8, 3), "locked", 3, 0.2, 4
    )
    branch = run.inflate(0.3)
    with pytest.raises(ConvergenceError, match=r"t0 = 0\.9 is not reached"):
        branch.end_at("t0", 0.9)


def test_the_history_does_not_depend_on_where_newtons_method_starts():
    """From frozen values that are a tenth off, and from states on a substrate of half the stiffness."""
    run = DiskPhases(
        MPI.COMM_SELF, DiskData(mooney_rivlin_of(0.1), 1.0, 2000.0, 0.5, 8, 3), "locked", 2.2, 0.2, 6
    )
    found, slipped = run.history.found, [run._slipped(front) for front in run.history.fronts]
    other = run.bonded(run.history.span)
    other.solve([stick_guess(other.model, at) for at in slipped], 1.1 * other.guess(slipped))
    assert other.found == pytest.approx(found, abs=1e-9)
    softer = [State(s.u, s.loads | {"k": 1000.0}) for s in other._states]
    other.solve(softer, other.guess(slipped))
    other.solve([State(s.u, s.loads | {"k": 2000.0}) for s in other._states], other.found)
    assert other.found == pytest.approx(found, abs=1e-9)


def test_adhesion_to_a_stiff_substrate_is_followed():
    run = DiskPhases(
        MPI.COMM_SELF, DiskData(mooney_rivlin_of(0.1), 1.0, 2000.0, 0.5, 8, 3), "locked", 2.43, 0.2, 6
    )
    assert run.end_of_inflation.loads["p"] == pytest.approx(2.43, abs=1e-12)
    assert run.end_of_inflation.loads["front"] < run.history.span


DEEP = {"alpha": 0.8742, "beta": 1.015, "l": 0.1863}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (DEEP | {"t_end": 2.87}, r"t_end = 2\.87 is more than 2 l = 0\.3726.*lower t_end"),
        ({"k": 691.6}, r"k = 691.6: input should be less than or equal to 200"),
        ({"l": 2.009, "t_end": 3.209}, r"l = 2.009: input should be less than or equal to 2"),
    ],
)
def test_a_scheme_on_a_far_or_stiff_substrate_is_refused(given, message):
    with pytest.raises(InputError, match=message):
        solve("circular_scheme", **given)


def test_a_scheme_whose_steps_are_too_long_gives_no_membrane_turned_inside_out():
    usual = validated(CircularSchemeParameters, DEEP, "circular_scheme")
    given = usual.model_copy(update={"k": 742.6, "t_end": 0.5})
    with pytest.raises(ConvergenceError, match=r"turned inside out|followed to"):
        FixedDisk(MPI.COMM_SELF, given, 32).run(given, 2)


def test_a_scheme_whose_law_locks_before_contact_names_what_to_change():
    law = {"model": "gent", "shear": 0.2051, "jm": 117.9}
    found = solve("circular_scheme", **law, beta=7.382, k=5.35, l=0.7548, t_end=1.277)
    assert re.search(r"followed up to t0 = .* within 1% of it; lower l and t_end", found.absent[0].reason)
