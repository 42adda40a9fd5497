"""Panels on the thesis's axes, with the errors of their curves below."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from weakforms.verification.judging.outcome import CurveOutcome, PanelOutcome, Verdict
from weakforms.verification.report.figures.canvas import (
    DASHED,
    DOTTED,
    FOOT,
    KINDS,
    MUTED,
    Picture,
    as_columns,
    as_math,
    clear_label,
    drawing,
    new_axes,
    pdf,
    svg,
)
from weakforms.verification.report.figures.legend import FAILED, panel_keys, with_legend
from weakforms.verification.report.figures.points import draw_points
from weakforms.verification.report.figures.residuals import draw_residuals
from weakforms.verification.report.look import HEIGHT, WIDTH
from weakforms.verification.report.summary import describe, of_curve
from weakforms.verification.report.wording import plain_tex

SHOWN = 22
"""Largest number of reference markers on a curve, which is compared at every row of its table."""


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
        failed = [row for curve in panel.curves for row in failed_rows(curve, verdicts, (panel.x, panel.y))]
        figure, keyed = with_legend(panel_keys(panel, bool(failed)), WIDTH, HEIGHT + FOOT, lower)
        place = (lower + keyed + FOOT, HEIGHT)
        axes = new_axes(figure, *place, as_math(panel.x_label), as_math(panel.y_label))
        for limits, setter in ((panel.x_range, axes.set_xlim), (panel.y_range, axes.set_ylim)):
            if all(map(math.isfinite, limits)) and limits[0] != limits[1]:
                setter(*limits)
        for index, curve in enumerate(panel.curves):
            _draw_curve(axes, curve, index)
        if panel.level is not None:
            axes.axhline(panel.level, color=MUTED, lw=0.9, ls=DASHED, zorder=0)
        for path in panel.paths:
            axes.plot(path.x, path.y, ls=":", lw=0.9, color=MUTED, zorder=1)
        draw_points(axes, panel)
        clear_label(axes)
        for row in failed:
            axes.plot(*row, **FAILED, zorder=5)
        if residuals:
            draw_residuals(new_axes(figure, FOOT, 1.12), panel, verdicts)
        title = plain_tex(panel.title or panel.name)
        shown = svg(figure, ident, title, describe(panel, verdicts))
        return Picture(shown, pdf(figure, title) if printed else b"")


def failed_rows(
    curve: CurveOutcome, verdicts: Sequence[Verdict], drawn: Sequence[str]
) -> list[tuple[float, float]]:
    """The rows of a curve's reference at which a check on it fails most, as points of the panel.

    Args:
        curve: The curve.
        verdicts: Those of its case.
        drawn: The columns on the axes. A check on another column of the same table, which may be drawn in
            another panel, marks a row here only if the row is out of its bound here too.
    """
    found = []
    for verdict in of_curve(curve, verdicts):
        place = re.search(r" = (-?\d[-+.e\d]*)", verdict.where)
        if verdict.passed or place is None or not curve.residual_x or not curve.reference_x:
            continue
        row = int(np.argmin(np.abs(np.asarray(curve.residual_x, float) - float(place[1]))))
        if verdict.check.rpartition(":")[2] not in drawn and curve.residual[row] <= curve.residual_bound[row]:
            continue
        row += len(curve.reference_x) - len(curve.residual_x)  # profiles are mirrored to both sides
        point = (curve.reference_x[row], curve.reference_y[row])
        if point not in found:
            found.append(point)
    return found


def _draw_curve(axes: Axes, curve: CurveOutcome, index: int) -> None:
    colour, marker = KINDS[index % len(KINDS)]
    x, y = as_columns(curve.x, curve.y)
    marks = {} if curve.reference_x else {"marker": marker, "ms": 3, "markevery": 7}
    unstable = np.zeros(len(x), int)
    unstable[: len(curve.unstable)] = curve.unstable[: len(x)]
    broken = np.minimum(np.maximum(unstable[1:], unstable[:-1]), 2)
    edges = [0, *(np.flatnonzero(np.diff(broken)) + 1), len(broken)]
    for start, stop in pairwise(edges):
        if stop > start:
            part, style = slice(start, stop + 1), ("-", DASHED, DOTTED)[broken[start]]
            axes.plot(x[part], y[part], color=colour, ls=style, **marks)
    rows = _legible(axes, *as_columns(curve.reference_x, curve.reference_y))
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
