"""Is the trace that a user takes away right: its own points against states solved for there.

Curves are compared at states solved for at the rows of a table; the points of the trace itself come from the
continuation. They are held against states solved for at some of them, drawn at random
(:mod:`weakforms.results.drawing`), in every column, by the rule of all comparisons:
|difference| <= 2 sqrt(u_trace^2 + u_state^2), and that bound sharper than :data:`SHARP`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from weakforms.problems.registry import abouts
from weakforms.results import Branch, Result, State
from weakforms.results.drawing import DESCRIBE, nearest
from weakforms.results.model import COUNTS
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.bounds import Comparison, compare
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions

TRACED = {name for name, about in abouts().items() if about.is_traced}
"""Problems whose answers are traces with states on demand."""

DRAWN = 2
"""States solved for at points of each trace."""

SHARP = 1e-3
"""Bound, relative to the size of the column, that must be sharper: a tenth of an error of one percent."""

BLUNT = (
    *("traction_max", "traction_front", "kappa", "X_iso"),
    *("S_least", "X_least", "Y_least", "lam1_c", "f_w", "f_s", "n_all", "n_held", "n_A1"),
)
"""Columns that some states know less sharply: tractions and curvature at the edge of a patch that lets go,
the point where two nearly equal stretches cross, the least stress of a sheet and its place among the points
of quadrature, derivatives at a point, wrinkled areas, and counts beside a limit load, which coarse meshes
have elsewhere. There they are not judged, unless off by more than their wide bound."""

SOLVED = 1e-10
"""To what the two solves stop: the relative step of Newton's method, and the eigensolver's tolerance."""

ZERO = 10.0
"""Size taken for a column that is zero all along: its bound is sharper than 1e-2 in its own unit."""

SMALL = 0.02
"""Smallest size a column is taken to have: what is zero but for its discretisation is no larger."""

KINKS = ("contact_onset", "zone_opening", "zone_closing", "cusp_point")
"""Special points at which columns are not smooth."""


def is_study(spec: Spec) -> bool:
    """Whether meshes are coarse on purpose, as those of a study of convergence are."""
    numerics = dict(spec.numerics)
    return numerics.get("levels", 3) < 3 or numerics.get("degree", 4) < 4


def is_judged(spec: Spec) -> bool:
    """Whether a solution has traces that a user would take."""
    return spec.problem in TRACED and not is_study(spec)


@dataclass(frozen=True)
class Trace(Check):
    """Points of all traces of a solution, drawn at random, are the states solved for there."""

    of: Spec

    verdict_kind: ClassVar[str] = "trace"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The solution; it has the states drawn."""
        return [(self.of, None)]

    def names(self, paper: int | str) -> list[str]:
        """One for all traces; none where :func:`is_judged` says so."""
        return [f"trace:{self.of}"] if is_judged(self.of) else []

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Every column of every point drawn agrees with its state, and no drawn point is without one."""
        if not is_judged(self.of):
            return
        result = solutions.result(self.of)
        said = (
            f"points of the trace of {self.of}, drawn at random, are the states solved for there, "
            "in every column"
        )
        found = [*_against_states(result), *_counts(result)]
        verdict = worst(f"trace:{self.of}", said, found, "states solved for")
        if missing := [text for branch in result.branches if (text := _missing(result, branch))]:
            verdict.passed, verdict.detail = False, "; ".join([*missing, verdict.detail])
        yield verdict


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


# -- counts and kinks ----------------------------------------------------------------------------------------


def _counts(result: Result) -> Iterator[Found]:
    """Numbers of negative eigenvalues are whole, and not negative, at every point."""
    for branch in result.branches:
        for name, counts in _columns(branch).items():
            if name.startswith(COUNTS):
                off = np.max(np.abs(counts - np.round(counts)) + np.maximum(-counts, 0.0), initial=0.0)
                yield f"{name} ({branch.name})", "a count", compare(float(off), 0.0, 0.0, 0.0, 1.0)


def kinks(result: Result, branch: Branch) -> list[int]:
    """Points of a trace next to special points at which columns are not smooth."""
    points = [p for p in result.special_points if p.kind in KINKS and p.branch == branch.name]
    return [i for i, distance in (nearest(branch, point) for point in points) if np.isfinite(distance)]
