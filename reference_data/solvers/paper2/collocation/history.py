r"""Adhesive inflation by collocation in the front position, and adhesive deflation after it.

A point sticks when it touches: in the patch [0, z_f] eta(z) = eta_c(z) permanently, and only rho changes.
While the patch grows both force components are continuous at the front, so that
eta_c'(z_f) = eta'(z_f+), z_f being where rho = s. This determines eta_c' from
eta_c'(0) = lambda1 at first touch on.

Here e = eta_c' is a polynomial on [0, z_end] (values at Chebyshev-Lobatto points z_j; both
parities, since e has a cubic term), and each z_j > 0 is the front of its own state: zones
[0, z_j] stuck with spring, [z_j, L] free, p_j unknown, rho(z_j) = s. These are solved side by side, and
e(z_j) = eta'(z_j+), e(0) = lambda1 is the fixed point of repeated substitution. Any other state of the
inflation then has its front as an unknown, p being given; that eta' is continuous there is a check.

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

from reference_data.solvers.core.collocation import Array, Resolution, lobatto
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.newton import settled
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.equations import State, Zone, profile, recut, solve
from reference_data.solvers.paper2.substrate import Substrate


@dataclass(frozen=True)
class Frozen:
    """Chebyshev series of the frozen eta' on [0, end]; eta(0) = 0."""

    end: float
    series: Array

    @classmethod
    def through(cls, end: float, values: Array) -> Frozen:
        """Polynomial with ``values`` at the Chebyshev-Lobatto points."""
        degree = len(values) - 1
        return cls(end, np.linalg.solve(cheb.chebvander(2 * lobatto(degree) - 1, degree), values))

    def _at(self, z: Any, series: Array) -> Any:
        return cheb.chebval(2 * z / self.end - 1, series)

    def position(self, z: Any) -> Any:
        """Position eta at which the patch is frozen."""
        return self._at(z, cheb.chebint(self.series, lbnd=-1, scl=self.end / 2))

    def slope(self, z: Any) -> Any:
        """Slope eta'."""
        return self._at(z, self.series)

    def bend(self, z: Any) -> Any:
        """Second derivative eta''."""
        return self._at(z, cheb.chebder(self.series, scl=2 / self.end))


def axial_slope(state: State) -> Any:
    """Slope eta' at the free side of the last front."""
    l1, b = (state.y[-1][..., 0, 0, i] for i in (2, 3))
    return l1 * np.cos(b)


class Inflation:
    """Adhesive inflation of one tube at one resolution, up to at least ``p_end``.

    Raises:
        RuntimeError: If it does not reach that pressure, or the history does not settle.
    """

    def __init__(self, tube: Tube, substrate: Substrate, how: Resolution, p_end: float) -> None:
        self.first, self.how = st.touch(tube, substrate, how.free), how
        front = float(st.frictionless(self.first, how, np.array([p_end]))[0].fronts[0])
        for margin in (0.0, 0.02, 0.05, 0.1):  # the front of adhesive contact is near that one
            self.end = front + margin * (tube.length - front)
            self.states = self._guesses()
            slopes = np.array([self.first.y[0][0, 0, 2], *axial_slope(self.states)])
            self._substituted(settled(self._substituted, slopes, 1e-13))
            if self.states.c[-1, 0] > p_end:
                return
        raise RuntimeError(f"adhesive inflation of {tube} reaches p = {self.states.c[-1, 0]:g} only")

    def _guesses(self) -> State:
        """Frictionless states whose fronts are the points of the series, side by side."""
        fronts = self.end * lobatto(self.how.terms - 1)[1:]
        state, found = st.frictionless_near_touch(self.first, self.how, float(fronts[0])), []
        for z in fronts:
            state = st.at_front(state, float(z))
            found.append(state)
        y = tuple(np.stack([s.y[d] for s in found]) for d in (0, 1))
        rho, _, l1, b, v = np.moveaxis(y[0], -1, 0)
        zones = (Zone(self.how.inner, stuck=True, spring=True), Zone(self.how.outer))
        inner = np.stack([rho, l1 * np.sin(b), v], axis=-1)
        return replace(state, zones=zones, y=(inner, y[1]), c=np.stack([s.c for s in found]))

    def _substituted(self, slopes: Array) -> Array:
        """Slopes at the fronts of the states that have these slopes as their history."""
        history = Frozen.through(self.end, slopes)
        fronts, s = self.end * lobatto(self.how.terms - 1)[1:], self.first.substrate.s
        self.states = solve(replace(self.states, history=history), front=fronts, rho=s)
        return np.array([slopes[0], *axial_slope(self.states)])

    def at(self, p: float) -> State:
        """State of the inflation at a pressure."""
        j = int(np.argmin(np.abs(self.states.c[:, 0] - p)))
        nearest = replace(self.states, y=tuple(y[j] for y in self.states.y), c=self.states.c[j])
        return solve(nearest, p=p, rho=nearest.substrate.s)


