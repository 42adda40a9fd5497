"""Lopsided states of a tube that bears no compression: taut at first, wrinkled beside the near disk then."""

from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI
from tube_data import families, require_alike

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.tube.model import TubeMesh
from weakforms.problems.tube.parameters import TubeParameters
from weakforms.problems.tube.secondary.lopsided import AMPLITUDE, WholeTube
from weakforms.problems.tube.secondary.lopsided_relaxed import (
    KINK,
    RelaxedLopsidedBranch,
    RelaxedModes,
    share_below,
)
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton

pytestmark = pytest.mark.paper2
COARSE = {"cells": 32, "levels": 2, "step": 0.2}
TUBE = {"alpha": 0.0, "u_end": 1.8, "extent": "full", "secondary": True}
TAUT, WRINKLED = 12.1, 14.0
"""Volumes at which the tube is taut, and wrinkled beside the disk."""
OTHER_CODE = {
    **{"p": 1.45667100347, "u_max": 1.52448277126, "w_mid": 0.551713845585},
    "wrinkled_fraction": 0.0581634062892,
}
"""The state at the latter volume, by the table ``lopsided_wrinkled_neo_hookean``."""


@pytest.fixture(scope="module")
def relaxed():
    return families(TUBE, COARSE, "relaxed")


@pytest.fixture(scope="module")
def ordinary():
    return families(TUBE, COARSE, "standard")


def test_a_taut_state_and_the_crossing_are_those_of_the_law(relaxed, ordinary):
    require_alike(relaxed, ordinary, TAUT)
    assert relaxed["secondary"].curvatures()["p_2"].value == pytest.approx(
        ordinary["secondary"].curvatures()["p_2"].value, rel=1e-8
    )


def test_the_first_wrinkle_is_where_the_ordinary_tube_begins_to_be_compressed(relaxed, ordinary):
    (ours,), (theirs,) = (family["secondary"].located("wrinkling_onset") for family in (relaxed, ordinary))
    for name in ("p", "V", AMPLITUDE):  # the ends of two interpolants, of gw and of a resultant
        assert ours[-1].values[name] == pytest.approx(theirs[-1].values[name], rel=1e-6)


def test_a_wrinkled_state_is_that_of_another_code_within_its_uncertainty(relaxed):
    found = relaxed["secondary"].state("V", WRINKLED).quantities
    for name, value in OTHER_CODE.items():
        assert abs(found[name].value - value) <= found[name].uncertainty < 1e-3
    assert found["wrinkled"].value == 1
    assert found["n_negative"].value == 1
    assert found["n_negative_volume"].value == 0


def test_a_wrinkled_state_has_no_negative_resultant_and_less_energy(relaxed, ordinary):
    here, there = (family["secondary"].fine.at("V", WRINKLED).values for family in (relaxed, ordinary))
    assert there["t_min"] < -0.3
    assert here["t_min"] == pytest.approx(0, abs=1e-12)
    assert here["Pi"] + here["p"] * here["V"] < there["Pi"] + there["p"] * there["V"] - 1e-3
    assert here[AMPLITUDE] > there[AMPLITUDE] + 0.04


def test_the_gas_does_work_on_the_volume_of_wrinkled_states(relaxed):
    branch = relaxed["secondary"].fine
    p, v, potential = (branch.over_points(name) for name in ("p", "V", "Pi"))
    work = np.diff(p) * (v[1:] + v[:-1]) / 2
    assert branch.over_points("wrinkled_fraction")[-1] > 0.05
    assert np.diff(potential) == pytest.approx(-work, rel=1e-2)


