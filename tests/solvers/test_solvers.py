"""Continuation, critical points and stability of problems with known exact solutions."""

from itertools import pairwise

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, StepControl
from weakforms.solvers.continuation.line import fold_line
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.support.roots import polynomial_through

COMM = MPI.COMM_SELF


def one_dof(function, load=0.0, second=0.0):
    """``function(u, load, second) = 0`` with a single degree of freedom."""
    domain = mesh.create_unit_interval(COMM, 1)
    space = fem.functionspace(domain, basix.ufl.element("DG", "interval", 0))
    u, v = fem.Function(space), ufl.TestFunction(space)
    constants = {"load": fem.Constant(domain, load), "second": fem.Constant(domain, second)}
    loads = {name: (c, ufl.variable(c)) for name, c in constants.items()}
    expression = function(u, loads["load"][1], loads["second"][1])
    return System(
        Formulation(
            unknown=u,
            residual=expression * v * ufl.dx,
            loads=loads,
            bcs=[],
            mass=ufl.TrialFunction(space) * v * ufl.dx,
            monitors={"u": u * ufl.dx, "square": u**2 * ufl.dx},
        )
    )


def start(system, u, scalars=("load",), **control: float):
    solver = ExtendedNewton(system, scalars)
    state = system.initial.copy()
    state.u[:] = u
    return Continuation(solver, control=StepControl(**control)), state


@pytest.mark.parametrize("step", [0.05, 0.3, 1.0])
@pytest.mark.parametrize("begin", [-1.0, 0.0, 2.0])
def test_line_is_followed_exactly(step, begin):
    continuation, state = start(one_dof(lambda u, p, _: u - p), begin, first=step, largest=step)
    first = continuation.start(state, Held("u", begin), towards={"u": 1.0})
    points = list(continuation.trace(first, stop=lambda p: p.monitors["u"] > begin + 3))
    for a, b in pairwise(points):
        assert b.state.loads["load"] == pytest.approx(b.state.u[0], abs=1e-14)
        assert continuation.distance(a.state, b.state) == pytest.approx(step, abs=1e-12)
    tangent = points[-1].tangent
    assert tangent.u[0] == pytest.approx(np.sqrt(0.5), abs=1e-14)
    assert tangent.loads["load"] == pytest.approx(np.sqrt(0.5), abs=1e-14)


def test_circle_passes_both_folds_and_counts_two_factorisations_a_step():
    system = one_dof(lambda u, p, _: u**2 + p**2 - 1)
    continuation, state = start(system, 1.0, first=0.05, largest=0.1)
    first = continuation.start(state, Held("load", 0.0), towards={"load": 1.0})
    before = continuation.solver.factor.count
    points = list(continuation.trace(first, stop=lambda p: p.state.u[0] < -0.5 and p.state.loads["load"] < 0))
    for p in points:
        assert p.state.u[0] ** 2 + p.state.loads["load"] ** 2 == pytest.approx(1, abs=1e-12)
    assert continuation.solver.factor.count - before <= 2 * (len(points) - 1)


def test_fold_is_located_and_agrees_with_inertia():
    # load = 1 - (u - 0.3)^2 with K = 2 (u - 0.3): the fold is at u = 0.3, load = 1.
    system = one_dof(lambda u, p, _: (u - 0.3) ** 2 + p - 1)
    continuation, state = start(system, -1.0, first=0.05, largest=0.2)
    first = continuation.start(state, Held("u", -1.0), towards={"u": 1.0})
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.monitors["u"] > 1)
    (fold,) = branch.special()
    assert fold.kind == "limit_point"
    assert fold.values["load"] == pytest.approx(1.0, abs=1e-12)
    assert fold.values["u"] == pytest.approx(0.3, abs=1e-9)
    assert [p.n_negative for p in branch.points] == [int(p.state.u[0] < 0.3) for p in branch.points]


def test_cusp_is_located():
    # Folds of u^3 - a u - load: 3 u^2 = a, load = -2 u^3; the cusp is at the origin, moved to (0.2, 0.1).
    system = one_dof(lambda u, p, a: (u - 0.1) ** 3 - (a - 0.2) * (u - 0.1) - p, second=1.2)
    continuation, state = start(system, -1.5, first=0.05, largest=0.1)
    first = continuation.start(state, Held("u", -1.5), towards={"u": 1.0})
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.monitors["u"] > 1.5)
    folds = branch.special()
    assert [f.values["u"] for f in folds] == pytest.approx([0.1 - 3**-0.5, 0.1 + 3**-0.5], abs=1e-9)
    steps = StepControl(first=0.05, largest=0.1)
    line = fold_line(branch, "second", -1.0, steps, stop=lambda p: p.state.loads["second"] > 1.2)
    for p in line.points:
        u, a = p.state.u[0] - 0.1, p.state.loads["second"] - 0.2
        assert 3 * u * u == pytest.approx(a, abs=1e-9)
    (cusp,) = line.special()
    assert cusp.values["second"] == pytest.approx(0.2, abs=1e-10)
    assert cusp.values["u"] == pytest.approx(0.1, abs=1e-8)


