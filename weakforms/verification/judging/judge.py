"""Checks of a case that are not curves: what they need solved, and their verdicts."""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from weakforms.results import SpecialPoint
from weakforms.verification.cases import references
from weakforms.verification.cases.case import Check, Claim, Constant, Count, Order, Points, States
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging import decide
from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.numbers import Number, stack
from weakforms.verification.judging.outcome import Convergence, Printed, Verdict
from weakforms.verification.run.solutions import Solutions

Wanted = tuple[Spec, At | None]
Judged = tuple[list[Verdict], list[Printed], list[Convergence]]


@singledispatch
def wants(check: Check, paper: int) -> list[Wanted]:
    """Solutions and states a check needs."""
    raise TypeError(type(check))


@singledispatch
def judge(check: Check, paper: int, solutions: Solutions) -> Judged:
    """Verdicts, ledger entries and convergence histories of a check."""
    raise TypeError(type(check))


@singledispatch
def names(check: Check, paper: int) -> list[str]:
    """What the verdicts of a check will be called, known before anything is solved."""
    raise TypeError(type(check))


@wants.register
def _(check: Count, paper: int) -> list[Wanted]:
    return [(spec, None) for spec in check.expected]


@names.register
def _(check: Count, paper: int) -> list[str]:
    return [f"count_{check.kind}:{spec}" for spec in check.expected]


@judge.register
def _(check: Count, paper: int, solutions: Solutions) -> Judged:
    verdicts = []
    for name, (spec, expected) in zip(names(check, paper), check.expected.items(), strict=True):
        found = len(solutions.points(spec, check.kind))
        verdicts.append(
            Verdict(
                check=name,
                kind="count",
                passed=found == expected,
                statement=f"{check.statement} ({spec})",
                detail=f"expected {expected}, found {found}",
            )
        )
    return verdicts, [], []


def _rows(check: Points, paper: int) -> list[tuple[Spec, int, int]]:
    """Spec, row of the table and index of the point for each row."""
    table = references.load(paper, check.reference)
    out = []
    for row in range(len(table)):
        if any(table.columns[name][row] != value for name, value in check.where.items()):
            continue
        given = {name: float(table.columns[name][row]) for name in check.parameters}
        order = int(table.columns["order"][row]) if "order" in table.columns else 1
        out.append((check.base.at(**given), row, order - 1))
    return out


@wants.register
def _(check: Points, paper: int) -> list[Wanted]:
    return [(spec, None) for spec, _, _ in _rows(check, paper)]


@names.register
def _(check: Points, paper: int) -> list[str]:
    rows = _rows(check, paper)
    return [
        _point_name(check, _label(check, spec, index), name)
        for spec, _, index in rows
        for name in check.asked
    ]


def _label(check: Points, spec: Spec, index: int) -> str:
    return f"{spec}[{', '.join([f'{k}={v:g}' for k, v in check.where.items()] + [str(index + 1)])}]"


def _point_name(check: Points | States, label: str, name: str) -> str:
    return f"{check.reference}:{label}:{name}"


@judge.register
def _(check: Points, paper: int, solutions: Solutions) -> Judged:
    table = references.load(paper, check.reference)
    verdicts = []
    for spec, row, index in _rows(check, paper):
        points, label = _selected(check, solutions.points(spec, check.kind)), _label(check, spec, index)
        for name in check.asked:
            if index < len(points):
                verdicts.append(_point_verdict(check, table, points[index], label, name, row))
            else:
                verdicts.append(_missing(check, label, name, len(points)))
    return verdicts, [], []


def _selected(check: Points, points: list[SpecialPoint]) -> list[SpecialPoint]:
    """The points that have the values the check is for (such as a wave number)."""
    here = [p for p in points if check.branch in ("", p.branch)]
    return [p for p in here if all(p.values.get(k, v) == v for k, v in check.where.items())]


def _missing(check: Points, label: str, name: str, found: int) -> Verdict:
    return Verdict(
        check=_point_name(check, label, name),
        kind="point",
        passed=False,
        statement=f"{name} of {check.kind} of {label}",
        detail=f"not there: the branch has {found}",
        reference=check.reference,
    )


def _point_verdict(
    check: Points | States,
    table: references.Reference,
    point: SpecialPoint,
    label: str,
    name: str,
    row: int,
) -> Verdict:
    asked = check.asked[name]
    value = table.columns[name][row]
    found = compare(point.values[name], point.uncertainty[name], value, table.uncertainty[name])
    return Verdict(
        check=_point_name(check, label, name),
        kind="point",
        passed=found.passed(asked),
        statement=f"{name} of {point.kind} of {label}",
        detail=f"computed {point.values[name]:.12g}, reference {value:.12g}",
        error=float(found.error[0]),
        bound=float(found.bound[0]),
        asked=asked,
        uncertainty=float(found.uncertainty[0]),
        reference_uncertainty=found.reference_uncertainty,
        reference=table.name,
    )


def _states(check: States, paper: int) -> list[tuple[Spec, int]]:
    table = references.load(paper, check.reference)
    return [
        (check.base.at(**{name: float(table.columns[name][row]) for name in check.parameters}), row)
        for row in range(len(table))
    ]


