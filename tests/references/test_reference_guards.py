"""No table of papers 1 and 2 is made of what did not converge: every iteration gives up with its words.

Each is led astray in the cheapest way: a correction that never becomes small, one that is no number, or a
branch that does not have what is looked for.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import AWAY, TUBE, Held, always, refused

from reference_data.solvers import registry
from reference_data.solvers.closed_form import tables as bodies
from reference_data.solvers.core import collocation as tube
from reference_data.solvers.core.tables import DisagreementError, agreed
from reference_data.solvers.core.two_estimates import Rounded
from reference_data.solvers.materials import tables_disk as laws_disk
from reference_data.solvers.materials import tables_tube as laws_tube
from reference_data.solvers.paper1 import tables_peeling as peeling_tables
from reference_data.solvers.paper1.collocation import equations as disk
from reference_data.solvers.paper1.collocation import history as disk_history
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting import equations as disk_shooting
from reference_data.solvers.paper1.shooting import radial as disk_radial
from reference_data.solvers.paper2 import common
from reference_data.solvers.paper2 import tables_checks as checks
from reference_data.solvers.paper2.collocation import contact
from reference_data.solvers.paper2.collocation import critical as tube_critical
from reference_data.solvers.paper2.collocation import history as tube_history
from reference_data.solvers.paper2.collocation import states as contact_states
from reference_data.solvers.paper2.differences import contact as fd_contact
from reference_data.solvers.paper2.differences import critical as fd_critical
from reference_data.solvers.paper2.differences import deflation as fd_deflation
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences import history as fd_history
from reference_data.solvers.paper2.differences.branch import Trace

# -- gas-filled tubes ------------------------------------------------------------------------------


@pytest.mark.parametrize("step", AWAY)
def test_collocation_of_the_tube(step, monkeypatch):
    start = tube.State(TUBE, None, np.zeros((1, 2, 4)), 0.0)
    system = SimpleNamespace(defect=np.zeros(1), volume=1.0, solve=always((step * np.ones((1, 2, 4)), 0.0)))
    monkeypatch.setattr(tube, "Linearised", always(system))
    refused("^collocation: no convergence at u_max = 0.5 for Tube", tube.newton, start, "u_max", 0.5)


@pytest.mark.parametrize("step", AWAY)
def test_finite_differences_of_the_tube(step, monkeypatch):
    grid = fd.Grid(20)
    y, p = fd.first_guess(TUBE, grid, 0.3)
    there = fd.at_control("u_max", 0.3)
    found, _ = fd.newton(TUBE, grid, (y, p), there)
    assert found[0] == pytest.approx(1.3, abs=1e-12)
    monkeypatch.setattr(fd, "bordered_solve", always(np.full(len(y) + 1, step)))
    refused("^finite differences: no convergence for Tube.*, n = 20$", fd.newton, TUBE, grid, (y, p), there)
    start = fd_contact.Contact(
        TUBE, SimpleNamespace(s=1.3, push=lambda _r, p: p), fd_contact.Fitted(20, 3, 0.3), y, p
    )
    words = "^finite differences: no convergence in contact for Tube.*, n = 20, p = 1.5$"
    refused(words, fd_contact.solve, start, 1.5)


def test_complex_states_in_contact_are_refused():
    grid = fd.Grid(20)
    y, p = fd.first_guess(TUBE, grid, 0.3)
    pressure = lambda rho, p: p + 0 * rho  # noqa: E731
    fd.jacobian_blocks(TUBE, grid, y, p, pressure)
    words = "complex states are only implemented for free inflation"
    refused(words, fd.jacobian_blocks, TUBE, grid, y + 0j, p, pressure, error=ValueError)


@pytest.mark.parametrize("step", AWAY)
def test_critical_points_by_finite_differences(step, monkeypatch):
    null = SimpleNamespace(
        core=None, g=0.0, by_p=None, g_by_state=always(np.zeros(4)), by_delta1=always((None, 0.0)),
        cubic_degeneracy=always(1.0),
    )  # fmt: skip
    monkeypatch.setattr(fd_critical, "Null", always(null))
    monkeypatch.setattr(fd_critical.fd, "residual", always(np.zeros(4)))
    monkeypatch.setattr(fd_critical.fd, "control_row", always((0.0, np.zeros(4))))
    grid, start = SimpleNamespace(n=9), (np.ones(4), 1.0)
    monkeypatch.setattr(fd_critical.fd, "bordered_solve", always(np.full(5, step)))
    words = "^finite differences: limit point not found for Tube.*, n = 9$"
    refused(words, fd_critical.limit_point, TUBE, grid, start)
    monkeypatch.setattr(fd_critical.fd, "bordered_solve", always(np.full(6, step)))
    words = "^finite differences: no fold at u_max = 0.4 for Tube.*, n = 9$"
    refused(words, fd_critical.fold_at, TUBE, grid, start, 0.4)
    monkeypatch.setattr(fd_critical, "fold_at", always((TUBE, start)))
    turns = iter(range(1, 99))
    null.cubic_degeneracy = lambda: (-2.0) ** next(turns)
    refused("^finite differences: no cusp near Tube.*, n = 9$", fd_critical.cusp, TUBE, grid, start)


def test_critical_points_by_collocation(monkeypatch):
    guess = tube.State(TUBE, None, np.ones((1, 2, 4)), 0.0)
    monkeypatch.setattr(tube_critical.col, "Linearised", always(SimpleNamespace(volume=1.0)))
    monkeypatch.setattr(tube_critical.col, "newton", always((guess, SimpleNamespace(volume=1.0))))
    monkeypatch.setattr(tube_critical.col, "derivatives", always((1.0, 1.0)))
    refused("^collocation: limit point not found for Tube", tube_critical.limit_point, guess, "u_max")
    turns = iter(range(10**6))
    monkeypatch.setattr(tube_critical, "slopes", lambda *_: (guess, *np.cos([next(turns), 2 * next(turns)])))
    refused("^collocation: no cusp near Tube", tube_critical.cusp, guess)
    words = "^collocation: secant iteration did not converge$"
    noise = iter(np.cos(np.arange(99.0) ** 2))
    refused(words, tube_critical.secant, lambda _: next(noise), 0.0, 1.0, 1e-10)
    assert tube_critical.secant(lambda x: x - 0.25, 0.0, 0.1, 1e-12) == pytest.approx(0.25)
    found = SimpleNamespace(columns={"p": np.array([1.0, 2.0])}, states=[guess])
    words = "^branch of Tube.* never meets p = 3$"
    refused(words, tube_critical.state_at_pressure, found, 3.0, error=ValueError)


def test_a_branch_by_finite_differences_that_never_meets_a_value():
    trace = Trace.__new__(Trace)
    trace.tube, trace.column = TUBE, always(np.array([0.0, 1.0]))
    refused("^branch of Tube.* never meets u_max = 3$", trace.near, "u_max", 3.0, error=ValueError)


# -- tubes in contact ------------------------------------------------------------------------------


@pytest.mark.parametrize("step", AWAY)
def test_collocation_in_contact(step, monkeypatch):
    start = Held(y=(np.zeros(1),), scalars=np.zeros(1))
    system = SimpleNamespace(
        residual=np.zeros(2), factors=SimpleNamespace(solve=always(np.full(2, step))),
        split=lambda s: iter([s[:1], s[1:]]),
    )  # fmt: skip
    monkeypatch.setattr(contact, "Linearised", always(system))
    words = r"^collocation: no convergence at \[\('scalar', 0, 2.0\)\] for Tube"
    refused(words, contact.newton, start, [("scalar", 0, 2.0)])


def test_frictionless_contact_under_a_falling_pressure(monkeypatch):
    pressures = iter([1.5, 1.6, 1.55])
    monkeypatch.setattr(contact_states, "frictionless_near_touch", always(Held(p=1.4)))
    monkeypatch.setattr(contact_states, "at_front", lambda *_: (Held(p=next(pressures)), None))
    words = "^frictionless: p falls at front "
    refused(words, contact_states.frictionless, Held(), None, None, np.array([3.0]))


def inflation(monkeypatch, size):
    """Adhesive inflation whose Newton steps have a given size."""
    run = tube_history.Inflation.__new__(tube_history.Inflation)
    run.how, run.first = SimpleNamespace(terms=2), SimpleNamespace(tube=TUBE, y=np.ones((1, 1, 4)))
    run.history = SimpleNamespace(series=np.ones(2))
    run.states = [Held(fronts=(1.0,), substrate=SimpleNamespace(s=1.3))]
    known = np.zeros((3, 3))
    system = SimpleNamespace(
        factors=SimpleNamespace(solve=always(known)), residual=np.zeros(3), index=always(np.arange(3))
    )
    monkeypatch.setattr(tube_history, "Linearised", always(system))
    monkeypatch.setattr(tube_history, "by_history", always(np.zeros((3, 2))))
    monkeypatch.setattr(tube_history, "axial_slope", always((1.0, np.zeros(3))))
    run._advance = always(size)
    return run


def test_adhesive_inflation_of_the_tube(monkeypatch):
    inflation(monkeypatch, 1e-9)._solve()
    run = inflation(monkeypatch, 1.0)
    refused("^adhesive inflation of Tube.*: no convergence$", run._solve)
    parts = [(None, np.full((3, 3), np.nan))]
    diverges = lambda: tube_history.Inflation._advance(run, np.zeros(2), np.zeros(2), parts)  # noqa: E731
    refused("^adhesive inflation of Tube.*: diverges$", diverges)
    found = SimpleNamespace(state=SimpleNamespace(fronts=(1.0,)))
    monkeypatch.setattr(tube_history.st, "touch", always((Held(), 1.0)))
    monkeypatch.setattr(tube_history.st, "frictionless", always([found]))
    monkeypatch.setattr(tube_history.Inflation, "_guesses", always([SimpleNamespace(p=1.9, history=None)]))
    monkeypatch.setattr(tube_history.Inflation, "_solve", always(None))
    how = SimpleNamespace(free=None)
    refused(
        "^adhesive inflation of Tube.* reaches p = 1.9 only$", tube_history.Inflation, TUBE, None, how, 3.0
    )


def test_a_patch_of_the_tube_that_is_not_there(monkeypatch):
    state = Held(fronts=(-0.1, 1.0), zones=(1, 2, 3), substrate=SimpleNamespace(s=1.3))
    monkeypatch.setattr(tube_history.con, "newton", always((state, None)))
    refused("^no patch of width -0.1 at p = 1$", tube_history.lifted, state, None, 1.0)
    kept = Held(p=1.005, y=(np.full((1, 1, 1), 1.4),), fronts=(0.2, 1.0), substrate=SimpleNamespace(s=1.3))
    monkeypatch.setattr(tube_history, "lifted", lambda *_: (_ for _ in ()).throw(RuntimeError("gone")))
    monkeypatch.setattr(tube_history, "released", always((kept, None)))
    words = "^unilateral spring: contact lost and kept at p = 1$"
    refused(words, tube_history.unilateral, kept, None, np.array([1.0]))


@pytest.mark.parametrize("step", AWAY)
def test_stuck_tubes_by_finite_differences(step, monkeypatch):
    glued = fd_history.Glued.__new__(fd_history.Glued)
    vars(glued).update(tube=TUBE, grid=None, substrate=SimpleNamespace(s=1.3))
    monkeypatch.setattr(fd_history.fd, "residual", lambda *_: np.zeros(4))
    monkeypatch.setattr(fd_history.fd, "jacobian_blocks", always(None))
    monkeypatch.setattr(fd_history, "banded", always(None))
    monkeypatch.setattr(fd_history, "solve_banded", always(np.full(4, step)))
    words = "^finite differences: no convergence, Tube.*, 1 nodes stuck$"
    refused(words, glued.solve, (np.ones(4), 1.0), np.zeros(1), None)


def test_unilateral_springs_by_finite_differences(monkeypatch):
    turns = iter(range(10**6))
    glued = SimpleNamespace(substrate=None, solve=lambda *_, **__: (np.array([next(turns), 1.0]), 1.0))
    start = fd_deflation.Stuck(glued, np.zeros(2), 2.0, 0)
    monkeypatch.setattr(fd_deflation, "cell_change", lambda y: y)
    monkeypatch.setattr(fd_deflation, "one_sided", always(None))
    refused("^unilateral spring: no convergence at p = 1$", fd_deflation.deflated, start, 1.0, "unilateral")
    first = SimpleNamespace(
        position=always((5.0, None)), glued=SimpleNamespace(grid=fd_contact.Fitted(20, 3, 0.3))
    )
    monkeypatch.setattr(fd_deflation, "followed", always(first))
    run = SimpleNamespace(p=np.linspace(1.0, 2.0, 20), glued=glued, states=None)
    monkeypatch.setattr(fd_deflation, "Inflation", always(run))
    monkeypatch.setattr(fd_deflation, "Glued", always(glued))
    words = "^no node of Tube.* touches at p = 9, n = 20: off by "
    refused(words, fd_deflation.fitted, TUBE, None, 20, 9.0)
    run.p = run.p[:2]
    words = "^front of Tube.* at p = 9 is beyond the computed ones, n = 20$"
    refused(words, fd_deflation.fitted, TUBE, None, 20, 9.0)


# -- disks -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("step", AWAY)
def test_collocation_of_the_disk(step, monkeypatch):
    batch = Held(
        zones=(SimpleNamespace(disk=Disk(0.1, 1.0)),), y=(np.zeros((1, 1, 1, 1)),), scalars=np.zeros((1, 1))
    )
    monkeypatch.setattr(disk, "correction", always(((np.full((1, 1, 1, 1), step),), np.zeros((1, 1)))))
    refused("^collocation: no convergence for Disk.*, scalars ", disk.newton, batch)


def test_a_history_of_the_disk_that_does_not_settle():
    noise = np.random.default_rng(1)
    words = "^collocation: history not settled, last change "
    refused(words, disk_history.mixed, lambda z: noise.random(z.shape), np.zeros(2), 1e-9)
    assert disk_history.mixed(lambda z: 0.5 * z + 1, np.zeros(2), 1e-12) == pytest.approx([2.0, 2.0])


def test_shooting_of_the_disk():
    newton = disk_shooting.Newton()
    assert newton.solve(lambda z: z - 2, [1.0]) == pytest.approx([2.0])
    refused("^shooting: no convergence near ", disk_shooting.Newton().solve, lambda z: z**2 + 1, [0.7])
    given = Disk(0.1, 1.0), 1.0, False, [1.0, 0.5, np.nan, 0.0], [0.5, 0.6], 1e-9
    with pytest.warns(UserWarning, match="dop853"):
        refused("^shooting: no solution up to x = 0.6 for Disk.*, p = 1$", disk_shooting.shoot, *given)
    refused("^shooting: no slope carries the force nan$", disk_radial.inverted, np.nan, 1.0, 1.2, 0.1, 0.5)


# -- tables ----------------------------------------------------------------------------------------


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


def test_a_curve_without_a_pull_off_point(monkeypatch):
    monkeypatch.setattr(peeling_tables.peel, "rates_a", always(None))
    monkeypatch.setattr(peeling_tables.peel, "minimum", always(None))
    monkeypatch.setattr(peeling_tables, "radii", always(np.ones(9)))
    words = r"^table t: no pull-off point for \(Case"
    refused(words, peeling_tables.pull_off, "t", error=DisagreementError)


def test_limit_points_of_two_methods(monkeypatch):
    monkeypatch.setattr(common, "fdc", SimpleNamespace(limit_points=always([])))
    monkeypatch.setattr(common.col, "branch", always(None))
    state = SimpleNamespace(p=1.0, y=np.full((1, 1, 1), 2.0))
    monkeypatch.setattr(common.col, "limit_points", always([[(state, 1.0), (state, 1.0)]]))
    words = "^table t, Tube.*: 0 limit points against 1$"
    refused(words, common.limit_pair, "t", TUBE, error=DisagreementError)


def test_fictitious_time_integration_that_ends_elsewhere():
    grid = SimpleNamespace(n=9)
    runs = [(SimpleNamespace(state=np.array([1.5]), converged=c), 1.0) for c in (False, True, True)]
    given = "t", "", {}, grid
    refused(r"^table t: FTIM and Newton differ by 1\.0e-01$", checks.ftim_table, *given, 0.4, runs)
    runs[0][0].converged = True
    words = r"^table t: variants converged: \[ True  True  True\]$"
    refused(words, checks.ftim_table, *given, 0.5, runs)


def test_a_front_that_meets_the_disk(monkeypatch):
    monkeypatch.setattr(fd_history.cfd, "touching", always((np.ones(4), 1.4)))
    glued = SimpleNamespace(tube=TUBE, substrate=None, grid=SimpleNamespace(n=3))
    refused("^front of Tube.* meets the disk below p = 3$", fd_history.Inflation, glued, 3.0)


def test_a_table_of_one_name_in_two_modules(monkeypatch):
    monkeypatch.setattr(registry, "solvers_folders", always(["paper1", "paper1"]))
    refused("^table .* is defined twice$", registry.tables, error=ValueError)


def test_methods_of_two_that_differ():
    good = Rounded(np.ones(2), np.full(2, 1e-9))
    about = "over C1", "pressure"
    agreed("t", "p", good, good, about)
    for value in (1 + 1e-6, np.nan):
        other = Rounded(np.array([1.0, value]), np.full(2, 1e-9))
        words = "^table t, column p, row 1: finite differences "
        refused(words, agreed, "t", "p", other, good, about, error=DisagreementError)
