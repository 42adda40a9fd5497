"""What the tables of the fluid-loaded tube have in common."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Array, Column, Levels, agreed
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3 import modes, path, text
from reference_data.solvers.paper3.collocation import State, solve
from reference_data.solvers.paper3.data import FluidTube

# Relative rounding errors: what remains of Newton's last step, and of slopes of high degree.
ROUNDING = {"collocation": 5e-13, "galerkin": 1e-11}


def resolved(coarse: Array, fine: Array, method: str) -> Levels:
    """Both resolutions of a method: their difference, and rounding, is the uncertainty."""
    return Levels(coarse, fine, rounding=ROUNDING[method])


def compared(table: str, name: str, collocation: Levels, galerkin: Levels) -> Column:
    """Column of collocation values, once the Galerkin values are found to agree.

    Raises:
        DisagreementError: Naming table, column and worst row.
    """
    return agreed(table, name, galerkin, collocation, text.COLUMNS[name], other="Galerkin")


Rows = list[dict[str, float]]


def columns_of(table: str, names: tuple[str, ...], a: Sequence[Rows], b: Sequence[Rows]) -> list[Column]:
    """Columns from rows at two resolutions of collocation (a) and of Galerkin's method (b)."""
    out = []
    for name in names:
        one, two = ([np.array([row[name] for row in rows]) for rows in found] for found in (a, b))
        out.append(compared(table, name, resolved(*one, "collocation"), resolved(*two, "galerkin")))
    return out


def given(tube: FluidTube) -> dict[str, object]:
    """Parameters as stored."""
    return {"L": float(tube.L), "delta": float(tube.delta), "gamma": float(tube.gamma)}


def named(kind: str, tube: FluidTube, gamma: bool) -> str:
    """Name of a table."""
    return f"{kind}_L_{tube.L:g}_delta_{tube.delta:g}" + f"_gamma_{tube.gamma:g}" * gamma


@cache
def followed(tube: FluidTube, stop: float, level: int) -> path.Path:
    """The primary branch up to a volume, on one of the resolutions.

    Raises:
        RuntimeError: If the branch cannot be followed.
    """
    line = path.Path(tube, path.RESOLUTIONS[level])
    line.reach(stop, 2.0)
    return line


def along(tube: FluidTube, volumes: Array, level: int) -> list[State]:
    """States of the primary branch at given volumes.

    Raises:
        RuntimeError: If the branch cannot be followed.
    """
    line = followed(tube, float(volumes[-1]), level)
    return [line.at(float(v)) for v in volumes]


def branch_rows(states: list[State], how: path.Resolution) -> tuple[Rows, Rows]:
    """Columns of the branch by both methods."""
    shapes = [path.galerkin(s, how) for s in states]
    return [modes.quantities(s) for s in states], [modes.galerkin_quantities(s) for s in shapes]


def on(how: path.Resolution, state: State) -> State:
    """A state on the meshes of another resolution, as a guess."""
    return state.moved_to(how.partial if state.partial else how.full)


@cache
def critical(
    tube: FluidTube, stop: float, waves: tuple[int, ...]
) -> dict[int, list[tuple[State, gal.Shape]]]:
    """First zeros of the wave numbers, each by both methods on both resolutions.

    Raises:
        RuntimeError: If the branch cannot be followed, or a zero not be solved for.
    """
    out = {}
    for n, near in modes.zeros(tube, stop, max(2.0, stop / 100), waves).items():
        pairs = []
        for how in path.RESOLUTIONS:
            found = modes.critical_point(on(how, near), how, n).state
            pairs.append((found, modes.galerkin_critical(found, how, n)))
        out[n] = pairs
    return out


def state_at_level(
    tube: FluidTube, zw: float, post: bool, stop: float
) -> tuple[list[State], list[gal.Shape]]:
    """States of a level, before or after the limit point, by both methods on both resolutions.

    Raises:
        ValueError: If the level does not occur there.
    """
    top = critical(tube, stop, (0,))[0][0][0].volume
    states, shapes = [], []
    for level, how in enumerate(path.RESOLUTIONS):
        line = followed(tube, stop, level)
        passed = [s for s in line.states if (s.volume >= top) == post]
        pairs = [p for p in pairwise(passed) if (p[0].zw - zw) * (p[1].zw - zw) <= 0]
        if not pairs:
            raise ValueError(f"z_w = {zw:g} does not occur {'after' if post else 'before'} the limit point")
        at = _brimful(pairs[0]) if zw == tube.L else line.at
        volume = root(lambda v, at=at: at(v).zw - zw, *(s.volume for s in pairs[0]))
        states.append(at(volume))
        near = path.galerkin(states[-1], how)
        own = root(lambda v, near=near: gal.solve(near, v).zw - zw, volume - 1e-3, volume + 1e-3)
        shapes.append(gal.solve(near, own))
    return states, shapes


def _brimful(pair: tuple[State, State]) -> Callable[[float], State]:
    """States next to the brim as over-filled ones, which spares them a dry region of no length."""
    near = next(s for s in pair if not s.partial)
    return lambda volume: solve(near, volume)


def root(f: Callable[[float], float], low: float, high: float) -> float:
    """Root of a function between two arguments."""
    return float(brentq(f, low, high, xtol=1e-13 * high, rtol=1e-14))