def slope_defect(state: State) -> float:
    """Jump of eta' at the front: zero but for the truncation of the series of e."""
    return float(state.history.slope(state.fronts[0]) - axial_slope(state))


def bilateral(state: State, p: Array) -> list[State]:
    """Deflation with the spring on the whole patch, at falling pressures."""
    front, out = float(state.fronts[0]), []
    for target in p:
        state = solve(state, p=float(target), front=front)
        out.append(state)
    return out


def released(state: State, how: Resolution, p: float) -> State:
    """State with the patch glued but no spring anywhere."""
    front = float(state.fronts[-1])
    if len(state.zones) == 3:
        state = recut(state, (Zone(how.inner, stuck=True), state.zones[-1]), (front,))
    elif state.zones[0].spring:
        state = replace(state, zones=(replace(state.zones[0], spring=False), state.zones[1]))
    return solve(state, p=p, front=front)


def lifted(state: State, how: Resolution, p: float) -> State:
    """State with the spring acting on [0, z_1] only, rho(z_1) = s.

    Raises:
        RuntimeError: If there is none with 0 < z_1 < z_f.
    """
    front = float(state.fronts[-1])
    if len(state.zones) == 2:  # the patch has just started to lift: start from the bilateral state
        state = solve(state, p=p, front=front)
        z = np.linspace(0, front, 2001)
        z_1 = float(z[np.nonzero(profile(state, z, side=-1)[:, 0] > state.substrate.s)[0][-1]])
        state = recut(state, (state.zones[0], Zone(how.inner, stuck=True), state.zones[1]), (z_1, front))
    state = solve(state, p=p, front=front, rho=state.substrate.s)
    if not 0 < float(state.fronts[0]) < front:
        raise RuntimeError(f"no patch of width {float(state.fronts[0]):g} at p = {p:g}")
    return state


def unilateral(start: State, how: Resolution, p: Array, step: float = 0.01) -> list[State]:
    """Deflation with a spring that only pushes, at falling pressures, by steps of at most ``step``.

    Ends early where no further state is found.

    Raises:
        RuntimeError: If a spring that lets go of the patch does not let go of the mid-plane.
    """
    out, state, on, at = [], start, True, start.p
    for target in p:
        count = max(1, int(np.ceil((at - target) / step - 1e-9)))
        for now in at + (float(target) - at) * np.arange(1, count + 1) / count:
            if at == target:
                state = solve(state, p=at, front=float(state.fronts[-1])) if on else released(state, how, at)
                break
            if on:
                try:
                    there = lifted(state, how, float(now))
                except RuntimeError:
                    on = False
            if not on:
                try:
                    there = released(state, how, float(now))
                except RuntimeError:
                    return out
                if there.y[0][0, 0, 0] > start.substrate.s:
                    raise RuntimeError(f"unilateral spring: contact lost and kept at p = {now:g}")
            state = there
        at = float(target)
        out.append(state)
    return out
