"""Counts of sheets at a given volume, or mass, of gas, against full matrices."""

import numpy as np
import pytest
from mpi4py import MPI
from scipy.sparse import csr_matrix

from weakforms import solve
from weakforms.problems.gas import Gas
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.membrane import branch as membranes
from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.problems.membrane.shapes import disk
from weakforms.problems.rectangle import branch as rectangles
from weakforms.problems.rectangle.model import RectangleModel, Sheet

GAS = Gas(1.3, 0.7, 100.0)


def rectangle():
    sheet = Sheet(mooney_rivlin_of(0.0), load="gas", cells=4, degree=1)
    return rectangles.traced(RectangleModel(MPI.COMM_SELF, sheet), 0.02, 2.0, 0.1, gas=GAS)


def membrane():
    body = Body(disk(4, 1), mooney_rivlin_of(0.0), degree=1)
    model, start = MembraneModel(MPI.COMM_SELF, body), membranes.Start(0.02, 5e-3)
    return membranes.traced(model, start, 2.5, 0.05, lambda _: None, GAS)


def negatives(matrix):
    return int(np.sum(np.linalg.eigvalsh(matrix) < 0))


@pytest.mark.parametrize("traced", [rectangle, membrane])
def test_counts_are_those_of_full_matrices(traced):
    """``K`` on the displacements that keep the volume, and ``K + s d d^T``; no other class is unstable."""
    branch, seen = traced(), set()
    system = branch.system
    free = np.setdiff1d(np.arange(system.size), system.bc_dofs)
    for point in branch.points[1::2]:
        with system.at(point.state):
            rows, columns, values = system.tangent().getValuesCSR()
            stiffness = csr_matrix((values, columns, rows)).toarray()[np.ix_(free, free)]
            d, volume = system.monitor_gradient("V")[0][free], system.monitor("V")
            found = branch.modes.observe()
        p = point.state.loads["p"]
        keeping = np.linalg.svd(d[None])[2][1:].T
        rate = GAS.kappa * (p + GAS.p_atm) / (volume + GAS.reservoir)
        assert found["n_held"] == negatives(keeping.T @ stiffness @ keeping)
        assert found["n_fixed_m"] == negatives(stiffness + rate * np.outer(d, d))
        assert found["m"] == pytest.approx((p + 0.7) * (volume + 100.0) ** 1.3, rel=1e-12)
        seen.add((point.n_negative, found["n_fixed_m"]))
    assert seen == {(0, 0), (1, 0), (1, 1)}
    (fold,) = (at for at in branch.special() if at.kind == "mass_fold")
    places = np.array([point.monitors["w_c"] for point in branch.points])
    counts = branch.columns()["n_fixed_m"]
    assert (counts == (places > fold.values["w_c"])).all()


@pytest.mark.parametrize("problem", ["rectangle", "membrane"])
def test_a_liquid_has_no_mass_of_gas(problem):
    coarse = {"cells": 4, "levels": 2}
    with pytest.warns(UserWarning, match="V_r = 3.0 has no effect here; it needs load = gas"):
        found = solve(problem, load="liquid", V_r=3.0, w_end=0.31, numerics=coarse)
    assert not {"m", "n_fixed_m"} & set(found.branch().columns)
