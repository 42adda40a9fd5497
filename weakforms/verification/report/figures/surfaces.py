"""Surfaces in space as SVG, beside the panels of :mod:`weakforms.verification.report.figures.panel`."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D

from weakforms.verification.judging.outcome import SurfaceOutcome
from weakforms.verification.report.figures.canvas import as_math, drawing, svg
from weakforms.verification.report.look import LOOK
from weakforms.verification.report.wording import plain_tex

LINES = 36
"""Largest number of lines in each direction."""

TICKS = 3
"""Largest number of intervals on an axis that is short relative to the others; twice as many on a long
one."""

SIZE = (4.9, 4.9)
"""Size in inches."""

FRAME = (0.04, 0.13, 0.92, 0.87)
"""Position of the axes in the picture."""


def surface_figure(surface: SurfaceOutcome, ident: str) -> str:
    """A surface in space, drawn to scale.

    Args:
        surface: Its position and the ranges of its axes.
        ident: Identifier of the figure on its page.

    Returns:
        An ``<svg>`` element.
    """
    colours = LOOK["light"]
    with drawing(ident):
        figure = FigureCanvasSVG(Figure(figsize=SIZE)).figure
        axes: Axes3D = figure.add_axes(FRAME, projection="3d", computed_zorder=False)
        axes.view_init(elev=14, azim=-62)
        x, y, z = (np.asarray(part, float) for part in surface.position)
        axes.plot_surface(
            x,
            y,
            z,
            rcount=LINES,
            ccount=LINES,
            color=colours["grid"],
            edgecolor=colours["c0"],
            linewidth=0.35,
            shade=False,
        )
        limits = (axes.set_xlim, axes.set_ylim, axes.set_zlim)
        labels = (axes.set_xlabel, axes.set_ylabel, axes.set_zlabel)
        for (low, high), limit, text, label in zip(
            surface.ranges, limits, surface.labels, labels, strict=True
        ):
            limit(low, high)
            label(as_math(text))
        tallest = max(high - low for low, high in surface.ranges)
        axes.set_box_aspect([high - low for low, high in surface.ranges])
        for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
            axis.set_pane_color((0, 0, 0, 0))
            low, high = axis.get_view_interval()
            axis.set_major_locator(MaxNLocator(TICKS if high - low < tallest / 2 else 2 * TICKS))
        return svg(figure, ident, plain_tex(surface.title or surface.name), describe_surface(surface))


def describe_surface(surface: SurfaceOutcome) -> str:
    """The picture in words, for screen readers."""
    spans = [
        f"{name} from {np.min(part):.3g} to {np.max(part):.3g}"
        for name, part in zip("xyz", surface.position, strict=True)
    ]
    return f"Deformed surface in space, drawn to scale: {', '.join(spans)}."
