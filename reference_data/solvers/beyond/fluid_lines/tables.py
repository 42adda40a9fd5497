"""Tables of critical points of the fluid-loaded tube in the plane of pre-stretch and level.

The methods are those of paper 3: collocation of the canonical equations of state and perturbation, and
Galerkin's method on the Cartesian weak form. Each point of a line starts from the one before it.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from reference_data.solvers.core.newton import Secants, secant
from reference_data.solvers.core.tables import Column, Table, steps
from reference_data.solvers.paper3 import canonical as can
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3 import modes, path, text
from reference_data.solvers.paper3.collocation import State
from reference_data.solvers.paper3.common import Rows, columns_of, on
from reference_data.solvers.paper3.data import GAMMA, FluidTube
from reference_data.solvers.registry import Builder

OTHER = {"other": ("1", "wave number that is critical too; n = 0: the limit point")}
SERIES = replace(text.SERIES, paper="beyond", columns=text.COLUMNS | OTHER)
L = 8.0
LARGEST = 280.0
"""Volume up to which the first point of a line is looked for."""
SCALED = {"V": "1/(2 pi A^3)", "Pi": "1/(2 pi C1 H A^2)"}
"""Scaling of the columns that diagrams have in another one than paper 3."""
WAVES = {"fold": 0, "n1": 1, "n2": 2, "n3": 3}


def first_points(delta: float, waves: tuple[int, ...], largest: float = LARGEST) -> dict[int, State]:
    """The first critical states of wave numbers at one pre-stretch.

    Raises:
        RuntimeError: If there is none up to the largest volume.
    """
    how = path.RESOLUTIONS[0]
    near = modes.zeros(FluidTube(L, delta), largest, 2.0, waves)
    if missing := sorted(set(waves) - set(near)):
        raise RuntimeError(f"delta = {delta:g}: no critical state of n = {missing} up to V = {largest:g}")
    return {n: modes.critical_point(on(how, state), how, n).state for n, state in near.items()}


def moved(state: State, delta: float, how: path.Resolution, n: int) -> State:
    """The critical state of another pre-stretch, from one nearby."""
    tube, front = replace(state.tube, delta=delta), state.front * state.tube.delta / delta
    guess = State(tube, state.mesh, state.y, state.zw, front)
    return modes.critical_point(path.at_volume(guess, state.volume, how), how, n).state


def scaled(row: dict[str, float]) -> dict[str, float]:
    """A row with its volume over 2 pi A^3 and its energy over 2 pi C1 H A^2; mu = 2 C1."""
    return row | {"V": row["V"] / (2 * np.pi), "Pi": row["Pi"] / np.pi}


def by_both(name: str, names: tuple[str, ...], a: tuple[Rows, Rows], b: tuple[Rows, Rows]) -> list[Column]:
    """Columns that both methods agree on."""
    columns = columns_of(name, names, a, b)
    return [replace(c, scaling=SCALED.get(c.name, c.scaling)) for c in columns]


def line(name: str, kind: str, deltas: np.ndarray) -> Table:
    """Critical points of a kind over the pre-stretch."""
    n = WAVES[kind]
    state = first_points(float(deltas[0]), (n,))[n]
    states = [state]
    for before, delta in pairwise(deltas.tolist()):
        for between in np.linspace(before, delta, 1 + round((delta - before) / STEP))[1:].tolist():
            state = moved(state, between, path.RESOLUTIONS[0], n)
        states.append(state)
    a: tuple[Rows, Rows] = ([], [])
    b: tuple[Rows, Rows] = ([], [])
    for near in states:
        for level, how in enumerate(path.RESOLUTIONS):
            found = modes.critical_point(on(how, near), how, n).state
            a[level].append(scaled(modes.quantities(found)))
            b[level].append(scaled(modes.galerkin_quantities(modes.galerkin_critical(found, how, n))))
    columns = SERIES.keys(delta=deltas) + by_both(name, ("zw", "V", "Pi"), a, b)
    what = "limit points" if n == 0 else f"bifurcations with n = {n}"
    return SERIES.table(name, f"Line of {what} over the pre-stretch", "", {"L": L, "gamma": GAMMA}, columns)


STEP = 0.125
"""Largest step of the pre-stretch along a line."""

PAIRS = (((0, 1), 4.5), ((0, 2), 5.1), ((0, 3), 5.7), ((1, 2), 6.1), ((1, 3), 7.0), ((2, 3), 8.6))
"""Wave numbers, and a pre-stretch near that at which both are neutral at once."""


def meetings(name: str) -> Table:
    """Points at which two wave numbers, or one and the limit point, are critical at once."""
    a: tuple[Rows, Rows] = ([], [])
    b: tuple[Rows, Rows] = ([], [])
    for pair, delta in PAIRS:
        near = first_points(delta, pair)
        for level, how in enumerate(path.RESOLUTIONS):
            state = by_collocation(near, pair, how)
            shape = by_galerkin(state, pair, how)
            a[level].append(scaled(modes.quantities(state)) | {"delta": state.tube.delta})
            b[level].append(scaled(modes.galerkin_quantities(shape)) | {"delta": shape.tube.delta})
    keys = dict(zip(("n", "other"), np.transpose([pair for pair, _ in PAIRS]).astype(float), strict=True))
    columns = SERIES.keys(**keys) + by_both(name, ("delta", "zw", "V", "Pi"), a, b)
    return SERIES.table(
        name,
        "Pre-stretches at which two wave numbers are critical at once",
        "",
        {"L": L, "gamma": GAMMA},
        columns,
        extra={"keys": ["n", "other"]},
    )


def by_collocation(near: dict[int, State], pair: tuple[int, int], how: path.Resolution) -> State:
    """Pre-stretch at which the volumes of both critical states are equal."""
    here = [{n: on(how, state) for n, state in near.items()}]

    def gap(delta: float) -> float:
        here[0] = {n: moved(state, delta, how, n) for n, state in here[0].items()}
        return here[0][pair[1]].volume - here[0][pair[0]].volume

    delta = near[pair[0]].tube.delta
    secant(gap, delta, delta * (1 + 1e-3), longest=0.2)
    return here[0][pair[0]]


def by_galerkin(near: State, pair: tuple[int, int], how: path.Resolution) -> gal.Shape:
    """Root in (V, delta) of both lowest eigenvalues."""
    first = path.galerkin(near, how)

    def at(volume: float, delta: float) -> gal.Shape:
        front = first.front * first.tube.delta / delta
        return gal.solve(replace(first, tube=replace(first.tube, delta=delta), front=front), volume)

    def values(x: np.ndarray) -> np.ndarray:
        shape = at(*x)
        return np.array([modes.galerkin_mode(shape, can.family(n))[0] for n in pair])

    what = f"Galerkin: n = {pair} near {near.tube}"
    return at(*Secants(offset=1e-4).solve(values, [near.volume, near.tube.delta], what, stalled=1e-8))


FULL, PARTLY = steps(3.25, 7.0, 0.375), steps(1.8, 3.0, 0.2)
TABLES: dict[str, Builder] = {
    "fluid_fold_delta": partial(line, "fluid_fold_delta", "fold", FULL),
    "fluid_n1_delta": partial(line, "fluid_n1_delta", "n1", FULL),
    "fluid_n2_delta": partial(line, "fluid_n2_delta", "n2", steps(4.0, 7.0, 0.375)),
    "fluid_n1_partly": partial(line, "fluid_n1_partly", "n1", PARTLY),
    "fluid_meetings": partial(meetings, "fluid_meetings"),
}
