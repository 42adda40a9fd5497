"""Time of a large surface against its unknowns, on several numbers of ranks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.ticker import NullLocator

from weakforms.verification.audit.bench_ranks import STAGES, Refinement, Scaled
from weakforms.verification.report.figures.canvas import FOOT, KINDS, drawing, new_axes, svg
from weakforms.verification.report.figures.legend import key, with_legend

WIDTH, HEIGHT = 5.4, 2.8
"""Width of the figure, and height of its axes, in inches."""

STYLES = ("-", "--", ":", "-.")
"""Lines of one, two ... ranks."""


def scaling_views(scaled: Scaled) -> list[dict[str, Any]]:
    """What the page shows of each surface: its figure, and both tables."""
    return [
        {
            "title": title,
            "figure": scaling_figure(runs := scaled.of(title), f"scaling-{i}", title),
            "runs": runs,
            "strong": scaled.strong(title),
            "weak": scaled.weak(title),
        }
        for i, title in enumerate(scaled.titles)
    ]


def scaling_figure(runs: Sequence[Refinement], ident: str, title: str) -> str:
    """Seconds of each stage against the unknowns, a line for each number of ranks.

    Args:
        runs: Of one surface.
        ident: Identifier of the figure on its page.
        title: Of the surface.

    Returns:
        An ``<svg>`` element.
    """
    stages = [key(name, i) for i, name in enumerate(STAGES.values())]
    kinds = [
        key(f"{run.ranks} rank{'s' * (run.ranks > 1)}", None, ls=_style(i)) for i, run in enumerate(runs)
    ]
    with drawing(ident):
        figure, keyed = with_legend([stages, kinds], WIDTH, HEIGHT + FOOT, 0)
        axes = new_axes(figure, keyed + FOOT, HEIGHT, "unknowns", "seconds")
        axes.set(xscale="log", yscale="log")
        for i, run in enumerate(runs):
            for stage, (colour, marker) in zip(STAGES, KINDS, strict=False):
                times = [getattr(row, stage) for row in run.rows]
                unknowns = [row.unknowns for row in run.rows]
                axes.plot(unknowns, times, marker=marker, ls=_style(i), color=colour, mfc="none", lw=0.9)
        axes.yaxis.set(minor_locator=NullLocator())
        return svg(figure, ident, f"Time of {title}", _said(runs))


def _style(index: int) -> str:
    return STYLES[index % len(STYLES)]


def _said(runs: Sequence[Refinement]) -> str:
    """The figure in words."""
    ends = [(run, run.rows[-1]) for run in runs if run.rows]
    parts = [
        f"{run.ranks} ranks: {row.unknowns} unknowns, "
        + ", ".join(f"{name} {getattr(row, stage):.3g} s" for stage, name in STAGES.items())
        for run, row in ends
    ]
    return ". ".join(parts) + "."
