"""Pictures of diagrams: lines of critical points, and numbers of negative eigenvalues between them.

At each value of the parameter the states of the primary branch lie between the points at which it crosses
the lines of limit points, of mirror breaking and of neutral waves around the axis. At each of these points
one eigenvalue changes sign. So the number of negative eigenvalues of every state follows from the lines
alone. Needs matplotlib.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from weakforms.errors import InputError
from weakforms.results.plot import COLOURS, MARKERS, draw_results, empty_axes, label_of
from weakforms.results.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LOOKS = {
    "fold": ("-", COLOURS[0]),
    "mirror": ("-", COLOURS[1]),
    "localisation": ("-", COLOURS[2]),
    "n1": ("-", COLOURS[4]),
    "n2": ("-", COLOURS[5]),
    "n3": ((0, (6, 1)), COLOURS[1]),
    "wrinkling": ("--", COLOURS[2]),
    "contact": (":", COLOURS[3]),
    "end": ("-.", "#5c5c61"),
}
"""Line style and colour of each kind of line."""

FAINT = 0.35
"""Opacity of the parts of lines on which the membrane would be wrinkled."""

COUNTED = {"fold": "n_negative", "mirror": "n_mirror", "localisation": "n_localisation"} | {
    f"n{n}": f"n_negative_n{n}" for n in (1, 2, 3)
}
"""Kinds at which an eigenvalue changes sign, and the column with the number of the other negative ones."""

DEPTHS = ("u_max", "t0", "lam", "lam2", "V")
"""Columns of largest displacement, the first of which that a membrane has is its own; ``V`` of a liquid."""

COLUMNS, ROWS = 121, 161
"""Number of places at which regions are told apart, along both axes."""

PALE = ("#ffffff", "#e7f0f7", "#fbeee4", "#e6f3ee", "#f4ebf3", "#f4f0e0", "#e6f3f8", "#eeeeef")
"""Colours of regions."""

TALL = 0.015
"""Least height of a region with a label, as a part of the axis."""


@dataclass(frozen=True)
class Crossing:
    """A point at which the primary branch crosses a line, at one value of the parameter."""

    kind: str
    depth: float
    load: float
    others: int
    """Negative eigenvalues of its class besides the critical one."""


def draw(results: Mapping[str, Result], x: str = "", y: str = "") -> Figure:
    """Draw results as :func:`draw_results` does, but a single diagram in its own plane, as its verb draws it.

    Raises:
        InputError: If there is nothing to draw, or a column is missing.
        EnvironmentLackError: If matplotlib is missing.
    """
    first = next(iter(results.values()))
    if len(results) > 1 or x or y or first.problem != "diagram" or not first.branches:
        return draw_results(results, x, y)
    plane = (first.parameters.get("x"), first.parameters.get("y"))
    known = set.intersection(*(set(branch.columns) for branch in first.branches))
    return draw_diagram(first, *plane) if set(plane) <= known else draw_results(results)


def draw_diagram(result: Result, x: str, y: str) -> Figure:
    """Draw the lines of a diagram, its points of codimension two, and its regions.

    A region's label gives the numbers of negative eigenvalues of its states at given load, those of all
    kinds of lines in the diagram together, in the order in which the primary branch meets them; waves around
    the axis count once. Parts of lines on which the membrane would be wrinkled are faint.

    Args:
        result: A result of the problem ``diagram``.
        x: Column of the abscissa.
        y: Column of the ordinate.

    Raises:
        InputError: If there is no line to draw.
        EnvironmentLackError: If matplotlib is missing.
    """
    if not result.branches:
        raise InputError("there is no line to draw")
    figure, axes = empty_axes()
    for branch in result.branches:
        kind = kind_of(branch.name)
        style, colour = LOOKS[kind]
        style = {"linestyle": style, "color": colour, "linewidth": 1.4}
        wrinkled = branch.columns.get("wrinkled", np.zeros(len(branch))) > 0
        taut = np.ma.array(branch[y], mask=wrinkled & np.roll(wrinkled, 1) & np.roll(wrinkled, -1))
        axes.plot(branch[x], branch[y], alpha=FAINT if wrinkled.any() else 1.0, **style)
        axes.plot(branch[x], taut, label=kind if branch.name == kind else None, **style)
    seen: set[str] = set()
    for point in result.special_points:
        kind = point.kind.replace("_", " ")
        style = {"color": "#1c1c1e", "markersize": 7, "markeredgecolor": "white", "linestyle": ""}
        place = [point.values[x]], [point.values[y]]
        axes.plot(*place, marker=MARKERS[point.kind], label=None if kind in seen else kind, **style)
        seen.add(kind)
    if x != load_of(result) == y:
        _draw_regions(axes, result, x)
    axes.set_xlabel(label_of(x, result.scales))
    axes.set_ylabel(label_of(y, result.scales))
    axes.set_title("diagram: " + str(result.parameters["body"]), loc="left", fontsize="medium")
    axes.legend(fontsize="x-small", frameon=False)
    return figure


def kind_of(name: str) -> str:
    """The kind of a line by its name, such as ``fold_2``."""
    return name.partition("_")[0]


def crossings_at(result: Result, vary: str, value: float) -> list[Crossing]:
    """Where the primary branch at a value of the parameter crosses lines, in its order."""
    depth, load = depth_of(result), load_of(result)
    found = []
    for branch in result.branches:
        kind = kind_of(branch.name)
        if kind not in (*COUNTED, "end"):
            continue
        over = branch[vary] - value
        for i in np.flatnonzero((over[:-1] * over[1:] < 0) | ((over[:-1] == 0) & (over[1:] != 0))):
            share = over[i] / (over[i] - over[i + 1])
            at = {n: float(branch[n][i] + share * (branch[n][i + 1] - branch[n][i])) for n in (depth, load)}
            counts = branch[COUNTED[kind]] if kind in COUNTED else np.zeros(len(branch))
            found.append(Crossing(kind, at[depth], at[load], int(counts[i])))
    return sorted(found, key=lambda crossing: crossing.depth)


def depth_of(result: Result) -> str:
    """The column with the largest displacement, which increases along the primary branch."""
    return next(name for name in DEPTHS if name in result.branches[0].columns)


def load_of(result: Result) -> str:
    """The column with the load: the level of a liquid, or the pressure of a gas."""
    return "zw" if "zw" in result.branches[0].columns else "p"


def states_between(crossings: list[Crossing], low: float) -> list[tuple[float, float, int]]:
    """The parts of the primary branch between crossings: loads at both ends, and negative eigenvalues.

    Args:
        crossings: In the order of the branch, of which the last is its end.
        low: Load at which the branch begins, with a stable state.

    Returns:
        Nothing if the counts of two neighbouring crossings contradict each other, which means that a line is
        missing, or if the end is not known.
    """
    counts = dict.fromkeys(COUNTED, 0)
    parts, load = [], low
    for crossing in crossings:
        parts.append((load, crossing.load, sum(counts.values())))
        load = crossing.load
        if crossing.kind == "end":
            return parts
        change = crossing.others - counts[crossing.kind]
        if change not in (0, -1):
            return []
        counts[crossing.kind] += 1 if change == 0 else -1
    return []


def _draw_regions(axes: Axes, result: Result, x: str) -> None:
    """Colour the regions, and write the numbers of negative eigenvalues of their states."""
    low, high = (float(result.parameters[name]) for name in ("low", "high"))
    bottom, top = axes.get_ylim()
    xs = np.linspace(low, high, COLUMNS + 2)[1:-1]
    loads = np.linspace(bottom, top, ROWS + 2)[1:-1]
    start = min(bottom, float(result.parameters[f"{load_of(result)}_low"]))
    labels = np.full((ROWS, COLUMNS), "", dtype=object)
    for k, value in enumerate(xs):
        parts = states_between(crossings_at(result, x, float(value)), start)
        for i, load in enumerate(loads):
            labels[i, k] = ", ".join(str(n) for a, b, n in parts if min(a, b) < load < max(a, b))
    names = sorted(set(labels.ravel()), key=lambda text: (len(text), text))
    shown = np.vectorize(names.index)(labels)
    for k in range(len(names)):  # an outline each, because a picture of so many cells would be large
        axes.contourf(xs, loads, shown == k, levels=[0.5, 1.5], colors=[PALE[k % len(PALE)]], zorder=0)
    for k, name in enumerate(names):
        if name:
            _write(axes, shown == k, name, xs, loads)


def _write(axes: Axes, inside: np.ndarray, text: str, xs: np.ndarray, loads: np.ndarray) -> None:
    """Write a label where its region is tallest, once for each range of the parameter in which it exists."""
    heights = np.zeros(inside.shape[1], dtype=int)
    middles = np.zeros(inside.shape[1], dtype=int)
    for k in range(inside.shape[1]):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], inside[:, k].astype(int), [0]])))
        for a, b in zip(edges[::2], edges[1::2], strict=True):
            if b - a > heights[k]:
                heights[k], middles[k] = b - a, (a + b) // 2
    edges = np.flatnonzero(np.diff(np.concatenate([[0], (heights > 0).astype(int), [0]])))
    for a, b in zip(edges[::2], edges[1::2], strict=True):
        tall = np.flatnonzero(heights[a:b] >= 0.9 * heights[a:b].max()) + a
        k = int(tall[len(tall) // 2])
        if heights[k] >= TALL * len(loads):
            style = {"ha": "center", "va": "center", "fontsize": "small", "color": "#3a3a3d"}
            axes.text(xs[k], loads[middles[k]], text, **style)
