"""Functions that the tables of the inflated tube have in common."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Column, DisagreementError, Estimate, agreed, steps
from reference_data.solvers.paper2 import text
from reference_data.solvers.paper2.collocation import critical as col
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import critical as fdc

U_STOP = 5.0  # limit points are searched up to this u_max


def given(tube: Tube) -> dict[str, object]:
    """Parameters as stored."""
    return {"alpha": float(tube.alpha), "delta1": float(tube.delta1), "lf": float(tube.lf)}


def limit_pair(name: str, tube: Tube) -> tuple[list[Estimate], list[Estimate]]:
    """Limit points (p, u_max) of one tube by both methods, in the order met.

    Raises:
        DisagreementError: If the methods find different numbers of them.
    """
    a = [fdb.richardson(*(np.array([p, y[0] - 1]) for y, p in s)) for s in fdc.limit_points(tube, U_STOP)]
    found = col.branch(tube, col.MESHES[-1], "u_max", steps(0.05, U_STOP, 0.05))
    b = [col.resolved(*([s.p, s.u_max] for s in pair)) for pair in col.limit_points(found)]
    if len(a) != len(b):
        raise DisagreementError(f"table {name}, {tube}: {len(a)} limit points against {len(b)}")
    return a, b


def stacked(name: str, columns: tuple[str, ...], a: list[Estimate], b: list[Estimate]) -> list[Column]:
    """Columns made of one estimate per row, each estimate holding all columns."""

    def column(rows: list[Estimate], i: int) -> Estimate:
        order = np.array([r.order[i] for r in rows]) if hasattr(rows[0], "order") else None
        return Estimate(
            *(np.array([getattr(r, k)[i] for r in rows]) for k in ("value", "uncertainty")), order
        )

    return [agreed(name, c, column(a, i), column(b, i), text.COLUMNS[c]) for i, c in enumerate(columns)]


def first_limits(tube: Tube, u_stop: float = U_STOP) -> tuple[list[fdb.State], list[col.State], int]:
    """First limit point on the grids and on the meshes, and the number of limit points."""
    by_fd = fdc.limit_points(tube, u_stop)
    if not by_fd:
        return [], [], 0
    found = col.branch(tube, col.MESHES[-1], "u_max", steps(0.05, u_stop, 0.05))
    return by_fd[0], col.limit_points(found)[0], len(by_fd)
