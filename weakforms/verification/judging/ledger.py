"""The ledger: numbers printed in the papers, reproduced to all digits, or what else they are shown to be."""

from __future__ import annotations

import math
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, Decimal

from weakforms.verification.cases.case import (
    CutOff,
    OnGrid,
    PrintedExact,
    PrintedInput,
    PrintedState,
    Reading,
)
from weakforms.verification.cases.case import Printed as PrintedCheck
from weakforms.verification.judging.judge import Judged, Wanted, judge, names, wants
from weakforms.verification.judging.outcome import Printed, Verdict
from weakforms.verification.run.solutions import Solutions

PROVEN = 10
"""How many times an uncertainty must fit into what it decides on (half a printed digit, the distance within
which an input counts as decoded) before anything but "reproduced" is said: less than a tenth of a distance
is left to chance then, and no wide bar proves a misprint."""


def _number(check: PrintedCheck | PrintedExact, paper: int, value: float, spread: float, why: str) -> Judged:
    """Entry and verdict of a printed number beside a computed one."""
    stated, reading = check.printed, check.reading
    status = "reproduced" if rounds_to(value, spread, stated) else "not reproduced"
    if reading is not None:
        proven = status != "reproduced" and shows(reading, value, spread, stated)
        status = reading.status if proven else f"{reading.status}, not proven"
    (name,) = names(check, paper)
    evidence = "; ".join(filter(None, (why, "" if reading is None else _explained(reading))))
    verdict = Verdict(
        check=name,
        kind="printed",
        passed=status == ("reproduced" if reading is None else reading.status),
        statement=f"{check.what} is printed as {stated} ({check.source})"
        + ("" if reading is None else f": {reading.status}"),
        detail=evidence,
    )
    return [verdict], [Printed(check.what, stated, value, spread, status, evidence, check.source)], []


def _explained(reading: Reading) -> str:
    """A reading in words."""
    if isinstance(reading, CutOff):
        return "the digits are cut off, not rounded"
    if isinstance(reading, OnGrid):
        side = "above" if reading.upwards else "below"
        return f"printed is a value of a grid of {reading.step}; the number is less than a step {side} it"
    return f"should be {reading.correct}: {reading.why}"


def shows(reading: Reading, value: float, uncertainty: float, printed: str) -> bool:
    """Whether a number anywhere within its uncertainty proves how a printed one came about.

    Its uncertainty must be ``PROVEN`` times smaller than half a unit of the last printed digit.
    """
    unit = Decimal(printed)
    half = float(Decimal(1).scaleb(unit.as_tuple().exponent)) / 2
    if not (math.isfinite(value) and 0 <= uncertainty <= half / PROVEN):
        return False
    ends = _ends(value, uncertainty)
    if isinstance(reading, CutOff):
        return all(end.quantize(unit, rounding=ROUND_DOWN) == unit for end in ends)
    if isinstance(reading, OnGrid):
        step = Decimal(reading.step)
        away = [(end - unit) if reading.upwards else (unit - end) for end in ends]
        return unit % step == 0 and all(0 < distance < step for distance in away)
    return rounds_to(value, uncertainty, reading.correct)


def rounds_to(value: float, uncertainty: float, printed: str) -> bool:
    """Whether a number, anywhere within its uncertainty, rounds to all printed digits."""
    unit = Decimal(printed)
    if not (abs(value) + uncertainty < 1e9 and uncertainty >= 0):  # nor does anything that is not a number
        return False
    return all(end.quantize(unit, rounding=ROUND_HALF_EVEN) == unit for end in _ends(value, uncertainty))


def _ends(value: float, uncertainty: float) -> list[Decimal]:
    """Both ends of where a number may lie."""
    return [Decimal(end) for end in (value - uncertainty, value + uncertainty)]


@wants.register
def _(check: PrintedCheck, paper: int) -> list[Wanted]:
    return [(check.of, None)]


