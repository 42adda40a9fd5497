r"""Adhesive inflation by collocation in the front position, and adhesive deflation after it.

A point sticks when it touches: in the patch [0, z_f] eta(z) = eta_c(z) permanently, and only rho changes.
While the patch grows both force components are continuous at the front, so that
eta_c'(z_f) = eta'(z_f+), z_f being where rho = s. This determines eta_c' from
eta_c'(0) = lambda1 at first touch on.

Here e = eta_c' is a polynomial on [0, z_end] (values at Chebyshev-Lobatto points z_j; both
parities, since e has a cubic term), and each z_j > 0 is the front of its own state: zones
[0, z_j] stuck with spring, [z_j, L] free, p_j unknown, rho(z_j) = s. Newton solves
e(z_j) = eta'(z_j+), e(0) = lambda1 for all e(z_j) and all states together; every inner zone
depends on all of e, so the system for the e(z_j) is full. Any other state of the inflation then
has its front as an unknown, p being given; that eta' is continuous there is a check.

Deflation: the patch keeps its e and its front, rho is free everywhere. Bilateral spring: it acts
on the whole patch, whatever the sign of rho - s (equation (9)). Unilateral: it acts where
rho > s, on [0, z_1], z_1 unknown with rho(z_1) = s; once rho(0) < s nowhere.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev as cheb

from reference_data.solvers.core import collocation as free
from reference_data.solvers.core.collocation import STEP, Array, Mesh
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.collocation import contact as con
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.contact import Linearised, State, Zone
from reference_data.solvers.paper2.collocation.states import Resolution
from reference_data.solvers.paper2.substrate import Substrate


@dataclass(frozen=True)
class Frozen:
    """Chebyshev series of the frozen eta' on [0, end]; eta(0) = 0."""

    end: float
    series: Array

    @classmethod
    def through(cls, end: float, values: Array) -> Frozen:
        """Polynomial with ``values`` at the Chebyshev-Lobatto points."""
        return cls(end, to_series(len(values)) @ values)

    def slope(self, z: Any) -> Any:
        """Slope eta' at which the patch is frozen."""
        return cheb.chebval(2 * z / self.end - 1, self.series)

    def position(self, z: Any) -> Any:
        """Height eta at which the patch is frozen."""
        whole = cheb.chebint(self.series, lbnd=-1, scl=self.end / 2)
        return cheb.chebval(2 * z / self.end - 1, whole)


def points(terms: int) -> Array:
    """Chebyshev-Lobatto points on [0, 1]."""
    return (1 - np.cos(np.pi * np.arange(terms) / (terms - 1))) / 2


def to_series(terms: int) -> Array:
    """Matrix from values at the points to Chebyshev coefficients."""
    return np.linalg.inv(cheb.chebvander(2 * points(terms) - 1, terms - 1))


def stick(state: State, history: Frozen) -> State:
    """Guess: a frictionless state's patch becomes stuck."""
    rho, _, l1, b = np.moveaxis(state.y[0], -1, 0)
    inner = np.stack([rho, l1 * np.sin(b)], axis=-1)
    zones = (Zone(state.zones[0].mesh, stuck=True, spring=True), *state.zones[1:])
    return replace(state, zones=zones, y=(inner, *state.y[1:]), history=history)


def axial_slope(state: State) -> tuple[float, Array]:
    """Slope eta' at the free side of the front, and its gradient by (rho, eta, l1, b) there."""
    _, _, l1, b = state.y[-1][0, 0]
    return float(l1 * np.cos(b)), np.array([0.0, 0.0, np.cos(b), -l1 * np.sin(b)])


def by_history(system: Linearised, cardinals: Array) -> Array:
    """Derivative of a state's residual by the values of e: one column per value."""
    state, out = system.state, []
    for series in cardinals.T:
        bumped = replace(state.history, series=state.history.series + 1j * STEP * series)
        there = replace(state, history=bumped)
        column = np.zeros(len(system.residual))
        value = np.imag(con.defect(there, 0, state.scalars)[0]).ravel() / STEP
        column[: len(value)] = value
        start = system.joint_row
        joint = con.joint(there, 0, state.y[0][-1, -1], state.y[1][0, 0], state.fronts[0])
        column[start : start + len(joint)] = np.imag(joint) / STEP
        out.append(column)
    return np.stack(out, axis=1)


