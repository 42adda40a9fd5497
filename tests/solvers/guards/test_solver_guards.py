"""The solvers refuse states and points that only resemble what was wanted."""

from dataclasses import replace
from math import cos, sin
from types import SimpleNamespace

import numpy as np
import pytest
import ufl
from petsc4py import PETSc
from small_systems import COMM, system_of

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, StepControl
from weakforms.solvers.continuation.crossing import Crossing
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.linear import (
    REFINEMENT_LIMIT,
    STIFF_LIMIT,
    BorderedMatrix,
    Factorization,
)
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.subspace import Subspace
from weakforms.solvers.stability import modal
from weakforms.solvers.stability.lowest import Lowest
from weakforms.solvers.stability.modal import ModalBranch
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.roots import root


def circle():
    """``u^2 + load^2 = 1``, from ``u = -1``."""
    system = system_of(lambda u, v, p: (u**2 + p**2 - 1) * v)
    continuation = Continuation(ExtendedNewton(system, ["load"]), control=StepControl(0.05, 0.2))
    state = system.initial.copy()
    state.u[:] = -1.0
    return continuation, continuation.start(state, Held("load", 0.0), towards={"load": 1.0})


def half_circle():
    continuation, first = circle()
    return EquilibriumBranch(continuation, "load", first, stop=lambda p: p.monitors["u"] > 0.9)


def test_a_pair_of_bifurcations_within_one_step_is_told_apart():
    """One long step along ``u = 0`` of an overloaded column, beyond two of its buckling loads."""
    system = system_of(lambda u, v, p: u.dx(0) * v.dx(0) + p * u * v, "Lagrange", 2, 40, ends=True)
    continuation = Continuation(ExtendedNewton(system, ["load"]), control=StepControl(60.0, 60.0))
    first = continuation.start(system.initial, Held("load", 0.0), towards={"load": -1.0})
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.state.loads["load"] < -50)
    assert [point.n_negative for point in branch.points] == [0, 2]
    found = [-point.values["load"] for point in branch.special()]
    assert found == pytest.approx([np.pi**2, 4 * np.pi**2], rel=1e-5)
    assert (np.diff([point.arclength for point in branch.points]) > 0).all()


def test_a_bifurcation_is_where_the_eigenvalue_is_zero():
    """Euler's first buckling load of this column; the primary branch has no limit point there."""
    system = system_of(lambda u, v, p: u.dx(0) * v.dx(0) + p * u * v, "Lagrange", 2, 40, ends=True)
    continuation = Continuation(ExtendedNewton(system, ["load"]), control=StepControl(3.0, 3.0))
    first = continuation.start(system.initial, Held("load", 0.0), towards={"load": -1.0})
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.state.loads["load"] < -20)
    (point,) = branch.special()
    assert point.kind == "bifurcation_point"
    assert point.values["load"] == pytest.approx(-(np.pi**2), rel=1e-6)


def crossed(energy):
    """The bifurcation point of the curve ``u1 = 0`` of an energy of two unknowns, and its system."""
    system = system_of(
        lambda u, v, load: ufl.derivative(energy(u, load) * ufl.dx, u, v).integrals()[0].integrand(),
        shape=(2,),
    )
    continuation = Continuation(ExtendedNewton(system, ["load"]), control=StepControl(0.4, 0.4))
    first = continuation.start(system.initial, Held("load", 0.0), towards={"load": 1.0})
    branch = EquilibriumBranch(continuation, "load", first, lambda p: p.state.loads["load"] > 1)
    (point,) = branch.special()
    return point, system


@pytest.mark.parametrize("skew", [0.0, 1.0])
def test_a_crossing_is_solved_for_with_and_without_symmetry(skew):
    """``u0 = sin(load)``; the stiffness of ``u1`` is ``1/2 - u0``, zero at ``load = pi/6``."""
    point, system = crossed(
        lambda u, load: (
            (u[0] - ufl.sin(load)) ** 2 / 2 + (0.5 - u[0]) * u[1] ** 2 / 2 + skew * u[1] ** 3 / 3 + u[1] ** 4
        )
    )
    assert point.state.loads["load"] == pytest.approx(np.pi / 6, abs=1e-12)
    with system.at(point.state):
        assert np.abs(system.residual()).max() < 1e-12