def test_functional_is_held_exactly_and_crossings_are_told_apart():
    system = one_dof(lambda u, p, _: u**2 + p - 1)
    continuation, state = start(system, -1.0, first=0.05, largest=0.2)
    first = continuation.start(state, Held("u", -1.0), towards={"u": 1.0})
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.monitors["u"] > 1)
    assert branch.at("square", 0.25, 1).values["u"] == pytest.approx(-0.5, abs=1e-12)
    assert branch.at("square", 0.25, 2).values["u"] == pytest.approx(0.5, abs=1e-12)
    assert branch.at("load", 0.75, 2).values["u"] == pytest.approx(0.5, abs=1e-12)
    with pytest.raises(InputError, match="taken 2 times on this branch, so there is no crossing 3"):
        branch.at("load", 0.75, 3)
    with pytest.raises(InputError, match="ranges over"):
        branch.at("load", 7.0)
    with pytest.raises(InputError, match="cannot ask"):
        branch.at("n_negative", 1.0)


def string(spring=0.0, cells=80, fixed=True):
    """``-u'' + spring u = load`` on the unit interval, fixed at both ends or free."""
    domain = mesh.create_unit_interval(COMM, cells)
    space = fem.functionspace(domain, basix.ufl.element("Lagrange", "interval", 2))
    u, v = fem.Function(space), ufl.TestFunction(space)
    load = fem.Constant(domain, 0.0)
    variable = ufl.variable(load)
    ends = mesh.locate_entities_boundary(domain, 0, lambda x: np.full(x.shape[1], True))
    dofs = fem.locate_dofs_topological(space, 0, ends)
    energy = u.dx(0) * v.dx(0) + spring * u * v - variable * v
    return System(
        Formulation(
            unknown=u,
            residual=energy * ufl.dx,
            loads={"load": (load, variable)},
            bcs=[fem.dirichletbc(np.array(0.0), dofs, space)] if fixed else [],
            mass=ufl.TrialFunction(space) * v * ufl.dx,
            monitors={"mean": u * ufl.dx},
        )
    )


def cells_with(stiffnesses):
    """One degree of freedom in each cell, whose eigenvalue is the cell's stiffness."""
    domain = mesh.create_unit_interval(COMM, len(stiffnesses))
    space = fem.functionspace(domain, basix.ufl.element("DG", "interval", 0))
    u, v, stiffness = fem.Function(space), ufl.TestFunction(space), fem.Function(space)
    stiffness.x.array[:] = stiffnesses
    mass = ufl.TrialFunction(space) * v * ufl.dx
    return System(Formulation(u, stiffness * u * v * ufl.dx, {}, [], mass, {}))


@pytest.mark.parametrize(("spring", "negative"), [(0.0, 0), (-20.0, 1), (-50.0, 2), (-100.0, 3)])
def test_spectrum_has_no_spurious_eigenvalues_and_the_inertias_count(spring, negative):
    system = string(spring=spring)
    spectrum = Stability(system).spectrum(system.initial, count=3)
    exact = np.sort([(n * np.pi) ** 2 + spring for n in range(1, 5)])[: len(spectrum.eigenvalues)]
    assert spectrum.n_negative == negative
    assert spectrum.eigenvalues == pytest.approx(exact, rel=2e-5)


@pytest.mark.parametrize("far", [(-500.0,), (-500.0, -300.0), (-500.0, -300.0, -60.0, -60.0)])
def test_eigenvalues_far_below_zero_are_found_beside_a_crowd_near_zero(far):
    near = np.array([-0.4, *np.linspace(0.1, 0.6, 60)])
    exact = np.array([*far, *near])
    system = cells_with(exact)
    spectrum = Stability(system).spectrum(system.initial)
    assert spectrum.n_negative == len(far) + 1
    assert spectrum.eigenvalues[: spectrum.n_negative] == pytest.approx(exact[: spectrum.n_negative])


def test_an_eigenvalue_that_is_missed_near_zero_is_not_replaced_by_another_one_twice(monkeypatch):
    exact = np.array([-500.0, -3.0, -2.0, -0.4, *np.linspace(4, 6, 60)])
    system, complete = cells_with(exact), Stability._eigenvalues

    def without_one(self, wanted, inverse, target=0.0):
        found = complete(self, wanted, inverse, target)
        return found[np.abs(found + 2) > 1e-6] if target == 0 else found

    monkeypatch.setattr(Stability, "_eigenvalues", without_one)
    assert Stability(system).spectrum(system.initial).eigenvalues[:4] == pytest.approx(exact[:4])


