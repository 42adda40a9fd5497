"""Pictures of results: branches with special points and stability, or profiles of states. Needs matplotlib.

A part of a branch with negative eigenvalues (``n_negative`` above zero) is dashed. Special points have one
marker for each kind, and the end of a branch names what ends it.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

import numpy as np

from weakforms.errors import InputError, lacking, not_among
from weakforms.results.io import require_place_for
from weakforms.results.model import KINDS, Branch, Field
from weakforms.results.result import Result
from weakforms.results.wording import which_crossing

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SUFFIXES = (".png", ".svg", ".pdf")
"""Endings of the files that a picture can be written to."""

COLOURS = ("#0b62a4", "#c4500a", "#08805c", "#94478d", "#8a6a00", "#2b8fbf", "#5c5c61")
POLYGONS = (
    (4, 1, 0),
    (6, 1, 0),
    (8, 1, 0),
    "<",
    (3, 1, 0),
    (5, 0, 180),
    (7, 0, 0),
    (10, 1, 0),
    (12, 1, 0),
    (9, 0, 0),
    (5, 1, 36),
    (4, 0, 20),
    (3, 0, 60),
    (5, 0, 36),
    (6, 1, 30),
    *((sides, 1, 25) for sides in range(3, 17)),
    *((5, 0, 18), (8, 0, 0), (4, 1, 20), (3, 1, 55)),
)
MARKERS = dict(zip(KINDS, [*"os*DPXv^>dhpH8", *POLYGONS], strict=True))
"""Marker of each kind of special point, filled, because its edge is white."""

ASIDE = ("n_negative", "residual", "iterations", "Pi")
"""Columns that are not drawn unless they are asked for."""

SIZE = (6.4, 4.4)
"""Inches."""

WIDTH = 46
"""Characters of a line beside an axis."""


def require_picture_name(path: Path) -> None:
    """Make sure that the ending of a file name is one of the known formats, and that it can be written.

    Raises:
        InputError: If not.
    """
    if Path(path).suffix.lower() not in SUFFIXES:
        raise InputError(f"cannot draw into {path}: the name must end in {', '.join(SUFFIXES)}")
    require_place_for(Path(path))


def draw_results(results: Mapping[str, Result], x: str = "", y: str = "") -> Figure:
    """Draw one column over another for all branches of some results, or for the profiles of their states.

    Args:
        results: Results by name; the legend gives the parameters in which they differ, or else these names.
        x: Column of the abscissa; by default the first one that is not the control.
        y: Column of the ordinate; by default the control, or another one if the branch does not show it.

    Raises:
        InputError: If a column is missing in every branch and every profile, or there is nothing to draw.
        EnvironmentLackError: If matplotlib is missing.
    """
    figure, axes = empty_axes()
    results = _by_parameters(results)
    branches = {_label(k, b.name, len(r.branches)): (r, b) for k, r in results.items() for b in r.branches}
    first = next((branch for _, branch in branches.values()), None)
    if not (x and y) and first is None:
        raise InputError("there is no branch to draw; name two columns of a profile as x and y")
    if not (x and y):
        x, y = _chosen(first, x, y, next(iter(results.values())).scales)
    drawn = {k: pair for k, pair in branches.items() if {x, y} <= set(pair[1].columns)}
    if drawn:
        _draw_branches(axes, drawn, x, y)
    else:
        profiles = _profiles(results, x, y)
        if not profiles:
            raise InputError(_missing(results, x, y))
        for k, (label, field) in enumerate(profiles.items()):
            colour = COLOURS[k % len(COLOURS)]
            axes.plot(field.columns[x], field.columns[y], color=colour, label=_literal(label))
    scales = next(iter(results.values())).scales
    axes.set_xlabel(_literal(label_of(x, scales)))
    axes.set_ylabel(_literal(label_of(y, scales)))
    names = list(dict.fromkeys(result.problem for result in results.values()))
    axes.set_title(_literal(", ".join(names)), loc="left", fontsize="medium")
    if len(axes.get_legend_handles_labels()[0]):
        axes.legend(fontsize="small", frameon=False)
    return figure


def _chosen(branch: Branch, x: str, y: str, scales: Mapping[str, str]) -> tuple[str, str]:
    """The control over the first other column that varies along a branch, where no column is given.

    The first is that of the problem's list, which the scales follow: a branch has its loads before others.
    """
    varies = [n for n, v in branch.columns.items() if n not in ASIDE and np.ptp(np.nan_to_num(v)) > 0]
    rank = {name: k for k, name in enumerate(scales)}
    names = sorted(varies or branch.columns, key=lambda n: (n == branch.control, rank.get(n, len(rank))))
    x = x or next((name for name in names if name != y), names[0])
    y = y or next((name for name in reversed(names) if name != x), x)
    return x, y


def save(figure: Figure, path: Path) -> None:
    """Write a picture; the file appears under its name only when complete.

    Raises:
        InputError: If the name has another ending, or the file cannot be written.
    """
    path = Path(path)
    require_picture_name(path)
    try:
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as folder:
            written = Path(folder) / f"picture{path.suffix.lower()}"
            figure.savefig(written, dpi=200)
            os.replace(written, path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}") from error


def empty_axes() -> tuple[Figure, Axes]:
    """A figure and its axes with a grid.

    Raises:
        EnvironmentLackError: If matplotlib is missing.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError as error:
        raise lacking(error) or error from error
    figure = FigureCanvasAgg(Figure(figsize=SIZE, layout="constrained")).figure
    axes = figure.add_subplot()
    axes.grid(color="#e6e6e2", linewidth=0.5)
    axes.margins(y=0.07)
    axes.set_axisbelow(True)
    return figure, axes


