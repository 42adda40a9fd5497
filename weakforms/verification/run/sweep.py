"""A problem at all combinations of some parameters: solved in parallel, stored, collected in one table."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from weakforms.errors import InputError
from weakforms.results import Result, write_atomically
from weakforms.results.io import dumps
from weakforms.results.tables import Row, csv_text, other_rows, point_rows, state_rows
from weakforms.terminal import WorkProgress, rank
from weakforms.verification.cases.specs import At, Spec

if TYPE_CHECKING:
    import pandas

    from weakforms.verification.run.solving import Solver

MOST = 10_000
"""Largest number of combinations."""

TABLE, PARQUET, FOLDER = "sweep.csv", "sweep.parquet", "solutions"
"""What a sweep writes into its folder."""


@dataclass
class Sweep:
    """The outcome of a sweep."""

    problem: str
    swept: tuple[str, ...]
    """Names of the parameters that vary."""
    results: dict[tuple[float, ...], Result] = field(default_factory=dict)
    """A result for each combination of their values that was solved."""
    failures: dict[tuple[float, ...], str] = field(default_factory=dict)
    """Why others were not."""

    @property
    def complete(self) -> bool:
        """Whether everything was solved and converged."""
        return not self.failures and not any(result.failures for result in self.results.values())

    def rows(self) -> list[Row]:
        """A row for each special point, state, end of a branch, and failure of each combination."""
        out = []
        for values in sorted({**self.results, **self.failures}):
            result = self.results.get(values)
            rows = [] if result is None else [*point_rows(result), *state_rows(result), *other_rows(result)]
            if values in self.failures:
                rows.append({"what": "failed", "reason": self.failures[values]})
            given = dict(zip(self.swept, values, strict=True))
            # A column of the same name, as p of a peeling curve, is the same number.
            out += [given | {name: value for name, value in row.items() if name not in given} for row in rows]
        return out

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a ``DataFrame``.

        Raises:
            EnvironmentLackError: If pandas is missing.
        """
        from weakforms.results.frames import rows_frame

        return rows_frame(self.rows())


def span(text: str) -> list[float] | None:
    """The values of ``a:b:step``, both ends included; ``None`` if the text is no such range.

    Raises:
        InputError: If it has colons and is not a range.
    """
    if ":" not in text:
        return None
    try:
        first, last, step = map(float, text.split(":"))
        if not all(map(math.isfinite, (first, last, step))) or step == 0 or (last - first) / step < 0:
            raise ValueError
    except ValueError:
        raise InputError(f"range {text!r}: FIRST:LAST:STEP is wanted, such as 1:1.2:0.05") from None
    count = int((last - first) / step * (1 + 1e-12) + 1e-9) + 1
    if count > MOST:
        raise InputError(f"range {text!r} has {count} values; allowed: up to {MOST}")
    return [float(f"{first + k * step:.12g}") for k in range(count)]


def sweep(
    problem: str,
    out: Path | None = None,
    *,
    at: Iterable[At] = (),
    numerics: Mapping[str, Any] | None = None,
    jobs: int = 1,
    resume: bool = False,
    progress: WorkProgress | None = None,
    **parameters: Any,
) -> Sweep:
    """Solve a problem at all combinations of parameters.

    Args:
        problem: Name of the problem, such as ``"tube"``.
        out: Folder for ``sweep.csv`` and all solutions; by default nothing is stored.
        at: Requested states (:class:`weakforms.cases.At`); one that is not there is a failure in the table.
        numerics: Meshes and degree, if not the defaults.
        jobs: Number of parallel processes.
        resume: Keep the solutions in the folder that the same code computed.
        progress: Called with the current solution, and the seconds of work done and in total.
        **parameters: Parameters of the problem; a list, tuple or array of numbers is swept.

    Raises:
        InputError: If nothing is swept, or any combination is refused; nothing was solved.
        EnvironmentLackError: If dolfinx is missing.
    """
    from weakforms import api

    api.require_environment()
    from weakforms.verification.run.runner import sole_writer
    from weakforms.verification.run.solving import Solver

    lists = {name: list(value) for name, value in parameters.items() if _is_list(value)}
    fixed = {name: value for name, value in parameters.items() if name not in lists}
    states, mesh = list(at), tuple(sorted((numerics or {}).items()))
    if not lists or not all(lists.values()):
        raise InputError("sweep: give at least one parameter several values, such as delta1=1:1.2:0.05")
    if math.prod(map(len, lists.values())) > MOST:
        raise InputError(f"sweep: more than {MOST} combinations")
    specs = {
        values: Spec(problem, tuple(sorted((fixed | dict(zip(lists, values, strict=True))).items())), mesh)
        for values in itertools.product(*lists.values())
    }
    for spec in specs.values():
        wanted = [(item.name, item.value) for item in states]
        api.prepare(problem, dict(spec.parameters), dict(mesh), wanted)
    done = Sweep(problem, tuple(lists))
    writes = out is not None and rank() == 0
    solver = Solver((out or Path()) / FOLDER, jobs, resume, writes, task=_task)
    if out is None:
        _solve(solver, specs, states, progress, done)
        return done
    with sole_writer(out, writes):
        _solve(solver, specs, states, progress, done)
        if writes:
            write_atomically(out / TABLE, csv_text(done.rows()))
            _write_parquet(out / PARQUET, done)
    return done


def _is_list(value: object) -> bool:
    return not isinstance(value, str) and hasattr(value, "__len__")


def _task(spec: Spec, states: Sequence[At]) -> str:
    """One solution as JSON, without uncertainties along its branches, which no table shows."""
    from weakforms import api
    from weakforms.problems.problem import StateRequest

    requests = [StateRequest(item.name, item.value, item.crossing, item.branch, ()) for item in states]
    given = dict(spec.parameters), dict(spec.numerics)
    return dumps(api.solve_requests(spec.problem, *given, requests, branch_uncertainty=False).to_json())


def _solve(
    solver: Solver,
    specs: Mapping[tuple[float, ...], Spec],
    states: list[At],
    progress: WorkProgress | None,
    into: Sweep,
) -> None:
    """Solve all combinations; one whose states are not there is solved without them."""
    from weakforms.verification.run.plan import Plan

    solver.run(Plan({spec: states for spec in specs.values()}, {}), progress)
    failed = dict(solver.failures)
    again = [spec for spec, error in failed.items() if states and isinstance(error, InputError)]
    if again:
        solver.run(Plan({spec: [] for spec in again}, {}), progress)
    for values, spec in specs.items():
        if spec in solver.results:
            into.results[values] = solver.results[spec]
        if spec in failed:
            into.failures[values] = str(failed[spec])


def _write_parquet(path: Path, done: Sweep) -> None:
    """The table as Parquet, if pandas can write it; it appears under its name only when complete."""
    try:
        import pandas  # noqa: F401
        import pyarrow  # noqa: F401
    except ImportError:
        return
    written = path.with_name(f".{path.name}.part")
    done.to_pandas().to_parquet(written)
    written.replace(path)
