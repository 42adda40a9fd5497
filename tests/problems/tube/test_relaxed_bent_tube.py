"""Bent states of a tube that bears no compression: taut at first, wrinkled at the disk further on."""

from types import SimpleNamespace

import numpy as np
import pytest
from mpi4py import MPI
from tube_data import families, require_alike

from weakforms import solve
from weakforms.errors import InputError
from weakforms.problems.meridian.kinks import EDGE, KINK, SEEN
from weakforms.problems.meridian.sector import SectorMesh
from weakforms.problems.tube.parameters import TubeParameters
from weakforms.problems.tube.secondary.bent import bent_tube
from weakforms.problems.tube.secondary.surface import AMPLITUDE
from weakforms.problems.tube.secondary.wrinkled import WrinkledBranch
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.sampling import Sampler

pytestmark = pytest.mark.paper2
COARSE = {
    "cells": 32,
    "levels": 2,
    "step": 0.2,
    "secondary_cells": 8,
    "secondary_around": 4,
    "secondary_degree": 4,
}
BENDING = {"alpha": 0.0, "lf": 10.0, "u_end": 1.2, "secondary": True, "secondary_n": 1}
TAUT, WRINKLED = 6.2, 7.2
"""Volumes at which the tube is taut, and wrinkled at the disk."""


@pytest.fixture(scope="module")
def relaxed():
    return families(BENDING, COARSE, "relaxed")


@pytest.fixture(scope="module")
def ordinary():
    return families(BENDING, COARSE, "standard")


def test_a_taut_state_and_the_crossing_are_those_of_the_law(relaxed, ordinary):
    require_alike(relaxed, ordinary, TAUT)


def test_a_wrinkled_state_has_no_negative_resultant_and_less_energy(relaxed, ordinary):
    here, there = (family["secondary"].fine.at("V", WRINKLED).values for family in (relaxed, ordinary))
    assert there["t_min"] < -0.05
    assert here["t_min"] == pytest.approx(0, abs=1e-12)
    assert 5e-4 < here["wrinkled_fraction"] < 5e-3
    assert here["Pi"] + here["p"] * here["V"] < there["Pi"] + there["p"] * there["V"] - 1e-6
    assert here[AMPLITUDE] > there[AMPLITUDE] + 5e-5


def test_the_gas_does_work_on_the_volume_of_wrinkled_states(relaxed):
    branch = relaxed["secondary"].fine
    p, v, potential = (branch.over_points(name) for name in ("p", "V", "Pi"))
    work = np.diff(p) * (v[1:] + v[:-1]) / 2
    assert branch.over_points("wrinkled_fraction")[-1] > 0
    assert np.diff(potential) == pytest.approx(-work, rel=1e-2)


def test_an_axisymmetric_wrinkled_state_is_that_of_a_mesh_that_follows_its_fronts():
    """The wrinkled zone of a tube that does not bend, on the surface and on the meridian."""
    given = {"alpha": 0.0, "lf": 6.0, "u_end": 2.0, "energy": "relaxed"}
    numerics = {"cells": 48, "degree": 5, "levels": 2}
    meridian = solve("tube", **given, at={"u_max": 1.8}, numerics=numerics).states[0].quantities
    given |= {"secondary": True, "secondary_n": 1}
    errors = []
    for energy in ("relaxed", "standard"):
        parameters = TubeParameters(**given | {"energy": energy})
        model = bent_tube(parameters, SectorMesh(24, 2, 5, 0.6), MPI.COMM_SELF)
        start = model.state_of(lambda s, _: np.vstack([1 + 0.3 * (1 - (s / 3) ** 6), 0 * s, s]), {"p": 1.4})
        solver = ExtendedNewton(model.system, ["p"])
        for u in np.linspace(0.3, 1.8, 31):
            start, _ = solver.solve(start, [Held("u_max", float(u))])
        errors.append(abs(start.loads["p"] / meridian["p"].value - 1))
    assert errors[0] < 2e-6
    assert errors[1] > 20 * errors[0]