def test_a_symmetric_wrinkled_state_is_that_of_a_mesh_that_follows_its_fronts():
    """With a zone at either disk, the sum of which is the wrinkled part."""
    given = {"alpha": 0.0, "u_end": 2.0, "energy": "relaxed"}
    numerics = {"cells": 48, "degree": 5, "levels": 2}
    follows = solve("tube", **given, at={"u_max": 1.8}, numerics=numerics).states[0].quantities
    parameters = TubeParameters(**given)
    tube = MPI.COMM_SELF, parameters.material, 1.0, 6.0, TubeMesh(64, 5, 0.6, full=True)
    errors = []
    for energy in ("relaxed", "standard"):
        model = WholeTube.free(*tube, uneven=0.0, energy=energy)
        solver, state = ExtendedNewton(model.system, ["p"]), model.system.initial.copy()
        state.loads["delta1"] = 1.3
        for u in np.linspace(0.1, 1.8, 18):
            state, _ = solver.solve(state, [Held("u_max", float(u))])
            state.loads["delta1"] = 1.0
        state, _ = solver.solve(state, [Held("u_max", 1.8)])
        errors.append(abs(state.loads["p"] / follows["p"].value - 1))
        if energy == "relaxed":
            modes = RelaxedModes(model, (0,))
            with model.system.at(state):
                part = modes.observe()["wrinkled_fraction"]
            assert part == pytest.approx(follows["wrinkled_fraction"].value, abs=2e-6)
    assert errors[0] < 1e-6
    assert errors[1] > 100 * errors[0]


def test_the_share_of_an_interval_that_is_below_a_level():
    one, other = np.array([0.0, 1.0, 0.0, 2.0, 0.5]), np.array([1.0, 0.0, 0.0, 3.0, 0.5])
    assert share_below(one, other, 0.25).tolist() == [0.25, 0.25, 1.0, 0.0, 0.0]


def test_a_wrinkled_state_has_the_largest_uncertainty_of_its_neighbours(relaxed):
    family = relaxed["secondary"]
    assert family.smooth_order({"wrinkled_fraction": 1e-4}) == KINK
    assert family.smooth_order({"wrinkled_fraction": 0.0}) == np.inf
    own = super(type(family), family).state("V", WRINKLED).quantities
    beside = list(family._beside("V", WRINKLED, 1))
    found = family.state("V", WRINKLED).quantities
    assert len(beside) == 4
    for name in ("p", "u_max", AMPLITUDE, "eigenvalue_1"):
        every = [own[name].uncertainty, *(other[name].uncertainty for other in beside)]
        assert found[name].uncertainty == pytest.approx(max(every), rel=1e-6)
        assert found[name].value == own[name].value
    assert found["V"].uncertainty < 1e-9
    taut = super(type(family), family).state("V", TAUT).quantities
    assert family.state("V", TAUT).quantities == taut


def test_points_of_the_branch_have_those_of_their_neighbours(relaxed):
    family = relaxed["secondary"]
    own = super(type(family), family).branch().uncertainty["p"]
    found = family.branch()
    wrinkled = found.columns["wrinkled_fraction"] > 0
    assert np.array_equal(found.uncertainty["p"][~wrinkled], own[~wrinkled])
    i = len(own) - 4
    assert wrinkled[i]
    assert found.uncertainty["p"][i] == own[i - 2 : i + 3].max()


def test_a_branch_ends_where_its_meridian_is_compressed():
    point = SimpleNamespace(state=None)
    branch = SimpleNamespace(side=1.0, _most=9.0, ending=lambda *_: lambda _: False, _slack=lambda _: True)
    assert RelaxedLopsidedBranch.until(branch, None, point)(point)
    branch._slack = lambda _: False
    assert not RelaxedLopsidedBranch.until(branch, None, point)(point)


def test_where_the_tube_would_be_compressed_no_branch_begins():
    given = TUBE | {"delta1": 1.05, "u_end": 1.8, "energy": "relaxed"}
    found = solve("tube", **given, numerics=COARSE)
    assert [branch.name for branch in found.branches] == ["primary"]
    (absent,) = (a for a in found.absent if a.what == "secondary branch")
    assert "where the mirror symmetry breaks, the tube would be compressed" in absent.reason


@pytest.mark.parametrize("given", [{"n": (0, 1)}, {"uneven": 0.01}])
def test_other_lopsided_states_of_a_tube_that_wrinkles_are_refused(given):
    with pytest.raises(InputError, match=r"energy = 'relaxed' is for axisymmetric, lopsided and bent states"):
        solve("tube", **TUBE | given, energy="relaxed")
