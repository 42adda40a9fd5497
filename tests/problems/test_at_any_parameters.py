"""Allowed parameters for which an audit once got no answer, on coarse meshes."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.forms.materials.catalogue import MATERIALS
from weakforms.problems import registry
from weakforms.problems.contact.guesses import stick_guess
from weakforms.problems.disk.model import DiskData
from weakforms.problems.disk.phases import DiskPhases
from weakforms.problems.disk.scheme import CircularSchemeParameters, FixedDisk
from weakforms.problems.liquid_tube import coincidence
from weakforms.problems.liquid_tube import problem as liquid_tube
from weakforms.problems.liquid_tube.bent import problem as bent
from weakforms.problems.liquid_tube.bent.branch import SecondaryBranch
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meridian.pre_stretch import has_bounded_force
from weakforms.problems.problem import Requests, StateRequest, validated
from weakforms.problems.wrinkled import branch as wrinkled_branch
from weakforms.problems.wrinkled.branch import WrinkledBranch
from weakforms.problems.wrinkled.fields import TAUT
from weakforms.problems.wrinkled.problem import WrinkledNumerics, wrinkled_membrane
from weakforms.problems.wrinkled.sheets import cylinder as sheet
from weakforms.problems.wrinkled.waves import problem as level
from weakforms.results import validate
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.walk import walk
from weakforms.solvers.equilibrium.state import State


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
    ("law", "force", "limit"),
    [
        ({"model": "harmonic", "shear": 4.183, "f2": 3.217}, 58.34, "6.298 in tension"),
        ({"model": "varga", "shear": 0.3}, 0.61, "0.5994 in tension"),
        ({"model": "saint_venant_kirchhoff", "shear": 1.0, "poisson": 0.5}, -1.2, "-0.5773 in compression"),
        ({"model": "saint_venant_kirchhoff", "shear": 1.0, "poisson": 0.1}, 94.0, "35.32 in tension"),
    ],
)
def test_a_force_that_a_law_does_not_bear_is_refused_with_the_largest_one(law, force, limit):
    """Largest forces of a strip, of three kinds.

    Varga's is ``2 mu (1 - lam^(-3/2))``. Kirchhoff's ``mu (1 + nu) lam (lam^2 - 1)`` has a least value, and
    its width ``sqrt(1 - nu (lam^2 - 1))`` vanishes, for ``nu = 0.1`` at a force of 36.5; the last of the
    stretches that are tried before that has a force of 35.32.
    """
    with pytest.raises(InputError, match=rf"force = {force:g}: .* no more than {limit}; choose a force near"):
        solve("infinite_tube", **law, force=force, lam_end=1.2)
    within = solve("infinite_tube", **law, force=0.5 * float(limit.split()[0]), lam_end=1.2)
    assert within.failures == []


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


FAR = {"alpha": 0.8089, "beta": 9.496, "k": 88.36, "l": 1.084, "p_end": 0.3871}
DISK = {"cells": 16, "levels": 2}


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


def test_a_scheme_that_touches_nothing_says_so_and_stays_free():
    tube = {"alpha": 0.6091, "delta1": 3.757, "lf": 3.978}
    given = tube | {"k": 98.02, "s": 3.575, "scheme": "pressure_steps", "p_end": 0.05848}
    result = solve("tube_scheme", **given, numerics={"cells": 32, "steps": 8})
    assert "p_end = 0.05848 is reached before first contact" in result.absent[0].reason
    assert result.quantities["contact_length"].value == 0.0
    free = solve("tube", **tube, at={"p": 0.05848}, numerics={"cells": 16, "levels": 2}).states[0]
    assert result.quantities["u_max"].value == pytest.approx(free.quantities["u_max"].value, rel=1e-3)


def test_a_scheme_ends_below_first_contact_at_its_last_pressure():
    """The step in which ``p_end`` is passed leads near a limit point, from where Newton's method diverges."""
    tube = {"alpha": 0.244, "delta1": 3.336, "lf": 12.77}
    given = tube | {"k": 1776.0, "s": 9.785, "p_end": 0.3542}
    result = solve("tube_scheme", **given, numerics={"cells": 32, "steps": 8})
    assert "p_end = 0.3542 is reached before first contact" in result.absent[0].reason
    free = solve("tube", **tube, at={"p": 0.3542}, numerics={"cells": 16, "levels": 2}).states[0]
    assert result.quantities["u_max"].value == pytest.approx(free.quantities["u_max"].value, rel=1e-2)
    with pytest.raises(InputError, match=r"p_end = 1e-09 is below p = .*raise p_end"):
        solve("tube_scheme", p_end=1e-9, numerics={"cells": 32, "steps": 8})


