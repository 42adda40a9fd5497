"""Curves, limit points, fold line and cusp of the half tube by collocation.

dp/du and d2p/du2 are exact (Taylor series along the branch), u standing for u_max or, for
long tubes, the half volume V. A limit point is the root of dp/du, a fold line the same root
followed with delta1 as the unknown, the cusp the common root of both derivatives; eliminating
the state from the extended systems leaves just these scalar equations. Everything is done on
two meshes; the difference is the uncertainty.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core import collocation as col
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Mesh, State
from reference_data.solvers.core.mooney_rivlin import Tube

MESHES = (Mesh(10, 12), Mesh(14, 16))
ROUNDING = 2e-13  # relative; remaining error of Newton's last step, from the two meshes


@dataclass
class Resolved:
    """Value on the finer mesh and its uncertainty (difference to the coarser, and rounding)."""

    value: Array
    uncertainty: Array


def resolved(coarse: Array, fine: Array) -> Resolved:
    """Combine values at two resolutions."""
    coarse, fine = np.asarray(coarse, dtype=float), np.asarray(fine, dtype=float)
    floor = ROUNDING * np.maximum(1.0, np.abs(fine))
    return Resolved(fine, np.abs(fine - coarse) + floor)


def quantities(state: State, volume: float) -> dict[str, float]:
    """Columns of a branch at one state."""
    rho, lam1 = state.y[0, 0, 0], state.y[0, 0, 2]
    t1, _ = mat.resultants(lam1, rho / state.tube.r0, state.tube.alpha)
    return {"u_max": rho - 1, "p": state.p, "lam1_mid": lam1, "t1_mid": t1, "V": volume}


def start(tube: Tube, mesh: Mesh, control: str, target: float) -> State:
    """The state at the first target, starting from u_max = 0.3, where Newton converges easily."""
    state, system = col.newton(col.first_guess(tube, mesh, 0.3), "u", 0.3)
    now = system.volume if control == "V" else 0.3
    for step in np.linspace(now, target, 6)[1:]:
        state, _ = col.newton(state, control, float(step))
    return state


@dataclass
class Branch:
    """States at rising values of the control, with their columns and dp/d(control)."""

    control: str
    states: list[State]
    columns: dict[str, Array]
    rate: Array


def branch(tube: Tube, mesh: Mesh, control: str, targets: Array) -> Branch:
    """Solve at each target in turn, with the last state as the next guess."""
    state = start(tube, mesh, control, float(targets[0]))
    states, rows, rate = [], [], []
    for target in targets:
        state, system = col.newton(state, control, float(target))
        states.append(state)
        rows.append(quantities(state, system.volume))
        rate.append(col.derivatives(state, system, control)[0])
    columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return Branch(control, states, columns, np.array(rate))


def curve(tube: Tube, control: str, targets: Array) -> tuple[dict[str, Resolved], Branch]:
    """All columns on two meshes, and the branch on the finer one."""
    coarse, fine = (branch(tube, mesh, control, targets) for mesh in MESHES)
    both = {name: resolved(coarse.columns[name], fine.columns[name]) for name in fine.columns}
    return both, fine


def limit_point(guess: State, control: str, max_iter: int = 20) -> tuple[State, float]:
    """Newton for dp/du = 0 with the exact d2p/du2; returns the state and its volume.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    state, system = guess, col.Linearised(guess, control, mat.plain_pressure)
    at = system.volume if control == "V" else float(guess.y[0, 0, 0]) - 1
    for _ in range(max_iter):
        state, system = col.newton(state, control, at)
        p1, p2 = col.derivatives(state, system, control)
        step = float(np.clip(-p1 / p2, -0.2, 0.2))
        if abs(step) < 1e-12 * max(1.0, abs(at)):
            return state, system.volume
        # rounding in p1 prevents a step of exactly zero: stop if it stagnates
        if abs(step) < 1e-9 and abs(p1) < 1e-12:
            return state, system.volume
        at += step
    raise RuntimeError(f"collocation: limit point not found for {guess.tube}")


def limit_points(found: Branch) -> list[list[tuple[State, float]]]:
    """Every limit point between the states of a branch, each on the two meshes."""
    out = []
    for i in np.nonzero(found.rate[:-1] * found.rate[1:] < 0)[0]:
        near = found.states[i if abs(found.rate[i]) < abs(found.rate[i + 1]) else i + 1]
        out.append([limit_point(near.moved_to(mesh), found.control) for mesh in MESHES])
    return out


