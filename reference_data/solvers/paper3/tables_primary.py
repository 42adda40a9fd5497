"""Tables of paper 3, axisymmetric: primary branches, their spectra, profiles and the dry tube.

Patil, Nordmark & Eriksson, Proc. R. Soc. A 471 (2015) 20150016, figures 2-5 and 7.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Array, Table, steps
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3 import modes, path, text
from reference_data.solvers.paper3.collocation import State, resultants
from reference_data.solvers.paper3.common import (
    along,
    branch_rows,
    columns_of,
    compared,
    given,
    named,
    resolved,
    state_at_level,
)
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.weak import cut_resultants
from reference_data.solvers.registry import Builder

QUANTITIES = ("zw", "r_mid", "r_max", "T1_ring", "T2_ring", "T1_mid", "T2_mid", "Pi")

# Volumes: step and end, a bit beyond the first bifurcation with n = 1.
PAPER: dict[FluidTube, tuple[float, float]] = {
    FluidTube(8, 1.5): (2, 110),
    FluidTube(8, 2): (2, 140),
    FluidTube(8, 3): (2.5, 170),
    FluidTube(24, 1.5): (2, 100),
    FluidTube(24, 2): (2, 130),
    FluidTube(24, 3): (2.5, 170),
}
DENSITY: dict[FluidTube, tuple[float, float]] = {
    FluidTube(8, 2, 0.058): (4, 224),
    FluidTube(8, 2, 0.232): (1.5, 75),
    FluidTube(24, 2, 0.058): (4, 240),
    FluidTube(24, 2, 0.232): (1.5, 72),
}
OFF: dict[FluidTube, tuple[float, float]] = {
    FluidTube(8, 5): (2.5, 170),
    FluidTube(8, 7): (2.5, 210),
    FluidTube(24, 1.1): (1, 58),
    FluidTube(16, 2.5, 0.05): (6, 336),
    FluidTube(12, 1.3, 0.25): (1, 47),
    FluidTube(24, 7, 0.25): (2, 104),
}


def curve(name: str, tube: FluidTube, volumes: Array, source: str) -> Table:
    """Primary branch over the volume."""
    pairs = [branch_rows(along(tube, volumes, i), how) for i, how in enumerate(path.RESOLUTIONS)]
    a, b = ([p[i] for p in pairs] for i in (0, 1))
    columns = [*text.SERIES.keys(V=volumes), *columns_of(name, QUANTITIES, a, b)]
    title = f"Primary branch, L = {tube.L:g}, delta = {tube.delta:g}, gamma = {tube.gamma:g}"
    return text.SERIES.table(name, title, source, given(tube), columns, notes=text.BRANCH_NOTES)


def spectrum(name: str, tube: FluidTube, volumes: Array, source: str) -> Table:
    """Lowest eigenvalues along the primary branch."""
    a: list[list[dict[str, float]]] = []
    b: list[list[dict[str, float]]] = []
    for level, how in enumerate(path.RESOLUTIONS):
        states = along(tube, volumes, level)
        both = [modes.spectrum(s, how) for s in states]
        a.append(
            [{"zw": s.zw} | {k: v[0] for k, v in row.items()} for s, row in zip(states, both, strict=True)]
        )
        levels = [path.galerkin(s, how).zw for s in states]
        b.append([{"zw": z} | {k: v[1] for k, v in row.items()} for z, row in zip(levels, both, strict=True)])
    columns = text.SERIES.keys(V=volumes)
    columns += columns_of(name, ("zw", *modes.FAMILIES), a, b)
    title = f"Stability of the primary branch, L = {tube.L:g}, delta = {tube.delta:g}, gamma = {tube.gamma:g}"
    return text.SERIES.table(name, title, source, given(tube), columns, notes=text.SPECTRUM_NOTES)


def by_collocation(state: State, at: Array) -> dict[str, Array]:
    """Profile columns of a collocation state."""
    r, z, lam1, _, _ = state.evaluate(at).T
    t1, t2 = resultants(lam1, r)
    return {"r": r, "z": z, "lam1": lam1, "lam2": r, "T1": t1, "T2": t2}


def by_galerkin(shape: gal.Shape, at: Array) -> dict[str, Array]:
    """Profile columns of a Galerkin state."""
    x, slope = shape.evaluate(at)
    lam1 = np.hypot(*slope.T)
    t1, t2 = cut_resultants(*gal.tangents(x, slope))
    return {"r": x[:, 0], "z": x[:, 1], "lam1": lam1, "lam2": x[:, 0], "T1": t1, "T2": t2}


def profile(name: str, tube: FluidTube, zw: float, post: bool, source: str) -> Table:
    """Profile at a level, before or after the limit point."""
    states, shapes = state_at_level(tube, zw, post, PAPER[tube][1])
    at = np.round(tube.length * np.arange(61) / 60, 12)
    a, b = ([f(s, at) for s in found] for f, found in ((by_collocation, states), (by_galerkin, shapes)))
    columns = text.SERIES.keys(Z=at)
    for c in ("r", "z", "lam1", "lam2", "T1", "T2"):
        one, two = resolved(*(p[c] for p in a), "collocation"), resolved(*(p[c] for p in b), "galerkin")
        columns.append(compared(name, c, one, two))
    where = "after" if post else "before"
    title = f"Profile at z_w = {zw:g} {where} the limit point, L = {tube.L:g}, delta = {tube.delta:g}"
    facts = given(tube) | {"zw": zw, "V": states[-1].volume, "post_limit": post}
    return text.SERIES.table(name, title, source, facts, columns, notes=text.PRESSURE_NOTES)


def dry(name: str) -> Table:
    """The pre-stretched tube without fluid."""
    tubes = [FluidTube(L, d) for L in (8, 24) for d in (1.1, 1.5, 2, 3, 5)]
    a: list[list[dict[str, float]]] = []
    b: list[list[dict[str, float]]] = []
    for how in path.RESOLUTIONS:
        states = [path.dry(t, how.partial) for t in tubes]
        first, second = branch_rows(states, how)
        a.append(first)
        b.append(second)
    keys = text.SERIES.keys(**{k: [getattr(t, k) for t in tubes] for k in ("L", "delta")})
    names = ("r_mid", "T1_ring", "T2_ring", "T1_mid", "T2_mid", "Pi")
    columns = [*keys, *columns_of(name, names, a, b)]
    title, source = "The pre-stretched tube without fluid", "figure 2, z_w <= 0"
    return text.SERIES.table(name, title, source, {"gamma": 0.0}, columns, extra={"keys": ["L", "delta"]})


def _branch_tables() -> dict[str, Builder]:
    """Tables over the volume."""
    out: dict[str, Builder] = {}
    for sets, source, gamma in (
        (PAPER, "figures 2 and 3", False),
        (DENSITY, "figure 4", True),
        (OFF, "the problem of figures 2 and 3 at other data", True),
    ):
        for tube, (step, stop) in sets.items():
            for kind, build, stride in (("primary", curve, 1), ("spectrum", spectrum, 5)):
                name = named(kind, tube, gamma)
                volumes = steps(step * stride, stop, step * stride)
                out[name] = partial(build, name, tube, volumes, source)
    return out


FIG05: dict[str, tuple[FluidTube, tuple[float, ...], tuple[float, ...]]] = {
    "fig05a": (FluidTube(8, 2), (2, 4, 6, 7, 8, 8.2), (8.2, 8)),
    "fig05b": (FluidTube(24, 2), (2, 4, 6, 7, 8), (8.3, 8)),
}


def _profile_tables() -> dict[str, Builder]:
    """Tables over Z."""
    out: dict[str, Builder] = {}
    for figure, (tube, before, after) in FIG05.items():
        source = f"figure 5({figure[-1]}), delta = 2 assumed"
        for post, levels in ((False, before), (True, after)):
            for zw in levels:
                name = f"{figure}_zw_{zw:g}" + "_post" * post
                out[name] = partial(profile, name, tube, float(zw), post, source)
    for name, zw, post in (("fig07a", 7.1019, False), ("fig07b", 8.356, True)):
        source = f"figure 7({name[-1]}), delta = 2 assumed"
        out[name] = partial(profile, name, FluidTube(24, 2), zw, post, source)
    return out


TABLES: dict[str, Builder] = {
    **_branch_tables(),
    **_profile_tables(),
    "dry": partial(dry, "dry"),
}
