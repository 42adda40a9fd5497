"""Which columns of stored solutions no check would miss: each is falsified in turn, and cases judge again.

A column is multiplied by 1.01 and by -1 wherever a solution has it: branches, special points, states.
Nothing is solved. What then still passes is judged by nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from weakforms.results import Branch, Field, Quantity, Result
from weakforms.verification.cases.discovery import FoundCase
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.checks.check import Check
from weakforms.verification.judging.consistency.exempt import EXEMPT, EXEMPT_SIZE
from weakforms.verification.judging.consistency.identities import Identities
from weakforms.verification.judging.consistency.traces import Trace
from weakforms.verification.judging.outcome import Verdict
from weakforms.verification.run.plan import case_wants, checks_of
from weakforms.verification.run.solutions import Solutions

FACTORS = (1.01, -1.0)

Judging = Callable[[Solutions], Iterable[Verdict]]


@dataclass(frozen=True)
class Missed:
    """A column that could be wrong without any check of the cases noticing."""

    spec: str
    column: str
    factor: float


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
    return list(names)


def falsified(result: Result, name: str, factor: float) -> Result | None:
    """A solution with one column multiplied; ``None`` where that changes nothing."""
    changed = [False]

    def times(value: np.ndarray | float) -> np.ndarray | float:
        changed[0] |= bool(np.any(np.nan_to_num(np.asarray(value, float)) != 0))
        return value * factor

    def quantities(of: Mapping[str, Quantity]) -> dict[str, Quantity]:
        return {k: replace(q, value=times(q.value)) if k == name else q for k, q in of.items()}

    def field(of: Field) -> Field:
        columns = {k: times(v) if f"{of.name}:{k}" == name else v for k, v in of.columns.items()}
        return Field(of.name, columns, of.uncertainty)

    def branch(of: Branch) -> Branch:
        columns = {k: times(v) if k == name else v for k, v in of.columns.items()}
        return Branch(of.name, of.control, columns, of.uncertainty)

    out = replace(
        result,
        branches=[branch(item) for item in result.branches],
        special_points=[
            replace(p, values={k: times(v) if k == name else v for k, v in p.values.items()})
            for p in result.special_points
        ],
        quantities=quantities(result.quantities),
        states=[
            replace(s, quantities=quantities(s.quantities), fields=tuple(map(field, s.fields)))
            for s in result.states
        ],
    )
    return out if changed[0] else None


def judgings(cases: Iterable[FoundCase], spec: Spec) -> Iterator[Judging]:
    """All that judges a solution: what must hold for it alone first, then what each case says of it."""
    yield from (partial(_verdicts, of(spec), 0) for of in (Trace, Identities))
    for found in cases:
        for check in checks_of(found):
            own = isinstance(check, Trace | Identities)
            if not own and any(wanted == spec for wanted, _ in check.wants(found.paper)):
                yield partial(_verdicts, check, found.paper)


def _verdicts(check: Check, paper: int | str, solutions: Solutions) -> list[Verdict]:
    return [item for item in check.judge(paper, solutions) if isinstance(item, Verdict)]


def audit(
    cases: list[FoundCase], results: Mapping[Spec, Result], report: Callable[[str], None] = lambda _: None
) -> list[Missed]:
    """Falsify every column of every solution and say which were missed.

    Args:
        cases: That judge.
        results: Stored solutions of theirs.
        report: Told which solution is at hand.
    """
    missed = []
    users: dict[Spec, list[FoundCase]] = {}
    for found in cases:
        for spec in dict.fromkeys(spec for spec, _ in case_wants(found)):
            users.setdefault(spec, []).append(found)
    for spec, result in results.items():
        report(str(spec))
        sound = [one for one in judgings(users.get(spec, ()), spec) if _passes(one, Solutions(results))]
        for name in columns_of(result):
            for factor in FACTORS:
                if name in EXEMPT or (factor > 0 and name in EXEMPT_SIZE):
                    continue
                wrong = falsified(result, name, factor)
                if wrong is None:
                    continue
                solutions = Solutions({**results, spec: wrong})
                if all(_passes(one, solutions) for one in sound):
                    missed.append(Missed(str(spec), name, factor))
    return missed


def _passes(one: Judging, solutions: Solutions) -> bool:
    """Whether all its verdicts pass; what it cannot cope with has been noticed."""
    try:
        return all(verdict.passed for verdict in one(solutions))
    except Exception:
        return False
