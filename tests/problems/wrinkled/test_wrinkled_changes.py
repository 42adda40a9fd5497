"""Changes of stability where a zone opens: the eigenvalue jumps within less than a mesh resolves."""

from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError
from weakforms.problems.wrinkled import events
from weakforms.problems.wrinkled.events import Event
from weakforms.problems.wrinkled.waves.stability import Sample, StabilityChanges


def held(load):
    return SimpleNamespace(state=SimpleNamespace(loads={"zw": load}))


class Canned(StabilityChanges):
    """The eigenvalue is a given function of the load; the other meshes find no state."""

    def __init__(self, lowest, *openings):
        def others(*_):
            raise ConvergenceError("SNES ended with DIVERGED_DTOL")

        found = [Event("zone_opening", 1.0, 0, (held(z - 1e-9), held(z))) for z in openings]
        super().__init__(SimpleNamespace(control="zw", others=others), 5, events=lambda: found)
        self.function = lowest

    def _at(self, name, value, start):
        return Sample(value, held(value), self.function(value))

    def changes(self):  # noqa: D102
        points = [(i, "zw", z, self._at("zw", z, None).held) for i, z in enumerate((5.0, 6.0))]
        self.lowest = lambda state: self.function(state.state.loads["zw"])
        return self.between(points)


def leap(z):
    return -0.06 if z < 5.5 else 0.14


def steep(z):
    return -0.06 + 40 * max(z - 5.5, 0.0) ** 0.5


@pytest.mark.parametrize("lowest", [leap, steep])
def test_a_leap_is_located_at_the_zone_that_opens_there(lowest):
    canned = Canned(lowest, 5.2, 5.5, 5.8)
    (change,) = canned.changes()
    assert canned.failures == []
    assert change.direction == -1.0
    assert [state.state.loads["zw"] for state in change.levels] == [5.5 - 1e-9, 5.5]
    root = change.beside.state.loads["zw"]
    assert root == pytest.approx(5.5, abs=3e-6)


@pytest.mark.parametrize(
    ("lowest", "said"), [(leap, "jumps from -0.06 to 0.14 at zw = 5.5"), (steep, "DTOL")]
)
def test_without_such_a_zone_it_is_a_failure(lowest, said):
    canned = Canned(lowest, 5.2, 5.50002)
    assert canned.changes() == []
    (failure,) = canned.failures
    assert said in failure.reason


@pytest.mark.slow
def test_waves_that_vanish_where_a_taut_zone_opens():
    """Between two points of the trace one zone opens and another closes: the number of fronts is the same."""
    given = {"M": 1.36, "delta": 2.796, "c2": 0.028, "n": 5, "load_end": 6.5}
    result = solve("wrinkled_tube", **given, numerics={"cells": 8, "levels": 2})
    assert result.failures == []
    kinds = [point.kind for point in result.special_points]
    assert kinds == ["stability_change", "zone_opening", "zone_closing", "stability_change"]
    first, last = result.points("stability_change")
    (opening,) = result.points("zone_opening")
    assert (first.values["direction"], last.values["direction"]) == (1.0, -1.0)
    assert abs(last.values["zw"] - opening.values["zw"]) <= last.uncertainty["zw"]
    assert last.uncertainty["zw"] > opening.uncertainty["zw"], "the distance of the root adds to it"


def test_an_interval_is_halved_only_as_often_as_allowed(monkeypatch):
    """Fronts that seem to leap however short the interval: three halvings, and thus seven middles."""
    zones = SimpleNamespace(first=1.0, fronts=(0.2, 0.4))
    same = SimpleNamespace(zones=zones, state=SimpleNamespace(loads={"p": 0.0}))
    middles = []

    def fitted(_state, _condition):
        middles.append(same)
        return [same]

    membrane = SimpleNamespace(control="p", length=1.0, fitted=fitted)
    monkeypatch.setattr(events, "_leaps", lambda *_: True)
    assert events._between(membrane, same, same, 0, "p", np.zeros(2), halvings=3) == []
    assert len(middles) == 7
