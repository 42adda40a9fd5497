"""Newton's method keeps its Jacobian while it converges fast, and only then."""

import numpy as np
import pytest

from tests.solvers.small_systems import system_of
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import State


def newton():
    """``u³ + u = load``, solved for the load at a prescribed ``u`` and for ``u`` at a load."""
    return ExtendedNewton(system_of(lambda u, v, load: (u**3 + u - load) * v), ["load"])


@pytest.mark.parametrize(("begin", "kept"), [(1.001, True), (3.0, False)])
def test_a_jacobian_is_kept_only_after_a_small_step(begin, kept):
    state, record = newton().solve(State(np.array([begin]), {"load": 2.0}), [Held("load", 2.0)])
    assert state.u == pytest.approx([1.0], abs=1e-12)
    slow = [b for a, b in zip(record.norms, record.norms[1:], strict=False) if b > 1e-3 * a]
    assert (record.factorizations == 1) is kept
    assert record.factorizations >= 1 + len(slow[:-1])


def test_a_solve_does_not_begin_with_the_jacobian_of_another():
    solver = newton()
    for target in (2.0, 130.0):
        guess = State(np.array([1.001 if target == 2.0 else 5.005]), {"load": target})
        state, record = solver.solve(guess, [Held("load", target)])
        assert record.factorizations == 1
    assert state.u == pytest.approx([5.0], abs=1e-11)
