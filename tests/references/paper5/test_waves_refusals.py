"""No table of paper 5 is made of what did not converge: every iteration gives up with its words."""

from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import AWAY, always, refused

from reference_data.solvers.paper5 import bloch, bloch_metric, tables_cylinder, tables_surface
from reference_data.solvers.paper5.waves import koiter
from reference_data.solvers.paper5.waves.bending import Bent
from reference_data.solvers.paper5.waves.cylinder import FLUID

LOST = ": Newton's method does not converge$"


@pytest.mark.parametrize("step", AWAY)
def test_polyhedra(step, monkeypatch):
    mesh = bloch.Polyhedron(FLUID, 4, 6)
    start = np.ones((5, 3))
    monkeypatch.setattr(bloch, "solve_banded", always(np.full(9, step)))
    refused(f"^polyhedron 4 x 6 at zw = 5{LOST}", bloch.newton, mesh, start, 5.0)


def test_windows_without_a_change_of_stability(monkeypatch):
    unstable = [False]
    monkeypatch.setattr(tables_surface, "state", always(SimpleNamespace(unstable=lambda: unstable[0])))
    mesh = bloch.Polyhedron(FLUID, 4, 6)
    refused(r"^polyhedron .*: no unstable level in \(5.0, 6.0\)$", tables_surface.end, mesh, (5.0, 6.0), True)
    unstable[0] = True
    refused("^polyhedron .*: unstable already at 5$", tables_surface.end, mesh, (5.0, 6.0), True)


@pytest.mark.parametrize("lower", [True, False])
def test_ends_of_an_unstable_range_are_bracketed(lower, monkeypatch):
    """A made-up membrane that is unstable between two levels, against three waves."""
    low, high = 5.123456, 5.654321

    def state(_mesh, level, _near):
        return SimpleNamespace(unstable=lambda: [6, 7, 8] if low < level < high else [])

    monkeypatch.setattr(tables_surface, "state", state)
    level, waves = tables_surface.end(bloch.Polyhedron(FLUID, 4, 6), (5.0, 6.0), lower)
    assert level == pytest.approx(low if lower else high, abs=tables_surface.WIDTH)
    assert waves == 7


def test_ends_of_other_wave_numbers_by_the_metric(monkeypatch):
    monkeypatch.setattr(tables_surface, "end", lambda _mesh, window, _lower: (window[0], 7))
    monkeypatch.setattr(tables_surface, "again", lambda _mesh, level, _lower: (level, 8))
    monkeypatch.setattr(tables_surface, "gaps", always([]))
    refused("wave numbers 7, 7 and by the metric 8, 8$", tables_surface.surface_ranges, "t")


def test_stiffnesses_that_are_not_found():
    told = Bent(None)
    turns = iter(range(10**6))
    told.first = lambda *_: (-np.exp(np.cos(next(turns))), 1.0)
    refused("^bending: no beta found for n = 20$", told.needed, 20.0)
    told.needed = lambda n: n
    refused("^bending: no maximum of beta about n = 20$", told.critical, 20.0)


def test_hermite_elements_on_a_taut_state():
    taut = SimpleNamespace(state=SimpleNamespace(tense=np.array([False, True])))
    refused("^Hermite elements: the state is not wholly wrinkled$", koiter.hermitian, taut, 20.0, 0.0, 10)


@pytest.mark.parametrize("step", AWAY)
def test_polyhedra_by_the_metric(step, monkeypatch):
    sector = bloch_metric.Sector(bloch.Polyhedron(FLUID, 4, 6))
    monkeypatch.setattr(bloch_metric.np.linalg, "solve", always(np.full(9, step)))
    words = f"^4 x 6 by the metric at zw = 5{LOST}"
    refused(words, bloch_metric.equilibrium, sector, np.ones((5, 3)), 5.0)


def test_a_row_of_a_mode_that_is_no_end_of_a_part(monkeypatch):
    vector = np.ones((2, 3))
    parts = SimpleNamespace(s=np.array([0.0, 1.0]), y=np.ones((2, 4)))
    spectrum = SimpleNamespace(forms=(), parts=always([parts]))
    monkeypatch.setattr(tables_cylinder.rel, "cylinder", always(spectrum))
    monkeypatch.setattr(tables_cylinder.cas, "solved", always(SimpleNamespace(tracked=())))
    monkeypatch.setattr(tables_cylinder, "MODE_SPLITS", ())
    transfer = SimpleNamespace(mode=always((np.array([0.3, 0.7]), vector)))
    monkeypatch.setattr(tables_cylinder, "Transfer", always(transfer))
    refused("^table t: a row is not an end of a part$", tables_cylinder.mode, "t", 100, 3.0)


def test_changes_of_stability_that_are_not_there(monkeypatch):
    """Unstable at the stable end, stable at the other one, or other waves than those that were followed."""

    def cells(*unstable):
        found = iter(unstable)
        level = iter((5.0, 6.0, 5.5))
        cell = lambda waves: lambda _among=None: waves  # noqa: E731
        make = lambda *_: SimpleNamespace(nodes=None, level=next(level), unstable=cell(next(found)))  # noqa: E731
        monkeypatch.setattr(bloch_metric, "equilibrium", make)

    sector = SimpleNamespace(mesh=bloch.Polyhedron(FLUID, 4, 6))
    words = "^Polyhedron.*: no change of stability between 5 and 6$"
    for waves in (([1], [2]), ([], [])):
        cells(*waves)
        refused(words, bloch_metric.change, sector, None, 5.0, 6.0, 0.6)
    cells([], [2], [2])
    assert bloch_metric.change(sector, None, 5.0, 6.0, 0.6) == (5.25, 2)
