"""Errors of a quantity against the number of cells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, NullLocator

from weakforms.verification.judging.outcome import Convergence
from weakforms.verification.report.figures.canvas import (
    FOOT,
    KINDS,
    as_columns,
    drawing,
    floor_of,
    new_axes,
    svg,
)
from weakforms.verification.report.figures.legend import key, with_legend
from weakforms.verification.report.summary import describe_histories
from weakforms.verification.report.wording import plain_tex

NARROW = 4.2
"""Width of the figure in inches."""


def convergence_figure(records: Sequence[Convergence], ident: str) -> str:
    """Errors of one quantity against the number of cells, with observed and expected slopes.

    Args:
        records: Refinement histories of the same quantity, usually one for each degree.
        ident: Identifier of the figure on its page.

    Returns:
        An ``<svg>`` element.
    """
    keys = [key(f"P{r.degree}", i, ls="") for i, r in enumerate(records)]
    lines = [key("observed order", None), key("expected order", None, ls=":")]
    with drawing(ident):
        figure, keyed = with_legend([keys, lines], NARROW, 2.4 + FOOT, 0)
        axes = new_axes(figure, keyed + FOOT, 2.4, "cells", "relative error")
        axes.set(xscale="log", yscale="log")
        floor = floor_of(error for record in records for error in record.errors)
        for index, record in enumerate(records):
            _draw_history(axes, record, index, floor)
        cells = sorted({cell for record in records for cell in record.cells})
        if 0 < len(cells) <= 8:
            axes.xaxis.set(major_locator=FixedLocator(cells), minor_locator=NullLocator())
            axes.xaxis.set_major_formatter("{x:.0f}")
        axes.yaxis.set(minor_locator=NullLocator())
        quantity = plain_tex(records[0].quantity) if records else "nothing"
        return svg(figure, ident, f"Convergence of {quantity}", describe_histories(records))


def _draw_history(axes: Axes, record: Convergence, index: int, floor: float) -> None:
    colour, marker = KINDS[index % len(KINDS)]
    cells, errors = as_columns(record.cells, record.errors)
    drawn = np.where(errors > 0, errors, np.where(errors == 0, floor, np.nan))
    axes.plot(cells, drawn, marker, color=colour, mfc="none")
    usable = np.flatnonzero((errors > 0) & np.isfinite(errors))
    for order, style in ((record.observed_order, "-"), (record.expected_order, ":")):
        if order is not None and len(usable):
            line = errors[usable[-1]] * (cells / cells[usable[-1]]) ** -order
            axes.plot(cells, line, ls=style, color=colour, lw=0.9)
