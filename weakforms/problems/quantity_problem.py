"""Problems without a branch, which are solved at two refinements; the differences give uncertainties."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from mpi4py import MPI

from weakforms.problems.problem import Numerics, Parameters, Progress
from weakforms.results import Quantity, Result
from weakforms.solvers.support.provenance import provenance
from weakforms.solvers.uncertainty.refinement import estimate


def solve_twice(
    problem: Any,
    parameters: Parameters,
    numerics: Numerics,
    comm: MPI.Intracomm,
    progress: Progress,
    run: Callable[[int], dict[str, float]],
    order: float,
) -> Result:
    """Result of a problem that has quantities only.

    Args:
        problem: The problem, whose name and scales the result has.
        parameters: Parameters of the problem.
        numerics: Discretisation of the problem.
        comm: Ranks.
        progress: Called with the number of the solve.
        run: Returns the quantities; its argument divides all mesh sizes and numbers of steps.
        order: Largest assumed order of convergence.
    """
    begun = time.perf_counter()
    found = []
    for coarser in (2, 1):
        progress(problem.name, 2 - coarser, 2)
        found.append(run(coarser))
    values = {name: estimate([item[name] for item in found], cap=order) for name in found[0]}
    return Result(
        problem=problem.name,
        parameters=parameters.model_dump(),
        scales=problem.scales,
        numerics=numerics.model_dump(),
        provenance=provenance(comm, time.perf_counter() - begun),
        quantities={n: Quantity(float(v.value), float(v.uncertainty)) for n, v in values.items()},
    )