def test_a_scheme_of_a_law_that_makes_a_neck_without_pressure_reaches_a_low_one():
    """The first guess, of uniform radius, was taken for the state without pressure."""
    law = {"model": "saint_venant_kirchhoff", "shear": 5.738, "poisson": 0.2504}
    tube = law | {"delta1": 4.456, "lf": 56.98}
    given = tube | {"k": 5169.0, "s": 13.59, "p_end": 0.4301, "scheme": "pressure_steps"}
    result = solve("tube_scheme", **given, numerics={"cells": 100, "steps": 8})
    free = solve("tube", **tube, at={"p": 0.4301}, numerics={"cells": 16, "levels": 2}).states[0]
    assert free.quantities["u_max"].value < -0.4
    assert result.quantities["u_max"].value == pytest.approx(free.quantities["u_max"].value, rel=1e-3)


def test_a_scheme_that_loses_contact_beyond_a_limit_point_says_so():
    """First contact is behind a limit point; the scheme's steps up to p_end lead back before it."""
    given = {
        "model": "varga",
        "shear": 3.56,
        "delta1": 3.245,
        "lf": 1.875,
        "k": 0.0,
        "s": 13.68,
        "p_end": 0.9191,
    }
    result = solve("tube_scheme", **given, scheme="pressure_steps", numerics={"cells": 40, "steps": 8})
    assert result.quantities["contact_length"].value == 0
    assert "lead to a state without contact; choose a smaller s" in result.absent[0].reason


@pytest.mark.parametrize(("counts", "first"), [((0, 1, 1), 1), ((1, 1, 1), 1), ((1, 0, 0), 1)])
def test_a_bent_branch_that_is_unstable_from_its_start_has_no_change_of_stability_there(
    counts, first, monkeypatch
):
    """At its first point one eigenvalue is zero; it counts as negative if the branch is unstable."""
    points = [SimpleNamespace(n_negative=count) for count in counts]
    branch = SecondaryBranch.__new__(SecondaryBranch)
    branch.continuation, branch.points = None, points[:1]

    def traced(self, *_, **__):
        self.points = points

    monkeypatch.setattr(EquilibriumBranch, "__init__", traced)
    branch.follow()
    assert [point.n_negative for point in branch.points] == [first, *counts[1:]]


def test_a_tube_is_inflated_from_rest_each_time():
    """The second free branch, up to ``p_end``, started from the bulged state at first contact."""
    given = {"alpha": 0.4899, "delta1": 1.389, "lf": 1.106, "k": 668.0, "s": 9.626, "p_end": 2.367}
    coarse = {"cells": 16, "levels": 2}
    result = solve("tube", **given, contact="adhesive", phase="deflation", numerics=coarse)
    assert result.failures == []
    assert "p_end = 2.367 is below first contact" in result.absent[0].reason
    p = result.branch().columns["p"]
    assert p[0] == pytest.approx(2.367, abs=1e-9)
    assert -0.1 * 2.367 < p[-1] <= 0


def no_bifurcation(*_):
    raise AbsentError("bifurcation point", "the primary branch has 0; choose another delta")


def test_a_liquid_tube_that_does_not_bend_keeps_its_primary_branch(monkeypatch):
    primary = SimpleNamespace(pieces=[SimpleNamespace(family=SimpleNamespace(name="primary", absent=[]))])
    monkeypatch.setattr(liquid_tube, "primary_family", lambda *_: primary)
    monkeypatch.setattr(liquid_tube, "secondary_family", no_bifurcation)
    given = {"parameters": SimpleNamespace(secondary=True), "numerics": None, "comm": None, "progress": None}
    problem, states = registry.get("fluid_tube"), [SimpleNamespace(branch="secondary")]
    found = problem.families(SimpleNamespace(**given, requests=SimpleNamespace(states=[])))
    assert list(found) == ["primary"]
    (absence,) = found["primary"].absent
    assert (absence.what, "choose another delta" in absence.reason) == ("secondary branch", True)
    with pytest.raises(AbsentError):
        problem.families(SimpleNamespace(**given, requests=SimpleNamespace(states=states)))


