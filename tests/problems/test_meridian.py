"""The model of an axisymmetric membrane: its energies and loads combine freely, on any body."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.meridian.blocks import Blocks, both_ends, one_end
from weakforms.problems.meridian.body import Body
from weakforms.problems.meridian.model import DRY, TAUT, WET, Marks, MeridianModel
from weakforms.problems.tube.model import TubeMesh, TubeModel, free_branch
from weakforms.solvers.equilibrium.state import State


def out_of_balance(model, u, loads):
    """The residual at a state, over its value if the first of the loads is a tenth larger."""
    first, system, sizes = next(iter(loads)), model.system, []
    for factor in (1.0, 1.1):
        with system.at(State(u, loads | {first: factor * loads[first]})):
            residual = system.residual()
        sizes.append(np.sqrt(system.dot(residual, residual)))
    return sizes[0] / sizes[1]


def test_a_liquid_as_a_potential_gives_the_states_of_the_liquid_filled_tube():
    """There the load is a first variation in space, over mu = 2 C1; here it is a potential, over C1."""
    given = TubeData(L=4.0, delta=2.0, gamma=0.3, alpha=0.1, cells=12, degree=4)
    partly_filled = FluidPath(MPI.COMM_SELF, given, 1, 0.5, 0.2).pieces[1]
    state = partly_filled.points[len(partly_filled.points) // 2].state
    tube = Body(
        name="tube",
        parameters=(),
        length=lambda _q: given.length,
        radius=lambda _s, _q: 1.0,
        thickness=lambda _s, _q: 1.0,
        shape=lambda s, _q: (1.0, given.delta * s),
    )
    front = state.loads["front"] * given.length
    mesh = Blocks([0, front, given.length], 12, 4, 20, {"front": 1}, [both_ends(given.grading)] * 2)
    model = MeridianModel(
        MPI.COMM_SELF, tube, {"zw": 0.0, "gamma": 0.0}, mesh, material=mooney_rivlin_of(0.1)
    )
    model.mark(Marks(np.full(2, TAUT), np.array([WET, DRY])))
    loads = {"gamma": 2 * given.gamma, "zw": state.loads["zw"], "front": front}
    assert out_of_balance(model, state.u, loads) < 1e-7


@pytest.mark.parametrize("model", ["mooney_rivlin", "gent"])
def test_a_taut_tube_does_not_notice_that_its_energy_is_relaxed(model):
    laws = {"mooney_rivlin": mooney_rivlin_of(0.1), "gent": Chosen("gent", (("shear", 1.0), ("jm", 97.2)))}
    full = TubeModel.free(MPI.COMM_SELF, laws[model], 1.2, 6.0, TubeMesh(8, 3, 0.6))
    state = free_branch(full.system, 1.2, 0.3, 0.1).points[-1].state
    mesh = Blocks([0.0, 3.0], 8, 3, 8, grading=[one_end(0.6)])
    values = {"p": 0.0, "delta1": 1.2}
    relaxed = TubeModel(MPI.COMM_SELF, laws[model], values, 3.0, mesh, energy="relaxed")
    assert out_of_balance(relaxed, state.u, state.loads) < 1e-7
    state.u[0::2] *= 0.6  # now it is folded: its hoops bear no compression
    stress = []
    for tube in (full, relaxed):
        with tube.system.at(state):
            stress.append(tube.system.monitor("Pi"))
    assert stress[1] < stress[0] - 0.1
