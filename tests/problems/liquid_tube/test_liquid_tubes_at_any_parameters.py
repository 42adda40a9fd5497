"""Liquid-filled tubes for which an audit once got no answer, on coarse meshes."""

from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import AbsentError, InputError
from weakforms.problems import registry
from weakforms.problems.liquid_tube import coincidence
from weakforms.problems.liquid_tube import problem as liquid_tube
from weakforms.problems.liquid_tube.bent import problem as bent
from weakforms.problems.liquid_tube.bent.branch import SecondaryBranch
from weakforms.results import validate
from weakforms.solvers.continuation.branch import EquilibriumBranch


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


def no_bifurcation(*_):
    raise AbsentError("bifurcation point", "the primary branch has 0; choose another delta")


def test_a_liquid_tube_that_does_not_bend_keeps_its_primary_branch(monkeypatch):
    primary = SimpleNamespace(missing=[])
    monkeypatch.setattr(liquid_tube, "primary_family", lambda *_: primary)
    monkeypatch.setattr(liquid_tube, "secondary_family", no_bifurcation)
    chosen = SimpleNamespace(secondary=True, energy="standard")
    given = {"parameters": chosen, "numerics": None, "comm": None, "progress": None}
    problem, states = registry.get("fluid_tube"), [SimpleNamespace(branch="secondary")]
    found = problem.families(SimpleNamespace(**given, requests=SimpleNamespace(states=[])))
    assert list(found) == ["primary"]
    (absence,) = found["primary"].missing
    assert (absence.what, "choose another delta" in absence.reason) == ("secondary branch", True)
    with pytest.raises(AbsentError):
        problem.families(SimpleNamespace(**given, requests=SimpleNamespace(states=states)))


def test_a_surface_that_does_not_bend_says_so(monkeypatch):
    monkeypatch.setattr(bent, "WholeRun", no_bifurcation)
    result = solve("fluid_tube_surface")
    assert (result.quantities, result.failures) == ({}, [])
    assert result.absent[0].reason.startswith("fluid_tube_surface: the primary branch has 0")


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


@pytest.mark.slow
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


@pytest.mark.slow
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


@pytest.mark.slow
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
