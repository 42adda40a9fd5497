"""Comparison of a curve of another code with a reference table: the cross-check that other packages call."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from weakforms.errors import InputError, not_among
from weakforms.results import CurveFile
from weakforms.verification.cases.references import Reference
from weakforms.verification.crosscheck.cause import causes, limits, trend
from weakforms.verification.crosscheck.claims import LARGEST_ACCURACY, judge_unclaimed
from weakforms.verification.crosscheck.columns import CurveLike, our_columns, read, require_same_parameters
from weakforms.verification.crosscheck.convergence import (
    RATIO,
    judge_convergence,
    require_meshes,
)
from weakforms.verification.crosscheck.pictures import picture
from weakforms.verification.crosscheck.rows import (
    FAILED,
    JudgedColumn,
    absent,
    judge_column,
    met,
    reached,
    tolerance,
)
from weakforms.verification.crosscheck.targets import (
    Against,
    Target,
    columns_of,
    default_abscissa,
    of_case,
    of_result,
    of_solution,
)
from weakforms.verification.crosscheck.units import abscissa_hint, forgotten
from weakforms.verification.crosscheck.verdicts import Verdicts
from weakforms.verification.judging.checks.curve import Curve


def compare(  # noqa: PLR0913  (each a choice of the caller)
    case: str,
    curve: CurveLike | Sequence[CurveLike],
    name: str | None = None,
    accuracy: float | None = None,
    columns: Mapping[str, str] | None = None,
    constants: Mapping[str, float] | None = None,
    only: Sequence[str] | None = None,
    branch: str | None = None,
    *,
    against: Against | None = None,
    over: str | None = None,
    crossing: int = 1,
    ratio: float = RATIO,
    cause: bool = False,
) -> Verdicts:
    """Compare a curve with the reference table of a case, with a solution, or with a stored result.

    The table is interpolated at the curve's abscissa by a spline. The error estimate of the spline
    (:func:`~weakforms.verification.crosscheck.rows.interpolated`) widens the bound. A row is not judged if
    its bound exceeds twice the accuracy asked. A column is not judged if at most half of its rows are, or if
    the curve does not have it and ``only`` does not leave it out. A curve that covers part of the table is
    judged on that part. Every verdict says what accuracy the curve reaches.

    Without ``accuracy`` a column passes within what the case asks of our own code. Otherwise it is not
    judged, and the verdict says which accuracy may be claimed; it fails if there is none
    (:mod:`~weakforms.verification.crosscheck.claims`).

    Args:
        case: Id of a case, such as ``paper2.fig03``; with ``against`` the name of a problem.
        curve: A CSV or JSON file, or columns by name, with the table's abscissa, which must be monotone.
            Several of them, from a coarse mesh to a fine one, are judged by their limit
            (:mod:`~weakforms.verification.crosscheck.convergence`).
        name: Name of the table, if the case has several.
        accuracy: Relative accuracy that the curve claims, up to 0.1; by default none.
        columns: Names in the curve by names in the table, such as ``{"p": "pressure"}``.
        constants: If the curve has units, the radius, modulus and thickness with which the paper scales, such
            as ``{"R_f": 0.02, "C1": 2e5, "h_o": 1e-4}``.
        only: Columns of the table to be judged; by default all that the case judges.
        branch: Branch of a file that has several; by default the one that the case draws. With ``against``
            also the branch of the solution.
        against: Parameters at which the problem is solved at every abscissa of the curve, or a result, or its
            file.
        over: With ``against``, the column over which the curve is compared; by default one that never turns.
        crossing: With ``against``, which crossing of each abscissa along the branch.
        ratio: Size of the cells of each curve over the size of those of the next one.
        cause: Whether to solve for what explains a column that is out of bounds, or that claims nothing
            (:mod:`~weakforms.verification.crosscheck.cause`); needs DOLFINx.

    Raises:
        InputError: If the case or curve is unknown, a column is wrong, the abscissa is not monotone, or a
            result is for other parameters than the table's.
        ConvergenceError: If the problem was to be solved, and a state did not converge.
        EnvironmentLackError: If the problem was to be solved, and DOLFINx is missing.
    """
    if accuracy is not None and not 0 < accuracy <= LARGEST_ACCURACY:
        raise InputError(f"accuracy = {accuracy!r}: must lie between 0 and {LARGEST_ACCURACY:g}")
    curves = list(curve) if isinstance(curve, list | tuple) else [curve]
    if len(curves) != 1:
        require_meshes(len(curves), ratio)
    if against is None:
        target = of_case(case, name)
        owns = [_ours(target, given, branch, columns, constants) for given in curves]
    else:
        files = [read(c, branch if branch and isinstance(c, str | Path) else "").columns for c in curves]
        owns = [our_columns(file, columns_of(case), columns, constants, case) for file in files]
        target = _solved(case, owns, against, over, branch or "primary", crossing)
    asked = target.asked if accuracy is None else dict.fromkeys(target.table.ordinates, accuracy)
    if accuracy is None and (against is not None or len(owns) > 1):
        asked = dict.fromkeys(target.asked or target.table.ordinates)
    meshes = [_judged(target, own, asked, only, constants or {}, accuracy is not None) for own in owns]
    (x, keep, judged), table, own = meshes[-1], target.table, owns[-1]
    rows = table.columns[table.abscissa]
    failed = [j for j in judged if _differs(j, len(owns) > 1)]
    explained = causes(target, failed) if cause else {}
    for found in failed:
        found.verdict.trend = trend(found, table.abscissa)
        found.verdict.causes = explained.get(found.verdict.column, ())
    return Verdicts(
        case=target.id,
        curve=table.name,
        abscissa=table.abscissa,
        covered=reached(x, rows),
        table=(float(rows.min()), float(rows.max())),
        rows=len(x),
        ignored_rows=int(np.sum(~keep)),
        claimed=accuracy,
        unjudged_rows={j.verdict.column: j.verdict.unjudged_rows for j in judged},
        table_rows=len(table),
        met_rows=met(rows, x),
        missing=tuple(j.verdict.column for j in judged if j.verdict.column not in own),
        left_out=tuple(c for c in table.ordinates if c not in {j.verdict.column for j in judged}),
        verdicts=tuple(j.verdict for j in judged),
        pictures=tuple(picture(table, own, j, target.panels) for j in judged if j.verdict.column in own),
        convergence=tuple(
            judge_convergence(of[0].verdict.column, table.abscissa, of, ratio, accuracy)
            for of in zip(*(found for _, _, found in meshes), strict=True)
            if len(of) > 1 and all(len(j.x) for j in of)
        ),
    )


def _differs(judged: JudgedColumn, several: bool) -> bool:
    """Whether a column is to be explained: it is out of bounds; a single curve without a claim differs."""
    if judged.verdict.asked is not None or several:
        return judged.verdict.status == FAILED
    return bool(np.any(np.abs(judged.error) > limits(judged)))


def _ours(
    target: Target,
    curve: CurveLike,
    branch: str | None,
    columns: Mapping[str, str] | None,
    constants: Mapping[str, float] | None,
) -> dict[str, np.ndarray]:
    """A curve with the names and the scaling of a case's table."""
    given = _read(curve, branch, target.curves[0])
    require_same_parameters(given, target.table, target.curves[0])
    names = _names(given.columns, target.curves, columns)
    return our_columns(given.columns, list(target.table.columns), names, constants, target.problem)