def test_a_stiffness_that_vanishes_where_no_branch_crosses_is_refused(monkeypatch):
    """With a force on ``u1`` the curve passes beside the crossing."""
    monkeypatch.setattr(Crossing, "_conditions", lambda self, x: self._state(x).u * 0 + x - [0.5, 0.1])
    with pytest.raises(ConvergenceError, match="no branch crosses here"):
        crossed(lambda u, load: (u[0] - load) ** 2 / 2 + (0.5 - u[0]) * u[1] ** 2 / 2 + u[1] ** 4)


@pytest.mark.parametrize(
    "function", [lambda x: x**2 + 1, lambda _: np.nan, lambda x: np.nan if x > 0 else -1.0]
)
def test_a_zero_that_is_not_there_is_no_zero(function):
    with pytest.raises(ConvergenceError, match="the turn is not found between -1 and 2"):
        root(function, -1.0, 2.0, "the turn")


def test_a_special_point_that_is_not_bracketed_is_named():
    with pytest.raises(ConvergenceError, match="limit_point in load is not found"):
        half_circle().zero(2, lambda _: 1.0, "limit_point")


def test_a_fold_the_inertia_does_not_see_is_named():
    branch = half_circle()
    assert len(branch.special()) == 1
    branch.points = [replace(point, n_negative=0) for point in branch.points]
    with pytest.raises(ConvergenceError, match="disagree"):
        branch.special()


def test_a_pair_of_one_family_that_stays_together_is_named(monkeypatch):
    monkeypatch.setattr(modal, "tell_apart", lambda *_: False)
    branch = ModalBranch.__new__(ModalBranch)
    branch.modes, branch._limits = SimpleNamespace(wave_numbers=[2]), []
    branch._counts = lambda _n: np.array([0, 2])
    with pytest.raises(ConvergenceError, match="several eigenvalues of n = 2"):
        branch.special()


def test_a_state_on_another_branch_is_refused(monkeypatch):
    """The other half of the circle has the same load."""
    branch = half_circle()
    right = branch.solver.solve

    def astray(guess, constraints=(), chord=False):
        state, record = right(guess, constraints, chord)
        return State(-state.u, state.loads), record

    assert branch.at("load", 0.5).state.u[0] == pytest.approx(-np.sqrt(0.75))
    monkeypatch.setattr(branch.solver, "solve", astray)
    with pytest.raises(ConvergenceError, match="away from where it was bracketed"):
        branch.at("load", 0.5)


def test_a_step_that_turns_back_is_repeated_shorter():
    continuation, first = circle()
    with pytest.raises(ConvergenceError, match="turns too sharply"):
        continuation.advance(None, first, 0.6)
    assert continuation.advance(None, first, 0.4).arclength > 0.39


def test_an_unconverged_state_of_a_subspace_is_refused():
    system = system_of(lambda u, v, _p: (u**2 + 1) * v)
    basis = PETSc.Mat().createAIJ((1, 1), csr=([0, 1], [0], [1.0]), comm=COMM)
    basis.assemble()
    with pytest.raises(ConvergenceError, match="in the subspace"):
        Subspace(system, basis, np.zeros(1)).solve(State(np.array([0.7]), {"load": 0.0}))


def test_pivoting_is_switched_on_once():
    """Who asks again is told so, and does not factorise again without end."""
    factor = Factorization(system_of(lambda u, v, p: u.dx(0) * v.dx(0) - p * v, "Lagrange", 1, 4))
    first = factor.package
    assert [factor.use_pivoting(), factor.use_pivoting()] == [first != "mumps", False]
    assert factor.package == "mumps"


