"""Do the marks of a reference lie on the line drawn through them: a picture must not show what is not so."""

from __future__ import annotations

import numpy as np

from weakforms.verification.cases.panels import Panel
from weakforms.verification.judging.outcome import CurveOutcome, PanelOutcome, Verdict
from weakforms.verification.report.look import HEIGHT, LEFT, LOOK, RIGHT, WIDTH

MARK = LOOK["style"]["lines.markersize"]
"""Size of a mark, points."""


def names(paper: int | str, panel: Panel) -> list[str]:
    """What the verdict on a panel will be called; none where it shows no marks of a reference."""
    return [f"marks:{panel.name}"] if _has_marks(paper, panel) else []


def _has_marks(paper: int | str, panel: Panel) -> bool:
    for curve in panel.curves:
        table = curve.table(paper)
        y = curve.y or panel.y.name
        if table is not None and panel.x.name in table.columns and y in table.columns:
            return True
    return False


def judge(panel: PanelOutcome) -> list[Verdict]:
    """A verdict on a panel: no mark is off its line by more than its own size."""
    marked = [curve for curve in panel.curves if curve.reference_x]
    if not marked:
        return []
    off = {curve.label or curve.name: farthest(panel, curve) for curve in marked}
    worst = max(off, key=lambda label: float(np.nan_to_num(off[label][0], nan=np.inf)))
    size, place = off[worst]
    return [
        Verdict(
            f"marks:{panel.name}",
            "marks",
            bool(size <= MARK),
            "marks of the reference lie on the lines drawn, to their own size",
            detail=f"farthest off: {size:.2g} pt of {MARK} pt, on {worst}",
            where=place,
        )
    ]


def farthest(panel: PanelOutcome, curve: CurveOutcome) -> tuple[float, str]:
    """Largest distance of a mark inside the axes from its line in the picture, points, and where it is."""
    scale = 72 * np.array([WIDTH - LEFT - RIGHT, HEIGHT]) / np.ptp([panel.x_range, panel.y_range], axis=1)
    low = np.array([panel.x_range[0], panel.y_range[0]])
    line, marks = (
        scale * (np.column_stack(pair).astype(float) - low)
        for pair in ((curve.x, curve.y), (curve.reference_x, curve.reference_y))
    )
    seen = np.all((marks >= 0) & (marks <= scale * np.ptp([panel.x_range, panel.y_range], axis=1)), axis=1)
    if not seen.any():
        return 0.0, ""
    distance = np.where(seen, _distance(marks, line), 0.0)
    i = int(np.argmax(distance))
    return float(distance[i]), f"{panel.x} = {curve.reference_x[i]:.6g}"


def _distance(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Distance of each point from a polygon with gaps, or from a single point."""
    start, along = line[:-1], np.diff(line, axis=0)
    if not len(along):
        return np.linalg.norm(points - line[0], axis=1)
    away = points[:, None] - start
    length = np.maximum(np.sum(along**2, axis=1), np.finfo(float).tiny)
    share = np.clip(np.sum(away * along, axis=2) / length, 0, 1)
    distance = np.linalg.norm(away - share[:, :, None] * along, axis=2)
    return np.nan_to_num(distance, nan=np.inf).min(axis=1)
