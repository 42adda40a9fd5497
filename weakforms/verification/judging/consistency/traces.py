"""Is the trace that a user takes away right: its own points against states, and against tables.

Curves are compared at states solved for at the rows of a table; the points of the trace itself come from the
continuation. They are held against

- states solved for at some of them, drawn at random (:mod:`weakforms.results.drawing`), in every column, by
  the rule of all comparisons: |difference| <= 2 sqrt(u_trace^2 + u_state^2), and that bound sharper than
  :data:`SHARP`;
- the tables of the case, interpolated, where those are dense enough to tell an error of one percent.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from weakforms.results import Branch, Result, State
from weakforms.results.drawing import DESCRIBE
from weakforms.verification.cases.case import Case, Curve
from weakforms.verification.cases.references import Reference
from weakforms.verification.cases.specs import Spec
from weakforms.verification.crosscheck.rows import interpolated
from weakforms.verification.judging.bounds import Comparison, compare
from weakforms.verification.judging.curves import asked_of, reference_of
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions

TRACED = {
    *("circular", "tube", "tube_fold", "fluid_tube", "wrinkled_tube", "hemisphere", "wrinkled_patch"),
    *("sphere", "infinite_tube", "homogeneous"),
}
"""Problems whose answers are traces with states on demand."""

DRAWN = 2
"""States solved for at points of each trace."""

SHARP = 1e-3
"""Bound, relative to the size of the column, that must be sharper: a tenth of an error of one percent."""

BLUNT = ("traction_max", "traction_front", "kappa", "X_iso")
"""Columns that some states know less sharply: tractions and curvature at the edge of a patch that lets go,
and the point where two nearly equal stretches cross. There they are not judged, unless off by more than their
wide bound."""

SOLVED = 1e-10
"""To what the two solves stop: the relative step of Newton's method, and the eigensolver's tolerance."""

ZERO = 10.0
"""Size taken for a column that is zero all along: its bound is sharper than 1e-2 in its own unit."""

SMALL = 0.02
"""Smallest size a column is taken to have: what is zero but for its discretisation is no larger."""

ENDS = 2
"""Intervals at either end of a table in which its interpolation is not relied on."""

SAFETY = 3.0
"""Factor of what interpolating a table may add: that is told for smooth columns, and these have kinks."""

RESOLVED = SHARP / 20
"""Error of a table's interpolation, as two splines show it, below which the table counts as dense. Where they
show more, they are no longer near enough to the curve for their difference to be an error bound."""

DENSE = 0.5
"""Part of a table's intervals that must be resolved for a column to be interpolated at all: the few that are
in a coarse table may lie between two points of a trace, and may look resolved by accident."""

EXTREMES = ("gw_min", "gw_max", "t_min", "t2_min", "T_min", "z_min", "r_max", "spring_max", "traction_max")
"""Columns that have a kink wherever their place on the body jumps or reaches an end, which a spline through a
table does not know: they are held against states only."""

LEAST_ROWS = 9
"""Rows of a table that is interpolated."""

KINKS = ("contact_onset", "zone_opening", "zone_closing", "cusp_point")
"""Special points at which columns are not smooth."""


def is_judged(spec: Spec) -> bool:
    """Whether a solution has traces that a user would take: not where meshes are coarse on purpose."""
    numerics = dict(spec.numerics)
    study = numerics.get("levels", 3) < 3 or numerics.get("degree", 4) < 4
    return spec.problem in TRACED and not study


def names(spec: Spec) -> list[str]:
    """What the verdicts on the traces of a solution will be called."""
    return [f"trace:{spec}"] if is_judged(spec) else []


def judge(spec: Spec, solutions: Solutions) -> list[Verdict]:
    """One verdict on all traces of a solution."""
    if not is_judged(spec):
        return []
    result = solutions.result(spec)
    found = [*_against_states(result), *_counts(result)]
    counts = [_missing(result, branch) for branch in result.branches]
    states = worst(
        f"trace:{spec}",
        f"points of the trace of {spec}, drawn at random, are the states solved for there, in every column",
        found,
        "states solved for",
    )
    if missing := [text for text in counts if text]:
        states.passed, states.detail = False, "; ".join([*missing, states.detail])
    return [states]


Found = tuple[str, str, Comparison]
"""Branch and column, where on it, and how it compares there."""


def worst(name: str, statement: str, found: list[Found], reference: str, sharp: float = SHARP) -> Verdict:
    """One verdict for many comparisons: all pass, and the numbers are the worst one's."""
    passed = bool(found) and all(item.passed(sharp) for *_, item in found)

    def far(item: Comparison) -> float:
        with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
            ratios = [np.float64(item.error.max()) / (item.bound.max() + 1e-300), item.bound.max() / sharp]
        return float("inf") if np.isnan(ratios).any() else max(ratios)

    verdict = Verdict(name, "trace", passed, statement, asked=sharp, reference=reference)
    if found:
        where, place, last = max(found, key=lambda item: far(item[2]))
        verdict.error, verdict.bound = float(last.error[0]), float(last.bound[0])
        verdict.uncertainty = float(last.uncertainty[0])
        verdict.reference_uncertainty = last.reference_uncertainty
        verdict.where, verdict.detail = f"{where}, {place}", f"{len(found)} numbers; scale {last.scale:.6g}"
    else:
        verdict.detail = "nothing could be judged"
    return verdict


