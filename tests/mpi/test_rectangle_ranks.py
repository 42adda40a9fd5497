"""The rectangular membrane: the same branches, states and counts serially and on two ranks."""

import json

import pytest
from on_ranks import start

pytestmark = pytest.mark.mpi

SEQUENCE = """
import json
from mpi4py import MPI
from weakforms.problems.rectangle import start
from weakforms.problems.rectangle.model import RectangleModel
from weakforms.problems.rectangle.parameters import RectangleParameters
from weakforms.solvers.equilibrium.newton import ExtendedNewton

start.COARSEST = 2
model = RectangleModel(MPI.COMM_WORLD, RectangleParameters(load="gas").sheet(8, degree=2))
solver = ExtendedNewton(model.system, ["p"])
found = []
for state in start.states_at(model, solver, [0.3, 0.6]):
    with model.system.at(state):
        found += [state.loads["p"], model.system.monitor("V"), model.system.monitor("Pi")]
if MPI.COMM_WORLD.rank == 0:
    print(json.dumps([*found, solver.factor.count]))
"""


def test_rectangle(same_on_ranks):
    coarse = {"cells": 4, "levels": 2}
    liquid = {"problem": "rectangle", "gamma": 5.0, "w_end": 0.35, "numerics": coarse, "at": [("w_c", 0.3)]}
    slack = {"problem": "rectangle", "load": "gas", "delta": 1.0, "c": 1.5, "w_end": 0.35, "numerics": coarse}
    gas = {"problem": "rectangle", "load": "gas", "alpha": 0.0, "V_r": 60.0, "w_end": 1.8, "numerics": coarse}
    found = same_on_ranks([liquid, slack, gas])
    assert [len(result.special_points) for result in found] == [1, 0, 2]


def test_states_that_start_from_a_coarser_mesh(launcher):
    serial, other = (json.loads(start(["-c", SEQUENCE], ranks)) for ranks in (1, 2))
    assert other == pytest.approx(serial, rel=1e-11)
