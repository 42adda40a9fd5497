r"""The one room in which statements about numbers are decided, each with uncertainties and a limit on them.

Two numbers *agree* when they differ by no more than twice their combined uncertainty
(:mod:`weakforms.verification.judging.bounds`) and that bound is sharper than the accuracy asked; ``zero`` and
``constant`` are special cases. An *inequality* (a sign, an order, a rise, a size) holds when its sides are
``CLEAR`` times their combined uncertainty apart, which is its limit on the uncertainty too. What is not a
number decides nothing: it fails, and so does a statement about nothing at all.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from weakforms.verification.judging.bounds import FACTOR, compare
from weakforms.verification.judging.numbers import Number, join, number, of_point, stack

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
    "same",
    "sides",
    "stack",
    "zero",
]

CLEAR = 10
"""By how many combined uncertainties the two sides of an inequality must be apart. Twice is what agreement
allows; five times more is left, so that no number can agree with the other side and be clear of it."""

ROUNDING = 400 * np.finfo(float).eps
"""What rounding leaves of an identity (9e-14 relative): a few hundred operations, each of half a unit."""

ORDER_SLACK = 0.25
"""How far below theory an observed order may lie: the next term of the error at the meshes used."""


SHOWN = 12
"""Findings told in full where a claim rests on many."""


class Finding(NamedTuple):
    """Whether a statement holds, and what was found, with numbers."""

    holds: bool
    detail: str


@dataclass(frozen=True)
class Stated:
    """What a word of size means: a number that somebody chose, with where it is from and why."""

    value: float
    word: str
    """The word or words, such as "nearly equal"."""
    reason: str
    """Source and reason, for the report."""


def agree(what: str, ours: Any, theirs: Any, asked: float, scale: Any = None) -> Finding:
    """Two numbers, or two arrays entry by entry, are the same.

    Args:
        what: What they are, for the report.
        ours: One side.
        theirs: The other.
        asked: The bound must be below this, relative to ``scale``.
        scale: What errors are relative to; by default the largest magnitude of the other side.
    """
    a, b = number(ours), number(theirs)
    if not _some(a, b):
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
    """A number, or every entry, is zero: within twice its uncertainty, and that is small beside ``scale``."""
    return agree(f"{what} = 0", found, 0.0, asked, scale)


def constant(what: str, found: Number, asked: float, scale: Any = None) -> Finding:
    """All entries are the same number, and there are at least two."""
    if found.value.size < 2:
        return Finding(False, f"{what}: {found.value.size} entries cannot differ")
    spread = Number(np.ptp(found.value), np.max(found.uncertainty))
    size = np.max(np.abs(found.value)) if scale is None else scale
    return agree(f"spread of {what} over {found.value.size} entries", spread, 0.0, asked, size)


def exact(what: str, found: Any, expected: Any, scale: float = 1.0) -> Finding:
    """What is the same but for rounding: nothing is approximated on either side."""
    gap = np.abs(np.asarray(found, float) - np.asarray(expected, float)) / scale
    if not gap.size:
        return Finding(False, f"{what}: there is nothing to compare")
    good = np.all(gap <= ROUNDING)
    return Finding(
        bool(good), f"{what}: off by {np.max(gap):.1e} on {gap.size} numbers, rounding {ROUNDING:.0e}"
    )


def positive(what: str, found: Any) -> Finding:
    """A number, or every entry, is above zero."""
    x = number(found)
    if not _some(x):
        return Finding(False, f"{what}: there are no numbers")
    i = np.argmin(np.where(np.isnan(x.uncertainty), -np.inf, x.value - CLEAR * x.uncertainty))
    worst = Number(x.value.flat[i], x.uncertainty.flat[i])
    detail = f"{what}: {_shown(worst)}" + (f", the least of {x.value.size}" if x.value.size > 1 else "")
    return Finding(bool(np.all(x.value > CLEAR * x.uncertainty)), detail)


def negative(what: str, found: Any) -> Finding:
    """A number, or every entry, is below zero."""
    holds, detail = positive(what, -number(found))
    return Finding(holds, f"minus {detail}")


def not_negative(what: str, found: Any, asked: float, scale: float) -> Finding:
    """No entry is below zero by more than twice its uncertainty, and that is small beside ``scale``.

    For what may touch zero, where a sign cannot be clear.
    """
    x = number(found)
    if not _some(x):
        return Finding(False, f"{what}: there are no numbers")
    wide = float(np.max(FACTOR * x.uncertainty)) / scale
    good = np.all(x.value >= -FACTOR * x.uncertainty) and wide <= asked
    return Finding(bool(good), f"{what}: at least {np.min(x.value):.3g}, bound {wide:.1e} of {scale:.3g}")


def rises(what: str, found: Number | Sequence[Any]) -> Finding:
    """Every entry is above the one before it, and there are at least two."""
    return _monotone(what, found, 1.0)


def falls(what: str, found: Number | Sequence[Any]) -> Finding:
    """Every entry is below the one before it, and there are at least two."""
    return _monotone(what, found, -1.0)


def less(what: str, *found: Any) -> Finding:
    """The numbers, in the order given, rise."""
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
    """Every entry is below a stated number."""
    holds, detail = positive(what, limit.value - number(found))
    return Finding(holds, _sized(what, number(found).value, "<", limit, np.max, detail))


def at_least(what: str, found: Any, limit: Stated) -> Finding:
    """Every entry is above a stated number."""
    holds, detail = positive(what, number(found) - limit.value)
    return Finding(holds, _sized(what, number(found).value, ">", limit, np.min, detail))


def _sized(what: str, values: np.ndarray, sign: str, limit: Stated, worst: Any, detail: str) -> str:
    if not values.size:
        return detail
    return f"{what}: {worst(values):.4g} {sign} {limit.value:g}, for “{limit.word}” ({limit.reason})"


def between(what: str, found: Any, low: Any, high: Any) -> Finding:
    """Every entry lies between two numbers, clear of both."""
    x = number(found)
    holds = positive(what, x - low).holds and positive(what, number(high) - x).holds
    ends = " to ".join(
        f"{v:.6g}" for v in sorted({float(np.min(v)) for v in (number(low).value, number(high).value)})
    )
    shown = ", ".join(f"{v:.6g}" for v in np.unique(x.value)[[0, -1]]) if x.value.size else "nothing"
    return Finding(holds, f"{what}: {shown} in {ends}")


def sides(values: Number, of: Any) -> tuple[np.ndarray, np.ndarray]:
    """Which entries lie clearly below a number, and which above it; those at it are on neither side."""
    apart = values - of
    clear = CLEAR * apart.uncertainty
    return apart.value < -clear, apart.value > clear


def order(
    what: str, cells: Sequence[float], errors: Any, expected: float, slack: float = ORDER_SLACK
) -> Finding:
    """Errors fall with refinement at the expected rate or faster, by the finest two meshes that show it.

    An error that its own uncertainty could explain by more than a tenth shows no rate: finer meshes than the
    last one above that are left out. Two must remain.
    """
    found = abs(number(errors))
    if found.value.ndim != 1 or len(cells) != found.value.size:
        return Finding(False, f"{what}: {found.value.size} errors on {len(cells)} meshes show no order")
    shown = f"{what}: errors " + ", ".join(f"{e:.1e}" for e in found.value)
    count = int(np.argmin([*(found.value >= CLEAR * found.uncertainty), False]))
    if count < 2:
        return Finding(
            False, f"{shown}, of which {count} can be told from the uncertainty of what they are against"
        )
    logs = found[count - 2 : count].log()
    rate = float((logs[0] - logs[1]).value / np.log(cells[count - 1] / cells[count - 2]))
    good = rate >= expected - slack
    return Finding(
        good, f"{shown}; observed {rate:.2f} from {cells[count - 2]:g} to {cells[count - 1]:g} cells"
    )


def mean_order(what: str, cells: Sequence[float], errors: Any, expected: float) -> Finding:
    """Errors fall at the expected rate or faster on the mean over all meshes, where they scatter about it.

    Every error must be ten times its uncertainty.
    """
    found = abs(number(errors))
    if found.value.ndim != 1 or len(found) < 3 or len(cells) != len(found):
        return Finding(False, f"{what}: {found.value.size} errors on {len(cells)} meshes show no mean order")
    shown = ", ".join(f"{e:.1e}" for e in found.value)
    if not np.all(found.value >= CLEAR * found.uncertainty):
        return Finding(False, f"{what}: errors {shown} cannot be told from their uncertainty")
    rate = -float(np.polyfit(np.log(cells), np.log(found.value), 1)[0])
    return Finding(rate >= expected - ORDER_SLACK, f"{what}: errors {shown}; mean order {rate:.2f}")


def same(what: str, found: Any, expected: Any) -> Finding:
    """A count, a list of counts or a pattern is exactly what it should be; an empty list shows nothing."""
    sized = hasattr(expected, "__len__")
    good = found == expected and (not sized or len(expected) > 0)
    said = f"{what}: {found}" if good else f"{what}: {found}, expected {expected}"
    return Finding(bool(good), said)


def every(what: str, found: Any) -> Finding:
    """A condition on counts or patterns holds at every one of some places, and there are some."""
    mask = np.asarray(list(found) if not isinstance(found, np.ndarray) else found)
    good = mask.dtype == bool and mask.size > 0 and mask.all()
    return Finding(bool(good), f"{what}: {int(np.sum(mask == True))} of {mask.size}")  # noqa: E712


def all_of(*findings: Finding | Iterable[Finding]) -> Finding:
    """All statements hold, and there is one at least."""
    flat = [f for item in findings for f in ([item] if isinstance(item, Finding) else item)]
    if not flat:
        return Finding(False, "nothing was found")
    failed = [f"FAILS: {f.detail}" for f in flat if not f.holds]
    said = failed or [f.detail for f in flat]
    more = [f"and {len(said) - SHOWN} more"] if len(said) > SHOWN else []
    return Finding(not failed, "; ".join([*said[:SHOWN], *more]))


def _some(*numbers: Number) -> bool:
    return all(x.value.size for x in numbers)


def _shown(x: Number) -> str:
    return f"{float(x.value):.6g} (uncertainty {float(x.uncertainty):.0e})"