# -- states --------------------------------------------------------------------------------------------------


def drawn_states(result: Result, branch: Branch) -> Iterator[tuple[int, State]]:
    """Index of each point drawn on a trace, and the state there."""
    for point in result.numerics.get("drawn", {}).get(branch.name, {}).get("points", []):
        at = {point["column"]: point["value"]}
        for state in result.states:
            if state.branch == branch.name and state.at == at and state.crossing == 1:
                yield point["index"], state
                break


def _missing(result: Result, branch: Branch) -> str:
    """What is wrong where a trace has fewer states than were to be drawn; empty where nothing is."""
    got, wanted = len(list(drawn_states(result, branch))), min(DRAWN, _inner(branch))
    left_out = result.numerics.get("drawn", {}).get(branch.name, {}).get("left_out", [])
    reasons = "; ".join(str(item["reason"]) for item in left_out[:2])
    return "" if got >= wanted else f"{branch.name}: {got} states for {wanted} points drawn ({reasons})"


def _inner(branch: Branch) -> int:
    """Points of a trace that can be drawn: not its ends, and none where nothing changes along it."""
    spans = [np.ptp(values) for values in _columns(branch).values() if np.isfinite(values).all()]
    return max(len(branch) - 2, 0) if max(spans, default=0.0) > 0 else 0


def _columns(branch: Branch) -> dict[str, np.ndarray]:
    return {name: np.asarray(v, float) for name, v in branch.columns.items() if name not in DESCRIBE}


def _against_states(result: Result) -> Iterator[Found]:
    for branch in result.branches:
        columns = _columns(branch)
        for i, state in drawn_states(result, branch):
            for name, values in columns.items():
                found = _at_point(branch, name, values, i, state)
                if found is not None:
                    yield f"{name} ({branch.name})", f"point {i}", found


def _at_point(branch: Branch, name: str, values: np.ndarray, i: int, state: State) -> Comparison | None:
    """A column at a point against the state's; ``None`` where neither has a number for it."""
    quantity = state.quantities.get(name)
    if quantity is None:
        # A column without a number there, such as one of an edge of contact before contact. A state that
        # is not judged for stability has no count.
        known = np.isfinite(values[i]) and not name.startswith("n_negative")
        return compare(values[i], np.nan, np.nan, np.nan, 1.0) if known else None
    spread = branch.uncertainty.get(name)
    own = 0.0 if quantity.uncertainty is None else float("nan") if spread is None else float(spread[i])
    other = quantity.uncertainty or 0.0
    size = size_of(values, 2 * float(np.hypot(own, other)))
    own = float(np.hypot(own, SOLVED * size))
    found = compare(values[i], own, quantity.value, other, size)
    return None if name in BLUNT and found.bound > SHARP and found.passed(np.inf) else found


def size_of(values: np.ndarray, bound: float) -> float:
    """Size of a column, or :data:`ZERO` for one that is zero all along, to what its bound tells."""
    size = float(np.nanmax(np.abs(values), initial=0.0))
    return max(size, SMALL) if size > 4 * bound else ZERO


# -- tables --------------------------------------------------------------------------------------------------


def names_of_curve(paper: int | str, curve: Curve, case: Case) -> list[str]:
    """What the verdict on the trace that a curve is drawn from will be called."""
    table = None if curve.at is not None or not is_judged(curve.of) else reference_of(paper, curve)
    return table_names(table, [] if table is None else _judged(table, curve, case))


def judge_curve(paper: int | str, curve: Curve, case: Case, solutions: Solutions) -> list[Verdict]:
    """Verdict on the trace that a curve is drawn from, against the curve's table."""
    if not names_of_curve(paper, curve, case):
        return []
    table = reference_of(paper, curve)
    names = [table.abscissa, *_judged(table, curve, case)]
    called = {name: curve.columns.get(name, name) for name in names}
    return against_table(solutions.branch(curve.of, curve.branch), table, called)


