"""The primary branch: states over the fluid volume, through both crossings of the brim.

The volume rises strictly along the branch, so each state is solved for at its volume. A partially
filled state whose free surface leaves the tube is solved again as an over-filled one, and back.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3.collocation import Array, Mesh, State, solve
from reference_data.solvers.paper3.data import FluidTube

V_START = 0.5


@dataclass(frozen=True)
class Resolution:
    """Collocation meshes for partially filled and over-filled tubes, and Galerkin elements likewise."""

    partial: Mesh
    full: Mesh
    partial_elements: gal.Elements
    full_elements: gal.Elements


def resolution(partial: tuple[int, ...], full: int, elements: tuple[int, ...], whole: int) -> Resolution:
    """Wet and dry elements and their degree, and the elements of over-filled tubes, of both methods."""
    return Resolution(
        Mesh.filled(*partial),
        Mesh.filled(full, 0, partial[2]),
        gal.Elements(*elements),
        gal.Elements(whole, 0, elements[2]),
    )


RESOLUTIONS = (resolution((11, 8, 14), 16, (10, 8, 11), 15), resolution((14, 10, 17), 20, (12, 9, 13), 18))

# Where critical points are only looked for; they are solved for on the resolutions above.
SEARCH = resolution((8, 6, 12), 11, (7, 5, 8), 10)


def dry(tube: FluidTube, mesh: Mesh) -> State:
    """The pre-stretched tube without load: filled with a weightless fluid.

    Raises:
        RuntimeError: If Newton's iteration does not converge.
    """
    return first(replace(tube, gamma=0.0), mesh, 1.0)


def first(tube: FluidTube, mesh: Mesh, volume: float) -> State:
    """The state with a little fluid, from a cylinder as the first guess.

    Raises:
        RuntimeError: If Newton's iteration does not converge.
    """
    level = volume / np.pi
    front = level / tube.delta
    at = mesh.position(tube, front)
    one = np.ones_like(at)
    inside = np.minimum(at / front, 1) * volume
    y = np.stack([one, tube.delta * at, tube.delta * one, np.pi / 2 * one, inside], axis=-1)
    return solve(State(tube, mesh, y, level, front), volume)


def checked(state: State) -> State:
    """The state, if it is a tube that crosses its free surface once.

    Raises:
        RuntimeError: If it is not.
    """
    y, mesh = state.y, state.mesh
    wet = np.broadcast_to(mesh.dampness > 0, y.shape[:2])
    above = np.where(wet, state.zw - y[..., 1], y[..., 1] - state.zw)
    if y[..., 0].min() <= 0 or y[..., 2].min() <= 0 or above.min() < -1e-10:
        raise RuntimeError(f"collocation: no admissible state at V = {state.volume:g} of {state.tube}")
    return state


def at_volume(guess: State, volume: float, how: Resolution) -> State:
    """State at a volume, partially or over-filled as it turns out.

    Raises:
        RuntimeError: If no admissible state is found from this guess.
    """
    mesh = how.partial if guess.partial else how.full
    state = solve(guess if guess.mesh is mesh else guess.moved_to(mesh), volume)
    if state.partial and not 0 < state.front < state.tube.length:
        state = solve(_filled(guess, how), volume)
        if state.zw < state.tube.L:
            raise RuntimeError(f"collocation: neither filled nor over-filled at V = {volume:g}")
    elif not state.partial and state.zw < state.tube.L:
        top = state.y[-1, -1]
        front = state.tube.length - (state.tube.L - state.zw) / (top[2] * np.sin(top[3]))
        state = solve(state.moved_to(how.partial, front), volume)
        if not 0 < state.front < state.tube.length:
            raise RuntimeError(f"collocation: neither filled nor over-filled at V = {volume:g}")
    return checked(state)


def _filled(state: State, how: Resolution) -> State:
    """An over-filled guess from a nearly filled state."""
    out = state.moved_to(how.full, state.tube.length)
    at = out.mesh.position(out.tube, out.front)
    beyond = np.maximum(at - state.front, 0) / (state.tube.length - state.front)
    r, rise = out.y[..., 0], state.tube.L - state.zw
    out.y[..., 4] += np.pi * r**2 * rise * beyond
    return State(out.tube, out.mesh, out.y, state.zw, out.front)


@dataclass
class Path:
    """States of the primary branch at rising volumes, on one resolution."""

    tube: FluidTube
    how: Resolution
    states: list[State] = field(default_factory=list)

    def reach(self, volume: float, step: float) -> State:
        """Go on to a volume in steps of at most ``step``, halved where Newton fails.

        Raises:
            RuntimeError: If the steps become tiny.
        """
        if not self.states:
            self.states.append(checked(first(self.tube, self.how.partial, min(volume, V_START))))
        h = step
        while self.states[-1].volume < volume - 1e-12:
            last = self.states[-1]
            target = min(volume, last.volume + h)
            try:
                state = at_volume(self._guess(target), target, self.how)
            except RuntimeError:
                h /= 2
                if h < 1e-3:
                    raise
                continue
            self.states.append(state)
            h = min(step, 2 * h)
        return self.states[-1]

    def _guess(self, volume: float) -> State:
        """Extrapolation from the last two states, when they are of one kind."""
        last = self.states[-1]
        if len(self.states) < 2 or self.states[-2].partial != last.partial:
            return last
        before = self.states[-2]
        t = (volume - last.volume) / (last.volume - before.volume)
        front = last.front + t * (last.front - before.front)
        if last.partial and not 0 < front < self.tube.length:
            return last
        y = last.y + t * (last.y - before.y)
        return State(self.tube, last.mesh, y, last.zw + t * (last.zw - before.zw), front)

    def at(self, volume: float) -> State:
        """State at a volume that the path has passed."""
        near = min(self.states, key=lambda s: abs(s.volume - volume))
        return at_volume(near, volume, self.how)


def galerkin(state: State, how: Resolution, volume: float | None = None) -> gal.Shape:
    """The same equilibrium by the Galerkin method (the collocation state is only the first guess)."""
    el = how.partial_elements if state.partial else how.full_elements
    x: Array = state.evaluate(el.positions(state.tube, state.front))[:, :2]
    x[0], x[-1] = (1, 0), (1, state.tube.L)
    guess = gal.Shape(state.tube, el, x, state.zw, state.front)
    return gal.solve(guess, state.volume if volume is None else volume)