def test_linear_problem_converges_in_one_step():
    system = string()
    state = system.initial.copy()
    state.loads["load"] = 1.0
    state, record = ExtendedNewton(system).solve(state)
    assert record.iterations <= 2
    with system.at(state):
        assert system.monitor("mean") == pytest.approx(1 / 12, rel=1e-10)


def test_singular_tangent_is_noticed():
    system = string(fixed=False)
    state = system.initial.copy()
    state.loads["load"] = 1.0
    with pytest.raises(ConvergenceError, match="DIVERGED_LINEAR_SOLVE: bordered linear system is singular"):
        ExtendedNewton(system).solve(state)


def test_no_solution_is_noticed():
    system = one_dof(lambda u, p, _: u**2 + 1 + p)
    state = system.initial.copy()
    state.u[:] = 0.7
    with pytest.raises(ConvergenceError, match="DIVERGED_MAX_IT after 25 iterations"):
        ExtendedNewton(system).solve(state)


def test_nan_is_noticed():
    system = one_dof(lambda u, p, _: ufl.sqrt(u) + p)
    state = system.initial.copy()
    state.u[:] = 1.0
    state.loads["load"] = 0.5
    with pytest.raises(ConvergenceError, match="NAN"):
        ExtendedNewton(system).solve(state)


def test_continuation_that_cannot_go_on_keeps_what_it_has():
    # u = sqrt(-load) ends at load = 0 with an infinite slope of the residual.
    system = one_dof(lambda u, p, _: ufl.sqrt(u) - p)
    continuation, state = start(system, 1.0, first=0.1, largest=0.1)
    state.loads["load"] = 1.0
    first = continuation.start(state, Held("u", 1.0), towards={"u": -1.0})
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.monitors["u"] < -1)
    assert branch.stalled
    assert len(branch.points) > 3
    assert all(p.record.norms[-1] < 1e-8 for p in branch.points)


def test_options_do_not_leak_between_solvers():
    from petsc4py import PETSc

    before = PETSc.Options().getAll()
    ExtendedNewton(one_dof(lambda u, p, _: u - p), ["load"])
    assert PETSc.Options().getAll() == before


@pytest.mark.parametrize(("begin", "count"), [(1.0001, 1), (3.0, 6)])
def test_newton_keeps_its_jacobian_only_while_it_converges_fast(begin, count):
    solver = ExtendedNewton(one_dof(lambda u, p, _: u**3 + u - p))
    for _ in range(2):  # a second solve does not begin with the Jacobian of the first
        state = solver.system.initial.copy()
        state.u[:], state.loads["load"] = begin, 2.0
        found, record = solver.solve(state)
        assert record.factorizations == count
        assert found.u == pytest.approx([1.0], abs=1e-12)
        state.loads["load"] = 130.0
        assert solver.solve(state)[0].u == pytest.approx([5.0], abs=1e-12)


# -- polynomials through values ---------------------------------------------------------------------

NODES = np.array([0.0, 0.3, 0.4, 1.0])


def cubic(x):
    return 2 - x + 3 * x**2 - 0.5 * x**3


@pytest.mark.parametrize("at", [-0.2, 0.05, 0.3, 0.77, 1.0])
def test_it_is_exact_for_polynomials_also_at_its_points(at):
    assert polynomial_through(NODES, cubic(NODES))(at) == pytest.approx(cubic(at), rel=1e-13)
    vectors = np.column_stack([cubic(NODES), -2 * cubic(NODES)])
    assert polynomial_through(NODES, vectors)(at) == pytest.approx(cubic(at) * np.array([1, -2]), rel=1e-13)


def test_it_is_the_same_to_the_last_bit_every_time():
    """SciPy's interpolator shuffles its points, so that two runs of a program differ."""
    values = np.random.default_rng(3).normal(size=(12, 50))
    points = (1 - np.cos(np.pi * (np.arange(12) + 0.5) / 12)) / 2
    first, second = (polynomial_through(points, values)(0.3141) for _ in range(2))
    assert np.array_equal(first, second)


def test_factors_that_were_freed_are_made_again():
    system = one_dof(lambda u, load, _: u**3 + 2 * u - load)
    factor = Factorization(system)
    with system.at(system.initial):
        factor.update()
        before, made = factor.solve(np.array([3.0])), factor.count
        factor.release()
        assert factor.count > made, "whoever kept what was made with them sees that they are gone"
        factor.update()
        assert factor.solve(np.array([3.0])) == before == [1.5]