def _judged(table: Reference, curve: Curve, case: Case) -> list[str]:
    """Columns that a trace has, too: fronts of zones belong to states."""
    return [name for name in table.ordinates if name in asked_of(curve, case) and "_front_" not in name]


def table_names(table: Reference | None, columns: Iterable[str]) -> list[str]:
    """What the verdict on a trace against a table will be called; none where the table is too coarse."""
    if table is None or not any(len(_dense(table, name)) for name in columns):
        return []
    return [f"trace:{table.name}"]


def _dense(table: Reference, name: str) -> np.ndarray:
    """Rows, in rising order of the abscissa, after which the table interpolates a column sharply.

    None where fewer than the part :data:`DENSE` of them does.
    """
    rows, values = np.sort(table.columns[table.abscissa]), table.columns[name]
    if len(rows) < LEAST_ROWS or name in EXTREMES:
        return np.array([], int)
    _, slack = interpolated(table.columns[table.abscissa], values, (rows[:-1] + rows[1:]) / 2)
    known = 2 * np.hypot(SAFETY * slack, table.uncertainty[name])
    known[:ENDS] = known[-ENDS:] = np.inf
    resolved = np.flatnonzero(known <= RESOLVED * np.max(np.abs(values)))
    return resolved if len(resolved) >= DENSE * len(known) else resolved[:0]


def against_table(branch: Branch, table: Reference, called: Mapping[str, str]) -> list[Verdict]:
    """Verdict on points of a trace where a table is dense and the abscissa is met for the first time.

    Args:
        branch: The trace.
        table: Over one of its columns.
        called: The trace's column for each of the table's that are judged, and for its abscissa.
    """
    judged = [name for name in table.ordinates if name in called]
    if not table_names(table, judged):
        return []
    rows = np.sort(table.columns[table.abscissa])
    along = np.asarray(branch.columns[called[table.abscissa]], float)
    highest, lowest = np.maximum.accumulate(along), np.minimum.accumulate(along)
    first = np.r_[True, (along[1:] > highest[:-1]) | (along[1:] < lowest[:-1])]
    inside = first & (along >= rows[0]) & (along < rows[-1])
    interval = np.where(inside, np.searchsorted(rows, along, "right") - 1, -1)
    found = []
    for name in judged:
        here = np.flatnonzero(np.isin(interval, _dense(table, name)))
        expected, slack = interpolated(table.columns[table.abscissa], table.columns[name], along[here])
        values, own = _with_spread(branch, called[name], called[table.abscissa], here)
        known = np.hypot(SAFETY * slack, table.uncertainty[name])
        size = float(np.max(np.abs(table.columns[name])))
        for i, *numbers in zip(here, values, own, expected, known, strict=True):
            place = f"{table.abscissa} = {along[i]:.6g}"
            found.append((f"{name} ({branch.name})", place, compare(*numbers, size or 1.0)))
    statement = f"points of the trace between the rows of the table, over {table.abscissa}"
    return [worst(f"trace:{table.name}", statement, found, table.name)]


def _with_spread(branch: Branch, name: str, over: str, here: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A column at some points, and its uncertainty at a fixed value of the column it is looked at over."""
    y, x = np.asarray(branch.columns[name], float), np.asarray(branch.columns[over], float)
    none = np.full(len(y), np.nan)
    slope = np.gradient(y, x, edge_order=1)
    spread = np.hypot(branch.uncertainty.get(name, none), slope * branch.uncertainty.get(over, none))
    return y[here], spread[here]


# -- counts and kinks ----------------------------------------------------------------------------------------


def _counts(result: Result) -> Iterator[Found]:
    """Numbers of negative eigenvalues are whole, and not negative, at every point."""
    for branch in result.branches:
        for name, counts in _columns(branch).items():
            if name.startswith("n_negative"):
                off = np.max(np.abs(counts - np.round(counts)) + np.maximum(-counts, 0.0), initial=0.0)
                yield f"{name} ({branch.name})", "a count", compare(float(off), 0.0, 0.0, 0.0, 1.0)


def kinks(result: Result, branch: Branch) -> list[int]:
    """Points of a trace next to special points at which columns are not smooth."""
    columns, found = _columns(branch), []
    for point in result.special_points:
        if point.kind in KINKS and point.branch == branch.name:
            apart = [
                np.abs(columns[name] - value) / (np.ptp(columns[name]) or 1.0)
                for name, value in point.values.items()
                if name in columns and np.isfinite(columns[name]).all()
            ]
            if apart:
                found.append(int(np.argmin(np.max(apart, axis=0))))
    return found
