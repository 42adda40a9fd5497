"""Tables of paper 3: critical points, where they coincide, and where V(z_w) curves cross.

Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016, figures 2-4 and their discussion.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import combinations

import numpy as np

from reference_data.solvers.core.newton import Secants, secant
from reference_data.solvers.core.tables import Table, steps
from reference_data.solvers.paper3 import canonical as can
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3 import modes, path, text
from reference_data.solvers.paper3.collocation import State
from reference_data.solvers.paper3.common import (
    Rows,
    along,
    columns_of,
    critical,
    followed,
    on,
    root,
)
from reference_data.solvers.paper3.data import GAMMA, GAMMA_EXACT, FluidTube
from reference_data.solvers.paper3.tables_primary import DENSITY, OFF, PAPER
from reference_data.solvers.registry import Builder

# Volumes up to which zeros are looked for; beyond the first n = 1 zero, n = 2 comes much later.
SEARCH: dict[FluidTube, tuple[float, tuple[int, ...]]] = {
    **{tube: (280.0, (0, 1, 2)) for tube in PAPER},
    **{tube: (stop, (0, 1)) for tube, (_, stop) in (DENSITY | OFF).items()},
    FluidTube(8, 5): (180.0, (0, 1, 2)),
    FluidTube(8, 7): (210.0, (0, 1, 2)),
    **{replace(tube, gamma=GAMMA_EXACT): (stop, (0, 1)) for tube, (_, stop) in PAPER.items()},
}


def points(name: str) -> Table:
    """Limit and bifurcation points of all sets."""
    keys: list[tuple[float, ...]] = []
    a: tuple[Rows, Rows] = ([], [])
    b: tuple[Rows, Rows] = ([], [])
    for tube in sorted(SEARCH, key=lambda t: (t.L, t.delta, t.gamma)):
        found = critical(tube, *SEARCH[tube])
        if set(found) != set(SEARCH[tube][1]):
            raise RuntimeError(f"table {name}: {tube}: zeros of n = {sorted(found)} only")
        for n in sorted(found):
            keys.append((tube.L, tube.delta, tube.gamma, n, 1))
            for level, (state, shape) in enumerate(found[n]):
                a[level].append(modes.quantities(state))
                b[level].append(modes.galerkin_quantities(shape))
    names = ("L", "delta", "gamma", "n", "order")
    columns = text.SERIES.keys(**dict(zip(names, zip(*keys, strict=True), strict=True)))
    columns += columns_of(name, ("zw", "V", "r_mid", "r_max", "T1_ring", "Pi"), a, b)
    title, source = "Limit points and bifurcation points of the primary branch", "figures 2-4"
    parameters = {"gamma_paper": GAMMA, "gamma_exact": GAMMA_EXACT}
    return text.SERIES.table(
        name, title, source, parameters, columns, notes=text.CRITICAL_NOTES, extra={"keys": list(names)}
    )


BRACKETS = ((8.0, 3.0, 5.0), (24.0, 1.1, 1.5))  # L, and two pre-strains between which the order changes


def coincidence(name: str) -> Table:
    """Pre-stretch for which limit point and n = 1 bifurcation coincide."""
    a: tuple[Rows, Rows] = ([], [])
    b: tuple[Rows, Rows] = ([], [])
    for L, low, high in BRACKETS:
        guess = _coarse_coincidence(L, low, high)
        for level, how in enumerate(path.RESOLUTIONS):
            state = _by_collocation(guess, how)
            a[level].append(modes.quantities(state) | {"delta": state.tube.delta})
            shape = _by_galerkin(state, how)
            b[level].append(modes.galerkin_quantities(shape) | {"delta": shape.tube.delta})
    columns = text.SERIES.keys(L=[x[0] for x in BRACKETS])
    columns += columns_of(name, ("delta", "zw", "V", "r_mid", "r_max"), a, b)
    return text.SERIES.table(
        name,
        "Pre-stretch at which limit point and n = 1 bifurcation coincide",
        "the order of the critical points of figure 2",
        {"gamma": GAMMA},
        columns,
        notes="L = 8: the limit point comes first for smaller delta; L = 24: for larger delta.",
    )


def _volumes(tube: FluidTube, how: path.Resolution, near: dict[int, State]) -> dict[int, State]:
    """Both critical states of a tube from those of a neighbour."""
    out = {}
    for n, state in near.items():
        moved = State(tube, state.mesh, state.y, state.zw, state.front * state.tube.delta / tube.delta)
        out[n] = modes.critical_point(path.at_volume(moved, state.volume, how), how, n).state
    return out


def _coarse_coincidence(L: float, low: float, high: float) -> dict[int, State]:
    """Both critical states for a pre-stretch at which their volumes differ by little."""
    how = path.RESOLUTIONS[0]
    gaps: dict[float, tuple[float, dict[int, State]]] = {}
    delta = (low + high) / 2
    for _ in range(3):
        near = modes.zeros(FluidTube(L, delta), 200.0, 2.0, (0, 1))
        found = {n: modes.critical_point(s, how, n).state for n, s in near.items()}
        gaps[delta] = found[1].volume - found[0].volume, found
        rising = L > 10  # the bifurcation moves behind the limit point as delta rises
        low, high = (low, delta) if (gaps[delta][0] > 0) == rising else (delta, high)
        delta = (low + high) / 2
    return min(gaps.values(), key=lambda g: abs(g[0]))[1]


def _by_collocation(near: dict[int, State], how: path.Resolution) -> State:
    """Pre-stretch at which the difference of the two volumes vanishes."""
    here = [near]
    if near[0].mesh.degree != how.partial.degree:
        here[0] = {n: on(how, s) for n, s in near.items()}

    def gap(delta: float) -> float:
        here[0] = _volumes(replace(near[0].tube, delta=delta), how, here[0])
        return here[0][1].volume - here[0][0].volume

    delta = near[0].tube.delta
    secant(gap, delta, delta * (1 + 1e-3))
    return here[0][0]


def _by_galerkin(near: State, how: path.Resolution) -> gal.Shape:
    """Root in (V, delta) of the eigenvalues n = 0 and n = 1."""
    first = path.galerkin(near, how)

    def at(volume: float, delta: float) -> gal.Shape:
        tube = replace(first.tube, delta=delta)
        front = first.front * first.tube.delta / delta
        return gal.solve(replace(first, tube=tube, front=front), volume)

    def values(x: np.ndarray) -> np.ndarray:
        shape = at(*x)
        return np.array([modes.galerkin_mode(shape, can.family(n))[0] for n in (0, 1)])

    what = f"Galerkin: coincidence near {near.tube}"
    return at(*Secants(offset=1e-4).solve(values, [near.volume, near.tube.delta], what, stalled=1e-8))


CROSSING_STOP = 130.0


def crossings(name: str) -> Table:
    """Where the curves V(z_w) of two pre-stretches cross."""
    keys: list[tuple[float, ...]] = []
    a: tuple[Rows, Rows] = ([], [])
    b: tuple[Rows, Rows] = ([], [])
    for L in (8.0, 24.0):
        for da, db in combinations((1.5, 2.0, 3.0), 2):
            tubes = FluidTube(L, da), FluidTube(L, db)
            volumes = steps(5.0, CROSSING_STOP, 1.0)
            levels = [np.array([s.zw for s in along(t, volumes, 0)]) for t in tubes]
            gap = levels[0] - levels[1]
            for order, i in enumerate(np.flatnonzero(gap[:-1] * gap[1:] <= 0), 1):
                v = volumes[i], volumes[i + 1]
                limits = [critical(t, PAPER[t][1], (0,))[0][0][0].volume for t in tubes]
                keys.append((L, da, db, order, *(float(v[0] > x) for x in limits)))
                for level in range(2):
                    first, second = _crossing(tubes, v, level)
                    a[level].append(first)
                    b[level].append(second)
    names = ("L", "delta_a", "delta_b", "order", "post_a", "post_b")
    columns = text.SERIES.keys(**dict(zip(names, zip(*keys, strict=True), strict=True)))
    columns += columns_of(name, ("zw", "V"), a, b)
    source = "figure 3 and the effect of pre-stretch"
    notes = (
        "Volumes from 5 to the shorter of the two curves are searched; at lower ones the curves touch at 0."
    )
    extra = {"keys": list(names[:4])}
    return text.SERIES.table(
        name, "Crossings of the curves V(z_w)", source, {"gamma": GAMMA}, columns, notes=notes, extra=extra
    )


def _crossing(
    tubes: tuple[FluidTube, FluidTube], v: tuple[float, float], level: int
) -> tuple[dict[str, float], dict[str, float]]:
    """Common point of two curves by both methods."""
    how = path.RESOLUTIONS[level]
    lines = [followed(t, CROSSING_STOP, level) for t in tubes]
    own = root(lambda x: lines[0].at(x).zw - lines[1].at(x).zw, *v)
    shapes = [path.galerkin(line.at(own), how) for line in lines]
    other = root(lambda x: gal.solve(shapes[0], x).zw - gal.solve(shapes[1], x).zw, own - 1e-3, own + 1e-3)
    return {"zw": lines[0].at(own).zw, "V": own}, {"zw": gal.solve(shapes[0], other).zw, "V": other}


TABLES: dict[str, Builder] = {
    "critical_points": partial(points, "critical_points"),
    "coincidence": partial(coincidence, "coincidence"),
    "crossings": partial(crossings, "crossings"),
}
