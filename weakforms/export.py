"""A result as files for other tools: CSV tables, and the shapes along a branch as a series for ParaView."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from weakforms.errors import InputError
from weakforms.results import Result, State
from weakforms.results.io import branch_csv, require_writable
from weakforms.results.tables import csv_text, field_rows, point_rows, state_rows
from weakforms.shapes import TRIANGLES, surface, write_shape

SERIES = "shapes.pvd"
"""The file that ParaView opens: it lists the shapes."""

INSIDE = 1e-6
"""Distance of the first and last state from the ends of a branch, relative to its range."""


def along(result: Result, branch: str, count: int, progress: Any = None) -> Result:
    """Solve for states with profiles evenly along a branch, over a column that never turns.

    Args:
        result: A result with this branch; its problem is solved again at the same parameters.
        branch: Name of the branch.
        count: Number of states.
        progress: Called with the current step, the amount of work done and the total amount.

    Returns:
        The result of that solve, whose states lie on the branch in order.

    Raises:
        InputError: If the result has no such branch, or all columns of the branch turn.
        EnvironmentLackError: If dolfinx is missing.
    """
    from weakforms import api

    registry = api.require_environment()
    from weakforms.problems.problem import StateRequest

    problem = registry.get(result.problem)
    try:
        of = result.branch(branch)
    except KeyError as error:
        raise InputError(str(error.args[0])) from None
    prescribable = {column.name for column in problem.about.columns if not column.derived}
    names = [name for name in of.columns if name in prescribable and _never_turns(of[name])]
    if not names:
        raise InputError(
            f"branch {branch}: every column turns, so that no states along it can be named; "
            "solve --at NAME=VALUE adds single states"
        )
    first, last = float(of[names[0]][0]), float(of[names[0]][-1])
    if of.ended is not None and of.ended.column == names[0]:
        last = of.ended.value
    margin = INSIDE * (last - first)
    values = np.linspace(first + margin, last - margin, count)
    requests = [StateRequest(names[0], float(value), 1, branch, ()) for value in values]
    numerics = {name: v for name, v in result.numerics.items() if name in problem.numerics.model_fields}
    solve = api.prepared(result.problem, result.parameters, numerics, requests, branch_uncertainty=False)
    return solve(progress)


def _never_turns(values: np.ndarray) -> bool:
    steps = np.diff(np.asarray(values, float))
    return len(steps) > 0 and bool(np.all(steps > 0) or np.all(steps < 0))


def export(result: Result, folder: Path, branch: str = "", frames: Sequence[State] = ()) -> list[Path]:
    """Write a result into a folder; files appear under their names only when all are complete.

    Args:
        result: Any result.
        folder: Folder for ``branches.csv``, ``special_points.csv``, ``states.csv``, ``fields.csv`` (the
            profiles of states) and, if these profiles are surfaces in space, ``shapes.pvd`` with a VTU file
            for each state.
        branch: Branch of the shapes; default: all of them.
        frames: States along a branch, as :func:`along` finds them: the tables have them after the states of
            the result, and the shapes are theirs.

    Returns:
        The files for a reader to open.

    Raises:
        InputError: If there is nothing to write, or it cannot be written.
        EnvironmentLackError: If meshio is missing.
    """
    folder = Path(folder)
    result = replace(result, states=[*result.states, *frames])
    states = [s for s in result.states if s.fields and branch in ("", s.branch)]
    shapes = [s for s in frames or states if s.fields and _is_surface(s)]
    texts = {
        "branches.csv": branch_csv(result) if result.branches else "",
        "special_points.csv": csv_text(point_rows(result)) if result.special_points else "",
        "states.csv": csv_text(state_rows(result)) if result.states else "",
        "fields.csv": csv_text(_profiles(states)) if states else "",
    }
    if not any(texts.values()):
        raise InputError("the result has neither branches nor special points nor states: nothing to export")
    require_writable(folder)
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=".export.") as made:
            for name, text in texts.items():
                if text:
                    (Path(made) / name).write_text(text, "utf-8")
            names = [f"shape_{k:04d}.vtu" for k in range(len(shapes))]
            for name, state in zip(names, shapes, strict=True):
                write_shape(Path(made) / name, *state.fields)
            if shapes:
                (Path(made) / SERIES).write_text(_series(shapes, names), "utf-8")
            written = sorted(path.name for path in Path(made).iterdir())
            for name in sorted(written, key=lambda name: name == SERIES):  # what lists the others comes last
                os.replace(Path(made) / name, folder / name)
    except OSError as error:
        raise InputError(f"cannot write to folder {folder}: {error.strerror or error}") from error
    return [folder / name for name in written if not name.startswith("shape_")]


def _is_surface(state: State) -> bool:
    if any(field.name == TRIANGLES for field in state.fields):
        return True
    try:
        surface(state.fields[0])
    except (InputError, ValueError):
        return False
    return True


def _profiles(states: Sequence[State]) -> list[dict[str, Any]]:
    """A row for each sample point of each field, after the number and place of its state."""
    rows = []
    for number, state in enumerate(states, start=1):
        at = ", ".join(f"{name} = {value:.12g}" for name, value in state.at.items())
        head = {"state": number, "at": at, "branch": state.branch, "crossing": state.crossing}
        rows += [head | {"field": f.name} | row for f in state.fields for row in field_rows(f)]
    return rows


def _series(shapes: Sequence[State], names: Sequence[str]) -> str:
    """The list of shapes; its time is the value at which states were asked for, or else their number."""
    values = [next(iter(state.at.values())) for state in shapes]
    rises = len({next(iter(s.at)) for s in shapes}) == 1 and bool(np.all(np.diff(values) > 0))
    times = values if rises else range(len(shapes))
    lines = [
        f'<DataSet timestep="{time:.12g}" part="0" file={quoteattr(name)}/>'
        for time, name in zip(times, names, strict=True)
    ]
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>'
    return "\n".join([head, *lines, "</Collection>\n</VTKFile>\n"])