def _draw_branches(axes: Axes, drawn: Mapping[str, tuple[Result, Branch]], x: str, y: str) -> None:
    kinds: dict[str, None] = {}
    ends: set[str] = set()
    for k, (label, (result, branch)) in enumerate(drawn.items()):
        colour = COLOURS[k % len(COLOURS)]
        for part, unstable in _parts(branch):
            style = "--" if unstable else "-"
            axes.plot(branch[x][part], branch[y][part], style, color=colour, linewidth=1.4)
        axes.plot([], [], color=colour, label=_literal(label or branch.name))
        for point in result.special_points:
            if point.branch == branch.name and {x, y} <= set(point.values):
                kinds[point.kind] = None
                place = point.values[x], point.values[y]
                axes.plot(
                    *place,
                    marker=MARKERS[point.kind],
                    ls="",
                    color=colour,
                    markersize=6,
                    markeredgecolor="white",
                )
        if branch.ended is not None and len(branch):
            place = float(branch[x][-1]), float(branch[y][-1])
            if _end_text(branch) not in ends:
                _annotate_end(axes, branch, x, y)
            ends.add(_end_text(branch))
            axes.plot(*place, "|", color=colour, markersize=9)
    for kind in kinds:
        axes.plot([], [], marker=MARKERS[kind], ls="", color="#5c5c61", label=kind.replace("_", " "))
    if any(unstable for _, branch in drawn.values() for _, unstable in _parts(branch)):
        axes.plot([], [], "--", color="#5c5c61", label="unstable (n_negative > 0)")


def _annotate_end(axes: Axes, branch: Branch, x: str, y: str) -> None:
    """Say beside the last point what ends a branch: above a branch that comes from below, else below it."""
    over, up = (float(branch[name][-1] - branch[name][max(len(branch) - 2, 0)]) for name in (x, y))
    place = float(branch[x][-1]), float(branch[y][-1])
    ha, va = "left" if over < 0 else "right", "bottom" if up > 0 else "top"
    offset = (4 if over < 0 else -4), (3 if up > 0 else -5)
    axes.annotate(
        _end_text(branch), place, offset, textcoords="offset points", ha=ha, va=va, fontsize="x-small"
    )


def _literal(text: str) -> str:
    """Text that matplotlib does not take for a formula, whatever a file holds."""
    return text.replace("$", r"\$")


def _by_parameters(results: Mapping[str, Result]) -> Mapping[str, Result]:
    """The results by the parameters in which they differ, if that tells all of them apart."""
    given = [result.parameters for result in results.values()]
    names = {name for one in given for name in one if any(one.get(name) != of.get(name) for of in given)}
    labels = [", ".join(f"{name} = {one.get(name)}" for name in one if name in names) for one in given]
    alike = len({result.problem for result in results.values()}) == 1
    if not alike or len(set(labels)) < max(len(labels), 2):
        return results
    return dict(zip(labels, results.values(), strict=True))


def _end_text(branch: Branch) -> str:
    end = branch.ended
    return _literal(str(end) if not end.reason else end.by)


def _parts(branch: Branch) -> Sequence[tuple[slice, bool]]:
    """Parts of a branch with stable or unstable states; neighbours share a point."""
    negative = np.asarray(branch.columns.get("n_negative", np.zeros(len(branch)))) > 0
    cuts = [0, *(np.flatnonzero(negative[1:] != negative[:-1]) + 1), len(negative)]
    parts = [(a, b) for a, b in pairwise(cuts) if a < b]
    return [(slice(max(a - 1, 0), b), bool(negative[a])) for a, b in parts]


def _profiles(results: Mapping[str, Result], x: str, y: str) -> dict[str, Field]:
    """Fields of the states that have both columns, by what the legend says."""
    out = {}
    for key, result in results.items():
        for state in result.states:
            at = ", ".join(f"{name} = {value:.6g}" for name, value in state.at.items())
            for field in state.fields:
                if {x, y} <= set(field.columns):
                    out[f"{key + ': ' if key else ''}{at}{which_crossing(state)}"] = field
    return out


def _missing(results: Mapping[str, Result], x: str, y: str) -> str:
    """What to say if no branch and no profile has both columns."""
    known: dict[str, None] = {}
    for result in results.values():
        for table in (*result.branches, *(field for state in result.states for field in state.fields)):
            known |= dict.fromkeys(table.columns)
    for name in (x, y):
        if name not in known:
            return f"there is no column {name!r}{not_among(name, known, 'there are')}"
    return f"no branch and no profile has both columns {x} and {y}"


def _label(key: str, branch: str, count: int) -> str:
    return f"{key}: {branch}" if key and count > 1 else key or branch


def label_of(name: str, scales: Mapping[str, str]) -> str:
    """Label of an axis: a column and its meaning, in lines of similar length."""
    if name not in scales:
        return name
    text = f"{name}:  {scales[name]}"
    count = len(wrap(text, WIDTH, break_on_hyphens=False))
    widths = range(len(text) // max(count, 1), WIDTH + 1)
    tried = (wrap(text, max(width, 1), break_on_hyphens=False) for width in widths)
    return "\n".join(next(lines for lines in tried if len(lines) <= count))
