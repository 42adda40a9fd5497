"""Tables of membranes whose thickness is a cosine of the meridian: cylinder, critical radius, flat disk."""

from __future__ import annotations

from functools import partial

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Array, Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.cases import STEPS, Pair
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods.collocation import Rule, State
from reference_data.solvers.paper4.methods.shooting_measures import starts_of
from reference_data.solvers.paper4.methods.shooting_newton import Solution, solve
from reference_data.solvers.paper4.methods.states import from_grid, moved_to, polished
from reference_data.solvers.paper4.uneven import FlatDisk, UnevenTube
from reference_data.solvers.registry import Builder

SOURCE = "the equations with another thickness; not in the paper"
RADII = (2.0, 3.0)
TUBES = {
    "uneven_tube_fluid": (UnevenTube(1.0, 2.0, Af=0.65), np.arange(0.5, 12.1, 0.5)),
    "uneven_tube_gas": (UnevenTube(1.0, 2.0, Af=0.65, load="gas"), np.round(np.arange(0.02, 0.31, 0.02), 2)),
}
DISK = FlatDisk()
RULES = (Rule(16, 0.1), Rule(18, 0.08))
HEIGHTS = tuple(round(0.1 * k, 1) for k in range(1, 21))
EASY, CELLS = 2.0, 120
"""Pressure of the disk's first state, and its intervals."""
DISK_COLUMNS = {
    "p": ("P R_f/(C1 h)", "pressure"),
    "lam_pole": ("1", "both stretches at the pole"),
    "lam1_rim": ("1", "meridional stretch at the clamp"),
    "V": ("V/(2 pi R_f^3)", "enclosed volume per 2 pi"),
}


def tube(name: str, membrane: UnevenTube, loads: Array) -> Table:
    """Scalars of the states at given loads."""
    found = [cas.solved(membrane, float(x)) for x in loads]
    columns = text.SERIES.keys(**{membrane.control: loads})
    for c in msr.SCALARS:
        columns.append(cas.agreed(name, c, *cas.stacked([x.scalar(c) for x in found]), text.COLUMNS[c]))
    given = {k: v for k, v in text.given(membrane).items() if k != "M"} | {
        "thickness": f"1 + {membrane.a:g}*cos(2*pi*Z/L)"
    }
    title = f"Cylinder of uneven thickness, {membrane.load}"
    return text.SERIES.table(name, title, SOURCE, given, columns, extra={"zones_at_the_end": found[-1].zones})


def radius_by_quadrature(membrane: UnevenTube) -> float:
    """The critical radius from an adaptive mean of stretches that are roots by Brent's method."""

    def stretch(force: float) -> float:
        return brentq(
            lambda l1: wri.relaxed_slope(l1, membrane.c2) - force, 1.0, 2 + force, xtol=1e-15, rtol=9e-16
        )

    def excess(force: float) -> float:
        half = membrane.L / 2  # the thickness is symmetric
        over = quad(lambda s: stretch(force / membrane.eta(s)), 0, half, epsabs=1e-13, epsrel=1e-13)[0]
        return over / half - membrane.delta

    top = 2.0 * wri.relaxed_slope(membrane.delta, membrane.c2)
    return stretch(brentq(excess, 1e-3, top, xtol=1e-15, rtol=9e-16) / membrane.thinnest) ** -0.5


def radii(name: str) -> Table:
    """Critical radii of the disks."""
    found = [UnevenTube(1.0, delta) for delta in RADII]
    a = np.array([wri.critical_radius(m) for m in found])
    b = np.array([radius_by_quadrature(m) for m in found])
    columns = [
        *text.SERIES.keys(delta=RADII),
        cas.agreed(name, "Af_critical", Pair(a, a), Pair(b, b), text.COLUMNS["Af_critical"]),
    ]
    method = (
        "Root N of mean lam1 = delta with eta W_r'(lam1) = N, then lam1^(-1/2) at the thinnest place: (a) "
        "the mean by Gauss-Legendre sums, lam1 by Newton's method; (b) adaptive integration, Brent's method."
    )
    given = {"c2": 0.01, "L": 8.0, "thickness": "1 + 0.4*cos(2*pi*Z/L)"}
    title = "Critical radius of the disks of a cylinder of uneven thickness"
    return text.SERIES.table(name, title, SOURCE, given, columns, method=method)


