"""No table of paper 4 is made of what did not converge: every iteration gives up with its words."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import AWAY, GAS, always, refused

from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.paper4 import cases, events, limits, tables_crests, tables_statements
from reference_data.solvers.paper4 import tables_branches as branches
from reference_data.solvers.paper4.methods import collocation as wrinkled
from reference_data.solvers.paper4.methods import differences as wrinkled_fd
from reference_data.solvers.paper4.methods import shooting as wrinkled_shooting
from reference_data.solvers.paper4.methods import shooting_newton, states
from reference_data.solvers.paper4.methods.collocation import Pattern, Rule, State

LOST = ": Newton's method does not converge$"


def guess(breaks=(0.0, 8.0), kinds=(), values=1.0):
    """A state of some zones, all taut, with the same values everywhere."""
    count = len(breaks) - 1
    pattern = Pattern(breaks, kinds, (True,) * count, (True,) * count)
    return State(GAS, Rule(2, 9.0), pattern, (1,) * count, np.full((count, 3, 5), values), 0.1)


def test_collocation_of_wrinkled_tubes(monkeypatch):
    lost = guess(values=np.nan)
    refused(f"^collocation of Membrane.* at V = 30{LOST}", wrinkled.newton, lost, "V", 30.0)
    monkeypatch.setattr(states, "newton", always(lost))
    monkeypatch.setattr(states, "mended", always(lost))
    refused("^collocation: zones do not settle at V = 30, Membrane", states.polished, lost, "V", 30.0)


def test_a_zone_that_shrinks_to_nothing_is_named(monkeypatch):
    short = 0.1 * wrinkled.SHORTEST
    start = guess((0.0, 1.0, 1.0 + short, 8.0), ("front", "front"))

    class Shrinks:
        def __init__(self, _state, *_given):
            self.missed, self.defects = None, None

        def solve(self, *_):
            return [np.full((1, 3, 5), 0.1)] * 3, np.array([0.0, 0.0, -1e3 * short])

    monkeypatch.setattr(wrinkled.Problem, "linearised", Shrinks)
    refused("^zone 1 vanished$", wrinkled.newton, start, "load", 0.1, error=wrinkled.VanishedZoneError)


def test_zones_that_vanish_join_or_change_places():
    """Two fronts go, the surface leaves at the top, a front and the surface change places."""
    three = Pattern((0.0, 1.0, 2.0, 8.0), ("front", "front"), (True, False, True), (True, True, True))
    fluid = replace(GAS, load="fluid")
    values = np.ones((3, 3, 5))

    def left(pattern, zone):
        state = State(
            fluid, Rule(2, 9.0), pattern, (1,) * len(pattern.tense), values[: len(pattern.tense)], 5.0
        )
        return states.without(state, zone).pattern

    assert left(three, 1).kinds == ()
    top = Pattern((0.0, 7.9, 8.0), ("surface",), (True, True), (True, False))
    assert left(top, 1).kinds == ()
    meet = replace(three, kinds=("front", "surface"), tense=(True, False, False), wet=(True, True, False))
    assert left(meet, 1).kinds == ("surface", "front")


@pytest.mark.parametrize("step", AWAY)
def test_other_methods_for_wrinkled_tubes(step, monkeypatch):
    guess = wrinkled_fd.unloaded(GAS, 8)
    monkeypatch.setattr(wrinkled_fd, "solve_banded", lambda _bands, _matrix, rhs: np.full(len(rhs), step))
    refused(f"^finite differences of Membrane.* at p = 0.1{LOST}", wrinkled_fd.newton, guess, 0.1)
    shot = SimpleNamespace(ends=np.full((1, 1, 5), step))
    monkeypatch.setattr(shooting_newton, "Shot", always(shot))
    monkeypatch.setattr(shooting_newton, "matrix_of", always(np.eye(5)))
    monkeypatch.setattr(shooting_newton.Solution, "missing", lambda *_: np.full(5, step))
    given = GAS, np.zeros((1, 4)), 0.1, "V", 30.0, 4
    refused(f"^shooting of Membrane.* at V = 30{LOST}", shooting_newton.solve, *given)
    coarse = shooting_newton.Solution(GAS, np.zeros((1, 4)), 0.1, shot, np.eye(5), "V")
    refused(f"^shooting of Membrane.* with 8 steps{LOST}", shooting_newton.refined, coarse, 30.0, 8)


def test_shots_that_meet_an_event_after_every_bit(monkeypatch):
    shot = wrinkled_shooting.Shot.__new__(wrinkled_shooting.Shot)
    vars(shot).update(membrane=GAS, h=np.ones(1), advance=lambda _s, y, *_: y)
    shot.crossed, shot.event = lambda s, *_: np.ones(len(s), int), lambda *_: (1e-3, 1)
    one = np.zeros(1), np.zeros((1, 1, 5)), np.ones(1, bool), np.ones(1, bool), [], []
    refused("^shooting: too many events in one step for Membrane", shot.step, *one)


def test_points_of_wrinkled_tubes_that_are_not_there(monkeypatch):
    touch = SimpleNamespace(field="gw", near=2.0, membrane=GAS, maximum=True)
    assert events.pick([(1.9, 1.0, -1.0)], touch) == (1.9, 1.0)
    refused("^no stationary gw near Z = 2: Membrane", events.pick, [(1.9, 1.0, 1.0)], touch)
    monkeypatch.setattr(limits.sta, "from_grid", always(None))
    monkeypatch.setattr(limits, "grid_at", always(None))
    monkeypatch.setattr(limits.sta, "polished", always(SimpleNamespace(volume=1.0, rate=always(1.0))))
    refused("^collocation: no limit load of Membrane", limits.climbed, GAS, 0.1, 0.5, 3)


def test_fronts_of_other_patterns(monkeypatch):
    monkeypatch.setattr(branches.cas, "solved", lambda _, load: SimpleNamespace(zones=f"zones {load:g}"))
    words = "^table t: patterns zones 1; zones 2$"
    refused(words, branches.fronts, "t", GAS, np.array([1.0, 2.0]), "")


def test_methods_that_find_other_numbers_of_fronts(monkeypatch):
    monkeypatch.setattr(cases.msr, "measures", always(SimpleNamespace(fronts=np.array([1.0]))))
    monkeypatch.setattr(cases.smsr, "measures", always(SimpleNamespace(fronts=np.array([1.0, 2.0]))))
    state = cases.Solved(GAS, 0.1)
    vars(state).update(tracked=[None], shots=[None])
    words = "^Membrane.* at 0.1: fronts "
    vars(state).update(tracked=[None, None], shots=[None, None])
    refused(words, lambda: state.measured, error=DisagreementError)


def test_crests_of_other_numbers(monkeypatch):
    one, two = (SimpleNamespace(crests=c, troughs=()) for c in ((1.0,), (1.0, 2.0)))
    monkeypatch.setattr(
        tables_crests.cas, "solved", always(SimpleNamespace(measured=([one, one], [one, two])))
    )
    refused("^table t: crests at p = 0.3: ", tables_crests.crests, "t")


def test_grids_that_find_other_fronts(monkeypatch):
    exact = SimpleNamespace(
        tracked=[None, None], measured=([None, SimpleNamespace(fronts=np.array([1.0]))], None)
    )
    monkeypatch.setattr(tables_statements.cas, "solved", always(exact))
    monkeypatch.setattr(tables_statements.fd, "unloaded", always(None))
    monkeypatch.setattr(tables_statements.fd, "walk", always(SimpleNamespace(fronts=np.array([1.0, 2.0]))))
    words = r"^table t: 100 intervals have fronts at \[1. 2.\]$"
    refused(words, tables_statements.fd_scheme, "t", GAS, 0.2)