@names.register
def _(check: PrintedCheck, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedCheck, paper: int, solutions: Solutions) -> Judged:
    points = solutions.points(check.of, check.kind)
    if check.index >= len(points):
        (name,) = names(check, paper)
        said = f"{check.what} is printed as {check.printed}"
        return [Verdict(name, "printed", False, said, f"there is no such {check.kind}")], [], []
    point = points[check.index]
    value, spread = point.values[check.column], point.uncertainty[check.column]
    return _number(check, paper, value, spread, f"computed {value:.10g} with uncertainty {spread:.1e}")


@wants.register
def _(check: PrintedExact, paper: int) -> list[Wanted]:
    return []


@names.register
def _(check: PrintedExact, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedExact, paper: int, solutions: Solutions) -> Judged:
    return _number(check, paper, check.exact, 0.0, check.evidence)


@wants.register
def _(check: PrintedInput, paper: int) -> list[Wanted]:
    return [(check.of, check.at)]


@names.register
def _(check: PrintedInput, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedInput, paper: int, solutions: Solutions) -> Judged:
    found = solutions.quantity(check.of, check.at, check.column)
    status = decoding(found.value, found.uncertainty, check.searched, check.within)
    near = min(check.searched, key=lambda value: abs(found.value - value))
    low, high = check.searched[0], check.searched[-1]
    where = f"{low:g}" if low == high else f"{len(check.searched)} round values from {low:g} to {high:g}"
    evidence = (
        f"implies {check.column} = {found.value:.6g}, {100 * (found.value / near - 1):+.2g} % from {near:g}; "
        f"searched: {where}, each within {100 * check.within:g} %"
    )
    (name,) = names(check, paper)
    verdict = Verdict(
        check=name,
        kind="printed",
        passed=status == ("input, decoded" if check.decoded else "input, not decoded"),
        statement=f"{check.what}, printed as {check.printed} ({check.source}), is "
        + ("" if check.decoded else "not ")
        + f"the value at a round {check.column}",
        detail=evidence,
    )
    entry = Printed(check.what, check.printed, found.value, found.uncertainty, status, evidence, check.source)
    return [verdict], [entry], []


def decoding(value: float, uncertainty: float, searched: tuple[float, ...], within: float) -> str:
    """Whether an input is one of the round values searched, none of them, or was not searched for at all.

    It is none of them only between two that were searched; and nothing is said of a number whose uncertainty
    is not ``PROVEN`` times smaller than the distance within which a round value counts.
    """
    near = min(searched, key=lambda known: abs(value - known))
    distance = within * abs(near)
    if not 0 <= uncertainty <= distance / PROVEN:
        return "input, not judged"
    if abs(value - near) + uncertainty <= distance:
        return "input, decoded"
    between = searched[0] < value < searched[-1] and abs(value - near) - uncertainty > distance
    return "input, not decoded" if between else "input, not judged"


@wants.register
def _(check: PrintedState, paper: int) -> list[Wanted]:
    return [(check.of, check.at)]


@names.register
def _(check: PrintedState, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedState, paper: int, solutions: Solutions) -> Judged:
    values = solutions.state(check.of, check.at).quantities
    found, negative = values[check.column], values["n_negative"].value
    there = rounds_to(found.value, found.uncertainty, check.printed)
    placed = there and negative == check.n_negative
    evidence = f"on the {check.at.branch} branch with {negative:g} negative eigenvalues: " + ", ".join(
        f"{name} = {values[name].value:.6g}" for name in check.shown
    )
    status = "input, placed" if placed else "input, not placed"
    (name,) = names(check, paper)
    verdict = Verdict(
        check=name,
        kind="printed",
        passed=placed,
        statement=f"there is a state with {check.what} {check.printed} ({check.source}) on the "
        f"{check.at.branch} branch with {check.n_negative} negative eigenvalues",
        detail=evidence,
    )
    entry = Printed(check.what, check.printed, found.value, found.uncertainty, status, evidence, check.source)
    return [verdict], [entry], []