@wants.register
def _(check: States, paper: int) -> list[Wanted]:
    return [(spec, check.at) for spec, _ in _states(check, paper)]


@names.register
def _(check: States, paper: int) -> list[str]:
    return [_point_name(check, str(spec), name) for spec, _ in _states(check, paper) for name in check.asked]


@judge.register
def _(check: States, paper: int, solutions: Solutions) -> Judged:
    table = references.load(paper, check.reference)
    verdicts = []
    for spec, row in _states(check, paper):
        quantities = solutions.state(spec, check.at).quantities
        values = {name: quantities[name].value for name in check.asked}
        spread = {name: quantities[name].uncertainty for name in check.asked}
        point = SpecialPoint(f"state at {check.at}", check.at.branch, "", values, spread)
        verdicts += [_point_verdict(check, table, point, str(spec), name, row) for name in check.asked]
    return verdicts, [], []


@wants.register
def _(check: Claim, paper: int) -> list[Wanted]:
    return list(check.wants)


@names.register
def _(check: Claim, paper: int) -> list[str]:
    return [f"claim:{check.name}"]


@judge.register
def _(check: Claim, paper: int, solutions: Solutions) -> Judged:
    holds, detail = check.holds(solutions)
    (name,) = names(check, paper)
    verdict = Verdict(
        check=name,
        kind="claim",
        passed=bool(holds),
        statement=check.statement,
        detail=detail,
        differs=check.differs,
    )
    return [verdict], [], []


@wants.register
def _(check: Constant, paper: int) -> list[Wanted]:
    return [(check.of, check.at)]


@names.register
def _(check: Constant, paper: int) -> list[str]:
    return [f"constant:{check.column}:{check.of}:{check.at}"]


@judge.register
def _(check: Constant, paper: int, solutions: Solutions) -> Judged:
    found = solutions.column(check.of, check.at, check.column)
    decided = decide.constant(check.column, found, check.asked)
    scale = float(np.max(np.abs(found.value)))
    bound = float(2 * np.max(found.uncertainty)) / scale
    (name,) = names(check, paper)
    verdict = Verdict(
        check=name,
        kind="exact",
        passed=decided.holds,
        statement=check.statement,
        detail=f"spread over {len(found)} points, relative to {scale:.6g}",
        error=float(np.ptp(found.value)) / scale,
        bound=bound,
        asked=check.asked,
        uncertainty=bound / 2,
        reference_uncertainty=0.0,
        reference="exact first integral",
    )
    return [verdict], [], []


def _on(check: Order, degree: int, cells: int) -> Spec:
    return check.of.on(degree=degree, cells=cells, levels=2)


@wants.register
def _(check: Order, paper: int) -> list[Wanted]:
    at = _sampled_at(check, paper)
    return [(_on(check, d, n), at) for d in check.expected for n in check.cells]


def _sampled_at(check: Order, paper: int) -> At | None:
    """The state with its profile sampled where the table has rows."""
    if check.at is None:
        return None
    table = references.load(paper, check.reference)
    points = tuple(float(v) for v in table.columns[table.abscissa])
    return At(check.at.name, check.at.value, check.at.crossing, points)


@names.register
def _(check: Order, paper: int) -> list[str]:
    return [f"order:{check.quantity}:P{degree}" for degree in check.expected]


@judge.register
def _(check: Order, paper: int, solutions: Solutions) -> Judged:
    table = references.load(paper, check.reference)
    verdicts, histories = [], []
    for called, (degree, expected) in zip(names(check, paper), check.expected.items(), strict=True):
        at = _sampled_at(check, paper)
        errors = stack(_error(check, table, _on(check, degree, n), at, solutions) for n in check.cells)
        name = f"{check.quantity}, P{degree}"
        found = decide.order(name, check.cells, errors, expected)
        fine = -np.log(errors.value[-1] / errors.value[-2]) / np.log(check.cells[-1] / check.cells[-2])
        verdicts.append(
            Verdict(
                check=called,
                kind="order",
                passed=found.holds,
                statement=f"{name} converges at order {expected:g} or better",
                detail=found.detail,
                reference=table.name,
            )
        )
        histories.append(
            Convergence(
                quantity=check.quantity,
                degree=degree,
                cells=list(check.cells),
                errors=[float(e) for e in errors.value],
                observed_order=float(fine),
                expected_order=expected,
                against=f"reference table {table.name}",
            )
        )
    return verdicts, [], histories


def _error(
    check: Order, table: references.Reference, spec: Spec, at: At | None, solutions: Solutions
) -> Number:
    """Relative error on one mesh, as uncertain as the table: of a point, or the largest in a profile."""
    exact = table.number(check.column)
    if at is None:
        value = solutions.points(spec, check.kind)[check.row].values[check.column]
        return abs(value - exact[check.row]) * (1 / abs(exact.value[check.row]))
    values, _ = solutions.sampled(spec, at, check.column)
    return abs(values - exact).largest() * (1 / np.max(np.abs(exact.value)))
