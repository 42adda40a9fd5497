"""Figures of the report as SVG: panels on the thesis's axes with residuals, and convergence plots.

Text is drawn as paths, so that it looks the same everywhere. Colours are CSS variables with light colours as
default.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from io import BytesIO, StringIO
from itertools import pairwise
from typing import Any

import matplotlib.style
import numpy as np
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG, RendererSVG
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.mathtext import MathTextParser
from matplotlib.text import Text
from matplotlib.textpath import TextToPath
from matplotlib.ticker import FixedLocator, LogLocator, NullLocator
from matplotlib.transforms import Bbox

from weakforms.verification.judging.outcome import Convergence, CurveOutcome, PanelOutcome, Verdict
from weakforms.verification.report.junit import clean
from weakforms.verification.report.look import HEIGHT, LEFT, LOOK, RIGHT, WIDTH
from weakforms.verification.report.summary import describe, describe_histories, of_curve
from weakforms.verification.report.svg import inline_svg
from weakforms.verification.report.wording import plain_tex, typeset

INK, MUTED = LOOK["light"]["ink"], LOOK["light"]["muted"]
POINTS, MARKERS = LOOK["points"], LOOK["markers"]
PALETTE = [colour for name, colour in LOOK["light"].items() if name[1:].isdigit()]
KINDS = list(zip(PALETTE * len(MARKERS), MARKERS * len(PALETTE), strict=True))
"""Colours and markers of curves, so that colour alone never carries information."""
NARROW, FOOT = 4.2, 0.5
"""Width of a narrower figure, and room below axes, in inches."""
SHOWN = 22
"""Largest number of reference markers on a curve, which is compared at every row of its table."""
ERRORS = 40
"""Largest number of errors drawn for a curve: of several rows beside each other the worst one."""
SIDES = ((1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1), (0, -1))
DASHED, DOTTED, ASKED = (0, (4, 2)), (0, (1, 1.5)), (0, (6, 2, 1, 2))


@dataclass(frozen=True)
class Picture:
    """A drawing for a page, and the same for print."""

    svg: str
    """An ``<svg>`` element."""
    pdf: bytes = b""
    """A file, if it was asked for."""


def panel_figure(panel: PanelOutcome, ident: str, verdicts: Sequence[Verdict] = ()) -> str:
    """One panel as an ``<svg>`` element; the arguments are those of :func:`panel_picture`."""
    return panel_picture(panel, ident, verdicts, printed=False).svg


def panel_picture(
    panel: PanelOutcome, ident: str, verdicts: Sequence[Verdict] = (), printed: bool = True
) -> Picture:
    """One panel on the printed axes, with the residuals of its curves below, if there are any.

    Args:
        panel: Curves, references and special points.
        ident: Identifier of the figure on its page.
        verdicts: Checks of the case; those on the panel's references give the asked accuracy.
        printed: Whether a PDF is wanted too.
    """
    residuals = any(len(curve.residual) for curve in panel.curves)
    lower = 1.97 if residuals else 0.0
    with drawing(ident):
        figure, keyed = _with_legend(_panel_keys(panel), WIDTH, HEIGHT + FOOT, lower)
        place = (lower + keyed + FOOT, HEIGHT)
        axes = _axes(figure, *place, as_math(panel.x_label), as_math(panel.y_label))
        for limits, setter in ((panel.x_range, axes.set_xlim), (panel.y_range, axes.set_ylim)):
            if all(map(math.isfinite, limits)) and limits[0] != limits[1]:
                setter(*limits)
        for index, curve in enumerate(panel.curves):
            _draw_curve(axes, curve, index)
        if panel.level is not None:
            axes.axhline(panel.level, color=MUTED, lw=0.9, ls=DASHED, zorder=0)
        for path in panel.paths:
            axes.plot(path.x, path.y, ls=":", lw=0.9, color=MUTED, zorder=1)
        _draw_points(axes, panel)
        if residuals:
            _draw_residuals(_axes(figure, FOOT, 1.12), panel, verdicts)
        title = plain_tex(panel.title or panel.name)
        shown = svg(figure, ident, title, describe(panel, verdicts))
        return Picture(shown, _pdf(figure, title) if printed else b"")


def convergence_figure(records: Sequence[Convergence], ident: str) -> str:
    """Errors of one quantity against the number of cells, with observed and expected slopes.

    Args:
        records: Refinement histories of the same quantity, usually one for each degree.
        ident: Identifier of the figure on its page.

    Returns:
        An ``<svg>`` element.
    """
    keys = [_key(f"P{r.degree}", i, ls="") for i, r in enumerate(records)]
    lines = [_key("observed order", None), _key("expected order", None, ls=":")]
    with drawing(ident):
        figure, keyed = _with_legend([keys, lines], NARROW, 2.4 + FOOT, 0)
        axes = _axes(figure, keyed + FOOT, 2.4, "cells", "relative error")
        axes.set(xscale="log", yscale="log")
        floor = _floor(error for record in records for error in record.errors)
        for index, record in enumerate(records):
            _draw_history(axes, record, index, floor)
        cells = sorted({cell for record in records for cell in record.cells})
        if 0 < len(cells) <= 8:
            axes.xaxis.set(major_locator=FixedLocator(cells), minor_locator=NullLocator())
            axes.xaxis.set_major_formatter("{x:.0f}")
        axes.yaxis.set(minor_locator=NullLocator())
        quantity = plain_tex(records[0].quantity) if records else "nothing"
        return svg(figure, ident, f"Convergence of {quantity}", describe_histories(records))


LETTERS = TextToPath()
"""Sets every text and formula once; each renderer of matplotlib would begin with nothing."""


class Pen(RendererSVG):
    """Draws or measures a figure of 72 dots an inch."""

    def __init__(self, width: float, height: float, stream: StringIO) -> None:
        super().__init__(width, height, stream)
        self._text2path = LETTERS


@contextmanager
def drawing(ident: str) -> Iterator[None]:
    """Context with the style of the report, without warnings about missing glyphs."""
    style = ["default", LOOK["style"] | {"svg.hashsalt": ident}]
    with matplotlib.style.context(style), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def svg(figure: Figure, ident: str, title: str, description: str) -> str:
    """The figure as an ``<svg>`` element with a title, a description and the colours of the page."""
    buffer = StringIO()
    for part in (figure, *figure.axes):
        part.patch.set(facecolor="none", edgecolor="none")
    pen = Pen(*figure.bbox.size, buffer)
    figure.draw(pen)
    pen.finalize()
    colours = {value: f"--f-{name}" for name, value in LOOK["light"].items()}
    return inline_svg(buffer.getvalue(), ident, title, description, colours)


def _pdf(figure: Figure, title: str) -> bytes:
    """The figure as a file for papers, the same at every run."""
    buffer = BytesIO()
    facts = {"CreationDate": None, "Title": clean(title)}
    figure.savefig(buffer, format="pdf", transparent=True, metadata=facts)
    return buffer.getvalue()


@cache
def as_math(text: str) -> str:
    """Text for a figure: TeX between dollars if matplotlib can set it, else the plain text."""
    text = typeset(" ".join(clean(text).split()))
    try:
        MathTextParser("path").parse(text)
    except (ValueError, RuntimeError):
        text = text.replace("$", r"\$")
    return text if len(text) <= 80 else plain_tex(text)[:60].replace("$", r"\$") + "…"


def _key(label: str, index: int | None, **style: Any) -> Line2D:
    colour, marker = (MUTED, "") if index is None else KINDS[index % len(KINDS)]
    usual = {"color": colour, "marker": marker, "mfc": "none", "label": label}
    return Line2D([], [], **usual | style)


def _panel_keys(panel: PanelOutcome) -> list[list[Line2D]]:
    """Legend entries: the curves, and below them the meaning of lines and marks."""
    curves = panel.curves
    named = [_key(as_math(curve.label or curve.name), i) for i, curve in enumerate(curves)]
    if any(any(curve.unstable) for curve in curves):
        keys = [_key(panel.full, None), _key(panel.dashed, None, ls=DASHED)]
        keys += [_key(panel.dotted, None, ls=DOTTED)] * bool(panel.dotted)
    else:
        keys = [_key(as_math(panel.drawn), None)] * bool(curves)
    keys += [_key("path of a material point", None, ls=":")] * bool(panel.paths)
    for kind in sorted({c.reference_kind for c in curves if c.reference_x}):
        keys.append(_key(as_math(f"reference ({kind})".replace(" ()", "")), None, marker="o", ls=""))
    for kind in sorted({point.kind for point in panel.markers}):
        style = {"marker": POINTS.get(kind, "d"), "mfc": INK, "color": INK, "ls": ""}
        keys.append(_key(as_math(kind.replace("_", " ")), None, **style))
    return [named, keys]


def _with_legend(
    groups: list[list[Line2D]], width: float, above: float, below: float
) -> tuple[Figure, float]:
    """A figure with its legend under the first axes, and the height of the legend."""
    figure = FigureCanvasSVG(Figure(figsize=(width, above + below))).figure
    ruler = _ruler(figure)
    keyed, legends = 0.0, []
    for keys in filter(None, groups):
        wide = [_key_width(figure, key, ruler) for key in keys]
        columns = min(6, len(keys))
        while columns > 1 and _legend_width(wide, columns) > figure.dpi * (width - LEFT + 0.05):
            columns -= 1
        legend = figure.legend(handles=_by_rows(keys, columns), ncols=columns, loc="upper left")
        legends.append((legend, above + keyed))
        keyed += legend.get_window_extent(ruler).height / figure.dpi + 0.03
    total = 0.06 + above + keyed + below + 0.06 * bool(legends)
    figure.set_size_inches(width, total)
    for legend, top in legends:
        legend.set_bbox_to_anchor((LEFT / width, 1 - (top + 0.08) / total), figure.transFigure)
    return figure, total - above - below - 0.06


def _ruler(figure: Figure) -> Pen:
    """Measures text as it will be drawn, in points; it draws nothing."""
    return Pen(*figure.bbox.size, StringIO())


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


def _axes(figure: Figure, bottom: float, height: float, x: str = "", y: str = "") -> Axes:
    width, total = figure.get_size_inches()
    inner = width - LEFT - RIGHT
    axes = figure.add_axes((LEFT / width, bottom / total, inner / width, height / total))
    axes.set(xlabel=x, ylabel=y)
    axes.yaxis.set_label_coords(-0.46 / inner, 0.5)
    return axes


def _columns(*columns: Sequence[float]) -> list[np.ndarray]:
    rows = min(map(len, columns))
    return [np.asarray(column[:rows], float) for column in columns]


def _floor(values: Iterable[float]) -> float:
    """The position of a zero on a logarithmic axis: a decade below everything else."""
    positive = [value for value in values if 0 < value < math.inf]
    return 10.0 ** (math.floor(math.log10(min(positive))) - 1) if positive else 1e-17


def _draw_curve(axes: Axes, curve: CurveOutcome, index: int) -> None:
    colour, marker = KINDS[index % len(KINDS)]
    x, y = _columns(curve.x, curve.y)
    marks = {} if curve.reference_x else {"marker": marker, "ms": 3, "markevery": 7}
    unstable = np.zeros(len(x), int)
    unstable[: len(curve.unstable)] = curve.unstable[: len(x)]
    broken = np.minimum(np.maximum(unstable[1:], unstable[:-1]), 2)
    edges = [0, *(np.flatnonzero(np.diff(broken)) + 1), len(broken)]
    for start, stop in pairwise(edges):
        if stop > start:
            part, style = slice(start, stop + 1), ("-", DASHED, DOTTED)[broken[start]]
            axes.plot(x[part], y[part], color=colour, ls=style, **marks)
    rows = _legible(axes, *_columns(curve.reference_x, curve.reference_y))
    axes.plot(*rows, marker, color=colour, mfc="none", clip_on=False, zorder=3)


def _legible(axes: Axes, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The rows inside the axes, thinned to an even spacing along the curve as it is seen."""
    seen = axes.transAxes.inverted().transform(axes.transData.transform(np.column_stack([x, y])))
    inside = np.all((seen >= -1e-9) & (seen <= 1 + 1e-9), axis=1)
    x, y, seen = x[inside], y[inside], seen[inside]
    if len(x) <= SHOWN:
        return x, y
    along = np.r_[0, np.cumsum(np.hypot(*np.diff(seen, axis=0).T))]
    rows = np.unique(np.searchsorted(along, np.linspace(0, along[-1], SHOWN)).clip(0, len(x) - 1))
    return x[rows], y[rows]


