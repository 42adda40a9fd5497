"""Python that PETSc and SLEPc own: its exceptions reach the caller, and it keeps nothing alive."""

import gc

import numpy as np
import pytest
from small_systems import system_of

from weakforms import solve
from weakforms.errors import ConvergenceError, EnvironmentLackError
from weakforms.solvers.equilibrium.callbacks import Deferred
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.subspace import Subspace
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.spectra import Stability

NOT_SOLVED = [ConvergenceError("made up"), ZeroDivisionError("made up"), np.linalg.LinAlgError("made up")]
OTHERS = [EnvironmentLackError("no compiler"), KeyboardInterrupt(), KeyError("a bug")]
TIMES = [1, 2, 3]


class Raises:
    """Replacement of a function that raises at one call and counts the calls."""

    def __init__(self, function, error, at):
        self.function, self.error, self.at, self.calls = function, error, at, 0

    def __call__(self, *given):
        """Return the value of the original function."""
        self.calls += 1
        if self.calls == self.at:
            raise self.error
        return self.function(*given)


def cubic():
    """``u^3 + u = load``, for which Newton's method needs several steps."""
    return system_of(lambda u, v, p: (u**3 + u - p) * v)


def column():
    return system_of(lambda u, v, p: u.dx(0) * v.dx(0) + p * u * v, "Lagrange", 2, 40, ends=True)


def test_after_a_failure_nothing_more_is_done():
    callbacks, done = Deferred(), []
    callbacks.run(lambda: done.append("work"), lambda: done.append("spoil"))
    callbacks.run(lambda: 1 / 0, lambda: done.append("spoil"))
    callbacks.run(lambda: done.append("more"), lambda: done.append("spoil"))
    assert done == ["work", "spoil", "spoil"]
    with pytest.raises(ZeroDivisionError):
        callbacks.release()
    callbacks.release()
    callbacks.run(lambda: done.append("work"), lambda: done.append("spoil"))
    assert done[-1] == "work"


@pytest.mark.parametrize("line_search", ["basic", "bt"])
@pytest.mark.parametrize("at", TIMES)
@pytest.mark.parametrize("part", ["residual", "tangent"])
@pytest.mark.parametrize("error", NOT_SOLVED + OTHERS, ids=lambda e: type(e).__name__)
def test_newton_names_what_its_forms_raise_and_solves_afterwards(error, part, at, line_search, monkeypatch):
    system = cubic()
    solver = ExtendedNewton(system, line_search=line_search)
    guess = system.initial.copy()
    guess.loads["load"] = 10.0
    right = getattr(system, part)
    monkeypatch.setattr(system, part, Raises(right, error, at))
    expected = ConvergenceError if error in NOT_SOLVED else type(error)
    with pytest.raises(expected, match=str(error.args[0]) if error.args else None) as caught:
        solver.solve(guess)
    assert error in (caught.value, caught.value.__cause__)
    monkeypatch.setattr(system, part, right)
    state, _ = solver.solve(guess)
    assert state.u[0] == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize("part", ["value", "gradient"])
@pytest.mark.parametrize("error", NOT_SOLVED + OTHERS, ids=lambda e: type(e).__name__)
def test_newton_names_what_a_constraint_raises(error, part, monkeypatch):
    system = cubic()
    solver = ExtendedNewton(system, ["load"])
    held = Held("u", 2.0)
    monkeypatch.setattr(Held, part, Raises(getattr(held, part), error, 1))
    with pytest.raises(ConvergenceError if error in NOT_SOLVED else type(error)):
        solver.solve(system.initial, [held])


@pytest.mark.parametrize("at", TIMES)
@pytest.mark.parametrize("part", ["residual", "tangent"])
@pytest.mark.parametrize("error", NOT_SOLVED + OTHERS, ids=lambda e: type(e).__name__)
def test_a_subspace_names_what_its_forms_raise(error, part, at, monkeypatch):
    system = cubic()
    subspace = Subspace(system, *whole(system))
    guess = system.initial.copy()
    monkeypatch.setattr(system, part, Raises(getattr(system, part), error, at))
    with pytest.raises(ConvergenceError if error in NOT_SOLVED else type(error)):
        subspace.solve(guess, {"load": 10.0})
    monkeypatch.undo()
    state, _ = subspace.solve(guess, {"load": 10.0})
    assert state.u[0] == pytest.approx(2.0, abs=1e-12)


def whole(system):
    """The whole space of a system as a subspace: basis and lift."""
    with system.at(system.initial):
        basis = system.tangent().duplicate()
    basis.zeroEntries()
    basis.shift(1.0)
    return basis, np.zeros(system.size)


@pytest.mark.parametrize("at", [1, 2, 7, 20])
@pytest.mark.parametrize("error", [NOT_SOLVED[0], *OTHERS], ids=lambda e: type(e).__name__)
def test_a_spectrum_names_what_its_inverse_raises(error, at):
    system = column()
    stability, state = Stability(system), system.initial
    right = stability.spectrum(state).eigenvalues
    inverse = Raises(stability.factor.solve, error, at)
    with pytest.raises(ConvergenceError if error in NOT_SOLVED else type(error)) as caught:
        stability._eigenvalues(8, inverse)
    assert error in (caught.value, caught.value.__cause__)
    assert inverse.calls == at  # it is not asked again
    assert stability.spectrum(state).eigenvalues == right


def alive():
    gc.collect()
    return sum(isinstance(item, System) for item in gc.get_objects())


@pytest.mark.parametrize(("problem", "parameters"), [("tube", {"alpha": 0.1}), ("fluid_tube", {"n_max": 1})])
def test_a_finished_solve_leaves_no_system_behind(problem, parameters):
    """A solver that is owned by a Python context of PETSc would stay for ever, with its mesh and matrices."""
    before = alive()
    solve(problem, numerics={"cells": 16, "levels": 2, "step": 0.5}, **parameters)
    assert alive() <= before