def by_both(heights: tuple[float, ...]) -> tuple[list[list[State]], list[list[Solution]]]:
    """Coarse and fine states of the disk with the pole at given depths, by collocation and by shooting."""
    s = np.linspace(0, DISK.L, CELLS + 1)
    grid = fd.newton(fd.Grid(DISK, s, -0.6 * (1 - s * s), EASY), EASY, 200)
    state = polished(from_grid(grid, RULES[0]), "load", EASY)
    first = float(state.y[0, 0, 1])
    known = {first: state}
    tracked, shot = [], []
    for height in sorted(heights, key=lambda h: abs(-h - first)):
        near = min(known, key=lambda z: abs(z + height))
        known[-height] = state = polished(known[near], "z_pole", -height)
        tracked.append((height, [state, polished(moved_to(state, RULES[1]), "z_pole", -height)]))
        shots = []
        for steps in STEPS:
            starts = starts_of(state, steps)
            starts[0] = state.y[0, 0, 2], state.y[0, 0, 1], 0.0, 0.0
            shots.append(solve(DISK, starts, state.load, "z_pole", -height, steps))
        shot.append((height, shots))
    return [x for _, x in sorted(tracked)], [x for _, x in sorted(shot)]


def of_state(state: State) -> tuple[float, ...]:
    """The disk's columns of a tracked state."""
    return state.load, float(state.y[0, 0, 2]), float(state.y[-1, -1, 2]), state.volume


def of_shot(found: Solution) -> tuple[float, ...]:
    """The disk's columns of a shot; the stretch at the clamp from the tension there."""
    end = np.real(found.shot.ends[-1, 0])
    force = np.hypot(end[2], end[3]) / DISK.eta(DISK.L)
    rim = brentq(lambda l1: _slope(l1) - force, 1.0, 50.0, xtol=1e-15, rtol=9e-16)
    return found.load, float(found.starts[0, 0]), rim, found.volume


def _slope(l1: float) -> float:
    """Derivative of the energy by the meridional stretch where the other one is 1, written out."""
    return 2 * (l1 - l1**-3) + 2 * DISK.c2 * (l1 - l1**-3)


def disk(name: str) -> Table:
    """Free inflation of the disk over the height of its pole."""
    tracked, shot = by_both(HEIGHTS)
    a = np.array([[of_state(x) for x in both] for both in tracked])
    b = np.array([[of_shot(x) for x in both] for both in shot])
    columns = text.SERIES.keys(t0=HEIGHTS)
    for i, (key, about) in enumerate(DISK_COLUMNS.items()):
        pairs = (Pair(x[:, 0, i], x[:, 1, i], 1e-12) for x in (a, b))
        columns.append(cas.agreed(name, key, *pairs, about))
    given = {"alpha": DISK.c2, "beta": 1.0, "thickness": f"1 + {DISK.a:g}*cos(pi*X)"}
    grid = (
        "(a) degree 16 on elements up to 0.1 and degree 18 up to 0.08 R_f long; (b) expansion up to 0.002 "
        "and 0.001, then 32 segments of 5 and 10 steps"
    )
    return text.SERIES.table(name, "Flat disk of uneven thickness", SOURCE, given, columns, grid=grid)


TABLES: dict[str, Builder] = {
    **{name: partial(tube, name, *given) for name, given in TUBES.items()},
    "uneven_tube_radii": partial(radii, "uneven_tube_radii"),
    "uneven_disk": partial(disk, "uneven_disk"),
}
