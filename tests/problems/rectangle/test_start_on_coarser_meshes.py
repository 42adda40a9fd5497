"""A fine mesh starts from the states of a coarser one, and ends at its own."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.rectangle import start
from weakforms.problems.rectangle.model import RectangleModel, Sheet
from weakforms.problems.rectangle.start import states_at
from weakforms.solvers.equilibrium.newton import ExtendedNewton

HEIGHTS = [0.3, 0.5]
SHEETS = {
    "gas": {"load": "gas"},
    "slack": {"load": "gas", "delta": 1.0, "delta_y": 1.0, "c": 1.5},
    "whole": {"load": "gas", "whole": True},
    "wets a part": {"gamma": 6.0},
    "strip": {"load": "gas", "strip": True, "degree": 1},
}


def states(given):
    model = RectangleModel(MPI.COMM_SELF, Sheet(mooney_rivlin_of(0.1), cells=8, **given))
    solver = ExtendedNewton(model.system, [model.sheet.control])
    return states_at(model, solver, HEIGHTS), solver


@pytest.mark.parametrize("given", SHEETS.values(), ids=SHEETS)
def test_states_are_those_without_coarser_meshes(monkeypatch, given):
    alone, much = states(given)
    monkeypatch.setattr(start, "COARSEST", 2)
    found, little = states(given)
    for state, other, height in zip(found, alone, HEIGHTS, strict=True):
        with little.system.at(state):
            assert little.system.monitor("w_c") == pytest.approx(height, rel=1e-12)
        assert np.abs(state.u - other.u).max() < 1e-9
    assert little.factor.count < much.factor.count
