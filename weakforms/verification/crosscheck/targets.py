"""What a curve is compared with: a table of a case, a solution at its own abscissae, or a stored result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from weakforms import api
from weakforms.errors import ConvergenceError, InputError, not_among
from weakforms.problems.registry import abouts
from weakforms.results import Branch, Result, State, load_result
from weakforms.verification.cases import references
from weakforms.verification.cases.discovery import FoundCase, find_cases, get_case
from weakforms.verification.cases.panels import Panel
from weakforms.verification.cases.references import Reference
from weakforms.verification.judging.checks.curve import Curve

Against = Mapping[str, Any] | Result | str | Path
"""Parameters at which a problem is solved, a result, or the file of one."""

NOT_COMPARED = ("residual", "iterations", "n_negative")
"""Columns that describe a solution and are no answer of another code."""


CLOSE = 0.02
"""Part of the mean distance of a branch's rows within which a requested state takes the place of a row."""


@dataclass(frozen=True)
class Target:
    """A table and what is known of it."""

    id: str
    """Id of the case, or name of the problem."""
    problem: str
    table: Reference
    asked: dict[str, float] = field(default_factory=dict)
    """Accuracy that the case asks of each column; empty for a solution."""
    panels: tuple[Panel, ...] = ()
    curves: tuple[Curve, ...] = ()
    """The curves of the case that have this table; none for a solution."""

    @property
    def parameters(self) -> dict[str, Any]:
        """Parameters of the solution that the table is for."""
        stated = dict(self.curves[0].of.parameters) if self.curves else {}
        return stated | {k: v for k, v in self.table.parameters.items() if not self.curves or k in stated}


def of_case(case: str, name: str | None) -> Target:
    """The table of a case.

    Raises:
        InputError: If the case is unknown, or has no table of that name.
    """
    found = get_case(case)
    chosen = choose(found, name)
    drawn = [(p, curve) for p in found.case.panels for curve in p.curves if curve.reference == chosen]
    curves = tuple(curve for _, curve in drawn)
    asked: dict[str, float] = {}
    for curve in curves:
        for column, value in curve.asked.items():
            asked[column] = min(value, asked.get(column, value))
    table = references.load_curve(found.paper, chosen)
    return Target(found.id, curves[0].of.problem, table, asked, tuple(panel for panel, _ in drawn), curves)


def of_solution(
    problem: str, parameters: Mapping[str, Any], over: str, x: np.ndarray, branch: str, crossing: int
) -> Target:
    """A problem solved at every abscissa of a curve, so that nothing is interpolated.

    Args:
        problem: Name of the problem.
        parameters: Those that differ from their defaults.
        over: Column whose values are prescribed.
        x: These values.
        branch: Branch on which the states lie.
        crossing: Which crossing of each value along the branch.

    Raises:
        InputError: For bad parameters, or an abscissa that the branch does not have.
        ConvergenceError: If a state did not converge.
        EnvironmentLackError: If DOLFINx is missing.
    """
    result = api.prepare(problem, parameters, {}, [(over, v) for v in x], crossing, branch)(None)
    if len(result.states) < len(x):
        reasons = [f"{f.what}: {f.reason}" for f in result.failures] + [a.reason for a in result.absent]
        raise ConvergenceError(
            f"{problem}: {len(result.states)} of {len(x)} states: {'; '.join(reasons)[:300]}"
        )
    columns: dict[str, np.ndarray] = {over: np.asarray(x, float)}
    uncertainty = {over: 0.0}
    for name in result.states[0].quantities:
        if name != over and name not in NOT_COMPARED:
            found = [state.quantities[name] for state in result.states]
            columns[name] = np.array([float(q.value) for q in found])
            uncertainty[name] = max(float(q.uncertainty or 0.0) for q in found)
    return _of_result(result, "solve", "a solution", over, columns, uncertainty)


def of_result(problem: str, result: Result | str | Path, over: str, branch: str) -> Target:
    """The branch of a stored result, over a column that rises or falls all along it.

    Its requested states are rows of the table too, so that nothing is interpolated at their abscissae.

    Raises:
        InputError: If the result is of another problem, or has no such branch or column.
    """
    name = "result" if isinstance(result, Result) else Path(result).name
    stored = result if isinstance(result, Result) else load_result(Path(result))
    if stored.problem != problem:
        raise InputError(f"{name} is a result of {stored.problem}, not of {problem}")
    try:
        of = stored.branch(branch)
    except KeyError as error:
        raise InputError(f"{name}: {error.args[0]}") from None
    if over not in of.columns:
        raise InputError(f"{name}: branch {branch} has no column {over!r}{not_among(over, of.columns)}")
    if not _never_turns(of.columns[over]):
        raise InputError(f"{name}: {over} turns along the branch; compare over {_abscissae(of)}")
    columns = {
        column: np.asarray(values, float)
        for column, values in of.columns.items()
        if column not in NOT_COMPARED and np.all(np.isfinite(np.asarray(values, float)))
    }
    uncertainty = {c: float(np.nanmax(of.uncertainty[c])) if c in of.uncertainty else 0.0 for c in columns}
    for state in stored.states:
        if state.branch == branch:
            _add(state, over, columns, uncertainty)
    return _of_result(stored, name.removesuffix(".json"), f"the result {name}", over, columns, uncertainty)