def _draw_points(axes: Axes, panel: PanelOutcome) -> None:
    """Draw special points, each with its label where it covers least."""
    tracks = [np.column_stack(_columns(c.x, c.y)) for c in panel.curves]
    tracks = [t[:-1] + s * np.diff(t, axis=0) for t in tracks for s in (0, 0.25, 0.5, 0.75)]
    tracks += [np.column_stack(_columns(c.reference_x, c.reference_y)) for c in panel.curves]
    tracks.append(np.array([[point.x, point.y] for point in panel.markers]).reshape(-1, 2))
    taken = axes.transData.transform(np.vstack(tracks))
    frame, ruler = axes.get_window_extent(), _ruler(axes.figure)
    boxes: list[Bbox] = []
    for point in panel.markers:
        if not frame.padded(1).contains(*axes.transData.transform((point.x, point.y))):
            continue
        size = 9 if point.kind == "cusp_point" else 5.5
        axes.plot(point.x, point.y, POINTS.get(point.kind, "d"), color=INK, ms=size, zorder=4)
        if point.label and len(panel.markers) <= 12:
            boxes.append(_label(axes, (point.x, point.y), as_math(point.label), taken, boxes, ruler))


def _label(
    axes: Axes,
    at: tuple[float, float],
    text: str,
    taken: np.ndarray,
    boxes: list[Bbox],
    ruler: Pen,
) -> Bbox:
    """Write a label beside a point, on the side where it covers least; returns its box."""
    frame, place = axes.get_window_extent(), axes.transData.transform(at)
    note = axes.annotate(text, at, (0, 0), textcoords="offset points")
    size = note.get_window_extent(ruler).size
    options = []
    for step, side in enumerate(np.array(SIDES * 2)):
        away = (7 if step < len(SIDES) else 18) * side * (1, 0.8)
        corner = place + away + size * (side - 1) / 2
        box = Bbox([corner, corner + size]).padded(1.5)
        hits = float(np.sum(np.all((taken >= box.min) & (taken <= box.max), axis=1)))
        hits += 500 * sum(box.overlaps(other) for other in boxes) + 0.1 * step
        hits += 2000 * (not (frame.contains(*box.min) and frame.contains(*box.max)))
        options.append((hits, step, away, side, box))
    *_, away, (right, up), box = min(options, key=lambda option: option[:2])
    note.set_position(away)
    note.set(ha=("right", "center", "left")[right + 1], va=("top", "center", "bottom")[up + 1])
    return box


