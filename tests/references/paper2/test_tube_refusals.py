"""No table of paper 2 is made of what did not converge: every iteration gives up with its words.

Each is led astray in the cheapest way: values that are no numbers, a correction that never becomes small, or
a branch that does not have what is looked for.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from led_astray import AWAY, TUBE, StandIn, always, refused

from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.paper2 import common, tables_contact, tables_free
from reference_data.solvers.paper2 import contact_cases as cases
from reference_data.solvers.paper2 import tables_checks as checks
from reference_data.solvers.paper2.collocation import critical as tube_critical
from reference_data.solvers.paper2.collocation import equations as tube
from reference_data.solvers.paper2.collocation import history as tube_history
from reference_data.solvers.paper2.collocation import states as contact_states
from reference_data.solvers.paper2.collocation.equations import State
from reference_data.solvers.paper2.differences import contact as fd_contact
from reference_data.solvers.paper2.differences import critical as fd_critical
from reference_data.solvers.paper2.differences import deflation as fd_deflation
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences import history as fd_history
from reference_data.solvers.paper2.differences.branch import Trace

MESH = tube_critical.Mesh.graded(2, 3)
LOST = ": Newton's method does not converge$"

# -- free tubes ------------------------------------------------------------------------------------


def test_collocation_of_the_tube():
    start = tube_critical.first_guess(TUBE, MESH, 0.3)
    assert tube.solve(start, u_max=0.3).u_max == pytest.approx(0.3, abs=1e-13)
    lost = replace(start, c=np.array([np.nan]))
    refused(f"^collocation of Tube.* at u_max = 0.5{LOST}", tube.solve, lost, u_max=0.5)


@pytest.mark.parametrize("step", AWAY)
def test_finite_differences_of_the_tube(step, monkeypatch):
    grid = fd.Grid(20)
    y, p = fd.first_guess(TUBE, grid, 0.3)
    there = fd.at_control("u_max", 0.3)
    found, _ = fd.newton(TUBE, grid, (y, p), there)
    assert found[0] == pytest.approx(1.3, abs=1e-12)
    monkeypatch.setattr(fd, "bordered_solve", always(np.full(len(y) + 1, step)))
    refused(f"^finite differences of Tube.*, n = 20{LOST}", fd.newton, TUBE, grid, (y, p), there)
    start = fd_contact.Contact(
        TUBE, SimpleNamespace(s=1.3, push=lambda _r, p: p), fd_contact.Fitted(20, 3, 0.3), y, p
    )
    words = f"^finite differences in contact for Tube.*, n = 20, p = 1.5{LOST}"
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
    words = f"^finite differences: limit point of Tube.*, n = 9{LOST}"
    refused(words, fd_critical.limit_point, TUBE, grid, start)
    monkeypatch.setattr(fd_critical.fd, "bordered_solve", always(np.full(6, step)))
    words = f"^finite differences: fold of Tube.* at u_max = 0.4, n = 9{LOST}"
    refused(words, fd_critical.fold_at, TUBE, grid, start, 0.4)
    monkeypatch.setattr(fd_critical, "fold_at", always((TUBE, start)))
    noise = iter(np.cos(np.arange(99.0) ** 2))
    null.cubic_degeneracy = lambda: next(noise)
    refused("^the secant iteration does not converge$", fd_critical.cusp, TUBE, grid, start)


def test_critical_points_by_collocation(monkeypatch):
    guess = tube_critical.first_guess(TUBE, MESH, 0.3)
    monkeypatch.setattr(tube_critical, "solve", lambda state, **_: state)
    monkeypatch.setattr(tube_critical.eq, "slopes", always((1.0, 1.0)))
    words = f"^collocation: limit point of Tube.*{LOST}"
    refused(words, tube_critical.limit_point, guess, "u_max")
    noise = iter(np.cos(np.arange(999.0) ** 2))
    monkeypatch.setattr(tube_critical.eq, "slopes", lambda *_: (next(noise), 1.0))
    refused("^the secant iteration does not converge$", tube_critical.fold_at, guess, 0.4)
    found = tube_critical.Branch("u_max", [guess, replace(guess, c=np.array([2.0]))])
    words = "^branch of Tube.* never meets p = 3$"
    refused(words, tube_critical.state_at_pressure, found, 3.0, error=ValueError)


def test_a_branch_by_finite_differences_that_never_meets_a_value():
    trace = Trace.__new__(Trace)
    trace.tube, trace.column = TUBE, always(np.array([0.0, 1.0]))
    refused("^branch of Tube.* never meets u_max = 3$", trace.near, "u_max", 3.0, error=ValueError)


# -- tubes in contact ------------------------------------------------------------------------------


def test_frictionless_contact_under_a_falling_pressure(monkeypatch):
    pressures = iter([1.5, 1.6, 1.55])
    monkeypatch.setattr(contact_states, "frictionless_near_touch", always(StandIn(p=1.4)))
    monkeypatch.setattr(contact_states, "at_front", lambda *_: StandIn(p=next(pressures)))
    words = "^frictionless: p falls at front "
    refused(words, contact_states.frictionless, StandIn(), None, np.array([3.0]))


def test_adhesive_inflation_of_the_tube(monkeypatch):
    found = SimpleNamespace(fronts=(1.0,))
    states = State(TUBE, (), (np.ones((1, 1, 1, 5)),), np.array([[1.9, 1.0]]))
    monkeypatch.setattr(tube_history.st, "touch", always(SimpleNamespace(y=np.ones((1, 1, 1, 3)))))
    monkeypatch.setattr(tube_history.st, "frictionless", always([found]))
    monkeypatch.setattr(tube_history.Inflation, "_guesses", always(states))
    monkeypatch.setattr(tube_history.Inflation, "_substituted", always(np.ones(2)))
    words = "^adhesive inflation of Tube.* reaches p = 1.9 only$"
    refused(words, tube_history.Inflation, TUBE, None, SimpleNamespace(free=None, terms=2), 3.0)


def test_a_patch_of_the_tube_that_is_not_there(monkeypatch):
    state = StandIn(fronts=(-0.1, 1.0), zones=(1, 2, 3), substrate=SimpleNamespace(s=1.3))
    monkeypatch.setattr(tube_history, "solve", always(state))
    refused("^no patch of width -0.1 at p = 1$", tube_history.lifted, state, None, 1.0)
    kept = StandIn(p=1.005, y=(np.full((1, 1, 1), 1.4),), fronts=(0.2, 1.0), substrate=SimpleNamespace(s=1.3))
    monkeypatch.setattr(tube_history, "lifted", lambda *_: (_ for _ in ()).throw(RuntimeError("gone")))
    monkeypatch.setattr(tube_history, "released", always(kept))
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
    words = f"^finite differences of Tube.*, 1 nodes stuck{LOST}"
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


# -- tables ----------------------------------------------------------------------------------------


def test_deflations_that_end_early(monkeypatch):
    monkeypatch.setattr(tables_contact.cc, "deflated", always([[], []]))
    monkeypatch.setattr(tables_contact.cc, "deflated_fd", always([[]]))
    words = "^table t: not all states found down to p = 0$"
    refused(words, tables_contact.deflation, "t", cases.PAPER[2], "bilateral", "figure 6(b)")


def test_a_branch_whose_displacement_turns(monkeypatch):
    trace = SimpleNamespace(run=always(SimpleNamespace(column=always(np.array([0.1, 0.3, 0.2])))))
    monkeypatch.setattr(tables_free.fdb, "Trace", always(trace))
    words = "^table t: u_max does not rise monotonically along the branch$"
    refused(words, tables_free.curve, "t", TUBE, 1.0, "figure 2")


def test_limit_points_of_two_methods(monkeypatch):
    monkeypatch.setattr(common, "fdc", SimpleNamespace(limit_points=always([])))
    monkeypatch.setattr(common.col, "branch", always(None))
    state = SimpleNamespace(p=1.0, u_max=1.0)
    monkeypatch.setattr(common.col, "limit_points", always([[state, state]]))
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
