"""Triangulated tubes at random parameters: their first state, their branch, and what is said without one."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.meridian.pre_stretch import unloaded_heights
from weakforms.problems.triangles.meshes import tube
from weakforms.problems.triangles.model import Body
from weakforms.problems.wrinkled.problem import WrinkledNumerics, WrinkledParameters, wrinkled_membrane
from weakforms.solvers.equilibrium.subspace import Subspace

pytestmark = pytest.mark.paper5

MESH = {"meridional": 30, "circumferential": 12}
ONE = {"scan": 1, "shown": 1, "eigenvalues": 0}


@pytest.mark.parametrize("M", [0.05, 1.0, 1.9])
def test_heights_without_load_have_the_same_force_everywhere(M):
    c2, delta, s = 0.4, 2.5, np.linspace(0.0, 1.0, 41)
    z = unloaded_heights(mooney_rivlin_of(c2), M, delta, s)
    lam, middle = np.diff(z) / np.diff(s), (s[1:] + s[:-1]) / 2
    force = (M + 2 * (1 - M) * middle) * 2 * (lam - lam**-2) * (1 + c2 / lam)
    assert (z[0], z[-1]) == pytest.approx((0.0, delta), abs=1e-8)
    assert force == pytest.approx(np.full(40, force[0]), rel=1e-4)


@pytest.mark.parametrize(
    "given",
    [
        {"M": 0.1058, "delta": 1.899, "c2": 0.8509, "L": 15.31, "Af": 0.3391},
        {"M": 0.088, "delta": 3.784, "c2": 0.491, "L": 9.08, "Af": 1.196},
    ],
)
def test_a_tube_with_a_thin_end_has_the_state_of_the_axisymmetric_problem(given):
    """At the uniform stretch of the first guess the tangent soon was singular."""
    result = solve("surface", **given, load="gas", load_end=0.02, **MESH | {"meridional": 120}, numerics=ONE)
    assert (result.failures, result.absent) == ([], [])
    mesh = WrinkledNumerics(cells=6, degree=4, levels=2)
    exact = wrinkled_membrane(WrinkledParameters(**given, load="gas"), mesh, MPI.COMM_WORLD)
    unloaded, _ = exact.by_homotopy(0.0)
    with exact.plain_model.system.at(unloaded):
        volume = exact.plain_model.system.monitor("V")
    prism = 12 * np.sin(np.pi / 6)  # twice the area of a polygon of 12 corners; ``volume`` is over 2 pi
    assert result.branch()["V"][0] == pytest.approx(prism * volume, rel=0.02)


def test_a_long_tube_under_gas_is_not_pinched():
    """Long steps led to an equilibrium with rings on the axis; it was shown, and lost at p = 0.344."""
    given = {"model": "rivlin_saunders", "c10": 0.9478, "c01": 0.1374, "q": 0.8301, "M": 0.6446, "L": 24.79}
    given |= {"load": "gas", "load_end": 0.19}
    coarse, fine = (solve("surface", **given, **MESH, numerics=ONE | {"scan": scan}) for scan in (4, 16))
    assert coarse.failures == []
    assert coarse.branch()["n_negative"].tolist() == [0] * 5
    assert coarse.branch()["V"] == pytest.approx(fine.branch()["V"][::4], rel=1e-9)


@pytest.mark.parametrize(
    ("given", "advice", "without"),
    [
        ({"load": "gas"}, "bring M closer to 1, or Af to 0.577", "gamma"),
        ({"load": "fluid"}, "choose another gamma, or bring M closer to 1, or Af to 0.577", "lower"),
        ({"geometry": "hemisphere", "size": 0.3}, "choose another gamma", "M closer"),
    ],
)
def test_without_a_first_state_the_message_names_what_has_an_effect(monkeypatch, given, advice, without):
    """Under gas it named ``gamma``, which has none."""

    def never(*_):
        raise ConvergenceError("it diverges")

    monkeypatch.setattr(Subspace, "solve", never)
    mesh = {} if "size" in given else MESH
    with pytest.raises(ConvergenceError, match=rf"no first state .*it diverges; {advice}") as error:
        solve("surface", **given, **mesh, numerics=ONE)
    assert without not in str(error.value)


def test_where_a_branch_is_lost_the_message_says_how_far_it_is_followed(monkeypatch):
    solved = Subspace.solve

    def up_to_five(self, guess, loads):
        if loads["zw"] > 5:
            raise ConvergenceError("it diverges")
        return solved(self, guess, loads)

    monkeypatch.setattr(Subspace, "solve", up_to_five)
    result = solve("surface", load_start=3.0, load_end=9.0, **MESH, numerics=ONE | {"scan": 3})
    (failure,) = result.failures
    assert failure.what == "branch primary, from zw = 7"
    assert failure.reason.startswith("it diverges; choose load_start and load_end up to 5, where")
    assert result.branch()["zw"].tolist() == [3.0, 5.0]


def test_a_pre_stretch_beyond_the_end_of_a_law_is_refused():
    """It ended without a first state."""
    with pytest.raises(InputError, match=r"surface: delta = 5 alone stretches .*'gent'"):
        solve("surface", model="gent", jm=3.0, delta=5.0, **MESH, numerics=ONE)


def test_every_first_guess_of_a_tube_keeps_its_supports():
    body = Body(tube(8.0, 6, 8), M=0.3, delta=3.0, Af=0.4362)
    first, *others = body.starts()
    held = body.triangles.held
    assert len(others) == 2
    for guess in others:
        assert guess[held] == pytest.approx(first[held], rel=1e-8, abs=1e-12)
        assert np.abs(guess - first).max() > 0.5
