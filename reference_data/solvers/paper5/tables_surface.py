"""Table of paper 5: unstable ranges of polyhedra (section 3.2), and effective wave numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Table, agreed, prescribed
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper5 import bloch as blo
from reference_data.solvers.paper5 import bloch_metric as met
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.bloch import Polyhedron, Ring
from reference_data.solvers.paper5.waves.cylinder import FLUID
from reference_data.solvers.registry import Builder

CONVENTIONS: dict[int, dict[str, object]] = {
    1: {},
    2: {"rule": "centroid"},
    3: {"rule": "inside"},
    4: {"potential": "volume"},
    5: {"flipped": True},
    6: {"arc": True},
    7: {"rule": "nodes"},
}
NAMES = (
    "1: edge midpoints, Phi times projected area; 2: one point (centroid); 3: three inside points; "
    "4: edge midpoints, p (x N_x + y N_y)/2 in place of Phi; 5: as 1, the other diagonal; 6: as 1, unloaded "
    "triangles in the unrolled cylinder (arcs) in place of chords; 7: the three nodes"
)
ROWS = ((120, 48, 1), (80, 96, 1), (60, 48, 1), (40, 96, 1), (240, 48, 1), (160, 96, 1),
        *((120, 48, k) for k in range(2, 8)), *((80, 96, k) for k in range(2, 8)))  # fmt: skip
# ranges of the search for both ends, by N_C
WINDOWS = {48: ((5.0, 5.3), (6.6, 7.1)), 96: ((3.9, 4.2), (9.0, 11.0))}
SCAN = 0.02
WIDTH = 1e-9
LEVEL = 1e-8  # of an end: above its bracket and what Newton's method leaves
STEEPEST = 15  # wave numbers a level, above the largest rate of the effective ones at any end
RATE = 1e-4  # step of the wave number for the slope of an eigenvalue
BRACKET = 1e-3  # to either side of an end, where the second method begins


@cache
def smooth(level: float) -> np.ndarray:
    """Nodes of the rings of a fine mesh at the end of a range, as a first state."""
    return blo.from_profile(Polyhedron(FLUID, 480, 48), level)


def state(mesh: Polyhedron, level: float, near: Ring | None) -> Ring:
    """The equilibrium at a level."""
    if near is not None:
        return blo.newton(mesh, near.nodes, level)
    return blo.newton(mesh, smooth(level)[:: 480 // mesh.rings], level)


def end(mesh: Polyhedron, window: tuple[float, float], lower: bool) -> tuple[float, int]:
    """First (lower) or last unstable level of a window, and the wave number unstable there."""
    levels = np.arange(window[0], window[1] + SCAN / 2, SCAN)
    if not lower:
        levels = levels[::-1]
    ring = None
    for k in range(len(levels)):
        ring = state(mesh, float(levels[k]), ring)
        if ring.unstable():
            break
    else:
        raise RuntimeError(f"polyhedron {mesh}: no unstable level in {window}")
    if k == 0:
        raise RuntimeError(f"polyhedron {mesh}: unstable already at {levels[0]:g}")
    off, on = float(levels[k - 1]), float(levels[k])
    while abs(on - off) > WIDTH:
        middle = (on + off) / 2
        ring = state(mesh, middle, ring)
        on, off = (middle, off) if ring.unstable() else (on, middle)
    left = state(mesh, on, ring).unstable()
    return (on + off) / 2, left[len(left) // 2]


def gaps(mesh: Polyhedron, lower: float, upper: float) -> list[float]:
    """Stable levels of a scan between the ends."""
    ring, out = None, []
    for level in np.arange(round(lower + 0.05, 1), upper, 0.05):
        ring = state(mesh, float(level), ring)
        if not ring.unstable():
            out.append(round(float(level), 2))
    return out


def again(mesh: Polyhedron, found: float, lower: bool) -> tuple[float, int]:
    """The end and its wave number by the second method, from a bracket about the first one's."""
    sector, side = met.Sector(mesh), -BRACKET if lower else BRACKET
    start = state(mesh, found, None).nodes
    return met.change(sector, start, found + side, found - side, WIDTH)


def effective(level: float, low: float, high: float) -> tuple[Pair, Pair]:
    """Real wave number whose lowest eigenvalue vanishes at a level, in the continuum, by both methods."""
    spectrum = rel.cylinder(FLUID, level)
    first = spectrum.forms[1].first
    n = float(brentq(first, low, high, xtol=1e-11))
    slope = (first(n + RATE) - first(n - RATE)) / (2 * RATE)
    floor = rel.ROUNDING / abs(slope) + STEEPEST * LEVEL
    a, b = (
        Pair(*(n - float(x[0]) / slope for x in (p.coarse, p.fine)), floor) for p in spectrum.lowest(n, 1)
    )
    return a, b