def test_profiles_have_the_resultants_of_the_relaxed_energy():
    """On a state that is stretched along the axis and narrowed: in uniaxial tension, by Mooney's law."""
    parameters = TubeParameters(**BENDING | {"alpha": 0.1}, energy="relaxed")
    model = bent_tube(parameters, SectorMesh(4, 2, 2, 0.0), MPI.COMM_SELF)
    narrow, long = 0.6, 1.5
    state = model.state_of(lambda s, _: np.vstack([0 * s + narrow, 0 * s, long * s]), {"p": 0.0})
    with model.system.at(State(state.u, {"p": 0.0})):
        sampled = Sampler(model.unknown, model.system.formulation.profile, np.array([[2.0, 0.0]]))()
        least = Sampler(model.unknown, model.principal_resultants(), np.array([[2.0, 0.0]]))()
        stored = model.system.monitor("Pi")
    tension = 2 * (1 + 0.1 / long) * (long - long**-2)
    assert sampled["t1"] == pytest.approx(tension / narrow, rel=1e-10)
    assert sampled["t2"] == pytest.approx(0, abs=1e-12)
    assert least["second"] < -0.1
    energy = long**2 + 2 / long - 3 + 0.1 * (2 * long + long**-2 - 3)
    assert stored == pytest.approx(5.0 * energy, rel=1e-10)


def test_a_branch_ends_where_an_eigenvalue_changes_its_sign_and_the_pressure_does_not_turn():
    def point(rate, count):
        return SimpleNamespace(tangent=SimpleNamespace(loads={"p": rate}), n_negative=count)

    branch = SimpleNamespace(side=1.0, _most=9.0, ending=lambda *_: lambda _: False)
    primary, start = SimpleNamespace(control="p"), point(-1.0, 1)
    ends = WrinkledBranch.until(branch, primary, start)
    assert [ends(p) for p in (point(-1.0, 1), point(1.0, 2), point(1.0, 2), point(1.0, 3))] == [
        False,
        False,
        False,
        True,
    ]
    ends = WrinkledBranch.until(branch, primary, start)
    assert ends(point(1.0, 1))
    assert branch._ripples


def test_uncertainties_of_wrinkled_states_assume_a_low_order(relaxed):
    family = relaxed["secondary"]
    assert family.smooth_order({"wrinkled_fraction": 1e-4}) == KINK < family.cap
    assert family.smooth_order({"wrinkled_fraction": 0.0}) == np.inf
    found = family.state("V", WRINKLED).quantities
    ours, theirs = (level.at("V", WRINKLED).values["wrinkled_fraction"] for level in family.levels)
    part = found["wrinkled_fraction"]
    assert family.caps["wrinkled_fraction"] == EDGE
    assert part.uncertainty == pytest.approx(3 * abs(ours - theirs) + SEEN * part.value, rel=1e-6)
    assert found["wrinkled"].value == 1
    assert found["n_negative_all_volume"].value == 0


def test_a_branch_has_its_resultants_and_how_much_is_wrinkled(relaxed):
    found = relaxed["secondary"].branch(with_uncertainty=False)
    assert np.all(found.columns["t_min"] >= 0)
    wrinkled = found.columns["wrinkled"] == 1
    assert wrinkled[-1]
    assert not wrinkled[0]
    assert np.all(found.columns["t_min"][wrinkled] < 1e-12)
    assert np.all(found.columns["wrinkled_fraction"][~wrinkled] == 0)


def test_where_the_tube_would_be_compressed_no_branch_begins():
    given = BENDING | {"delta1": 1.1, "u_end": 1.5, "energy": "relaxed"}
    found = solve("tube", **given, numerics=COARSE)
    assert [branch.name for branch in found.branches] == ["primary"]
    (absent,) = (a for a in found.absent if a.what == "secondary branch")
    assert "the tube would be compressed; relaxed states begin where it is taut" in absent.reason


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"secondary_n": 0}, "set extent = 'full', or secondary_n = 1 for bent states"),
        ({"n": (0, 1)}, r"set n = \(\), or energy = 'standard'"),
        ({"model": "saint_venant_kirchhoff"}, "allowed: "),
    ],
)
def test_other_branches_of_a_tube_that_wrinkles_are_refused(given, message):
    given = {k: v for k, v in (BENDING | given).items() if not (k == "alpha" and "model" in given)}
    with pytest.raises(InputError, match=message):
        solve("tube", **given, energy="relaxed")
