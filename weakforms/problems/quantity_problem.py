"""Quantities of problems without a branch, from two meshes; their differences give uncertainties."""

from __future__ import annotations

from collections.abc import Callable

from weakforms.problems.problem import Progress
from weakforms.results import Quantity
from weakforms.solvers.uncertainty.refinement import estimate


def on_two_meshes(
    run: Callable[[int], dict[str, float]], order: float, what: str, progress: Progress
) -> dict[str, Quantity]:
    """Quantities with uncertainties.

    Args:
        run: Returns the quantities; its argument divides all mesh sizes and numbers of steps.
        order: Largest assumed order of convergence.
        what: Name of the problem, for the progress.
        progress: Called with the number of the solve.
    """
    found = []
    for coarser in (2, 1):
        progress(what, 2 - coarser, 2)
        found.append(run(coarser))
    values = {name: estimate([item[name] for item in found], cap=order) for name in found[0]}
    return {n: Quantity(float(v.value), float(v.uncertainty)) for n, v in values.items()}
