"""Which columns no check looks at: each is falsified in all stored solutions, and the cases judge again.

A column of a problem is multiplied by 1.01 and by -1 wherever a solution of the problem has it: in branches,
special points, states, fields. Nothing is solved. A column with which every check still passes is judged by
nothing.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from weakforms.results import Branch, Field, Quantity, Result
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.bounds import FACTOR
from weakforms.verification.judging.checks.check import Check
from weakforms.verification.judging.consistency.exempt import EXEMPT, EXEMPT_SIZE
from weakforms.verification.judging.consistency.identities import Identities
from weakforms.verification.judging.consistency.traces import Trace
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.plan import checks_of
from weakforms.verification.run.solutions import Solutions

FACTORS = (1.01, -1.0)

Judging = Callable[[Solutions], Iterable[Verdict]]


@dataclass(frozen=True)
class Missed:
    """A column that could be wrong in every solution of a problem without any check noticing."""

    problem: str
    column: str
    factor: float


def one_of(name: str) -> str:
    """A column's name without the wave number it is for: columns for any wave number are one column."""
    return re.sub(r"(?<=_n)\d+", "#", name)


def columns_of(result: Result) -> list[str]:
    """Everything a solution has numbers for; a column of a field is ``field:column``."""
    names: dict[str, None] = {}
    for branch in result.branches:
        names |= dict.fromkeys(branch.columns)
    for point in result.special_points:
        names |= dict.fromkeys(point.values)
    names |= dict.fromkeys(result.quantities)
    for state in result.states:
        names |= dict.fromkeys(state.quantities)
        for field in state.fields:
            coordinates = next(iter(field.columns))
            names |= dict.fromkeys(f"{field.name}:{c}" for c in field.columns if c != coordinates)
    return list(dict.fromkeys(map(one_of, names)))


def falsified(result: Result, name: str, factor: float) -> Result | None:
    """A solution with one column multiplied, or ``None`` if all its numbers are zero.

    A number counts as zero within twice its uncertainty. That it is zero is stated by identities and claims.
    """
    changed = [False]

    def times(value: np.ndarray | float, spread: np.ndarray | float | None) -> np.ndarray | float:
        zero = FACTOR * np.nan_to_num(np.asarray(0.0 if spread is None else spread, float))
        changed[0] |= bool(np.any(np.abs(np.nan_to_num(np.asarray(value, float))) > zero))
        return value * factor

    def quantities(of: Mapping[str, Quantity]) -> dict[str, Quantity]:
        return {
            k: replace(q, value=times(q.value, q.uncertainty)) if one_of(k) == name else q
            for k, q in of.items()
        }

    def columns(of: Mapping[str, Any], spread: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
        return {k: times(v, spread.get(k)) if one_of(prefix + k) == name else v for k, v in of.items()}

    def field(of: Field) -> Field:
        return Field(of.name, columns(of.columns, of.uncertainty, f"{of.name}:"), of.uncertainty)

    def branch(of: Branch) -> Branch:
        return Branch(of.name, of.control, columns(of.columns, of.uncertainty), of.uncertainty)

    out = replace(
        result,
        branches=[branch(item) for item in result.branches],
        special_points=[replace(p, values=columns(p.values, p.uncertainty)) for p in result.special_points],
        quantities=quantities(result.quantities),
        states=[
            replace(s, quantities=quantities(s.quantities), fields=tuple(map(field, s.fields)))
            for s in result.states
        ],
    )
    return out if changed[0] else None


def judgings(cases: Iterable[FoundCase], specs: Iterable[Spec]) -> list[Judging]:
    """All that judges some solutions: what must hold for each alone, then what each case says of any."""
    wanted = set(specs)
    own = [partial(_verdicts, of(spec), 0) for spec in specs for of in (Trace, Identities)]
    stated = [
        partial(_verdicts, check, found.paper)
        for found in cases
        for check in checks_of(found)
        if not isinstance(check, Trace | Identities)
        and any(spec in wanted for spec, _ in check.wants(found.paper))
    ]
    return [*own, *stated]


def _verdicts(check: Check, paper: int | str, solutions: Solutions) -> list[Verdict]:
    return [item for item in check.judge(paper, solutions) if isinstance(item, Verdict)]


def audit(
    cases: list[FoundCase], results: Mapping[Spec, Result], report: Callable[[str], None] = lambda _: None
) -> list[Missed]:
    """Falsify every column of every problem and say which were missed.

    Args:
        cases: That judge.
        results: Stored solutions of theirs.
        report: Told which problem is at hand.
    """
    missed = []
    for problem in dict.fromkeys(spec.problem for spec in results):
        report(problem)
        own = {spec: result for spec, result in results.items() if spec.problem == problem}
        sound = [one for one in judgings(cases, own) if _passes(one, Solutions(results))]
        names = dict.fromkeys(name for result in own.values() for name in columns_of(result))
        for name, factor in product(names, FACTORS):
            if name in EXEMPT or (factor > 0 and name in EXEMPT_SIZE):
                continue
            found = {spec: falsified(result, name, factor) for spec, result in own.items()}
            wrong = {spec: result for spec, result in found.items() if result is not None}
            solutions = Solutions({**results, **wrong})
            if wrong and all(_passes(one, solutions) for one in sound):
                missed.append(Missed(problem, name, factor))
    return missed


def _passes(one: Judging, solutions: Solutions) -> bool:
    """Whether all its verdicts pass; a check that breaks down is a failed one in a run, and here."""
    try:
        return all(verdict.passed for verdict in one(solutions))
    except Exception:
        return False
