r"""Decides all statements about numbers, each with uncertainties and a limit on them.

Two numbers *agree* if they differ by at most twice their combined uncertainty
(:mod:`weakforms.verification.judging.bounds`) and this bound is smaller than the accuracy asked; ``zero`` and
``constant`` are special cases. An *inequality* (a sign, an order, a rise, a size) is true if its sides are
``CLEAR`` times their combined uncertainty apart, which also limits the uncertainty. A NaN makes a statement
false, and so does the absence of numbers.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np

from weakforms.verification.judging.bounds import FACTOR, compare
from weakforms.verification.judging.numbers import Number, join, number, of_point, stack, work

__all__ = [
    "Finding",
    "Number",
    "Stated",
    "agree",
    "all_of",
    "at_least",
    "at_most",
    "between",
    "constant",
    "every",
    "exact",
    "falls",
    "join",
    "less",
    "mean_order",
    "negative",
    "not_negative",
    "number",
    "of_point",
    "order",
    "positive",
    "rises",
    "runs",
    "same",
    "sides",
    "stack",
    "vanishing",
    "work",
    "zero",
]

CLEAR = 10
"""The two sides of an inequality must be this number of combined uncertainties apart. Agreement allows two;
the factor of five in between means that no number can both agree with the other side and differ from it."""

ROUNDING = 400 * np.finfo(float).eps
"""Rounding error of an identity (9e-14 relative): a few hundred operations, each of half a unit."""

ORDER_SLACK = 0.25
"""Largest deficit of an observed order, from the next term of the error on the meshes used."""


SHOWN = 12
"""Number of findings that are printed in full if a claim has many."""


class Finding(NamedTuple):
    """Whether a statement is true, and the numbers that were found."""

    holds: bool
    detail: str


@dataclass(frozen=True)
class Stated:
    """The meaning of a word of size, such as "small": a chosen number with its source and reason."""

    value: float
    word: str
    """The word or words, such as "nearly equal"."""
    reason: str
    """Source and reason, for the report."""


def agree(what: str, ours: Any, theirs: Any, asked: float, scale: Any = None) -> Finding:
    """Decide whether two numbers, or two arrays entry by entry, agree.

    Args:
        what: Name of the numbers, for the report.
        ours: One side.
        theirs: The other side.
        asked: The bound must be below this, relative to ``scale``.
        scale: Divisor of errors; by default the largest magnitude of the other side.
    """
    a, b = number(ours), number(theirs)
    if not _all_given(a, b):
        return Finding(False, f"{what}: there is nothing to compare")
    size = np.max(np.abs(b.value)) if scale is None else number(scale).value
    values, others = np.broadcast_arrays(a.value, b.value)
    spread = np.hypot(a.uncertainty, b.uncertainty)
    found = compare(values.ravel(), np.broadcast_to(spread, values.shape).ravel(), others.ravel(), 0.0, size)
    i = found.worst
    detail = f"{what}: off by {found.error[i]:.1e}, bound {found.bound[i]:.1e}"
    wide = float(np.max(found.bound))
    late = f" (a bound of {wide:.1e} where {asked:.0e} is asked)" if not wide <= asked else ""
    return Finding(bool(size > 0) and found.passed(asked), detail + late)


def zero(what: str, found: Any, asked: float, scale: Any = 1.0) -> Finding:
    """Decide whether every entry is zero within twice its uncertainty, small beside ``scale``."""
    return agree(f"{what} = 0", found, 0.0, asked, scale)


def constant(what: str, found: Number, asked: float, scale: Any = None) -> Finding:
    """Decide whether all entries, at least two, agree."""
    if found.value.size < 2:
        return Finding(False, f"{what}: {found.value.size} entries cannot differ")
    spread = Number(np.ptp(found.value), np.max(found.uncertainty))
    size = np.max(np.abs(found.value)) if scale is None else scale
    return agree(f"spread of {what} over {found.value.size} entries", spread, 0.0, asked, size)


def exact(what: str, found: Any, expected: Any, scale: float = 1.0) -> Finding:
    """Decide whether two sides without approximations are equal up to rounding."""
    gap = np.abs(np.asarray(found, float) - np.asarray(expected, float)) / scale
    if not gap.size:
        return Finding(False, f"{what}: there is nothing to compare")
    good = np.all(gap <= ROUNDING)
    return Finding(
        bool(good), f"{what}: off by {np.max(gap):.1g}, the worst of {gap.size}, rounding {ROUNDING:.0e}"
    )


def positive(what: str, found: Any) -> Finding:
    """Decide whether a number, or every entry, is above zero."""
    x = number(found)
    if not _all_given(x):
        return Finding(False, f"{what}: there are no numbers")
    i = np.argmin(np.where(np.isnan(x.uncertainty), -np.inf, x.value - CLEAR * x.uncertainty))
    worst = Number(x.value.flat[i], x.uncertainty.flat[i])
    detail = f"{what}: {_shown(worst)}" + (f", the least of {x.value.size}" if x.value.size > 1 else "")
    return Finding(bool(np.all(x.value > CLEAR * x.uncertainty)), detail)


def negative(what: str, found: Any) -> Finding:
    """Decide whether a number, or every entry, is below zero."""
    holds, detail = positive(what, -number(found))
    return Finding(holds, f"minus {detail}")


def not_negative(what: str, found: Any, asked: float, scale: float) -> Finding:
    """Decide whether no entry is below zero by more than twice its uncertainty, small beside ``scale``.

    This is for numbers that may be zero, whose sign is not definite.
    """
    x = number(found)
    if not _all_given(x):
        return Finding(False, f"{what}: there are no numbers")
    wide = float(np.max(FACTOR * x.uncertainty)) / scale
    good = np.all(x.value >= -FACTOR * x.uncertainty) and wide <= asked
    return Finding(bool(good), f"{what}: at least {np.min(x.value):.3g}, bound {wide:.1e} of {scale:.3g}")


def rises(what: str, found: Number | Sequence[Any]) -> Finding:
    """Decide whether every entry, of at least two, is above the one before it."""
    return _monotone(what, found, 1.0)


def falls(what: str, found: Number | Sequence[Any]) -> Finding:
    """Decide whether every entry, of at least two, is below the one before it."""
    return _monotone(what, found, -1.0)


def less(what: str, *found: Any) -> Finding:
    """Decide whether the numbers increase in the given order."""
    return rises(what, list(found))


def _monotone(what: str, found: Number | Sequence[Any], way: float) -> Finding:
    x = found if isinstance(found, Number) else stack(found)
    if x.value.ndim != 1 or len(x) < 2:
        return Finding(False, f"{what}: {x.value.size} numbers have no order")
    holds, _ = positive(what, way * x.diff())
    sign = " < " if way > 0 else " > "
    if len(x) <= 6:
        return Finding(holds, f"{what}: " + sign.join(f"{v:.6g}" for v in x.value))
    least = np.min(way * np.diff(x.value))
    return Finding(holds, f"{what}: {x.value[0]:.6g}{sign}...{sign}{x.value[-1]:.6g}, least step {least:.1e}")


def at_most(what: str, found: Any, limit: Stated) -> Finding:
    """Decide whether every entry is below a stated number."""
    holds, detail = positive(what, limit.value - number(found))
    return Finding(holds, _sized(what, number(found).value, "<", limit, np.max, detail))


def at_least(what: str, found: Any, limit: Stated) -> Finding:
    """Decide whether every entry is above a stated number."""
    holds, detail = positive(what, number(found) - limit.value)
    return Finding(holds, _sized(what, number(found).value, ">", limit, np.min, detail))


def _sized(what: str, values: np.ndarray, sign: str, limit: Stated, worst: Any, detail: str) -> str:
    if not values.size:
        return detail
    return f"{what}: {worst(values):.4g} {sign} {limit.value:g}, for “{limit.word}” ({limit.reason})"


def between(what: str, found: Any, low: Any, high: Any) -> Finding:
    """Decide whether every entry lies clearly between two numbers."""
    x = number(found)
    holds = positive(what, x - low).holds and positive(what, number(high) - x).holds
    ends = " to ".join(
        f"{v:.6g}" for v in sorted({float(np.min(v)) for v in (number(low).value, number(high).value)})
    )
    shown = ", ".join(f"{v:.6g}" for v in np.unique(x.value)[[0, -1]]) if x.value.size else "nothing"
    return Finding(holds, f"{what}: {shown} in {ends}")


def sides(values: Number, of: Any) -> tuple[np.ndarray, np.ndarray]:
    """Entries that lie clearly below a number, and entries clearly above it; others are in neither."""
    apart = values - of
    clear = CLEAR * apart.uncertainty
    return apart.value < -clear, apart.value > clear


def order(
    what: str, cells: Sequence[float], errors: Any, expected: float, slack: float = ORDER_SLACK
) -> Finding:
    """Decide whether errors decrease at the expected rate or faster, by the finest two useful meshes.

    An error whose uncertainty is more than a tenth of it shows no rate. Meshes finer than the last one above
    this limit are left out, and two must remain.
    """
    found = abs(number(errors))
    if found.value.ndim != 1 or len(cells) != found.value.size:
        return Finding(False, f"{what}: {found.value.size} errors on {len(cells)} meshes show no order")
    shown = f"{what}: errors " + ", ".join(f"{e:.1e}" for e in found.value)
    count = int(np.argmin([*(found.value >= CLEAR * found.uncertainty), False]))
    if count < 2:
        return Finding(False, f"{shown}, of which {count} exceed the uncertainty of the reference")
    logs = found[count - 2 : count].log()
    rate = float((logs[0] - logs[1]).value / np.log(cells[count - 1] / cells[count - 2]))
    good = rate >= expected - slack
    return Finding(
        good, f"{shown}; observed {rate:.2f} from {cells[count - 2]:g} to {cells[count - 1]:g} cells"
    )


def mean_order(what: str, cells: Sequence[float], errors: Any, expected: float) -> Finding:
    """Decide whether errors that scatter decrease at the expected mean rate or faster.

    Every error must be ten times its uncertainty.
    """
    found = abs(number(errors))
    if found.value.ndim != 1 or len(found) < 3 or len(cells) != len(found):
        return Finding(False, f"{what}: {found.value.size} errors on {len(cells)} meshes show no mean order")
    shown = ", ".join(f"{e:.1e}" for e in found.value)
    if not np.all(found.value >= CLEAR * found.uncertainty):
        return Finding(False, f"{what}: errors {shown} do not exceed their uncertainty")
    rate = -float(np.polyfit(np.log(cells), np.log(found.value), 1)[0])
    return Finding(rate >= expected - ORDER_SLACK, f"{what}: errors {shown}; mean order {rate:.2f}")


def same(what: str, found: Any, expected: Any) -> Finding:
    """Decide whether a count, a list of counts or a pattern is as expected; an empty list is not."""
    sized = hasattr(expected, "__len__")
    good = found == expected and (not sized or len(expected) > 0)
    said = f"{what}: {found}" if good else f"{what}: {found}, expected {expected}"
    return Finding(bool(good), said)


def every(what: str, found: Any) -> Finding:
    """Decide whether a condition on counts or patterns is true for all of at least one item."""
    mask = np.asarray(list(found) if not isinstance(found, np.ndarray) else found)
    good = mask.dtype == bool and mask.size > 0 and mask.all()
    return Finding(bool(good), f"{what}: {int(np.sum(mask == True))} of {mask.size}")  # noqa: E712


def vanishing(values: Number, sizes: Any) -> Number:
    """The limit of a series in powers of a size as it vanishes; half of what the last term changes is added.

    Args:
        values: The series at the sizes.
        sizes: The sizes, the smallest one first.
    """

    def at_zero(x: np.ndarray) -> Number:
        weights = [np.prod([b / (b - a) for b in x if b != a]) for a in x]
        return sum(float(w) * values[i] for i, w in enumerate(weights))

    best, before = at_zero(np.asarray(sizes)), at_zero(np.asarray(sizes)[:-1])
    return Number(best.value, best.uncertainty + abs((best - before).value) / 2)


def all_of(*findings: Finding | Iterable[Finding]) -> Finding:
    """Combine statements: all are true, and there is at least one."""
    flat = [f for item in findings for f in ([item] if isinstance(item, Finding) else item)]
    if not flat:
        return Finding(False, "nothing was found")
    failed = [f"FAILS: {f.detail}" for f in flat if not f.holds]
    times = Counter(failed or [f.detail for f in flat])
    said = [text if count == 1 else f"{text} ({count} times)" for text, count in times.items()]
    more = [f"and {len(said) - SHOWN} more"] if len(said) > SHOWN else []
    return Finding(not failed, "; ".join([*said[:SHOWN], *more]))


def _all_given(*numbers: Number) -> bool:
    return all(x.value.size for x in numbers)


def _shown(x: Number) -> str:
    return f"{float(x.value):.6g} (uncertainty {float(x.uncertainty):.0e})"


def runs(numbers: Iterable[float]) -> list[int]:
    """Whole numbers along a branch, such as counts of negative eigenvalues, without repetition."""
    return [int(n) for n, _ in groupby(numbers)]
