"""Errors of a panel's curves at the rows of their tables, with their bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

from weakforms.verification.judging.outcome import PanelOutcome, Verdict
from weakforms.verification.report.figures.canvas import INK, KINDS, MUTED, as_columns, as_math, floor_of
from weakforms.verification.report.summary import of_curve

ERRORS = 40
"""Largest number of errors drawn for a curve: of several rows beside each other the worst one."""
ASKED = (0, (6, 2, 1, 2))


def draw_residuals(axes: Axes, panel: PanelOutcome, verdicts: Sequence[Verdict]) -> None:
    """Draw the relative error of each row, its bound as steps, the asked accuracy as a line."""
    curves = panel.curves
    axes.set_yscale("log")
    floor = floor_of(value for c in curves for value in (*c.residual, *c.residual_bound))
    for index, curve in enumerate(curves):
        colour, marker = KINDS[index % len(KINDS)]
        x, error = as_columns(curve.residual_x, curve.residual)
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
    note += ";\nworst of neighbouring rows" * any(len(c.residual) > ERRORS for c in curves)
    axes.text(0, 1.05, note, transform=axes.transAxes, fontsize=8.5, color=MUTED)


def _worst(x: np.ndarray, error: np.ndarray, limit: np.ndarray) -> np.ndarray:
    """Rows in the order of x: all, or of each group of neighbours the one that is nearest to its bound.

    Rows that are not finite are left out of a group that has others.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        badness = np.nan_to_num(error / limit, nan=-1.0, posinf=np.inf)
    groups = np.array_split(np.argsort(x, kind="stable"), min(ERRORS, max(len(x), 1)))
    return np.array([group[np.argmax(badness[group])] for group in groups if len(group)], int)
