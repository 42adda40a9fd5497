"""Each guard refuses what is not an answer, tested on replacements of the solvers' results."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from small_systems import system_of
from stand_ins import bare, refused

from weakforms.errors import AbsentError, ConvergenceError
from weakforms.problems.liquid_tube.bent import stability as bent
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.problems.triangles import problem as surface
from weakforms.problems.wrinkled import events as wrinkled_events
from weakforms.problems.wrinkled.waves import bands as wrinkled_bands
from weakforms.problems.wrinkled.waves.bands import Bands
from weakforms.problems.wrinkled.waves.stability import StabilityChanges
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.stability.lowest import Lowest
from weakforms.solvers.stability.spectra import Stability


def mode(value, vector=1.0):
    return SimpleNamespace(eigenvalue=value, vector=np.array([vector]))


# -- bands of wave numbers -------------------------------------------------------------------------


@pytest.fixture
def bands(monkeypatch):
    """Bands whose lowest eigenvalue and required stiffness are given functions of the wave number."""

    def make(value=lambda n: n - 3.5, stiffness=lambda n: 0.0):
        monkeypatch.setattr(Bands, "lowest", lambda _self, n, _beta=None: value(n))
        monkeypatch.setattr(Bands, "unstable", lambda _self, n: value(n) < 0)
        monkeypatch.setattr(Bands, "stiffness", lambda _self, n: stiffness(n))
        return Bands(held=None)

    return make


def test_a_band_of_wave_numbers_ends_within_those_looked_at(bands):
    assert bands(lambda n: abs(n - 5) - 1.5).band(9) == ((3.0, 4.0), (6.0, 7.0))
    with pytest.raises(AbsentError, match=r"begin at n = 4, and the band reaches beyond 6"):
        bands(lambda n: abs(n - 5) - 1.5).band(6)
    with pytest.raises(AbsentError, match=r"begin at n = 1, and the band reaches beyond 3"):
        bands().band(3)


def test_a_zero_in_the_wave_number_needs_a_change_of_sign(bands):
    assert bands().zero(3.0, 4.0) == pytest.approx(3.5)
    refused("no change of stability between n = 1 and 3 on a mesh", bands().zero, 1.0, 3.0)


def test_the_largest_stiffness_is_inside_a_band_that_is_unstable_throughout(bands):
    n, largest = bands(stiffness=lambda n: 2 - (n - 10) ** 2).peak(10.1)
    assert (n, largest) == (pytest.approx(10.0), pytest.approx(2.0))
    refused("are not all unstable", bands(stiffness=lambda n: float(n > 10)).peak, 10.0)
    refused("the largest stiffness is not near n = 10", bands(stiffness=lambda n: n).peak, 10.0)


def test_no_stiffness_makes_it_stable(monkeypatch):
    waves = SimpleNamespace(negative_count=lambda *_: 1)
    monkeypatch.setattr(wrinkled_bands, "waves_at", lambda _: nullcontext(waves))
    with pytest.raises(AbsentError, match="unstable at any bending stiffness up to 1") as caught:
        Bands(held=None).stiffness(20.0)
    assert caught.value.what == "beta_c"


# -- changes of stability ----------------------------------------------------------------------------


def test_a_root_that_is_never_reached_is_none():
    """The eigenvalue jumps from -1 to 1: halving never ends."""
    at = lambda x: SimpleNamespace(value=x, lowest=-1.0 if x < 1 / 3 else 1.0, held=None)  # noqa: E731
    changes = bare(StabilityChanges, n=20)
    changes._first_found = lambda a, b, *_: at(a.value + 1e-3 * (b.value - a.value))
    refused("no root of Lambda for n = 20", changes._narrowed, at(0.0), at(1.0), "zw")


def test_zones_that_change_one_by_one_are_not_a_pair():
    zones = lambda *fronts, first=1: SimpleNamespace(zones=SimpleNamespace(fronts=fronts, first=first))  # noqa: E731
    told = wrinkled_events._at_both_ends
    refused("several zones change at once", told, None, zones(), zones(2.0), 1, "zw", True)
    refused("several zones change at once", told, None, zones(), zones(2.0, 6.0), 1, "zw", True)


def test_a_change_of_stability_that_the_surface_does_not_have():
    run = SimpleNamespace(control="zw")
    wanted = SimpleNamespace(name="stability_change", value=2)
    refused("this branch has 1 stability changes", surface._state, run, wanted, [None], 3)


def test_a_bifurcation_that_the_primary_branch_does_not_have():
    forks = [SimpleNamespace(values={"n": 1.0})]
    piece = SimpleNamespace(special=lambda: forks, crossings=lambda *_: [], stalled="steps too small")
    told = bare(PrimaryBranch, path=SimpleNamespace(pieces=[piece], zw_end=0.7))
    refused("has 0 bifurcation points of n = 2, not 1, as far as .*too small", told.bifurcation, [0.0], 2)
    refused("has 1 bifurcation points of n = 1, not 2", told.bifurcation, [0.0], 1, 2)
    piece.stalled = None
    with pytest.raises(AbsentError, match=r"has 1 bif.* to 0\.7 of the highest.*choose another delta"):
        told.bifurcation([0.0], 1, 2)
    refused("zw = 5 is not taken 1 times", told.at, "zw", 5.0, [0.0])


# -- bent states -----------------------------------------------------------------------------------


def breaking(eigenvalues, below, turn):
    """A bent state with given symmetry-breaking eigenvalues, the turn of the pattern among them."""
    modes = [mode(value) for value in eigenvalues]
    told = bare(bent.BentStability, breaks=SimpleNamespace(about=lambda *_: (modes, below)))
    told._turn = lambda *_: modes[turn]
    return told


def test_bent_states_count_what_breaks_the_symmetry_twice():
    refused("inertia counts 1 .* SLEPc finds 0", breaking([1e-9, 0.2, 0.3], 1, 0)._breaking, None)
    refused("inertia counts 0 .* SLEPc finds 1", breaking([-0.1, 1e-9, 0.3], 0, 1)._breaking, None)


def test_an_eigenvalue_as_near_to_zero_as_the_turns_has_no_sign():
    refused("its sign is uncertain", breaking([1e-9, -5e-10, 0.3], 0, 0)._breaking, None)


def test_bent_states_below_every_target_are_refused():
    keeps = SimpleNamespace(about=lambda *_: ([mode(-1.0)], 1))
    refused("there are eigenvalues below", bare(bent.BentStability, keeps=keeps, _lowest=-1.0).lowest, None)


# -- eigenvalues -----------------------------------------------------------------------------------


def test_no_negative_eigenvalue_where_one_is_wanted():
    told = bare(Stability, system=system_of(lambda u, v, p: u * v), modes=lambda *_: [mode(0.1), mode(2.0)])
    refused("no negative eigenvalue is found near zero", told.highest_negative, None)
    told.modes = lambda *_: [mode(0.1), mode(-0.5)]
    assert told.highest_negative(None).eigenvalue == -0.5


def test_a_singular_tangent_has_no_inertia():
    refused("met a zero pivot", bare(Factorization, failed=True).negative_count)


def test_a_stiffness_to_compare_with_is_positive():
    system = system_of(lambda u, v, _p: u.dx(0) * v.dx(0) - 20 * u * v, "Lagrange", 2, 20, ends=True)
    refused("not positive", Stability(system).lowest_against, system.initial, system.mass)


def test_eigenvalues_below_every_target_are_refused(monkeypatch):
    system = system_of(lambda u, v, _p: u.dx(0) * v.dx(0), "Lagrange", 2, 20, ends=True)
    looked = Lowest(system)
    monkeypatch.setattr(looked, "_below", lambda _shift: 1)
    looked._count = 1
    refused("there are eigenvalues below -", looked._go_below)


def test_copies_that_are_never_found_are_missed(monkeypatch):
    system = system_of(lambda u, v, _p: u.dx(0) * v.dx(0), "Lagrange", 2, 20, ends=True)
    looked = Lowest(system)
    right = looked._below
    monkeypatch.setattr(looked, "_below", lambda shift: right(shift) + (shift > 0) * 100)
    with pytest.raises(ConvergenceError, match="finds fewer lowest eigenvalues than the inertia counts"):
        looked(system.initial, 2)
