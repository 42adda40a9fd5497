"""Legends of figures: what each line and mark means, in rows under the first axes."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import rcParams
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text

from weakforms.verification.judging.outcome import PanelOutcome
from weakforms.verification.report.figures.canvas import (
    DASHED,
    DOTTED,
    INK,
    KINDS,
    MUTED,
    Pen,
    as_math,
    new_ruler,
)
from weakforms.verification.report.look import LEFT, LOOK
from weakforms.verification.report.wording import kind_of_point

POINTS = LOOK["points"]
"""Markers of special points."""

FAILED = {"marker": "o", "ms": 11, "mew": 1.8, "mfc": "none", "color": INK, "ls": ""}
"""Ring around a row at which a check fails."""


def key(label: str, index: int | None, **style: Any) -> Line2D:
    """A legend entry of a curve, or of a meaning that no curve has (``None``)."""
    colour, marker = (MUTED, "") if index is None else KINDS[index % len(KINDS)]
    usual = {"color": colour, "marker": marker, "mfc": "none", "label": label}
    return Line2D([], [], **usual | style)


def panel_keys(panel: PanelOutcome, failed: bool = False) -> list[list[Line2D]]:
    """Legend entries: the curves, and below them the meaning of lines and marks.

    Args:
        panel: What is drawn.
        failed: Whether rows at which a check fails are marked.
    """
    curves = panel.curves
    named = [key(as_math(curve.label or curve.name), i) for i, curve in enumerate(curves)]
    if any(any(curve.unstable) for curve in curves):
        keys = [key(panel.full, None), key(panel.dashed, None, ls=DASHED)]
        keys += [key(panel.dotted, None, ls=DOTTED)] * bool(panel.dotted)
    else:
        keys = [key(as_math(panel.drawn), None)] * bool(curves)
    keys += [key("path of a material point", None, ls=":")] * bool(panel.paths)
    for kind in sorted({c.reference_kind for c in curves if c.reference_x}):
        keys.append(key(as_math(f"reference ({kind})".replace(" ()", "")), None, marker="o", ls=""))
    for kind in sorted({point.kind for point in panel.markers}):
        style = {"marker": POINTS.get(kind, "d"), "mfc": INK, "color": INK, "ls": ""}
        keys.append(key(as_math(kind_of_point(kind)), None, **style))
    keys += [key("a check fails here", None, **FAILED)] * failed
    return [named, keys]


def with_legend(groups: list[list[Line2D]], width: float, above: float, below: float) -> tuple[Figure, float]:
    """A figure with its legend under the first axes, and the height of the legend."""
    figure = FigureCanvasSVG(Figure(figsize=(width, above + below))).figure
    ruler = new_ruler(figure)
    keyed, legends = 0.0, []
    for keys in filter(None, groups):
        wide = [_key_width(figure, key, ruler) for key in keys]
        columns = min(6, len(keys))
        while columns > 1 and _legend_width(wide, columns) > figure.dpi * (width - LEFT):
            columns -= 1
        legend = figure.legend(handles=_by_rows(keys, columns), ncols=columns, loc="upper left")
        legends.append((legend, above + keyed))
        keyed += legend.get_window_extent(ruler).height / figure.dpi + 0.03
    total = 0.06 + above + keyed + below + 0.06 * bool(legends)
    figure.set_size_inches(width, total)
    for legend, top in legends:
        legend.set_bbox_to_anchor((LEFT / width, 1 - (top + 0.08) / total), figure.transFigure)
    return figure, total - above - below - 0.06


def _key_width(figure: Figure, key: Line2D, ruler: Pen) -> float:
    """Width of a legend entry: its line, its text and their distance, in points."""
    text = Text(text=key.get_label(), size=rcParams["legend.fontsize"])
    text.set_figure(figure)
    line = rcParams["legend.handlelength"] + rcParams["legend.handletextpad"]
    return text.get_window_extent(ruler).width + line * text.get_size()


def _by_rows(entries: list[Any], columns: int) -> list[Any]:
    """The entries in the order in which a legend, filled by columns, shows them by rows."""
    return [entry for column in range(columns) for entry in entries[column::columns]]


def _legend_width(entries: list[float], columns: int) -> float:
    """Width of a legend whose entries have these widths."""
    widest = [max(column) for column in np.array_split(_by_rows(entries, columns), columns)]
    return sum(widest) + (columns - 1) * rcParams["legend.columnspacing"] * rcParams["legend.fontsize"]
