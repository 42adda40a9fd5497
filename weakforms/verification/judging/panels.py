"""Panels for the report: branches, profiles, paths of material points, special points."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.registry import symbol
from weakforms.results import SpecialPoint
from weakforms.verification.cases.panels import Panel
from weakforms.verification.cases.references import Reference
from weakforms.verification.judging.checks.curve import Curve
from weakforms.verification.judging.outcome import CurveOutcome, Marker, PanelOutcome, PathOutcome
from weakforms.verification.report.wording import kind_of_point
from weakforms.verification.run.solutions import Solutions

AXIAL = ("Z", "eta")
"""Coordinates along the axis of a body, which are odd about its mid-plane."""


def draw_panel(paper: int | str, panel: Panel, solutions: Solutions) -> PanelOutcome:
    """The panel for the report; a curve that could not be solved is missing."""
    outcome = PanelOutcome(
        name=panel.name,
        title=panel.title,
        x=panel.x.name,
        y=panel.y.name,
        x_label=panel.x.tex,
        y_label=panel.y.tex,
        x_range=(panel.x.low, panel.x.high),
        y_range=(panel.y.low, panel.y.high),
        level=panel.level,
        note=panel.note,
    )
    if panel.lines and not panel.curves:
        outcome.drawn = "exact"
    outcome.curves = [CurveOutcome(line.label, line.label, [*line.x], [*line.y]) for line in panel.lines]
    if panel.counted:
        outcome.dashed, outcome.dotted = "one negative eigenvalue", "more of them"
    if panel.dashed is not None:
        outcome.full, outcome.dashed = panel.dashed.full, panel.dashed.dashed
    for curve in panel.curves:
        try:
            drawn = _draw(paper, panel, curve, solutions)
            marks = _markers(panel, curve, solutions)
        except ConvergenceError:
            continue  # the comparison of the curve reports this as an error
        outcome.curves.append(drawn)
        outcome.markers.extend(marks)
    with suppress(ConvergenceError):  # the same holds for a state of a path
        outcome.paths = _draw_paths(paper, panel, solutions)
    return outcome


def _draw_paths(paper: int | str, panel: Panel, solutions: Solutions) -> list[PathOutcome]:
    """Paths of all material points through the states that could be solved."""
    out = []
    for path in panel.paths:
        samples = [
            [solutions.sampled(path.of, at, name)[0] for name in (panel.x.name, panel.y.name)]
            for at in path.states(paper)
        ]
        for i, point in enumerate(path.points):
            x, y = (np.array([float(sample[axis][i]) for sample in samples]) for axis in (0, 1))
            for side in (1, -1) if panel.mirrored else (0,):
                sides = (_beside(panel, name, v, side) for name, v in ((panel.x.name, x), (panel.y.name, y)))
                out.append(PathOutcome(point, *(v.tolist() for v in sides)))
    return out


def _beside(panel: Panel, name: str, values: np.ndarray, side: int) -> np.ndarray:
    """A coordinate of a path on one side of the mid-plane, or as it is (0)."""
    if not side or name not in AXIAL:
        return values
    axis = panel.x if panel.x.name == name else panel.y
    return (axis.low + axis.high) / 2 + side * values


def _draw(paper: int | str, panel: Panel, curve: Curve, solutions: Solutions) -> CurveOutcome:
    x, y = panel.x.name, curve.y or panel.y.name
    table = curve.table(paper)
    own = curve.columns.get(y, y)
    if curve.at is not None:
        columns = solutions.profile(curve.of, curve.shown_at(table)).columns
        rule = panel.dashed
        unstable = [] if rule is None else (columns[rule.column] < rule.below).tolist()
    else:
        counted = panel.counted or ("n_negative",)
        columns = _with_states(curve, table, solutions, (x, own), counted)
        sizes = {x: panel.x.high - panel.x.low, own: panel.y.high - panel.y.low}
        for point in _special(panel, curve, solutions):
            columns = through(point.values, columns, sizes)
        total = sum(columns[name] for name in counted)
        unstable = [int(n) for n in total] if panel.counted else [bool(n) for n in total]
    xs, ys = columns[x], columns[own]
    if panel.mirrored:
        xs, ys = mirror(panel, x, xs), mirror(panel, y, ys)
    outcome = CurveOutcome(
        name=curve.reference or str(curve.of),
        label=curve.label,
        x=xs.tolist(),
        y=ys.tolist(),
        unstable=unstable if not panel.mirrored else [],
    )
    if table is not None and x in table.columns and y in table.columns:
        rx, ry = table.columns[x], table.columns[y]
        if panel.mirrored:
            rx, ry = mirror(panel, x, rx), mirror(panel, y, ry)
        outcome.reference_name, outcome.reference_kind = table.name, table.kind
        outcome.reference_x, outcome.reference_y = rx.tolist(), ry.tolist()
    comparisons = {}
    with suppress(ConvergenceError):  # the comparison of the curve reports this
        comparisons = curve.comparisons(paper, solutions)
    worst = comparisons.get(y) or next(iter(comparisons.values()), None)
    if table is not None and worst is not None:
        outcome.residual_abscissa = symbol(table.abscissa) or table.abscissa
        outcome.residual_x = table.columns[table.abscissa].tolist()
        outcome.residual = worst.error.tolist()
        outcome.residual_bound = worst.bound.tolist()
    return outcome


def _with_states(
    curve: Curve,
    table: Reference | None,
    solutions: Solutions,
    names: tuple[str, ...],
    counted: tuple[str, ...] = ("n_negative",),
) -> dict[str, np.ndarray]:
    """Columns of a branch, with the states at the rows of its table in between.

    A branch traced in long steps would otherwise be a polygon beside these states.
    """
    branch = solutions.branch(curve.of, curve.branch).columns
    columns = {name: np.asarray(branch[name], float) for name in (*names, *counted)}
    along = None if table is None else branch.get(table.abscissa)
    if along is None:
        return columns
    after, values = [], []
    for row in table.columns[table.abscissa]:
        try:
            state = solutions.state(curve.of, curve.row_at(table, float(row))).quantities
        except ConvergenceError:  # the comparison of the curve reports this
            continue
        i = _passed(along, float(row))
        if i is not None and all(name in state for name in names):
            at_state = {name: state[name].value if name in state else columns[name][i] for name in columns}
            after.append((i, (row - along[i]) * np.sign(along[i + 1] - along[i])))
            values.append(at_state)
    order = sorted(range(len(after)), key=after.__getitem__)
    places = [after[k][0] + 1 for k in order]
    return {name: np.insert(v, places, [values[k][name] for k in order]) for name, v in columns.items()}


def through(
    point: Mapping[str, float], columns: dict[str, np.ndarray], sizes: Mapping[str, float]
) -> dict[str, np.ndarray]:
    """The columns of a branch with a special point between the neighbours from which it is the least detour.

    Args:
        point: Values of the special point.
        columns: Those that are drawn, and counts.
        sizes: Ranges of the axes by the two columns that are drawn.
    """
    if not all(np.isfinite(point.get(name, np.nan)) for name in sizes):
        return columns
    track = np.column_stack([columns[name] / size for name, size in sizes.items()])
    place, chord = np.array([point[name] / size for name, size in sizes.items()]), np.diff(track, axis=0)
    before, after = (np.linalg.norm(place - ends, axis=1) for ends in (track[:-1], track[1:]))
    length = np.linalg.norm(chord, axis=1)
    detour = before + after - length
    detour[~(detour <= length / 2)] = np.inf  # beyond an end of what is drawn, or where a column has no value
    if not np.isfinite(detour.min(initial=np.inf)):
        return columns
    i = int(np.argmin(detour))
    return {name: np.insert(v, i + 1, point[name] if name in sizes else v[i]) for name, v in columns.items()}


def _passed(along: np.ndarray, value: float) -> int | None:
    """The point of a branch after which a column first crosses a value; ``None`` if it never does."""
    distance = np.asarray(along, float) - value
    hits = np.flatnonzero((distance[:-1] * distance[1:] < 0) | (distance[1:] == 0) | (distance[:-1] == 0))
    return int(hits[0]) if len(hits) else None


def mirror(panel: Panel, name: str, values: np.ndarray) -> np.ndarray:
    """A half profile, completed to a profile from end to end as in the paper.

    Axial coordinates are odd about the mid-plane and shifted to start at 0; all other columns are even.
    """
    if name in AXIAL:
        axis = panel.x if panel.x.name == name else panel.y
        middle = (axis.low + axis.high) / 2
        return np.concatenate([middle - values[::-1], middle + values[1:]])
    return np.concatenate([values[::-1], values[1:]])


def _markers(panel: Panel, curve: Curve, solutions: Solutions) -> list[Marker]:
    return _edge(panel, curve, solutions) + [
        Marker(point.kind, _marker_label(point), point.values[panel.x.name], point.values[panel.y.name])
        for point in _special(panel, curve, solutions)
    ]


def _special(panel: Panel, curve: Curve, solutions: Solutions) -> list[SpecialPoint]:
    """The special points of a curve's branch that a panel marks."""
    kinds = (panel.markers,) if isinstance(panel.markers, str) else panel.markers
    points = [p for kind in filter(None, kinds) for p in solutions.points(curve.of, kind)]
    return [point for point in points if point.branch == curve.branch]


def _edge(panel: Panel, curve: Curve, solutions: Solutions) -> list[Marker]:
    """The material point that is marked on a profile, between the two samples around it."""
    if not panel.edge or curve.at is None:
        return []
    columns = solutions.profile(curve.of, curve.at).columns
    place = solutions.value(curve.of, curve.at, panel.edge)
    along = next(iter(columns.values()))
    x, y = (float(np.interp(place, along, columns[axis.name])) for axis in (panel.x, panel.y))
    return [Marker("contact_edge", "", x, y)]


def _marker_label(point: SpecialPoint) -> str:
    """The label of a marker; the legend shows its kind."""
    return f"n = {point.values['n']:g}" if point.values.get("n") else kind_of_point(point.kind)