class Inflation:
    """Adhesive inflation of one tube at one resolution, up to at least ``p_end``."""

    def __init__(self, tube: Tube, substrate: Substrate, how: Resolution, p_end: float) -> None:
        self.first, self.volume = st.touch(tube, substrate, how.free)
        self.how, self.p_end = how, p_end
        smooth = st.frictionless(self.first, substrate, how, np.array([p_end]))[0].state
        front = float(smooth.fronts[0])  # the front of adhesive contact is near it, before or after
        for margin in (0.0, 0.02, 0.05, 0.1):
            self.end = front + margin * (tube.length - front)
            self.states = self._guesses(substrate)
            self.history = self.states[-1].history
            self._solve()
            if self.states[-1].p > p_end:
                return
        raise RuntimeError(f"adhesive inflation of {tube} reaches p = {self.states[-1].p:g} only")

    def _guesses(self, substrate: Substrate) -> list[State]:
        """Frictionless states with the same fronts; e from the slope at their fronts."""
        fronts = self.end * points(self.how.terms)[1:]
        state = st.frictionless_near_touch(self.first, substrate, self.how, float(fronts[0]))
        smooth = []
        for z in fronts:
            state, _ = st.at_front(state, float(z))
            smooth.append(state)
        lam1 = float(self.first.y[0, 0, 2])
        values = np.array([lam1] + [axial_slope(s)[0] for s in smooth])
        history = Frozen.through(self.end, values)
        return [stick(s, history) for s in smooth]

    def _solve(self, max_iter: int = 30) -> None:
        """Newton for all states and the frozen values together."""
        terms, small = self.how.terms, 0
        cardinals = to_series(terms)
        values = cheb.chebval(2 * points(terms) - 1, self.history.series)
        lam1 = float(self.first.y[0, 0, 2])
        for _ in range(max_iter):
            matrix, rhs, parts = np.eye(terms), np.zeros(terms), []
            rhs[0] = lam1 - values[0]
            for j, state in enumerate(self.states, 1):
                conditions = [("scalar", 1, float(state.fronts[0])), ("rho", 0, state.substrate.s)]
                system = Linearised(state, conditions)
                known = system.factors.solve(
                    np.column_stack([system.residual, by_history(system, cardinals)])
                )
                slope, gradient = axial_slope(state)
                seen = gradient @ known[system.index(1, 0, 0)]
                matrix[j] += seen[1:]
                rhs[j] = slope - seen[0] - values[j]
                parts.append((system, known))
            step = np.linalg.solve(matrix, rhs)
            size = self._advance(values, step, parts)
            values = values + min(1.0, 0.2 / size) * step
            small += size < 1e-7
            if small == 2:
                return
        raise RuntimeError(f"adhesive inflation of {self.first.tube}: no convergence")

    def _advance(self, values: Array, step: Array, parts: list[tuple[Linearised, Array]]) -> float:
        """Move every state along the common Newton step; returns the size of the step."""
        steps = [-known[:, 0] - known[:, 1:] @ step for _, known in parts]
        size = max(float(np.abs(s).max()) for s in [*steps, step])
        if not np.isfinite(size):
            raise RuntimeError(f"adhesive inflation of {self.first.tube}: diverges")
        scale = min(1.0, 0.2 / size)
        self.history = Frozen.through(self.end, values + scale * step)
        moved = []
        for (system, _), s in zip(parts, steps, strict=True):
            cut = list(system.split(scale * s))
            y = tuple(a + b for a, b in zip(system.state.y, cut, strict=False))
            scalars = system.state.scalars + cut[-1]
            moved.append(replace(system.state, y=y, scalars=scalars, history=self.history))
        self.states = moved
        return size

    def at(self, p: float) -> Linearised:
        """State of the inflation at a pressure."""
        nearest = min(self.states, key=lambda s: abs(s.p - p))
        return con.newton(nearest, [("scalar", 0, p), ("rho", 0, nearest.substrate.s)])[1]


