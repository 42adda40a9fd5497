"""Tables of the order of the first derivative that jumps at a front, by two resolutions of one method."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reference_data.solvers.core.tables import Array, Column, DisagreementError, prescribed, round_up

FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2")
HIGHEST = 3  # derivatives of order 0 .. 3 are compared
NONE = HIGHEST + 1
JUMP = 5e-3  # relative; actual jumps are larger, and others are much smaller


def derivatives(operator: Array, values: Array) -> Array:
    """Derivatives of orders 0 .. HIGHEST at nodes, by the matrix of one derivative, shape (order, node)."""
    rows = [values]
    for _ in range(HIGHEST):
        rows.append(operator @ rows[-1])
    return np.array(rows)


def relative(inside: dict[str, Array], outside: dict[str, Array]) -> dict[str, Array]:
    """Jump of each derivative over the larger of its two one-sided values."""
    return {
        c: np.abs(inside[c] - outside[c]) / np.maximum(np.abs(inside[c]), np.abs(outside[c])) for c in FIELDS
    }


def first_jump(jumps: Array) -> int:
    """Order of the first derivative that jumps."""
    found = np.nonzero(jumps > JUMP)[0]
    return int(found[0]) if len(found) else NONE


def columns(
    table: str,
    kinds: dict[int, Callable[[], tuple[dict[str, Array], dict[str, Array]]]],
    along: str,
    about: str,
    printed: Callable[[int, str], int] | None = None,
) -> list[Column]:
    """Columns of the orders and jumps of several kinds of state.

    Args:
        table: Name of the table.
        kinds: Relative jumps on the coarser and the finer resolution, for each kind.
        along: Coordinate of the derivatives.
        about: What the numbers of the kinds mean.
        printed: Orders that a paper prints, by kind and field.

    Raises:
        DisagreementError: If the two resolutions differ in an order.
    """
    rows = []
    for which, jumps in kinds.items():
        coarse, fine = jumps()
        for i, f in enumerate(FIELDS, 1):
            order = first_jump(fine[f])
            if first_jump(coarse[f]) != order:
                raise DisagreementError(
                    f"table {table}: order of {f}, kind {which}, depends on the resolution"
                )
            size = [j[f][order] if order < NONE else 0.0 for j in (coarse, fine)]
            below = max(float(j[f][:order].max(initial=0.0)) for j in (coarse, fine))
            said = printed(which, f) if printed else 0
            rows.append((which, i, order, said, size[1], below, abs(size[1] - size[0])))
    kind, field, order, said, size, below, change = np.array(rows).T
    out = [
        prescribed("kind", kind, ("1", about)),
        prescribed("field", field, ("1", "1 rho, 2 eta, 3 lam1, 4 lam2, 5 t1, 6 t2")),
        prescribed(
            "first_jump",
            order,
            ("1", f"order of the first derivative by {along} that jumps; {NONE}: none up to {HIGHEST}"),
        ),
    ]
    if printed:
        out.append(prescribed("printed", said, ("1", "the same by the printed table")))
    meaning = "that jump over the larger of the two one-sided values; 0 if there is none"
    out.append(Column("jump", size, round_up(float(change.max()) + 1e-6), "1", meaning))
    meaning = "largest such ratio of all lower orders: rounding amplified by differentiation"
    return [*out, Column("below", below, round_up(float(below.max())), "1", meaning)]
