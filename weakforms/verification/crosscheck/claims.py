"""The verdict on a column whose author claims no accuracy, and what may be claimed instead."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from weakforms.verification.crosscheck.rows import FAILED, FEWEST_ROWS, PASSED, JudgedColumn
from weakforms.verification.report.wording import scientific

LARGEST_ACCURACY = 0.1
"""Largest accuracy that a curve may claim; with a larger one nearly every curve would pass."""

SMALLEST_ACCURACY = float(np.finfo(float).eps)
"""Smallest accuracy that is proposed for a claim, if the curve differs from the table by less."""

ROUNDING = 1e-9
"""Relative distance from a number of one digit within which an accuracy is rounded up to the next one."""


def judge_unclaimed(judge: Callable[[float | None], JudgedColumn], asked: float | None) -> JudgedColumn:
    """Judge a column that claims no accuracy; what it reaches and may claim is said in ``claim``.

    A column passes if it does with what the case asks of our own code. If it is out of that bound, it is not
    judged if it would pass with an accuracy that may be claimed, and fails if there is none.

    Args:
        judge: The verdict on the column with an accuracy, or with ``None``, without one.
        asked: What the case asks of our own code; ``None`` for a column that no case judges.
    """
    found = judge(asked)
    if asked is not None and found.verdict.status != FAILED:
        return found
    least = smallest_claim(found)
    claim = None if least is None else _rounded_up(least)
    if claim is not None and judge(claim).verdict.status != PASSED:
        claim = None
    if asked is not None and claim is not None:
        found = judge(None)
    found.verdict.claim = _sentence(found, asked, least, claim)
    return found


def smallest_claim(judged: JudgedColumn) -> float | None:
    """The smallest accuracy with which a column of enough rows passes; ``None`` if none may be claimed.

    With it no row is out of its bound, and more than half of them are judged; with ``reached`` every row is.

    Args:
        judged: The column, with any accuracy.
    """
    known = np.sort(2 * judged.known)
    enough = max(min(FEWEST_ROWS, len(known)), len(known) // 2 + 1)
    beyond = np.max(np.abs(judged.error) - 2 * judged.known)
    least = float(np.max([beyond, known[enough - 1], SMALLEST_ACCURACY]))
    return least if least <= LARGEST_ACCURACY else None


def _rounded_up(accuracy: float) -> float:
    """The next accuracy of one digit."""
    size = 10.0 ** math.floor(math.log10(accuracy))
    digit = math.ceil(accuracy / size * (1 + ROUNDING))
    return min(float(f"{digit * size:.0e}"), LARGEST_ACCURACY)


def _sentence(judged: JudgedColumn, asked: float | None, least: float | None, claim: float | None) -> str:
    """What the curve reaches, and how to claim it or why it cannot be claimed."""
    rows, reached = len(judged.x), judged.verdict.reached
    text = "no accuracy is claimed"
    if asked is not None:
        text += f", and the curve does not reach the {scientific(asked)} asked of our own code: it"
    else:
        text += ": the curve"
    if claim is None:
        why = f"but a verdict needs {FEWEST_ROWS} rows"
        if least is None:
            why = f"and no more than {LARGEST_ACCURACY:g} may be claimed"
        return f"{text} reaches {scientific(reached)}, {why}"
    told = int(np.sum(2 * judged.known <= claim))
    text += f" reaches {scientific(reached if told == rows else least)}"
    if told < rows:
        text += f" in the {told} of {rows} rows where the table is certain enough"
    return f"{text}, which --accuracy {claim:.0e} claims"