def test_round_off_of_a_stiff_bordered_system_is_accepted():
    """A stiff string on a soft foundation: round-off in its forces is large against the load."""
    system = system_of(lambda u, v, p: 1e10 * u.dx(0) * v.dx(0) + u * v, "Lagrange", 1, 7)
    factor = Factorization(system)
    with system.at(system.initial):
        factor.update()
    load = system.multiply(system.mass, np.ones(system.size))
    bordered = BorderedMatrix(factor, [], [], np.zeros((0, 0)))
    *_, left = bordered._refined(load, [])
    assert REFINEMENT_LIMIT < left < STIFF_LIMIT
    assert bordered.solve(load, np.zeros(0))[0] == pytest.approx(1.0, rel=STIFF_LIMIT)


@pytest.mark.parametrize(
    ("stiffness", "left", "size"),
    [(1.0, 1e-4, 1.0), (1e15, 2 * STIFF_LIMIT, 1.0), (1e10, STIFF_LIMIT / 2, 1e-9)],
)
def test_only_round_off_of_a_stiff_matrix_excuses_a_residual(monkeypatch, stiffness, left, size):
    """A residual beyond round-off in the forces is refused, and so is a large one of a stiff matrix.

    The forces of a small solution are small, however stiff the matrix is.
    """
    system = system_of(lambda u, v, p: stiffness * u.dx(0) * v.dx(0) + u * v, "Lagrange", 1, 4)
    factor = Factorization(system)
    with system.at(system.initial):
        factor.update()
    load = np.ones(system.size)
    monkeypatch.setattr(BorderedMatrix, "_refined", lambda self, f, g: (size * load, [0.0] * len(g), left))
    with pytest.raises(ConvergenceError, match="singular"):
        BorderedMatrix(factor, [], [], np.zeros((0, 0))).solve(load, np.zeros(0))


def test_a_singular_bordered_system_is_refused():
    """An unsupported string pulled to one side."""
    system = system_of(lambda u, v, p: u.dx(0) * v.dx(0) - p * v, "Lagrange", 1, 4)
    factor = Factorization(system)
    with system.at(system.initial):
        factor.update()
    with pytest.raises(ConvergenceError, match="singular"):
        BorderedMatrix(factor, [], [], np.zeros((0, 0))).solve(np.ones(system.size), np.zeros(0))


def test_a_bordered_matrix_multiplies_what_it_solves():
    """The product with the solution is the right-hand side, in the rows of the field and in the borders."""
    system = system_of(lambda u, v, p: u.dx(0) * v.dx(0) + 3 * u * v - p * v, "Lagrange", 1, 4)
    factor = Factorization(system)
    with system.at(system.initial):
        factor.update()
    ramp, wave = np.linspace(0.1, 1, system.size), np.cos(np.arange(system.size))
    matrix = BorderedMatrix(factor, [ramp, wave], [wave, ramp**2], np.array([[0.5, 0.2], [-0.1, 0.7]]))
    f, g = np.sin(np.arange(system.size)), np.array([0.3, -0.4])
    product = matrix.multiply(*matrix.solve(f, g))
    assert product[0] == pytest.approx(f, abs=1e-12)
    assert product[1] == pytest.approx(g, abs=1e-12)


def test_copies_of_an_eigenvalue_that_were_missed_are_looked_for(monkeypatch):
    """Two equal strings in one system: eigenvalues are double; the first search finds one of each."""
    system = system_of(lambda u, v, _p: ufl.inner(u.dx(0), v.dx(0)), "Lagrange", 2, 20, ends=True, shape=(2,))
    lowest = Lowest(system)
    exact = [np.pi**2, np.pi**2, 4 * np.pi**2, 4 * np.pi**2]
    right, looks = lowest._solve, []

    def forgetful(wanted, target, tolerance, apart_from):
        found = right(wanted, target, tolerance, apart_from)
        looks.append(len(apart_from))
        return found if apart_from or wanted == 1 else found[:1] + found[2:]

    monkeypatch.setattr(lowest, "_solve", forgetful)
    assert [mode.eigenvalue for mode in lowest(system.initial, 4)] == pytest.approx(exact, rel=2e-5)
    assert max(looks) > 0, "it looked again, apart from those found"


