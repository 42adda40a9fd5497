"""A special point located on several meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from weakforms.results import Quantity, SpecialPoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.uncertainty.refinement import Slow, estimate


def special_point(
    same: Sequence[Solved],
    shown: Sequence[str],
    cap: float,
    branch: str,
    control: str,
    caps: Mapping[str, float] | None = None,
    slow: Slow | None = None,
) -> SpecialPoint:
    """A special point located on several meshes, coarse to fine, with its uncertainties."""
    lower = caps or {}
    return point_of(
        same[-1].kind,
        branch,
        control,
        {k: estimate([s.values[k] for s in same], lower.get(k, cap), slow=slow).quantity() for k in shown},
    )


def point_of(kind: str, branch: str, control: str, columns: Mapping[str, Quantity]) -> SpecialPoint:
    """A special point with its columns."""
    return SpecialPoint(
        kind,
        branch,
        control,
        {name: q.value for name, q in columns.items()},
        {name: q.uncertainty for name, q in columns.items() if q.uncertainty is not None},
        orders={name: q.order for name, q in columns.items() if q.order is not None},
    )
