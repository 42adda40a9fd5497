"""Forms belong to one state at a time, inside of a context; a reading without a state fails loudly."""

from dataclasses import replace

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI
from small_systems import system_of

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.meridian.model import WRINKLED, Marks
from weakforms.problems.wrinkled.body import CYLINDER
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.problem import PAPER_GAMMA
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import NoStateError, State
from weakforms.solvers.stability.modes import Singular
from weakforms.solvers.support.sampling import Sampler

READINGS = {
    "residual": lambda s: s.residual(),
    "tangent": lambda s: s.tangent(),
    "monitors": lambda s: s.monitors(),
    "monitor": lambda s: s.monitor("u"),
    "gradient": lambda s: s.monitor_gradient("u"),
    "load derivative": lambda s: s.load_derivative("load"),
    "load": lambda s: s.load("load"),
    "state": lambda s: s.state(),
    "unknown": lambda s: s.owned(),
    "forces": lambda s: s.force_size(),
    "rewriting": lambda s: s.rewrite(np.zeros(s.size), {}),
}


def one_equation():
    """``u = load``."""
    return system_of(lambda u, v, p: (u - p) * v)


def state(u, load=0.0):
    return State(np.array([float(u)]), {"load": float(load)})


@pytest.mark.parametrize("reading", READINGS)
def test_a_reading_outside_of_every_context_is_an_error(reading):
    system = one_equation()
    for _ in range(2):  # at first, and after a context
        with pytest.raises(NoStateError, match="belong to no state"):
            READINGS[reading](system)
        with system.at(state(2.0)):
            system.tangent()
            READINGS[reading](system)


def test_what_is_read_past_the_system_is_no_number():
    """Forms and samplers of their own see an unknown that is not a number."""
    system = one_equation()
    sampler = Sampler(system.unknown, {"u": system.unknown}, np.array([0.5]))
    form = fem.form(system.unknown * ufl.dx)
    with system.at(state(2.0)):
        assert (sampler()["u"][0], fem.assemble_scalar(form)) == (2.0, 2.0)
    assert np.isnan(sampler()["u"][0])
    assert np.isnan(fem.assemble_scalar(form))


def test_a_context_inside_another_gives_the_outer_state_back():
    system = one_equation()
    with system.at(state(2.0, 5.0)):
        with system.at(state(3.0, 7.0)):
            assert (system.monitor("u"), system.load("load")) == (3.0, 7.0)
        assert (system.monitor("u"), system.load("load")) == (2.0, 5.0)
        found, _ = ExtendedNewton(system).solve(state(0.0, 4.0))
        assert found.u == pytest.approx([4.0])
        assert (system.monitor("u"), system.load("load")) == (2.0, 5.0)


def test_an_error_ends_the_context_too():
    system = one_equation()
    with pytest.raises(ConvergenceError), system.at(state(2.0)):
        raise ConvergenceError("inside")
    assert not system.is_lent
    assert np.isnan(system.unknown.x.array).all()


def test_a_state_that_lacks_a_load_is_refused():
    """The forms would keep the load of another state."""
    system = one_equation()
    with pytest.raises(ValueError, match="a state without load"), system.at(State(np.zeros(1), {})):
        pass


def test_a_state_is_a_value():
    system = one_equation()
    given = state(2.0, 5.0)
    with system.at(given):
        copied = system.state()
        system.rewrite(np.array([9.0]), {"load": 1.0})
    assert (given.u[0], given.loads["load"]) == (2.0, 5.0)
    assert (copied.u[0], copied.loads["load"]) == (2.0, 5.0)


def test_a_second_variation_belongs_to_the_state_of_its_base():
    path = FluidPath(MPI.COMM_SELF, TubeData(4.0, 2.0, 0.3, 0.1, 8, 3), 1)
    dry, waves = path.dry(), path.modes.variation(1)
    readings = (
        waves.spectrum,
        waves.negative_count,
        waves.nearest,
        path.modes.observe,
        lambda: waves.mass_times(np.zeros(waves.size)),
        Singular(lambda: waves, np.ones(waves.size)).vectors,
    )
    for reading in readings:
        with pytest.raises(NoStateError):
            reading()
    with pytest.raises(NoStateError), waves.at(State(np.zeros(waves.size), {})):
        pytest.fail("a perturbation of no state was set")
    with path.model.system.at(dry):
        for reading in readings:
            reading()


def test_marks_of_blocks_belong_to_the_state():
    """Two states of one wrinkled model that differ in their marks: each is read with its own."""
    values = {"M": 1.5, "delta": 2.0, "c2": 0.01, "L": 8.0, "gamma": PAPER_GAMMA, "Af": 0.5568}
    tube = Membrane(MPI.COMM_SELF, CYLINDER, values, True, (3,), 4, "relaxed")
    (held,) = tube.fitted(tube.plain(tube.by_homotopy(7.44)[0]), Held("zw", 7.44))
    system, marks = held.model.system, held.state.marks
    folded = replace(held.state, marks=Marks(np.full_like(marks.taut, WRINKLED), marks.wet))
    with system.at(held.state):
        own = system.monitor("Pi")
        with system.at(folded):
            assert system.monitor("Pi") < own - 1e-3
        assert system.monitor("Pi") == own
        assert system.state().marks is marks
    undone = State(held.state.u, held.state.loads)
    with pytest.raises(ValueError, match="a state without marks"), system.at(undone):
        pass
