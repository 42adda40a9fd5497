"""No table of paper 1 is made of what did not converge: every iteration gives up with its words."""

from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import always, refused

from reference_data.solvers.core.newton import Secants
from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.paper1 import tables_free, tables_peeling
from reference_data.solvers.paper1.collocation import equations as disk
from reference_data.solvers.paper1.collocation import rows as collocation_rows
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting import equations as disk_shooting
from reference_data.solvers.paper1.shooting import history as shooting_history
from reference_data.solvers.paper1.shooting import radial as disk_radial
from reference_data.solvers.paper1.shooting import rows as shooting_rows

DISK = Disk(0.1, 1.0)


def test_collocation_of_the_disk():
    batch = cs.free_batch(DISK, cs.Mesh.graded(2, 3), np.array([np.nan]))
    refused("^collocation of Disk.*: Newton's method does not converge$", disk.newton, batch)


def test_shooting_of_the_disk():
    given = DISK, 1.0, False, [1.0, 0.5, np.nan, 0.0], [0.5, 0.6], 1e-9
    with pytest.warns(UserWarning, match="dop853"):
        refused("^shooting: no solution up to x = 0.6 for Disk.*, p = 1$", disk_shooting.shoot, *given)
    refused("^shooting: no slope carries the force nan$", disk_radial.inverted, np.nan, 1.0, 1.2, 0.1, 0.5)


def onset(**how):
    """A state of first contact for histories by shooting."""
    levels = {"first": 0.1, "history": 1e-9, "rtol": 1e-9} | how
    return SimpleNamespace(disk=DISK, how=SimpleNamespace(**levels), lam=1.2, p=1.0)


def test_a_history_by_shooting_that_ends_early(monkeypatch):
    monkeypatch.setattr(shooting_history, "seed", always((1.2, 0.1, 0.2)))
    failed = SimpleNamespace(success=False, message="the step is too small")
    monkeypatch.setattr(shooting_history, "solve_ivp", always(failed))
    words = "^shooting: history of Disk.* ends early: the step is too small$"
    refused(words, shooting_history.Inflation, onset(), 0.5)


def test_a_history_of_model_n_by_shooting_that_does_not_settle(monkeypatch):
    monkeypatch.setattr(disk_radial, "seed", always((1.2, 0.1, 0.2)))
    noise = np.random.default_rng(1)
    monkeypatch.setattr(
        disk_radial.Radial, "_solve", lambda *_: SimpleNamespace(slope=1 + float(noise.random()))
    )
    words = "^shooting: history of Disk.* not settled at x = "
    refused(words, disk_radial.Radial, onset(first=0.02), 0.5)


def test_stretches_that_are_equal_everywhere():
    same = SimpleNamespace(
        disk=DISK, how=SimpleNamespace(start=1e-3), p=1.0,
        states=lambda x: [np.array([at, 0.5, 1.0, 0.0]) for at in x],
    )  # fmt: skip
    words = "^lambda1 = lambda2 within 0.0001 everywhere: Disk"
    refused(words, shooting_rows.equal_until, same, error=ValueError)
    mesh = cs.Mesh.graded(2, 3)
    x = mesh.x[None]
    flat = np.stack([x, 0 * x, 1 + 0 * x, 0 * x], axis=-1)
    batch = cs.controlled(
        disk.Batch((disk.Sliding(DISK, mesh),), (flat,), np.ones((1, 1)), None, None), "p", 1.0
    )
    refused(words, collocation_rows.equal_until, batch, 0, error=ValueError)


def test_a_profile_closer_to_the_pole_than_the_first_front():
    run = SimpleNamespace(disk=DISK, how=SimpleNamespace(first=0.1), onset=SimpleNamespace(lam=1.2))
    edge = SimpleNamespace(patch=SimpleNamespace(x=0.5), t0=0.6)
    words = "^x = 0.05 is inside the first front$"
    refused(words, shooting_rows.edge_profile, run, edge, np.array([0.0, 0.05]), error=ValueError)


def test_limit_points_of_disks_that_are_not_one_each(monkeypatch):
    monkeypatch.setattr(tables_free, "limit_a", lambda d, _i: [1.0] if d.alpha == 0 else [])
    monkeypatch.setattr(tables_free, "limit_b", lambda d, _i: [1.0, 2.0] if d.alpha == 0 else [])
    words = r"^table t: \{1, 2\} limit points for alpha = 0, 0 for alpha = 0.1$"
    refused(words, tables_free.limit_points, "t", error=DisagreementError)


def test_a_curve_without_a_pull_off_point(monkeypatch):
    monkeypatch.setattr(tables_peeling.peel, "rates_a", always(None))
    monkeypatch.setattr(tables_peeling.peel, "minimum", always(None))
    monkeypatch.setattr(tables_peeling, "radii", always(np.ones(9)))
    words = r"^table t: no pull-off point for \(Case"
    refused(words, tables_peeling.pull_off, "t", error=DisagreementError)


def test_a_closed_form_that_is_not_the_potentials_quotient(monkeypatch):
    peel, ones = tables_peeling.peel, lambda rho: np.ones(len(rho))
    monkeypatch.setattr(tables_peeling, "radii", always(np.array([0.2, 0.3])))
    for name in ("rates_a", "rates_b"):
        monkeypatch.setattr(peel, name, always(ones))
    for name in ("fronts_a", "fronts_b"):
        monkeypatch.setattr(peel, name, lambda _case, rho, _i: rho)
    monkeypatch.setattr(peel, "quotient", lambda _c, _p, rho, _i: 1.001 + 0 * rho)
    words = "^table t: closed form and difference of the potential differ by 1.0e-03$"
    case = tables_peeling.dc.MR_1
    refused(words, tables_peeling.curve, "t", case, 1.4, "figure 11", error=DisagreementError)


def test_roots_of_shooting_are_the_cores():
    assert Secants().solve(lambda z: z - 2, [1.0]) == pytest.approx([2.0])