def state_at_pressure(found: Branch, p: float) -> list[State]:
    """State at the first crossing of p on both meshes: Newton in u with the exact dp/du.

    Raises:
        ValueError: If the branch does not cross p.
    """
    gap = found.columns["p"] - p
    crossing = np.nonzero(gap[:-1] * gap[1:] <= 0)[0]
    if not len(crossing):
        raise ValueError(f"branch of {found.states[0].tube} never meets p = {p:g}")
    out = []
    for mesh in MESHES:
        state = found.states[int(crossing[0])].moved_to(mesh)
        for _ in range(12):
            u = float(state.y[0, 0, 0]) - 1
            state, system = col.newton(state, "u", u)
            step = (p - state.p) / col.derivatives(state, system, "u")[0]
            if abs(step) < 1e-13:
                break
            state, _ = col.newton(state, "u", u + step)
        out.append(state)
    return out


def slopes(guess: State, u: float, delta1: float) -> tuple[State, float, float]:
    """State at (u_max, delta1) with dp/du and d2p/du2 there."""
    tube = replace(guess.tube, delta1=delta1)
    state, system = col.newton(State(tube, guess.mesh, guess.y, guess.p), "u", u)
    return state, *col.derivatives(state, system, "u")


def secant(f: Callable[[float], float], x0: float, x1: float, tol: float) -> float:
    """Root by the secant method, with steps clipped to 0.1.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    f0, f1 = f(x0), f(x1)
    for _ in range(30):
        if f1 == f0 or abs(x1 - x0) < tol:
            return x1
        step = float(np.clip(-f1 * (x1 - x0) / (f1 - f0), -0.1, 0.1))
        x0, f0, x1 = x1, f1, x1 + step
        f1 = f(x1)
    raise RuntimeError("collocation: secant iteration did not converge")


def fold_at(guess: State, u: float) -> State:
    """The limit point with u_max = u: root of dp/du in delta1, starting at the guess's."""
    at = float(guess.tube.delta1)
    root = secant(lambda d: slopes(guess, u, d)[1], at, at + 1e-3, 1e-10)
    return slopes(guess, u, root)[0]


def fold_top(limit: State, step: float = 0.05) -> State:
    """Follow the fold line from a first limit point until delta1 stops rising."""
    here = limit
    while True:
        ahead = fold_at(here, float(here.y[0, 0, 0]) - 1 + step)
        if ahead.tube.delta1 < here.tube.delta1:
            return here
        here = ahead


def cusp(guess: State, max_iter: int = 20) -> State:
    """Newton for dp/du = d2p/du2 = 0 in (u_max, delta1).

    The 2 x 2 matrix is differenced, which affects the speed only, not the root.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    at = np.array([guess.y[0, 0, 0] - 1, guess.tube.delta1])
    state, eps, best = guess, 1e-5, np.inf
    for _ in range(max_iter):
        state, *now = slopes(state, *at)
        matrix = np.empty((2, 2))
        for j in range(2):
            shift = eps * np.eye(2)[j]
            up, down = slopes(state, *(at + shift))[1:], slopes(state, *(at - shift))[1:]
            matrix[:, j] = (np.array(up) - np.array(down)) / (2 * eps)
        step = -np.linalg.solve(matrix, now)
        size = float(np.abs(step).max())
        if size < 1e-11 or (size < 1e-8 and size > 0.3 * best):  # converged, or at rounding
            return state
        best = min(best, size)
        at = at + step * min(1.0, 0.1 / size)
    raise RuntimeError(f"collocation: no cusp near {guess.tube}")


def profile(state: State, z_plot: Array) -> dict[str, Array]:
    """Columns over Z = delta1 z."""
    tube = state.tube
    rho, eta, lam1, _ = col.evaluate(state.mesh, state.y, z_plot / (tube.lf / 2)).T
    lam2 = rho / tube.r0
    t1, t2 = mat.resultants(lam1, lam2, tube.alpha)
    return {"rho": rho, "eta": eta, "lam1": lam1, "lam2": lam2, "t1": t1, "t2": t2}
