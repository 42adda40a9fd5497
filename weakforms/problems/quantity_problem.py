"""Problems without a branch: solved at two refinements, their quantities with the change between them."""

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
    """Result of a problem that is its quantities alone.

    Args:
        problem: Whose name and scales the result carries.
        parameters: As given.
        numerics: As given.
        comm: Ranks.
        progress: Told which of the two is being solved.
        run: The quantities, with everything that is refined divided by its argument.
        order: Largest order of convergence that is trusted.
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
