"""Curves, limit points, fold line and cusp of the half tube by collocation.

dp/du and d2p/du2 are exact (Taylor series along the branch), u standing for u_max or, for
long tubes, the half volume V. A limit point is the root of dp/du, a fold line the same root
followed with delta1 as the unknown, the cusp the common root of both derivatives; eliminating
the state from the extended systems leaves just these scalar equations. Everything is done on
two meshes; the difference is the uncertainty.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Mesh
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import newton, secant
from reference_data.solvers.core.tables import Levels
from reference_data.solvers.paper2.collocation import equations as eq
from reference_data.solvers.paper2.collocation.equations import State, Zone, solve

MESHES = (Mesh.graded(10, 12, 1.6), Mesh.graded(14, 16, 1.6))
ROUNDING = 2e-13  # relative; remaining error of Newton's last step, from the two meshes


def resolved(coarse: Array, fine: Array) -> Levels:
    """Values on the finer mesh; the difference to the coarser one, and rounding, is the uncertainty."""
    return Levels(coarse, fine, rounding=ROUNDING)


def quantities(state: State) -> dict[str, float]:
    """Columns of a branch at one state."""
    rho, _, lam1, *_ = state.y[0][0, 0]
    t1, _ = mat.resultants(lam1, rho / state.tube.r0, state.tube.alpha)
    return {"u_max": rho - 1, "p": state.p, "lam1_mid": lam1, "t1_mid": t1, "V": state.volume}


def first_guess(tube: Tube, mesh: Mesh, u: float) -> State:
    """A bulge of height u to start Newton from: rho = 1 + u (1 - x^6), eta uniform."""
    x = mesh.x
    slope = -6 * u * x**5 / tube.length
    rho, angle = 1 + u * (1 - x**6), np.arctan2(slope, tube.delta1 + 0 * x)
    y = [rho, x * tube.lf / 2, np.hypot(tube.delta1, slope), angle, rho**2 * x * tube.lf / 4]
    return State(tube, (Zone(mesh),), (np.stack(y, axis=-1),), np.array([0.5]))


def start(tube: Tube, mesh: Mesh, control: str, target: float) -> State:
    """The state at the first target, starting from u_max = 0.3, where Newton converges easily."""
    state = solve(first_guess(tube, mesh, 0.3), u_max=0.3)
    now = state.volume if control == "V" else 0.3
    for step in np.linspace(now, target, 6)[1:]:
        state = solve(state, **{control: float(step)})
    return state


@dataclass
class Branch:
    """States at rising values of the control, with their columns."""

    control: str
    states: list[State]

    @property
    def columns(self) -> dict[str, Array]:
        """Columns of the states."""
        rows = [quantities(s) for s in self.states]
        return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def branch(tube: Tube, mesh: Mesh, control: str, targets: Array) -> Branch:
    """Solve at each target in turn, with the last state as the next guess."""
    state, states = start(tube, mesh, control, float(targets[0])), []
    for target in targets:
        state = solve(state, **{control: float(target)})
        states.append(state)
    return Branch(control, states)


def curve(tube: Tube, control: str, targets: Array) -> dict[str, Levels]:
    """All columns on two meshes."""
    coarse, fine = (branch(tube, mesh, control, targets).columns for mesh in MESHES)
    return {name: resolved(coarse[name], fine[name]) for name in fine}


def limit_point(guess: State, control: str) -> State:
    """Newton's method for dp/du = 0 with the exact d2p/du2.

    Raises:
        RuntimeError: If the iteration does not converge.
    """

    def correct(state: State) -> tuple[float, object]:
        at = state.volume if control == "V" else state.u_max
        p1, p2 = eq.slopes(state, control)
        return abs(p1 / p2), lambda share: solve(state, **{control: at - float(share) * p1 / p2})

    what = f"collocation: limit point of {guess.tube}"
    at = guess.volume if control == "V" else guess.u_max
    return newton(solve(guess, **{control: at}), correct, what, longest=0.2, close=1e-9)


def limit_points(found: Branch) -> list[list[State]]:
    """Every limit point between the states of a branch, each on the two meshes."""
    rate = np.array([eq.slope(s, found.control) for s in found.states])
    out = []
    for i in np.nonzero(rate[:-1] * rate[1:] < 0)[0]:
        near = found.states[i if abs(rate[i]) < abs(rate[i + 1]) else i + 1]
        out.append([limit_point(eq.recut(near, (Zone(mesh),), ()), found.control) for mesh in MESHES])
    return out


def state_at_pressure(found: Branch, p: float) -> list[State]:
    """State at the first crossing of p on both meshes.

    Raises:
        ValueError: If the branch does not cross p.
    """
    gap = np.array([s.p for s in found.states]) - p
    crossing = np.nonzero(gap[:-1] * gap[1:] <= 0)[0]
    if not len(crossing):
        raise ValueError(f"branch of {found.states[0].tube} never meets p = {p:g}")
    near = found.states[int(crossing[0])]
    return [solve(eq.recut(near, (Zone(mesh),), ()), p=p) for mesh in MESHES]


def fold_at(guess: State, u: float) -> State:
    """The limit point with u_max = u: root of dp/du in delta1, starting at the guess's."""
    at = float(guess.tube.delta1)
    there = lambda d: solve(replace(guess, tube=replace(guess.tube, delta1=d)), u_max=u)  # noqa: E731
    return there(secant(lambda d: eq.slope(there(d), "u_max"), at, at + 1e-3, 0.1)[0])


def fold_top(limit: State, step: float = 0.05) -> State:
    """Follow the fold line from a first limit point until delta1 stops rising."""
    here = limit
    while True:
        ahead = fold_at(here, here.u_max + step)
        if ahead.tube.delta1 < here.tube.delta1:
            return here
        here = ahead


def cusp(guess: State) -> State:
    """The point of the fold line at which d2p/du2 vanishes as well."""
    low, high = guess.u_max, guess.u_max + 0.02
    here = [guess]

    def second(u: float) -> float:
        here[0] = fold_at(here[0], float(u))
        return eq.slopes(here[0], "u_max")[1]

    return fold_at(here[0], secant(second, low, high, 0.1)[0])


def profile(state: State, z_plot: Array) -> dict[str, Array]:
    """Columns over Z = delta1 z."""
    return eq.columns(state.tube, eq.profile(state, z_plot / state.tube.delta1))