def test_a_surface_that_does_not_bend_says_so(monkeypatch):
    monkeypatch.setattr(bent, "WholeRun", no_bifurcation)
    result = solve("fluid_tube_surface")
    assert (result.quantities, result.failures) == ({}, [])
    assert result.absent[0].reason.startswith("fluid_tube_surface: the primary branch has 0")


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
    monkeypatch.setattr(wrinkled_branch, "WrinkledBranch", lambda *_: branch)
    if stalled:
        with pytest.raises(ConvergenceError, match=r"ranges over \[0, 5\.8\]: steps too small"):
            solve("wrinkled_sheet", load="gas", at_load=32.0)
    else:
        (absence,) = solve("wrinkled_sheet", load="gas", at_load=32.0, volume_end=14.0).absent
        assert re.search(r"\[0, 5\.8\], up to 14 times the volume .*; lower at_load", absence.reason)


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


def test_points_in_one_order_at_both_ends_coincide_nowhere_that_is_known(monkeypatch):
    limit, fork = (SimpleNamespace(values={"V": volume}) for volume in (2.0, 1.0))
    monkeypatch.setattr(coincidence._Finder, "_path", lambda *_: None)
    monkeypatch.setattr(coincidence._Finder, "_points", lambda *_: ((None, limit), fork))
    result = solve("fluid_tube_coincidence", delta_low=3.0, delta_high=5.0)
    assert (result.quantities, result.failures) == ({}, [])
    assert "the same order at delta = 3 and 5" in result.absent[0].reason
    validate(result.to_json())


def test_branches_without_limit_point_or_bifurcation_have_no_coincidence():
    path = SimpleNamespace(pieces=[], data=SimpleNamespace(delta=4.783), zw_end=0.7)
    with pytest.raises(AbsentError, match=r"at delta = 4\.783 the branch has 0 limit points and 0 bifurc"):
        coincidence._Finder._points(None, path)


def test_a_liquid_tube_near_the_limit_of_its_law_ends_under_a_hundredfold_pressure():
    """The residual of its stiff equations was above the limit; then its level rose without end."""
    law = {"model": "gent", "shear": 1.784, "jm": 89.3}
    given = law | {"L": 39.93, "gamma": 0.6225, "delta": 8.9, "n_max": 1}
    result = solve("fluid_tube", **given, numerics={"cells": 16, "levels": 2})
    assert result.failures == []
    (rest,) = result.absent
    assert "there the pressure of the liquid is 100 times the stiffness of the law" in rest.reason
    last = result.branches[0].columns["zw"][-1]
    assert last == pytest.approx(100 * 1.784 / 2 / 0.6225, rel=0.05)


def test_a_bent_branch_whose_level_hardly_falls_ends_where_it_is_bent_very_far():
    """The law stiffens: the level stayed near 18, and 300 s were not enough for the branch."""
    given = {"L": 2.058, "delta": 4.855, "gamma": 1.18, "alpha": 0.4226, "n_max": 1, "secondary": True}
    coarse = {"cells": 16, "levels": 2}
    surface = {"secondary_cells": 12, "secondary_levels": 2, "secondary_degree": 4}
    result = solve("fluid_tube", **given, numerics=coarse | surface)
    assert result.failures == []
    (rest,) = (part for part in result.absent if part.what == "rest of branch secondary")
    assert "where the tube is bent very far, after a path of 4" in rest.reason
    level = result.branch("secondary").columns["zw"]
    assert 0.9 * level[0] < level[-1] < level[0]


def test_a_coincidence_beyond_the_limit_of_the_law_is_refused():
    with pytest.raises(InputError, match=r"delta_high = 5: .*lower delta_high|delta_high = 5 alone"):
        solve("fluid_tube_coincidence", model="gent", jm=20.0, delta_low=3.0, delta_high=5.0)