def slope_defect(state: State) -> float:
    """Jump of eta' at the front: zero but for the truncation of the series of e."""
    return float(state.history.slope(state.fronts[0])) - axial_slope(state)[0]


def bilateral(start: State, p: Array) -> list[Linearised]:
    """Deflation with the spring on the whole patch, at falling pressures."""
    front, out, state = float(start.fronts[0]), [], start
    for target in p:
        state, system = con.newton(state, [("scalar", 0, float(target)), ("scalar", 1, front)])
        out.append(system)
    return out


def split_at(state: State, z: float, mesh: Mesh) -> State:
    """Guess: the stuck zone cut at z, the spring acting before it only."""
    inner, outer = state.zones
    front, rows = float(state.fronts[0]), []
    for m, left, right in ((inner.mesh, 0.0, z), (mesh, z, front)):
        x = con.places(m, left, right)[0] / front
        rows.append(free.evaluate(inner.mesh, state.y[0], x))
    zones = (replace(inner, spring=True), Zone(mesh, stuck=True), outer)
    return replace(state, zones=zones, y=(*rows, *state.y[1:]), scalars=np.array([state.p, z, front]))


def released(state: State, how: Resolution, p: float) -> tuple[State, Linearised]:
    """State with the patch glued but no spring anywhere."""
    front = float(state.fronts[-1])
    if len(state.zones) == 3:
        z = con.places(how.inner, 0.0, front)[0]
        there = st.profile(state, np.ravel(z))
        inner = np.stack([there[:, 0], there[:, 2] * np.sin(there[:, 3])], axis=-1).reshape(*z.shape, 2)
        zones = (Zone(how.inner, stuck=True), state.zones[-1])
        state = replace(state, zones=zones, y=(inner, state.y[-1]), scalars=np.array([state.p, front]))
    elif state.zones[0].spring:
        state = replace(state, zones=(replace(state.zones[0], spring=False), state.zones[1]))
    return con.newton(state, [("scalar", 0, p), ("scalar", 1, front)])


def lifted(state: State, how: Resolution, p: float) -> tuple[State, Linearised]:
    """State with the spring acting on [0, z_1] only, rho(z_1) = s.

    Raises:
        RuntimeError: If there is none with 0 < z_1 < z_f.
    """
    front = float(state.fronts[-1])
    if len(state.zones) == 2:  # the patch has just started to lift: start from the bilateral state
        state, _ = con.newton(state, [("scalar", 0, p), ("scalar", 1, front)])
        z = np.linspace(0, front, 2001)
        z_1 = float(z[np.nonzero(st.profile(state, z, side=-1)[:, 0] > state.substrate.s)[0][-1]])
        state = split_at(state, z_1, how.inner)
    conditions = [("scalar", 0, p), ("scalar", 2, front), ("rho", 0, state.substrate.s)]
    state, system = con.newton(state, conditions)
    if not 0 < float(state.fronts[0]) < front:
        raise RuntimeError(f"no patch of width {float(state.fronts[0]):g} at p = {p:g}")
    return state, system


def unilateral(start: State, how: Resolution, p: Array, step: float = 0.01) -> list[Linearised]:
    """Deflation with a spring that only pushes, at falling pressures, by steps of at most ``step``.

    Ends early where no further state is found.
    """
    out, state, on = [], start, True
    at = start.p
    for target in p:
        count = max(1, int(np.ceil((at - target) / step - 1e-9)))
        for now in at + (float(target) - at) * np.arange(1, count + 1) / count:
            if at == target:
                state, system = (
                    released(state, how, at)
                    if not on
                    else con.newton(state, [("scalar", 0, at), ("scalar", 1, float(state.fronts[-1]))])
                )
                break
            if on:
                try:
                    there, system = lifted(state, how, float(now))
                except RuntimeError:
                    on = False
            if not on:
                try:
                    there, system = released(state, how, float(now))
                except RuntimeError:
                    return out
                if there.y[0][0, 0, 0] > start.substrate.s:
                    raise RuntimeError(f"unilateral spring: contact lost and kept at p = {now:g}")
            state = there
        at = float(target)
        out.append(system)
    return out