def _add(state: State, over: str, columns: dict[str, np.ndarray], uncertainty: dict[str, float]) -> None:
    """Add a state to a table, in place of a row that is so close that a spline would not bear both."""
    found = {column: state.quantities.get(column) for column in columns}
    if any(quantity is None for quantity in found.values()):
        return
    x, value = columns[over], float(found[over].value)
    apart = np.abs(x - value) > np.ptp(x) / len(x) * CLOSE
    place = int(np.sum((x < value) if x[0] < x[-1] else (x > value), where=apart))
    for column, quantity in found.items():
        columns[column] = np.insert(columns[column][apart], place, float(quantity.value))
        uncertainty[column] = max(uncertainty[column], float(quantity.uncertainty or 0.0))


def _of_result(
    result: Result,
    name: str,
    source: str,
    over: str,
    columns: dict[str, np.ndarray],
    uncertainty: dict[str, float],
) -> Target:
    shown = ", ".join(f"{k}={v}" for k, v in result.parameters.items() if isinstance(v, int | float | str))
    table = Reference(
        name=name,
        kind="weak form",
        source=f"{source} of {result.problem}({shown[:200]})",
        method="weak form on several meshes",
        abscissa=over,
        columns=columns,
        uncertainty=uncertainty,
        parameters=dict(result.parameters),
    )
    return Target(result.problem, result.problem, table)


def columns_of(problem: str) -> list[str]:
    """Names of the columns of a problem.

    Raises:
        InputError: If there is no such problem.
    """
    if problem not in abouts():
        raise InputError(f"{problem!r} is no problem{not_among(problem, abouts(), 'the problems are')}")
    return [column.name for column in abouts()[problem].columns]


def default_abscissa(problem: str, columns: Mapping[str, Any]) -> str:
    """The column over which a curve is compared if its author names none.

    This is the first column of the problem that the curve has and that rises or falls in every row, but not
    the control if another one does, because the control turns at limit points.

    Raises:
        InputError: If there is none.
    """
    about = abouts()[problem]
    known = [column.name for column in about.columns if not column.derived]
    found = [name for name in known if name in columns and _never_turns(columns[name])]
    control = about.control.partition(" ")[0]
    for name in [*(n for n in found if n != control), *found]:
        return name
    raise InputError(
        f"the curve has no column of {problem} that rises or falls in every row; "
        f"the columns of {problem} are {', '.join(known)}: name yours with --map, or the abscissa with --over"
    )


def _never_turns(values: Sequence[float]) -> bool:
    steps = np.diff(np.asarray(values, float))
    return bool(len(steps)) and bool(np.all(steps > 0) or np.all(steps < 0))


def _abscissae(branch: Branch) -> str:
    steady = [n for n, values in branch.columns.items() if n not in NOT_COMPARED and _never_turns(values)]
    return ", ".join(steady) or "none of its columns, all of which turn"


def tables_of(found: FoundCase) -> list[str]:
    """Tables of a case that a curve can be compared with."""
    curves = [curve for panel in found.case.panels for curve in panel.curves]
    return list(dict.fromkeys(curve.reference for curve in curves if curve.reference is not None))


def comparable(group: str) -> list[str]:
    """Cases of a paper, or of another group, that have such a table."""
    return [found.id for found in find_cases() if found.group == group and tables_of(found)]


def choose(found: FoundCase, name: str | None) -> str:
    """The table of a case, by name if there are several.

    Raises:
        InputError: If the name is unknown, or missing where there are several.
    """
    names = tables_of(found)
    if not names:
        raise InputError(
            f"{found.id} has no table of a curve to compare with; cases that have one: "
            f"{', '.join(comparable(found.group)) or 'see weakforms list'}"
        )
    if name is None and len(names) == 1:
        return names[0]
    if name not in names:
        problem = f"unknown curve {name!r}" if name else "which curve?"
        raise InputError(f"{found.id}: {problem}; it has {', '.join(names)}")
    return name
