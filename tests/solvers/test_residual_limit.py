"""The residual that a state may have is proportional to the forces."""

import numpy as np
import pytest
from small_systems import system_of

from weakforms.errors import ConvergenceError
from weakforms.solvers.equilibrium import newton
from weakforms.solvers.equilibrium.balance import OF_FORCES, OF_TERMS, RESIDUAL_LIMIT, residual_limit
from weakforms.solvers.equilibrium.constraints import MonitorPlane
from weakforms.solvers.equilibrium.newton import ExtendedNewton

SIZES = [1e-9, 1.0, 1e9]


def bar(size, cells=400):
    """A bar under its own weight; stiffness and weight scale together; cubic, so that Newton iterates."""
    return system_of(
        lambda u, v, p: size * ((u.dx(0) + u.dx(0) ** 3) * v.dx(0) - (1 + p) * v),
        "Lagrange",
        3,
        cells,
        ends=True,
    )


def solved(system, wrong=0.0):
    """Solve with nodal forces that have a given relative error in every evaluation."""
    right = system.residual
    if wrong:
        noise = np.random.default_rng(1).standard_normal(system.size)
        noise[system.bc_dofs] = 0.0
        with system.at(system.initial):
            forces = np.linalg.norm(right())
        shift = wrong * forces * noise / np.linalg.norm(noise)
        calls = iter(range(10_000))
        # It differs from call to call: the step comes to rest all the same, the forces never do.
        system.residual = lambda: right() + shift * (-1) ** next(calls)
    return ExtendedNewton(system, stol=1e-2 if wrong else 1e-10).solve(system.initial)


@pytest.mark.parametrize("size", SIZES)
def test_round_off_is_accepted_whatever_the_forces(size):
    system = bar(size)
    state, _ = solved(system)
    with system.at(state):
        left = np.sqrt(system.dot(system.residual(), system.residual()))
        assert left < 0.2 * residual_limit(system)


@pytest.mark.parametrize("refused", ["residuals above round-off", "long steps"])
def test_round_off_is_accepted_if_it_lasts_and_moves_little(refused, monkeypatch):
    """With a tolerance that no step meets, and different round-off in every evaluation."""
    system = bar(1.0)
    right, solver = system.residual, ExtendedNewton(system, stol=1e-18)
    exact, _ = solved(system)
    noise = np.random.default_rng(1).standard_normal(system.size)
    noise[system.bc_dofs] = 0.0
    calls = iter(range(10_000))
    with system.at(exact):
        system.tangent()
        shift = 0.1 * OF_FORCES[0] * system.force_size() * noise / np.linalg.norm(noise)
    system.residual = lambda: right() + shift * (-1) ** next(calls)
    state, record = solver.solve(system.initial)
    assert record.reason == "DIVERGED_MAX_IT"
    assert np.allclose(state.u, exact.u, atol=1e-10)
    if refused == "long steps":
        monkeypatch.setattr(newton, "AT_ROUND_OFF", (newton.AT_ROUND_OFF[0], 1e-30))
    else:
        shift *= 100  # far below the limit of unit forces
    with pytest.raises(ConvergenceError, match="DIVERGED_MAX_IT"):
        solver.solve(system.initial)


@pytest.mark.parametrize("size", SIZES)
def test_forces_that_do_not_balance_are_refused(size):
    """A residual of a ten-thousandth of the load; for small forces it is below the limit of unit forces."""
    with pytest.raises(ConvergenceError, match=r"CONVERGED_SNORM_RELATIVE .* residual"):
        solved(bar(size), wrong=1e-4)


def test_the_limit_is_the_usual_one_between_its_bounds():
    low, high = OF_FORCES
    for size in np.logspace(-9, 9, 19):
        system = bar(size, cells=20)
        with system.at(system.initial):
            system.tangent()
            forces, limit = system.force_size(), residual_limit(system)
        assert low * forces <= limit <= high * forces
        assert limit == RESIDUAL_LIMIT or limit in (low * forces, high * forces)


@pytest.mark.parametrize("size", SIZES)
def test_the_lower_bound_of_the_limit_is_one(size):
    """It is returned if it is enough, and the limit itself if not."""
    system = bar(size, cells=20)
    with system.at(system.initial):
        system.tangent()
        least, forces = system.least_force_size(), system.force_size()
        assert 0 < least <= forces
        limit = residual_limit(system)
        low = residual_limit(system, 1e-3 * OF_FORCES[1] * least)
        assert 0 < low <= limit
        assert residual_limit(system, 2 * limit) == limit
        if size < 1:
            assert low < limit


def test_the_distance_from_a_plane_is_measured_along_its_normal():
    """Undivided, its round-off would exceed the limit where a functional grows steeply along a branch."""
    system = system_of(lambda u, v, p: (u - 1e3 * p / 3) * v)
    plane = MonitorPlane({"u": 1e9, "load": 1.0}, 1e12 / 7)
    solver = ExtendedNewton(system, ["load"])
    state, _ = solver.solve(system.initial, [plane])
    assert state.loads["load"] == pytest.approx(3 / 7 / (1 + 3e-12), rel=1e-13)
    short, long = (MonitorPlane({"u": k, "load": k}, k) for k in (1.0, 1e6))
    with system.at(state):
        values = [one.value(solver) for one in (short, long)]
        rows = [one.gradient(solver) for one in (short, long)]
    assert values[0] == pytest.approx(values[1], rel=1e-14)
    assert values[0] == pytest.approx((1e3 / 7 + 3 / 7 - 1) / np.sqrt(2), rel=1e-10)
    assert rows[0][0] == pytest.approx(rows[1][0], rel=1e-14)
    assert rows[0][1] == pytest.approx({"load": 1 / np.sqrt(2)}, rel=1e-14)


@pytest.mark.parametrize("part", [0.5, 20.0])
def test_a_constraint_is_met_to_the_round_off_of_its_terms(part, monkeypatch):
    """With round-off of part of what is allowed, which differs in every evaluation."""
    size = 1e12 / 7
    system, plane = system_of(lambda u, v, p: (u - 1e12 * p) * v), MonitorPlane({"u": 1.0}, size)
    right, calls = MonitorPlane.value, iter(range(10_000))
    shift = part * OF_TERMS * size
    assert shift > RESIDUAL_LIMIT
    monkeypatch.setattr(MonitorPlane, "value", lambda *at: right(*at) + shift * (-1) ** next(calls))
    solver = ExtendedNewton(system, ["load"])
    if part < 1:
        state, _ = solver.solve(system.initial, [plane])
        assert state.loads["load"] == pytest.approx(1 / 7, rel=1e-13)
    else:
        with pytest.raises(ConvergenceError, match="CONVERGED_SNORM_RELATIVE"):
            solver.solve(system.initial, [plane])