def test_each_search_for_copies_starts_elsewhere():
    """A search finds the part of its start in an eigenspace; apart from that, the same start has nothing."""
    lowest = Lowest(system_of(lambda u, v, _p: u.dx(0) * v.dx(0), "Lagrange", 2, 20, ends=True))
    first, second, again = (lowest._start(seed).array for seed in (0, 1, 0))
    assert np.abs(first - again).max() == 0.0
    assert abs(first @ second) < 0.5 * np.linalg.norm(first) * np.linalg.norm(second)


def test_targets_of_many_negative_eigenvalues_are_few(monkeypatch):
    """A column beyond its 30th buckling load: the counts say how far below zero the lowest eigenvalue is."""
    load = (30.5 * np.pi) ** 2
    system = system_of(lambda u, v, _p: u.dx(0) * v.dx(0) - load * u * v, "Lagrange", 2, 200, ends=True)
    lowest = Lowest(system)
    right, targets = lowest._below, []
    monkeypatch.setattr(lowest, "_below", lambda target: targets.append(target) or right(target))
    assert lowest(system.initial, 1)[0].eigenvalue == pytest.approx(np.pi**2 - load, rel=1e-6)
    below = [target for target in targets if target <= np.pi**2 - load]
    assert targets.index(below[0]) < 5


def test_the_mode_of_a_double_eigenvalue_is_the_same_whichever_copies_are_found(monkeypatch):
    system = system_of(lambda u, v, _p: ufl.inner(u.dx(0), v.dx(0)), "Lagrange", 2, 20, ends=True, shape=(2,))
    first = Lowest(system)(system.initial, 2)[0].vector
    lowest = Lowest(system)
    right = lowest._solve

    def turned(*given):
        (one, a), (other, b), *rest = right(*given)
        return [(one, a * cos(2) + b * sin(2)), (other, b * cos(2) - a * sin(2)), *rest]

    monkeypatch.setattr(lowest, "_solve", turned)
    assert np.abs(first).max() > 0.1
    assert np.abs(lowest(system.initial, 2)[0].vector - first).max() < 1e-9


def test_a_spectrum_that_misses_an_eigenvalue_is_refused(monkeypatch):
    system = system_of(lambda u, v, _p: u.dx(0) * v.dx(0) - 20 * u * v, "Lagrange", 2, 20, ends=True)
    stability = Stability(system)
    assert stability.spectrum(system.initial).n_negative == 1
    right = stability._eigenvalues

    def positive(*given, **named):
        values = right(*given, **named)
        return values[values > 0]

    monkeypatch.setattr(stability, "_eigenvalues", positive)
    with pytest.raises(ConvergenceError, match="inertia counts 1 negative eigenvalues, SLEPc finds 0"):
        stability.spectrum(system.initial)


def test_a_factorisation_that_does_not_solve_is_made_again_with_pivoting(monkeypatch):
    system = system_of(lambda u, v, _p: u.dx(0) * v.dx(0) - 20 * u * v, "Lagrange", 2, 20, ends=True)
    stability = Stability(system)
    expected = stability.spectrum(system.initial)
    assert stability.factor.package == "petsc"
    right = stability.factor.solve
    wrong = {"petsc": 1 + 1e-6, "mumps": 1.0}
    monkeypatch.setattr(stability.factor, "solve", lambda rhs: wrong[stability.factor.package] * right(rhs))
    found = stability.spectrum(system.initial)
    assert stability.factor.package == "mumps"
    assert found.eigenvalues == pytest.approx(expected.eigenvalues, rel=1e-11)
