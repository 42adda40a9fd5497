"""A special point located on several meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from weakforms.results import SpecialPoint
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.uncertainty.refinement import Estimate, Slow, estimate


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
    values = {k: estimate([s.values[k] for s in same], lower.get(k, cap), slow=slow) for k in shown}
    return SpecialPoint(
        same[-1].kind,
        branch,
        control,
        {k: float(v.value) for k, v in values.items()},
        {k: float(v.uncertainty) for k, v in values.items()},
        orders=_orders(values),
    )


def _orders(values: dict[str, Estimate]) -> dict[str, float]:
    return {k: float(v.order) for k, v in values.items() if v.order > 0}
