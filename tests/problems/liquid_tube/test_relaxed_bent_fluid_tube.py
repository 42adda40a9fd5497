"""Bent states of a tube of liquid that bears no compression: taut at first, wrinkled further on."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI
from scipy.interpolate import CubicSpline

from weakforms import solve
from weakforms.errors import AbsentError, InputError
from weakforms.problems.liquid_tube.bent.fitted import Fitting, KeptNewton
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.liquid_tube.bent.surface import SurfaceData
from weakforms.problems.liquid_tube.critical import AxisymmetricState
from weakforms.problems.liquid_tube.relaxed_bent import RelaxedSecondaryBranch, RelaxedSecondaryFamily
from weakforms.problems.meridian.kinks import KINK
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.state import State

pytestmark = pytest.mark.paper3
TUBE = {"L": 12.0, "delta": 1.4, "gamma": 0.03, "n_max": 1, "secondary": True}
COARSE = {
    **{"cells": 32, "levels": 2, "step": 1.0, "secondary_cells": 12, "secondary_levels": 2},
    **{"secondary_degree": 4, "secondary_step": 0.4, "secondary_end": 0.8},
}
TAUT, WRINKLED = 19.5, 17.2
"""Levels at which the bent tube is taut, and wrinkled at the lower ring."""


@cache
def solved(energy):
    at = [("zw", TAUT), ("zw", WRINKLED)]
    return solve("fluid_tube", **TUBE, energy=energy, at=at, branch="secondary", numerics=COARSE)


def values(energy, index):
    return {name: q.value for name, q in solved(energy).states[index].quantities.items()}


@pytest.mark.slow
def test_a_taut_state_and_the_bifurcation_are_those_of_the_law():
    ours, theirs = (values(energy, 0) for energy in ("relaxed", "standard"))
    assert ours.keys() - {"wrinkled_fraction"} == theirs.keys()
    for name, value in theirs.items():
        assert ours[name] == pytest.approx(value, rel=1e-8, abs=1e-8), name
    assert ours["wrinkled_fraction"] == 0
    begins = [
        next(p for p in solved(energy).special_points if p.branch == "secondary")
        for energy in ("relaxed", "standard")
    ]
    for name in ("zw", "V", "dzw_dV"):
        assert begins[0].values[name] == pytest.approx(begins[1].values[name], rel=1e-7)


@pytest.mark.slow
def test_a_wrinkled_state_has_no_negative_resultant_and_holds_less():
    ours, theirs = (values(energy, 1) for energy in ("relaxed", "standard"))
    assert theirs["T_min"] < -0.05
    assert ours["T_min"] == pytest.approx(0, abs=1e-12)
    assert 5e-4 < ours["wrinkled_fraction"] < 5e-3
    assert theirs["V"] - 2e-2 < ours["V"] < theirs["V"] - 1e-3


@pytest.mark.slow
def test_a_branch_has_how_much_is_wrinkled():
    part = solved("relaxed").branch("secondary").columns["wrinkled_fraction"]
    assert part[0] == 0
    assert part[-1] > 5e-4
    assert not solved("relaxed").failures


@pytest.mark.parametrize("energy", ["relaxed", "standard"])
def test_an_axisymmetric_wrinkled_state_is_that_of_a_mesh_that_follows_its_fronts(energy):
    """A full tube that does not bend, on the surface and on the meridian."""
    tube = {"L": 8.0, "delta": 1.05, "gamma": 0.116, "alpha": 0.2}
    mesh = {"cells": 32, "levels": 2, "degree": 5}
    found = solve("fluid_tube", **tube, n_max=1, energy="relaxed", at={"V": 400.0}, numerics=mesh)
    (state,) = found.states
    profile = state.fields[0].columns
    r, z = (CubicSpline(profile["Z"], profile[name]) for name in "rz")
    length = tube["L"] / tube["delta"]
    data = SurfaceData(*tube.values(), 24, 2, 5, front=length, relaxed=energy == "relaxed")
    model = SurfaceModel(MPI.COMM_SELF, data)
    guess = model.state_of(
        lambda s, t: np.vstack([r(s) * np.cos(t), r(s) * np.sin(t), z(s)]),
        {"zw": state.quantities["zw"].value},
    )
    bent = Fitting(model, KeptNewton(model.system, ["zw"])).solve(guess, [Held("V", 400.0)])
    error = abs(bent.loads["zw"] / state.quantities["zw"].value - 1)
    assert error < 1e-5 if energy == "relaxed" else error > 1e-4


def test_resultants_are_those_of_uniaxial_tension_where_it_is_wrinkled():
    """By Mooney's law, at given stretches; the meridional one acts on the actual width."""
    model = SurfaceModel(MPI.COMM_SELF, SurfaceData(8.0, 2.0, 0.1, 0.1, 6, 2, 2, front=4.0, relaxed=True))
    narrow, long = 0.6, 1.5
    tension = (1 + 0.1 / long) * (long - long**-2)
    found = model._resultants(np.array([long]), np.array([narrow]))
    assert found["T1"] == pytest.approx(tension / narrow, rel=1e-12)
    assert found["T2"] == 0.0


