"""Table of paper 5: unstable ranges of polyhedra (section 3.2), and effective wave numbers."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Column, Table, prescribed
from reference_data.solvers.paper5 import bloch as blo
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


@cache
def effective(level: float, low: float, high: float) -> float:
    """Real wave number whose lowest eigenvalue vanishes at a level, in the continuum."""
    form = rel.cylinder(FLUID, level).forms[0]
    return float(brentq(form.first, low, high, xtol=1e-8))


def surface_ranges(name: str) -> Table:
    """The ranges of several meshes and conventions of the load."""
    rows, stable = [], []
    for n_s, n_c, code in ROWS:
        mesh = replace(Polyhedron(FLUID, n_s, n_c), **CONVENTIONS[code])
        (lower, n_lower), (upper, n_upper) = (end(mesh, w, k == 0) for k, w in enumerate(WINDOWS[n_c]))
        if code == 1:
            found = gaps(mesh, lower, upper)
            stable.append(f"{n_s} x {n_c}: " + (", ".join(f"{x:g}" for x in found) or "none"))
        reach = (5.0, 9.0) if n_c == 48 else (10.0, 18.0)
        real = effective(round(lower, 6), *reach), effective(round(upper, 6), *reach)
        rows.append((n_s, n_c, code, lower, upper, n_lower, n_upper, *real))
    data = np.array(rows, dtype=float)
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
            columns.append(Column(key, data[:, i], 1e-8, *what))
        elif key.startswith("n_eff"):
            columns.append(Column(key, data[:, i], 1e-5, *what))
        else:
            columns.append(prescribed(key, data[:, i], what))
    return text.make(
        name,
        "Levels between which a polyhedral cylinder is unstable",
        "section 3.2: 5.14 to 6.81 for 120 x 48, 4.03 to 9.81 for 80 x 96",
        text.cylinder("fluid"),
        columns,
        method=(
            "Constant-strain triangles, rotation-symmetric equilibrium by Newton's method, Hermitian tangent "
            "of every n = 0..N_C/2, positive definite or not by Cholesky's factors; a scan in steps of "
            f"{SCAN:g} from outside, then bisection. A test holds the reduced matrices against the whole "
            "mesh's, whose element is coded anew from the invariants with derivatives by complex step. "
            "The effective wave numbers are those of the other tables' second variation at real n."
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