def test_a_diagram_ends_where_the_law_of_its_disk_takes_no_more():
    """Branches went on to states without meaning, on which first wrinkling was looked for."""
    law = {"model": "gent", "shear": 8.909, "jm": 19.49}
    given = law | {"body": "circular", "beta": 2.9, "low": 2.8, "high": 3.0, "kind": "wrinkling"}
    result = solve("diagram", **given, l=0.15, t_end=3.1, numerics={"cells": 8, "levels": 2})
    assert result.failures == []
    assert "or to where the law is at its limit" in result.absent[0].reason
    with pytest.raises(InputError, match=r"diagram: high = 4: model = 'gent' .* lower high"):
        solve("diagram", **law, body="circular", beta=2.0, low=1.5, high=4.0)


def test_a_long_strip_is_refused_because_it_bulges_along_itself():
    with pytest.raises(InputError, match=r"c = 2\.5 with edges = 'strip': .*allowed: c up to 2, or edges"):
        solve("rectangle", edges="strip", c=2.5)


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


def test_a_stiffening_liquid_tube_ends_where_it_is_wide():
    """With ``alpha = 0.51`` the level has no limit point; the trace once went on to a level of 1260."""
    given = {"L": 3.331, "delta": 6.689, "gamma": 0.1716, "alpha": 0.5086, "n_max": 1}
    result = solve("fluid_tube", **given, numerics={"cells": 16, "levels": 2})
    (rest,) = result.absent
    assert result.failures == []
    assert rest.what == "rest of branch primary"
    assert "there the mean radius is 10" in rest.reason
    columns = result.branches[0].columns
    assert (np.diff(columns["zw"]) > 0).all()
    assert np.sqrt(columns["V"][-1] / (np.pi * 3.331)) == pytest.approx(10, rel=0.05)


def test_a_bent_state_that_is_far_is_reached_by_steps():
    """Newton's method with the whole amplitude at once diverges there."""
    given = {
        "L": 12.03,
        "delta": 5.4,
        "gamma": 1.167,
        "alpha": 0.01257,
        "amplitude": 0.1056,
        "uneven": 0.1351,
    }
    result = solve("fluid_tube_surface", **given, numerics={"cells": 16})
    assert result.failures == []
    numbers = result.quantities
    assert numbers["zw_bent"].value < numbers["zw_bifurcation"].value


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


def test_a_scheme_whose_tube_cannot_reach_the_substrate_ends_at_the_last_pressure_before():
    """At ``u_max = 1.2`` the membrane is all but inextensible, far above the last pressure."""
    law = {"model": "gent", "shear": 1.46, "jm": 29.75}
    given = law | {"delta1": 2.905, "lf": 1.889, "k": 308.2, "s": 2.997, "p_end": 0.02736}
    result = solve("tube_scheme", **given)
    assert result.failures == []
    (rest,) = result.absent
    assert "p_end = 0.02736 is reached before first contact" in rest.reason
    assert result.quantities["contact_length"].value == 0
    assert 0 < result.quantities["u_max"].value < 0.1


@pytest.mark.parametrize("scheme", ["pressure_steps", "semismooth"])
def test_pressure_steps_of_a_scheme_that_find_no_state_where_the_pressure_falls_say_so(scheme):
    law = {"model": "three_chain", "nkt": 0.4865, "links": 456100.0}
    given = law | {"delta1": 4.258, "lf": 5.717, "k": 1008.0, "s": 4.51, "p_end": 7.783}
    result = solve("tube_scheme", **given, scheme=scheme)
    assert result.failures == []
    assert result.quantities == {}
    (rest,) = result.absent
    assert "the pressure falls at first contact, and steps of it find no state beyond p = " in rest.reason
    assert "scheme = 'front_nodes' follows the branch" in rest.reason


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


@pytest.mark.parametrize(
    ("law", "bounded"),
    [(Chosen("varga", (("shear", 2.0),)), True), (Chosen("ogden", ()), False), (Chosen("gent", ()), False)],
)
def test_only_the_force_of_vargas_law_is_bounded(law, bounded):
    known = {name: c.default for name, c in MATERIALS[law.model].constants.items()} | dict(law.constants)
    assert has_bounded_force(Chosen(law.model, tuple(known.items()))) is bounded