@dataclass
class Ends:
    """An end of every row by one method."""

    value: np.ndarray

    @property
    def uncertainty(self) -> np.ndarray:
        """That of each."""
        return np.full(self.value.shape, LEVEL)


def surface_ranges(name: str) -> Table:
    """The ranges of several meshes and conventions of the load."""
    rows, second, real, stable = [], [], [], []
    for n_s, n_c, code in ROWS:
        mesh = replace(Polyhedron(FLUID, n_s, n_c), **CONVENTIONS[code])
        (lower, n_lower), (upper, n_upper) = (end(mesh, w, k == 0) for k, w in enumerate(WINDOWS[n_c]))
        if code == 1:
            found = gaps(mesh, lower, upper)
            stable.append(f"{n_s} x {n_c}: " + (", ".join(f"{x:g}" for x in found) or "none"))
        reach = (5.0, 9.0) if n_c == 48 else (10.0, 18.0)
        (low, n_low), (up, n_up) = (again(mesh, x, k == 0) for k, x in enumerate((lower, upper)))
        if (n_low, n_up) != (n_lower, n_upper):
            raise RuntimeError(f"{mesh}: wave numbers {n_lower}, {n_upper} and by the metric {n_low}, {n_up}")
        real.append([effective(x, *reach) for x in (lower, upper)])
        rows.append((n_s, n_c, code, lower, upper, n_lower, n_upper))
        second.append((low, up))
    data, other = np.array(rows, dtype=float), np.array(second)
    about = {
        "N_S": ("1", "quadrilaterals along the meridian"),
        "N_C": ("1", "quadrilaterals around"),
        "rule": ("1", NAMES),
        "lower": ("1/Ao", "lowest unstable level"),
        "upper": ("1/Ao", "highest unstable level"),
        "n_lower": ("1", "wave number unstable at the lower end (the middle one if several)"),
        "n_upper": ("1", "wave number unstable at the upper end (the middle one if several)"),
        "n_eff_lower": ("1", "real wave number of the continuum that turns unstable at the lower end"),
        "n_eff_upper": ("1", "real wave number of the continuum that turns stable at the upper end"),
    }
    columns = []
    for i, (key, what) in enumerate(about.items()):
        if key in ("lower", "upper"):
            pair = Ends(other[:, int(key == "upper")]), Ends(data[:, i])
            columns.append(agreed(name, key, *pair, what, other="metric", written="stretches"))
        elif key.startswith("n_eff"):
            pairs = cas.stacked([row[int(key == "n_eff_upper")] for row in real])
            columns.append(cas.agreed(name, key, *pairs, what))
        else:
            columns.append(prescribed(key, data[:, i], what))
    return text.SERIES.table(
        name,
        "Levels between which a polyhedral cylinder is unstable",
        "section 3.2: 5.14 to 6.81 for 120 x 48, 4.03 to 9.81 for 80 x 96",
        text.cylinder("fluid"),
        columns,
        method=(
            "Constant-strain triangles reduced by rotation symmetry, in two codes that share the "
            "description of the mesh: (a) principal stretches by singular values, load by a rule of "
            "quadrature, complex steps, positive definite or not by Cholesky's factors, for every n "
            f"= 0..N_C/2; a scan in steps of {SCAN:g} from outside, then bisection; (b) invariants of "
            "the metric, load in closed form where all of a triangle is wet and the rule exact, "
            "second derivatives written out, lowest eigenvalue of band matrices; bisection from a "
            f"bracket of {BRACKET:g} to either side. A test holds the matrices against the whole "
            "mesh's. The effective wave numbers are those of the other tables' second variation at "
            "real n, by both of their methods."
        ),
        grid="as given by N_S and N_C",
        tolerance=f"bisection to {WIDTH:g}; Newton takes one more step after the first one below 1e-9",
        notes=(
            "The levels are exact for the mesh and the convention; the spread over conventions shows how "
            "much they mean. Nothing is fitted to the printed ends. With N_C = 96 the upper end comes when "
            "a ring of triangles turns taut, many n at once, and so depends on N_S; the others hardly do."
        ),
        extra={"keys": ["N_S", "N_C", "rule"], "stable_levels_between": stable},
    )


TABLES: dict[str, Builder] = {"surface_ranges": lambda: surface_ranges("surface_ranges")}