def _solved(
    problem: str,
    owns: Sequence[Mapping[str, np.ndarray]],
    against: Against,
    over: str | None,
    branch: str,
    crossing: int,
) -> Target:
    """The solution, or the stored result, that curves are compared with."""
    over = over or default_abscissa(problem, owns[-1])
    for own in owns:
        if over not in own:
            raise InputError(
                f"the curve has no column {over!r}, over which it is compared{not_among(over, own)}"
            )
    if not isinstance(against, Mapping):
        return of_result(problem, against, over, branch)
    x = np.unique(np.concatenate([own[over] for own in owns]))
    return of_solution(problem, against, over, x, branch, crossing)


def _judged(
    target: Target,
    own: Mapping[str, np.ndarray],
    asked: Mapping[str, float | None],
    only: Sequence[str] | None,
    constants: Mapping[str, float],
    claimed: bool,
) -> tuple[np.ndarray, np.ndarray, list[JudgedColumn]]:
    """The abscissa within the table, the rows it belongs to, and every column judged."""
    table = target.table
    wanted = _wanted(table, own, target.asked, asked, only)
    hint = abscissa_hint(target.problem, table.abscissa, constants)
    x, keep = _aligned(table, own, hint)
    judged = []
    for column in wanted:
        if column not in own:
            judged.append(absent(table, column, asked[column], len(x)))
            continue
        numbers, values = np.flatnonzero(keep) + 1, own[column][keep]
        if not np.all(np.isfinite(values)):
            raise InputError(f"column {column!r} has no number in row {numbers[~np.isfinite(values)][0]}")
        judge = partial(judge_column, table, column, x, values, numbers=numbers)
        judged.append(judge(asked[column]) if claimed else judge_unclaimed(judge, asked[column]))
        verdict = judged[-1].verdict
        verdict.units = forgotten(judged[-1], target.problem, constants, table.parameters)
        outside = len(keep) - len(x)
        far = 2 * len(x) < len(keep) or (outside and np.all(np.abs(judged[-1].error) > 1))
        if verdict.status == FAILED and not verdict.units and far and hint:
            verdict.units = f"{outside} of {len(keep)} rows lie outside of the table: {hint}"
    return x, keep, judged


