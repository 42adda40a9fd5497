"""Surfaces in space as SVG, beside the panels of :mod:`weakforms.verification.report.figures.panel`."""

from __future__ import annotations

import numpy as np
from matplotlib import colormaps
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d import Axes3D

from weakforms.problems.registry import symbol
from weakforms.verification.judging.outcome import SurfaceOutcome
from weakforms.verification.report.figures.canvas import Picture, as_math, drawing, pdf, svg
from weakforms.verification.report.look import LOOK
from weakforms.verification.report.wording import plain_tex

LINES = 36
"""Largest number of lines in each direction."""

TICKS = 3
"""Largest number of intervals on an axis that is short relative to the others; twice as many on a long
one."""

SIZE = (4.9, 5.8)
"""Size in inches."""

FRAME = (0.04, 0.26, 0.92, 0.74)
"""Position of the axes in the picture."""

COLOURED = ("lam2", "lam1", "gw")
"""Fields that colour a surface; the first one that it has is used."""

STEPS = 10
"""Largest number of colours: few, so that each can be found in the bar beside the surface."""

BAR = (0.2, 0.09, 0.6, 0.022)
"""Position of the bar of colours, below the axes."""


def surface_picture(surface: SurfaceOutcome, ident: str) -> Picture:
    """A surface in space, drawn to scale, in the colours of its stretch, or of another field.

    Colours are those of cividis, which readers see alike who do not tell red from green.

    Args:
        surface: Its position, the ranges of its axes, and its fields.
        ident: Identifier of the figure on its page.
    """
    colours = LOOK["light"]
    with drawing(ident):
        figure = FigureCanvasSVG(Figure(figsize=SIZE)).figure
        axes: Axes3D = figure.add_axes(FRAME, projection="3d", computed_zorder=False)
        axes.view_init(elev=14, azim=-62)
        x, y, z = (np.asarray(part, float) for part in surface.position)
        scale, values = _colours(surface)
        look = {"color": colours["grid"]} if scale is None else {"facecolors": scale.to_rgba(values)}
        edge = colours["c0"] if scale is None else colours["muted"]
        axes.plot_surface(
            x, y, z, rcount=LINES, ccount=LINES, edgecolor=edge, linewidth=0.25, shade=False, **look
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
        axes.zaxis.labelpad = 9  # clear of the longest number
        if scale is not None:
            bar = figure.colorbar(scale, cax=figure.add_axes(BAR), orientation="horizontal")
            bar.set_label(as_math(symbol(_shown(surface)) or _shown(surface)))
            bar.ax.xaxis.set_major_locator(MaxNLocator(5))
        title = plain_tex(surface.title or surface.name)
        return Picture(svg(figure, ident, title, describe_surface(surface)), pdf(figure, title))


def _shown(surface: SurfaceOutcome) -> str:
    """Name of the field that colours a surface; empty if it has none of them."""
    return next((name for name in COLOURED if name in surface.fields), "")


def _colours(surface: SurfaceOutcome) -> tuple[ScalarMappable | None, np.ndarray]:
    """The scale of colours and the values on the surface; no scale for a field that is uniform or missing."""
    values = np.asarray(surface.fields.get(_shown(surface), [[]]), float)
    known = values[np.isfinite(values)]
    if not len(known) or np.ptp(known) <= 1e-9 * np.abs(known).max():
        return None, values
    levels = MaxNLocator(STEPS).tick_values(known.min(), known.max())
    colours = colormaps["cividis"]
    return ScalarMappable(BoundaryNorm(levels, colours.N), colours), values


def describe_surface(surface: SurfaceOutcome) -> str:
    """The picture in words, for screen readers."""
    spans = [
        f"{name} from {np.min(part):.3g} to {np.max(part):.3g}"
        for name, part in zip("xyz", surface.position, strict=True)
    ]
    text = f"Deformed surface in space, drawn to scale: {', '.join(spans)}."
    scale, values = _colours(surface)
    if scale is not None:
        text += f" Colour shows {_shown(surface)} from {np.nanmin(values):.3g} to {np.nanmax(values):.3g}."
    return text
