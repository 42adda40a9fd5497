"""The ledger: numbers printed in the papers, reproduced to all their digits or shown to be misprints."""

from __future__ import annotations

from decimal import ROUND_HALF_EVEN, Decimal

from weakforms.verification.case import Printed as PrintedCheck
from weakforms.verification.case import PrintedExact, PrintedInput, PrintedState
from weakforms.verification.judge import Judged, Wanted, judge, names, wants
from weakforms.verification.outcome import Printed, Verdict
from weakforms.verification.solutions import Solutions


@wants.register
def _(check: PrintedCheck, paper: int) -> list[Wanted]:
    return [(check.of, None)]


@names.register
def _(check: PrintedCheck, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedCheck, paper: int, solutions: Solutions) -> Judged:
    points = solutions.points(check.of, check.kind)
    (name,) = names(check, paper)
    if check.index >= len(points):
        verdict = Verdict(
            check=name,
            kind="printed",
            passed=False,
            statement=f"{check.what} is printed as {check.printed}",
            detail=f"there is no such {check.kind}",
        )
        return [verdict], [], []
    point = points[check.index]
    value, uncertainty = point.values[check.column], point.uncertainty[check.column]
    reproduced = rounds_to(value, uncertainty, check.printed)
    evidence = f"computed {value:.10g} with uncertainty {uncertainty:.1e}"
    evidence += f": {check.misprint}" if check.misprint else ""
    entry = Printed(
        what=check.what,
        printed=check.printed,
        computed=value,
        uncertainty=uncertainty,
        status="reproduced" if reproduced else "misprint" if check.misprint else "not reproduced",
        evidence=evidence,
        source=check.source,
    )
    verdict = Verdict(
        check=name,
        kind="printed",
        passed=reproduced != bool(check.misprint),
        statement=f"{check.what} is printed as {check.printed} ({check.source})"
        + (", a misprint" if check.misprint else ""),
        detail=evidence,
    )
    return [verdict], [entry], []


@wants.register
def _(check: PrintedExact, paper: int) -> list[Wanted]:
    return []


@names.register
def _(check: PrintedExact, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedExact, paper: int, solutions: Solutions) -> Judged:
    reproduced = rounds_to(check.exact, 0.0, check.printed)
    status = "reproduced" if reproduced else "misprint" if check.misprint else "not reproduced"
    (name,) = names(check, paper)
    verdict = Verdict(
        check=name,
        kind="printed",
        passed=reproduced != check.misprint,
        statement=f"{check.what} is printed as {check.printed} ({check.source})"
        + (", a misprint" if check.misprint else ""),
        detail=check.evidence,
    )
    entry = Printed(check.what, check.printed, check.exact, 0.0, status, check.evidence, check.source)
    return [verdict], [entry], []


@wants.register
def _(check: PrintedInput, paper: int) -> list[Wanted]:
    return [(check.of, check.at)]


@names.register
def _(check: PrintedInput, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedInput, paper: int, solutions: Solutions) -> Judged:
    found = solutions.quantity(check.of, check.at, check.column)
    off = found.value / check.near - 1
    decoded = abs(off) <= check.within
    evidence = (
        f"implies {check.column} = {found.value:.6g}, {100 * off:+.2g} % from {check.near:g} "
        f"(decoded within {100 * check.within:g} %)"
    )
    status = "input, decoded" if decoded else "input, not decoded"
    (name,) = names(check, paper)
    verdict = Verdict(
        check=name,
        kind="printed",
        passed=decoded == check.decoded,
        statement=f"{check.what}, printed as {check.printed} ({check.source}), is "
        + ("" if check.decoded else "not ")
        + f"the value at a round {check.column}",
        detail=evidence,
    )
    entry = Printed(check.what, check.printed, found.value, found.uncertainty, status, evidence, check.source)
    return [verdict], [entry], []


@wants.register
def _(check: PrintedState, paper: int) -> list[Wanted]:
    return [(check.of, check.at)]


@names.register
def _(check: PrintedState, paper: int) -> list[str]:
    return [f"printed:{check.what}"]


@judge.register
def _(check: PrintedState, paper: int, solutions: Solutions) -> Judged:
    values = solutions.state(check.of, check.at).quantities
    found, negative = values[check.column], int(values["n_negative"].value)
    there = rounds_to(found.value, found.uncertainty, check.printed)
    placed = there and negative == check.n_negative
    evidence = f"on the {check.at.branch} branch with {negative} negative eigenvalues: " + ", ".join(
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


def rounds_to(value: float, uncertainty: float, printed: str) -> bool:
    """Whether a number, anywhere within its uncertainty, rounds to all printed digits."""
    unit = Decimal(printed)
    if not abs(value) + uncertainty < 1e9:  # nor does anything that is not a number
        return False
    return all(
        Decimal(end).quantize(unit, rounding=ROUND_HALF_EVEN) == unit
        for end in (value - uncertainty, value + uncertainty)
    )