def _read(curve: CurveLike, branch: str | None, drawn: Curve) -> CurveFile:
    """Read the curve; of a file, by default, the branch that the case draws."""
    if branch is None and isinstance(curve, str | Path) and drawn.branch != "primary":
        branch = drawn.branch
    return read(curve, branch or "")


def _names(
    columns: Mapping[str, np.ndarray], curves: Sequence[Curve], names: Mapping[str, str] | None
) -> dict[str, str]:
    """Names in the curve by names in the table: those given, and those that our own solutions use."""
    known = {ours: theirs for curve in curves for ours, theirs in curve.columns.items()}
    own = {ours: theirs for ours, theirs in known.items() if ours not in columns and theirs in columns}
    return own | dict(names or {})


def _wanted(
    table: Reference,
    own: Mapping[str, np.ndarray],
    by_case: Mapping[str, float],
    asked: Mapping[str, float | None],
    only: Sequence[str] | None,
) -> list[str]:
    """Columns to be judged.

    These are the columns requested by name; else those that the case judges, and, if an accuracy is claimed,
    all others that both table and curve have.
    """
    if only:
        only = [only] if isinstance(only, str) else list(only)
        for column in only:
            if column not in table.ordinates:
                raise InputError(
                    f"--column {column}: table {table.name} has no such column; "
                    f"it has {', '.join(table.ordinates)}"
                )
            if column not in asked:
                raise InputError(f"--column {column}: the case asks no accuracy of it; state --accuracy")
        wanted = [column for column in table.ordinates if column in only]
    else:
        wanted = [c for c in table.ordinates if c in by_case or (c in asked and c in own)]
    if table.abscissa not in own:
        raise InputError(
            f"the curve has no column {table.abscissa!r}, over which table {table.name} is compared; "
            f"it has {', '.join(own)}"
        )
    if not any(column in own for column in wanted):
        raise InputError(
            f"the curve has none of the columns of table {table.name} that are judged: "
            f"{', '.join(wanted)}; it has {', '.join(own)}"
        )
    return wanted


def _aligned(table: Reference, columns: Mapping[str, np.ndarray], hint: str) -> tuple[np.ndarray, np.ndarray]:
    """The abscissa within the table's range, up to rounding, and the rows it belongs to."""
    x = columns[table.abscissa]
    rows = table.columns[table.abscissa]
    blur = tolerance(rows)
    keep = (x >= rows.min() - blur) & (x <= rows.max() + blur)
    if not np.any(keep):
        raise InputError(
            f"the curve's {table.abscissa} lies in [{np.nanmin(x):g}, {np.nanmax(x):g}], "
            f"the table's in [{rows.min():g}, {rows.max():g}]: nothing to compare"
            + (f"; {hint}" if hint else "")
        )
    steps = np.diff(x[keep])
    if not (np.all(steps > 0) or np.all(steps < 0)):
        raise InputError(f"the curve's {table.abscissa} must rise, or fall, from row to row")
    return x[keep], keep
