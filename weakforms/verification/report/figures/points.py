"""Labels inside a panel, each where it covers least: of special points, and of many curves."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.transforms import Bbox

from weakforms.verification.judging.outcome import PanelOutcome
from weakforms.verification.report.figures.canvas import (
    INK,
    KINDS,
    PALETTE,
    Pen,
    as_columns,
    as_math,
    new_ruler,
)
from weakforms.verification.report.figures.legend import POINTS

SIDES = ((1, 0), (-1, 0), (1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1), (0, -1))
"""Sides of a point on which its label may stand, the best first."""


PLACES = np.linspace(0.02, 0.98, 17)
"""Parts of the visible length of a curve at which its label may stand."""


def draw_points(axes: Axes, panel: PanelOutcome) -> None:
    """Draw special points, each with its label where it covers least; so are curves, if colours repeat."""
    tracks = [np.column_stack(as_columns(c.x, c.y)) for c in panel.curves]
    tracks = [t[:-1] + s * np.diff(t, axis=0) for t in tracks for s in (0, 0.25, 0.5, 0.75)]
    tracks += [np.column_stack(as_columns(c.reference_x, c.reference_y)) for c in panel.curves]
    tracks.append(np.array([[point.x, point.y] for point in panel.markers]).reshape(-1, 2))
    taken = axes.transData.transform(np.vstack(tracks))
    frame, ruler = axes.get_window_extent(), new_ruler(axes.figure)
    boxes: list[Bbox] = []
    if len(panel.curves) > len(PALETTE):
        for index, (text, place) in enumerate(_free_places(axes, panel)):
            if place is not None:
                look = {"color": KINDS[index % len(KINDS)][0], "fontsize": 8}
                boxes.append(_label(axes, place, text, taken, boxes, ruler, **look))
    for point in panel.markers:
        if not frame.padded(1).contains(*axes.transData.transform((point.x, point.y))):
            continue
        size = 9 if point.kind == "cusp_point" else 5.5
        axes.plot(point.x, point.y, POINTS.get(point.kind, "d"), color=INK, ms=size, zorder=4)
        if point.label and len(panel.markers) <= 12:
            boxes.append(_label(axes, (point.x, point.y), as_math(point.label), taken, boxes, ruler))


def _free_places(axes: Axes, panel: PanelOutcome) -> list[tuple[str, tuple[float, float] | None]]:
    """The label of each curve with a point of it that is far from the other curves and their labels.

    No point for a curve that is not seen.
    """
    seen = []
    for curve in panel.curves:
        track = axes.transAxes.inverted().transform(
            axes.transData.transform(np.column_stack(as_columns(curve.x, curve.y)))
        )
        seen.append(track[np.all((track >= 0) & (track <= 1), axis=1)])
    found: list[tuple[str, tuple[float, float] | None]] = []
    used = np.empty((0, 2))
    for index, (curve, own) in enumerate(zip(panel.curves, seen, strict=True)):
        text = as_math(curve.label or curve.name)
        if not len(own):
            found.append((text, None))
            continue
        options = own[(PLACES * (len(own) - 1)).astype(int)]
        others = np.vstack([used, *(track for k, track in enumerate(seen) if k != index)])
        apart = np.linalg.norm(options[:, None] - others[None], axis=2)
        best = options[np.argmax(apart.min(axis=1))] if len(others) else options[0]
        used = np.vstack([used, best])
        found.append((text, tuple(axes.transData.inverted().transform(axes.transAxes.transform(best)))))
    return found


def _label(
    axes: Axes,
    at: tuple[float, float],
    text: str,
    taken: np.ndarray,
    boxes: list[Bbox],
    ruler: Pen,
    **look: object,
) -> Bbox:
    """Write a label beside a point, on the side where it covers least; returns its box."""
    frame, place = axes.get_window_extent(), axes.transData.transform(at)
    note = axes.annotate(text, at, (0, 0), textcoords="offset points", **look)
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
