"""A mesh that is refined where the error of the branch on it is large."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from mpi4py import MPI

from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.solvers.stability.surface_family import FilledBranch
from weakforms.solvers.uncertainty.recovery import marked


def adapted(body: Body, rounds: int, trace: Callable[[Body, str], FilledBranch]) -> Body:
    """The membrane on a mesh whose triangles are cut some times where the error of the branch is large.

    Each state of the branch counts alike: of each the share that a triangle has of the squared error.

    Args:
        body: The membrane on the first mesh.
        rounds: Number of times.
        trace: The branch on a mesh, with words that say which it is.

    Raises:
        ConvergenceError: If there is no branch on one of the meshes.
    """
    for k in range(rounds):
        branch = trace(body, f"refinement {k + 1} of {rounds}")
        found = marked(shares(branch))
        body = replace(body, reference=body.reference.refined(found))
    return body


def shares(branch: FilledBranch) -> np.ndarray:
    """Sum over the states of each triangle's share of the squared error, the same on all ranks."""
    model: MembraneModel = branch.modes.model
    out = np.zeros(len(model.body.reference.cells))
    for point in branch.points:
        with model.system.at(point.state):
            squares = model.recovery()
        whole = model.mesh.comm.allreduce(squares.sum(), op=MPI.SUM)
        out[model.cells] += squares / whole
    return model.mesh.comm.allreduce(out, op=MPI.SUM)
