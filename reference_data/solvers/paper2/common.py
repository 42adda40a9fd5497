"""Functions that the tables of the inflated tube have in common."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import (
    Array,
    Column,
    DisagreementError,
    Estimate,
    Table,
    agreed,
)
from reference_data.solvers.paper2 import text
from reference_data.solvers.paper2.collocation import critical as col
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import critical as fdc

U_STOP = 5.0  # limit points are searched up to this u_max


def steps(start: float, stop: float, step: float) -> Array:
    """Round numbers start, start + step, ..., stop."""
    return np.round(start + step * np.arange(round((stop - start) / step) + 1), 10)


def make(
    name: str,
    title: str,
    source: str,
    parameters: dict[str, object],
    columns: list[Column],
    **more: object,
) -> Table:
    """A table of paper 2 with the documentation common to all of them."""
    defaults = {"method": text.METHOD, "grid": text.grid(), "tolerance": text.TOLERANCE}
    abscissa = more.pop("abscissa", columns[0].name)
    return Table(
        name=name,
        paper=2,
        title=title,
        source=f"{text.PAPER}, {source}",
        parameters=parameters,
        abscissa=abscissa,
        columns=columns,
        **(defaults | more),
    )


def given(tube: Tube) -> dict[str, object]:
    """Parameters as stored."""
    return {"alpha": float(tube.alpha), "delta1": float(tube.delta1), "lf": float(tube.lf)}


def limit_pair(name: str, tube: Tube) -> tuple[list[Estimate], list[Estimate]]:
    """Limit points (p, u_max) of one tube by both methods, in the order met.

    Raises:
        DisagreementError: If the methods find different numbers of them.
    """
    a = [
        fdb.richardson(*(np.array([p, y[0] - 1]) for y, p in states))
        for states in fdc.limit_points(tube, U_STOP)
    ]
    mesh = col.MESHES[-1]
    found = col.branch(tube, mesh, "u_max", steps(0.05, U_STOP, 0.05))
    b = [
        col.resolved(*(np.array([s.p, s.y[0, 0, 0] - 1]) for s, _ in pair))
        for pair in col.limit_points(found)
    ]
    if len(a) != len(b):
        raise DisagreementError(f"table {name}, {tube}: {len(a)} limit points against {len(b)}")
    return a, b


def stacked(name: str, columns: tuple[str, ...], a: list[Estimate], b: list[Estimate]) -> list[Column]:
    """Columns made of one estimate per row, each estimate holding all columns."""
    out = []
    for i, column in enumerate(columns):
        first = fdb.Extrapolated(
            np.array([e.value[i] for e in a]),
            np.array([e.uncertainty[i] for e in a]),
            np.array([e.order[i] for e in a]),
        )
        second = col.Resolved(np.array([e.value[i] for e in b]), np.array([e.uncertainty[i] for e in b]))
        out.append(agreed(name, column, first, second, text.COLUMNS[column]))
    return out


def first_limits(tube: Tube, u_stop: float = U_STOP) -> tuple[list[fdb.State], list[col.State], int]:
    """First limit point on the grids and on the meshes, and the number of limit points."""
    by_fd = fdc.limit_points(tube, u_stop)
    if not by_fd:
        return [], [], 0
    found = col.branch(tube, col.MESHES[-1], "u_max", steps(0.05, u_stop, 0.05))
    return by_fd[0], [s for s, _ in col.limit_points(found)[0]], len(by_fd)
