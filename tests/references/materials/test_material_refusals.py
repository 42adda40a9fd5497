"""No table of a law or of a closed form is made of what was not found."""

import numpy as np
from led_astray import always, refused

from reference_data.solvers.closed_form import tables as bodies
from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.materials import tables_disk as laws_disk
from reference_data.solvers.materials import tables_liquid_tube as laws_liquid
from reference_data.solvers.materials import tables_tube as laws_tube


def test_two_ways_that_find_other_numbers_of_points():
    words = "^table t: 1 points against 2$"
    refused(words, bodies.columns_of, "t", ("p",), [(1.0,)], [(1.0,), (2.0,)], {}, error=DisagreementError)


def test_limit_points_that_are_not_one(monkeypatch):
    for curve, found in ((lambda t: t, 0), (lambda t: np.sin(6 * t), 4)):
        monkeypatch.setattr(laws_disk, "walked", lambda _model, t0, _i, curve=curve: [{"p": curve(t0)}])
        refused(f"^table t: {found} limit points$", laws_disk.limits, "t", "gent", error=DisagreementError)
    u = np.linspace(0.9, 1.1, 15)
    refused("^0 limit points near u_max = 1$", laws_tube._turn, u, u, 1e-12, 1.0)
    assert laws_tube._turn(u, -((u - 1.01) ** 2), 1e-12, 1.0)


def test_critical_points_that_are_not_all_found(monkeypatch):
    monkeypatch.setattr(laws_liquid, "critical", always({1: None}))
    refused(r"^table t: zeros of n = \[1\] only$", laws_liquid.points, "t", "gent")