def _draw_residuals(axes: Axes, panel: PanelOutcome, verdicts: Sequence[Verdict]) -> None:
    """Draw the relative error of each row, its bound as steps, the asked accuracy as a line."""
    curves = panel.curves
    axes.set_yscale("log")
    floor = _floor(value for c in curves for value in (*c.residual, *c.residual_bound))
    for index, curve in enumerate(curves):
        colour, marker = KINDS[index % len(KINDS)]
        x, error = _columns(curve.residual_x, curve.residual)
        limit = np.resize(np.asarray(curve.residual_bound or [np.nan], float), len(x))
        shown = _worst(x, error, limit)
        x, error, limit = x[shown], error[shown], limit[shown]
        out = error > limit
        drawn = np.where(error > 0, error, np.where(error == 0, floor, np.nan))
        axes.plot(x[~out], drawn[~out], marker, color=colour, mew=0.7, ms=3.2, mfc="none")
        axes.plot(x[out], drawn[out], marker, color=colour, mew=0.7, ms=4.2)
        axes.plot(x, np.maximum(limit, floor), drawstyle="steps-mid", color=colour, lw=0.8)
    judged = [verdict.asked for c in curves for verdict in of_curve(c, verdicts) if verdict.asked]
    for asked in sorted(set(judged))[:3]:
        axes.axhline(asked, color=INK, lw=0.8, ls=ASKED)
    heights = [floor, *judged, *(v for c in curves for v in (*c.residual, *c.residual_bound))]
    zeros = any(0 in curve.residual for curve in curves)
    high = max(value for value in heights if value < math.inf)
    axes.set_ylim(floor * (0.5 if zeros else 4), 3 * high)
    axes.yaxis.set(major_locator=LogLocator(numticks=6), minor_locator=NullLocator())
    labels = {panel.x: panel.x_label, panel.y: panel.y_label}
    names = {c.residual_abscissa for c in curves if c.residual} - {""}
    axes.set_xlabel(as_math(", ".join(labels.get(name, name) for name in sorted(names))))
    axes.set_ylabel("relative error", fontsize=10)
    note = "open: error; filled: out of bound; line: bound"
    note += "; dash-dotted: asked" * bool(judged) + "; at the foot: zero" * zeros
    note += "; worst of neighbouring rows" * any(len(c.residual) > ERRORS for c in curves)
    axes.text(0, 1.05, note, transform=axes.transAxes, fontsize=8.5, color=MUTED)


def _worst(x: np.ndarray, error: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """Rows in the order of x: all, or of each group of neighbours the one that is nearest to its bound.

    Rows that are not finite are left out of a group that has others.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        badness = np.nan_to_num(error / limit, nan=-1.0, posinf=np.inf)
    groups = np.array_split(np.argsort(x, kind="stable"), min(ERRORS, max(len(x), 1)))
    return np.array([group[np.argmax(badness[group])] for group in groups if len(group)], int)


def _draw_history(axes: Axes, record: Convergence, index: int, floor: float) -> None:
    colour, marker = KINDS[index % len(KINDS)]
    cells, errors = _columns(record.cells, record.errors)
    drawn = np.where(errors > 0, errors, np.where(errors == 0, floor, np.nan))
    axes.plot(cells, drawn, marker, color=colour, mfc="none")
    usable = np.flatnonzero((errors > 0) & np.isfinite(errors))
    for order, style in ((record.observed_order, "-"), (record.expected_order, ":")):
        if order is not None and len(usable):
            line = errors[usable[-1]] * (cells / cells[usable[-1]]) ** -order
            axes.plot(cells, line, ls=style, color=colour, lw=0.9)
