"""What must hold between the columns of one solution at any parameters: definitions, work, balances.

Tables hold most columns; what no table has is held here, on every stored solution. Each identity takes a
solution apart and puts two numbers beside each other that were computed in different ways, by the rule of all
comparisons; uncertainties are the solution's own and those of the quadrature (two degrees of splines).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from scipy.ndimage import maximum_filter1d

from weakforms.results import Branch, Result, SpecialPoint
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.bounds import Comparison, compare
from weakforms.verification.judging.checks.check import Check, Wanted
from weakforms.verification.judging.consistency import quadrature
from weakforms.verification.judging.consistency.traces import is_study, kinks, worst
from weakforms.verification.judging.decide import ROUNDING
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.solutions import Solutions

SHARP = 3e-3
"""Bound, relative to the number, that must be sharper: a third of an error of one percent."""

Found = tuple[str, str, Comparison]
"""What is compared, where, and how it compares there."""

Given = Mapping[str, Any]
"""Parameters of a spec, defaults left out."""


@dataclass(frozen=True)
class Identity:
    """A statement on columns of one solution."""

    name: str
    statement: str
    look: Callable[[Result], Iterator[Found]]
    over: Callable[[Given], bool] = lambda given: True
    """Parameters for which it is stated."""


# -- between the columns of a trace ----------------------------------------------------------------------


Columns = Mapping[str, np.ndarray]


def work(load: str, weight: Callable[[Result, Columns], np.ndarray], of: str = "Pi") -> Identity:
    r"""Work along a trace: :math:`\Delta\Pi = \int w\,\mathrm{d}\ell` over the load :math:`\ell`.

    Summed over the intervals between kinks; the spline's two degrees tell its uncertainty.
    """

    def look(result: Result) -> Iterator[Found]:
        for branch in result.branches:
            for part in smooth_parts(result, branch, load, of):
                columns = {name: np.asarray(v, float)[part] for name, v in branch.columns.items()}
                if len(columns[load]) < 6:
                    continue
                w = weight(result, columns)
                along = _along(columns[load], w)
                done, doubt = quadrature.work_by_interval(along, w, columns[load])
                change = np.diff(columns[of])
                # Two splines are close by accident in one interval, hardly in several that follow.
                doubt = maximum_filter1d(doubt, 5)
                clear = doubt <= SHARP / 8 * np.abs(done).sum() / len(done)
                if clear.any():
                    # Signs are taken out, lest rising and falling parts cancel.
                    sign = np.sign(done[clear])
                    spread = doubt[clear].sum() + 2 * _spread(branch, of, part)
                    size = float(np.abs(done[clear]).sum())
                    total = compare(np.sum(sign * change[clear]), spread, size, 0.0, size)
                    yield f"{of} ({branch.name})", f"{clear.sum()} of {len(clear)} steps", total

    return Identity("work", f"d{of} is the work done over {load}, all along the trace", look)


def slope(of: str, over: str, column: str) -> Identity:
    """A column is the derivative of another one over a third."""

    def look(result: Result) -> Iterator[Found]:
        for branch in result.branches:
            x, y, d = (np.asarray(branch.columns[name], float) for name in (over, of, column))
            fine, coarse = (spline(x, 1) for spline in quadrature.splines(x, y))
            none = np.full(len(x), np.nan)
            size = max(float(np.abs(d).max()), 1e-6)
            # Two splines are close by accident at one point, hardly at several that follow.
            doubt = maximum_filter1d(quadrature.SAFETY * np.abs(fine - coarse), 5)
            for i in range(2, len(x) - 2):
                found = compare(d[i], branch.uncertainty.get(column, none)[i], fine[i], doubt[i], size)
                yield f"{column} ({branch.name})", f"{over} = {x[i]:.6g}", found

    return Identity(column, f"{column} is the derivative of {of} over {over}", look)


def equal(name: str, statement: str, other: Callable[[Columns], np.ndarray]) -> Identity:
    """A column of a trace by the others in closed form."""

    def look(result: Result) -> Iterator[Found]:
        for branch in result.branches:
            columns = {key: np.asarray(v, float) for key, v in branch.columns.items()}
            here, there = columns[name], other(columns)
            i = int(np.argmax(np.abs(here - there)))
            size = float(np.abs(here).max()) or 1.0
            own = branch.uncertainty.get(name, np.full(len(here), np.nan))
            yield f"{name} ({branch.name})", f"point {i}", compare(here[i], own[i], there[i], own[i], size)

    return Identity(name, statement, look)


def positive(*columns: str) -> Identity:
    """Stretches and the like are positive."""

    def look(result: Result) -> Iterator[Found]:
        for branch in result.branches:
            for name in (n for n in columns if n in branch.columns):
                below = max(-float(np.nanmin(branch.columns[name])), 0.0)
                yield f"{name} ({branch.name})", "anywhere", compare(below, 0.0, 0.0, 0.0, 1.0)

    return Identity("positive", f"{', '.join(columns)} are positive", look)


def zero(*columns: str) -> Identity:
    """Numbers of a solution and of its states are zero within twice their uncertainty."""

    def look(result: Result) -> Iterator[Found]:
        everywhere = [("", result.quantities), *((state.branch, state.quantities) for state in result.states)]
        for where, quantities in everywhere:
            for name in (n for n in columns if n in quantities):
                known = quantities[name].uncertainty
                found = compare(quantities[name].value, np.nan if known is None else known, 0.0, 0.0, 1.0)
                yield name, where, found

    return Identity("zero", f"{', '.join(columns)}: zero", look)


def of_events(name: str, statement: str, other: Callable[[SpecialPoint], float | None]) -> Identity:
    """A number of special points by their others; ``None`` where the others do not tell it."""

    def look(result: Result) -> Iterator[Found]:
        for point in result.special_points:
            expected = other(point) if name in point.values else None
            if expected is not None:
                size = abs(expected) or 1.0
                yield name, point.kind, compare(point.values[name], 0.0, expected, ROUNDING * size, size)

    return Identity(f"{name} of special points", statement, look)


def total(name: str, statement: str, other: Callable[[Result], float | None]) -> Identity:
    """A number of a whole solution by its others."""

    def look(result: Result) -> Iterator[Found]:
        expected = other(result) if name in result.quantities else None
        if expected is not None:
            size = abs(expected) or 1.0
            found = result.quantities[name].value
            yield name, "", compare(found, 0.0, expected, ROUNDING * size, size)

    return Identity(f"{name} of the whole", statement, look)


def smooth_parts(result: Result, branch: Branch, *names: str) -> list[slice]:
    """Parts of a trace between kinks, long enough for a spline of degree 5."""
    edges = sorted({0, *(k + side for k in kinks(result, branch) for side in (-1, 2)), len(branch)})
    edges = [edge for edge in edges if 0 <= edge <= len(branch)]
    return [slice(a, b) for a, b in pairwise(edges) if b - a >= 6]


def _along(*columns: np.ndarray) -> np.ndarray:
    """Length along a trace in the plane of two columns."""
    steps = np.sqrt(sum((np.diff(c) / (np.ptp(c) or 1.0)) ** 2 for c in columns))
    return np.r_[0, np.cumsum(np.maximum(steps, 1e-12))]


def _spread(branch: Branch, name: str, part: slice) -> float:
    return float(np.max(branch.uncertainty.get(name, np.full(len(branch), np.nan))[part]))


def stable() -> Identity:
    """The lowest eigenvalue is positive where none is counted negative, and negative elsewhere."""

    def look(result: Result) -> Iterator[Found]:
        for state in result.states:
            lowest, count = state.quantities.get("eigenvalue_1"), state.quantities.get("n_negative")
            if lowest is None or count is None or lowest.value == 0:
                continue
            wrong = (lowest.value < -(lowest.uncertainty or 0.0) - 1e-6) != (count.value > 0)
            near = abs(lowest.value) <= 1e-6 + 2 * (lowest.uncertainty or 0.0)
            place = ", ".join(f"{k} = {v:.6g}" for k, v in state.at.items())
            yield "eigenvalue_1", place, compare(float(wrong and not near), 0.0, 0.0, 0.0, 1.0)

    return Identity("sign", "the lowest eigenvalue has the sign that the count of negative ones says", look)


# -- judging ------------------------------------------------------------------------------------------------


def stated(spec: Spec) -> list[Identity]:
    """Identities that a solution must meet."""
    from weakforms.verification.judging.consistency.identity_table import IDENTITIES

    if is_study(spec):
        return []
    given = dict(spec.parameters)
    return [identity for identity in IDENTITIES.get(spec.problem, ()) if identity.over(given)]


@dataclass(frozen=True)
class Identities(Check):
    """All that must hold between the columns of one solution."""

    of: Spec

    verdict_kind: ClassVar[str] = "trace"

    def wants(self, paper: int | str) -> list[Wanted]:
        """The solution."""
        return [(self.of, None)]

    def names(self, paper: int | str) -> list[str]:
        """One for all identities; none where none is stated."""
        return [f"identities:{self.of}"] if stated(self.of) else []

    def judge(self, paper: int | str, solutions: Solutions) -> Iterator[Verdict]:
        """Each identity holds; the numbers of the verdict are the worst one's."""
        identities = stated(self.of)
        if not identities:
            return
        result = solutions.result(self.of)
        found = [
            (f"{identity.name}: {what}", place, comparison)
            for identity in identities
            for what, place, comparison in identity.look(result)
        ]
        said = f"columns of {self.of} agree with one another: " + "; ".join(i.statement for i in identities)
        # Samples and splines do not resolve every state sharply. What they do not resolve is not judged, and
        # is counted, unless it is beyond even its wide bound.
        judged = [item for item in found if _sharp(item[2]) or not item[2].passed(np.inf)]
        verdict = worst(f"identities:{self.of}", said, judged, "identities", SHARP)
        if len(judged) < len(found):
            unresolved = len(found) - len(judged)
            verdict.detail += f"; {unresolved} of {len(found)} are not resolved sharply: not judged"
        yield verdict


def _sharp(comparison: Comparison) -> bool:
    return bool(np.all(comparison.bound <= SHARP))