def test_where_the_tube_would_be_compressed_no_branch_begins():
    z = np.linspace(0, 4.0, 41)
    taut = AxisymmetricState({"zw": 7.0}, z, 0 * z + 0.92, 1.2 * z)
    RelaxedSecondaryFamily.require_start(taut)
    with pytest.raises(AbsentError, match="would be compressed; relaxed bent states begin where it is taut"):
        RelaxedSecondaryFamily.require_start(replace(taut, r=0 * z + 0.91))


def test_a_branch_that_is_absent_is_said_to_be(monkeypatch):
    def refuse(_begin):
        raise AbsentError("secondary branch", "it would be compressed")

    monkeypatch.setattr(RelaxedSecondaryFamily, "require_start", refuse)
    found = solve("fluid_tube", **TUBE, energy="relaxed", numerics=COARSE)
    assert [branch.name for branch in found.branches] == ["primary"]
    (absent,) = found.absent
    assert absent.what == "secondary branch"
    assert absent.reason == "fluid_tube: it would be compressed"


def test_a_branch_ends_where_an_eigenvalue_changes_its_sign_and_the_level_does_not_turn():
    def point(rate, count, part):
        tangent, state = SimpleNamespace(loads={"zw": rate}), State(np.zeros(0), {"zw": 18.0})
        given = {
            "tangent": tangent,
            "state": state,
            "arclength": 1.0,
            "monitors": {"wrinkled_fraction": part},
        }
        return SimpleNamespace(n_negative=count, **given)

    branch = RelaxedSecondaryBranch.__new__(RelaxedSecondaryBranch)
    branch.points, branch._lowest, branch.size = [point(-1.0, 0, 0.0)], 17.0, 10.0
    for counts, expected in (
        (((-1.0, 1, 0.0), (-1.0, 2, 0.0), (-1.0, 2, 1e-3)), False),  # taut, or no change
        (((-1.0, 1, 1e-3), (1.0, 2, 1e-3)), False),  # the level turns
        (((-1.0, 1, 1e-3), (-1.0, 2, 1e-3)), True),
    ):
        branch._before = branch.points[0]
        assert [branch.ends(point(*each)) for each in counts][-1] is expected
        assert branch._ripples is expected


def test_uncertainties_of_wrinkled_states_assume_a_low_order():
    family = RelaxedSecondaryFamily.__new__(RelaxedSecondaryFamily)
    assert family.smooth_order({"wrinkled_fraction": 1e-4}) == KINK
    assert family.smooth_order({"wrinkled_fraction": 0.0}) == np.inf


def test_no_eigenvalue_is_given_if_the_meshes_disagree_on_stability():
    family = RelaxedSecondaryFamily.__new__(RelaxedSecondaryFamily)
    family.warnings = []
    state = SimpleNamespace(values={"zw": 17.0})
    assert family._lowest_eigenvalue([state]) == {}
    (text,) = family.warnings
    assert text.startswith("secondary branch, zw = 17: the tube is or may be wrinkled")


def test_laws_that_cannot_wrinkle_are_refused():
    with pytest.raises(InputError, match="model"):
        solve("fluid_tube", **TUBE, energy="relaxed", model="harmonic")
