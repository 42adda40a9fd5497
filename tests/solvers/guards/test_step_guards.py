"""Steps, spectra and families that are no answer are refused: small systems with solvers led astray."""

from types import SimpleNamespace

import numpy as np
import pytest
from petsc4py import PETSc
from small_systems import system_of
from stand_ins import always, bare, refused

from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, StepControl
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability import eigensolver
from weakforms.solvers.stability.lowest import Lowest
from weakforms.solvers.stability.spectra import Stability
from weakforms.solvers.uncertainty.family import BranchFamily

# -- continuation ----------------------------------------------------------------------------------


def line(**control):
    """Two parallel branches, ``u = -1`` and ``u = 1`` at every load; the first one is followed."""
    system = system_of(lambda u, v, p: (u**2 - 1 + 0 * p) * v)
    continuation = Continuation(ExtendedNewton(system, ["load"]), control=StepControl(0.1, 0.1, **control))
    state = system.initial.copy()
    state.u[:] = -1.0
    return continuation, continuation.start(state, Held("load", 0.0), towards={"load": 1.0})


def beside(continuation, monkeypatch):
    """The solver answers with the other branch."""
    right = continuation.solver.solve

    def astray(guess, constraints=(), chord=False):
        state, record = right(guess, constraints, chord)
        return State(-state.u, state.loads), record

    monkeypatch.setattr(continuation.solver, "solve", astray)


def test_a_step_to_a_parallel_branch_is_refused(monkeypatch):
    continuation, first = line()
    assert continuation.advance(None, first, 0.1).arclength == pytest.approx(0.1)
    beside(continuation, monkeypatch)
    refused("the step leads to another curve", continuation.advance, None, first, 0.1)


def test_a_step_out_of_the_range_of_the_problem_is_refused():
    continuation, first = line()
    continuation.allowed = lambda state: state.loads["load"] < 0.05
    refused("the step leads out of the range of the problem", continuation.advance, None, first, 0.1)
    assert continuation.advance(None, first, 0.04).state.loads["load"] == pytest.approx(0.04)


def test_a_trace_says_why_it_stalled_and_keeps_what_it_has():
    continuation, first = line()
    continuation.allowed = lambda state: state.loads["load"] < 0.25
    points, trace = [], continuation.trace(first, stop=always(False))
    with pytest.raises(ConvergenceError, match=r"^continuation stalled: the step leads out of the range"):
        points.extend(trace)
    branch = EquilibriumBranch(continuation, "load", first, stop=always(False))
    assert branch.stalled.startswith("continuation stalled: the step leads out of the range")
    assert 0.2 < branch.points[-1].state.loads["load"] < 0.25


def test_a_trace_without_an_end_is_given_up():
    continuation, first = line(max_points=3)
    refused(
        r"^continuation did not end within 3 points; raise step",
        list,
        continuation.trace(first, stop=always(False)),
    )


def test_an_end_that_is_not_reached_is_named_with_the_reason():
    continuation, first = line()
    branch = EquilibriumBranch(continuation, "load", first, stop=lambda p: p.state.loads["load"] > 0.3)
    branch.end_at("load", 0.25)
    assert branch.points[-1].state.loads["load"] == pytest.approx(0.25)
    refused(r"^load = 2 is not reached: the branch ends$", branch.end_at, "load", 2.0)
    branch.stalled = "continuation stalled: it turned"
    refused(r"^load = 2 is not reached: continuation stalled: it turned$", branch.end_at, "load", 2.0)


# -- eigenvalues -----------------------------------------------------------------------------------


def string(stiffness=0.0):
    return system_of(lambda u, v, _p: u.dx(0) * v.dx(0) - stiffness * u * v, "Lagrange", 2, 20, ends=True)


class Answers:
    """Stands for SLEPc's solver: it finds two eigenvalues, or breaks off."""

    error = None
    ProblemType, Which = SimpleNamespace(GHEP=1), SimpleNamespace(TARGET_MAGNITUDE=1)

    def solve(self):
        """As SLEPc would."""
        if self.error:
            raise self.error

    def getConverged(self):  # noqa: N802
        """How many it found."""
        return 2

    def getEigenpair(self, i, _vector=None):  # noqa: N802
        """One of them."""
        return complex(i + 1)

    def __getattr__(self, _name):
        return always(self)


BROKEN = [PETSc.Error(73), SystemError("an exception was set"), ConvergenceError("the inverse failed")]


@pytest.mark.parametrize("error", BROKEN)
def test_fewer_eigenvalues_than_wanted_are_no_answer(error):
    stability, eps = Stability(string()), Answers()
    read = lambda eps: [eps.getEigenpair(i).real for i in range(eps.getConverged())]  # noqa: E731
    assert stability._near(eps, 2, read) == [1.0, 2.0]
    refused(r"^SLEPc converged 2 of 3 eigenvalues$", stability._near, eps, 3, read)
    eps.error = error
    refused("^SLEPc failed: ", stability._near, eps, 2, read)


def test_fewer_lowest_eigenvalues_than_wanted_are_no_answer(monkeypatch):
    looked = Lowest(string())
    monkeypatch.setattr(eigensolver, "SLEPc", SimpleNamespace(EPS=Answers))
    assert [value for value, _ in looked._solve(2, 0.0, 1e-9, [])] == [1.0, 2.0]
    refused(r"^SLEPc converged 2 of 3 eigenvalues$", looked._solve, 3, 0.0, 1e-9, [])
    monkeypatch.setattr(Answers, "error", BROKEN[0])
    refused("^SLEPc failed: ", looked._solve, 2, 0.0, 1e-9, [])


def test_a_constrained_spectrum_that_misses_an_eigenvalue_is_refused(monkeypatch):
    """A column beyond its second buckling load, held in one place: one of two negative values is left."""
    stability = Stability(system := string(60.0))
    border = np.zeros(system.size)
    border[system.size // 3] = 1.0
    assert stability.spectrum(system.initial).n_negative == 2
    assert stability.bordered(system.initial, border, 0.0).n_negative == 1
    right = stability._eigenvalues
    monkeypatch.setattr(stability, "_eigenvalues", lambda *given: np.abs(right(*given)))
    words = "inertia counts 1 negative eigenvalues under the constraint, SLEPc finds 0"
    refused(words, stability.bordered, system.initial, border, 0.0)


# -- families --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("reached", "left"), [((True, True), 2), ((False, True), 1), ((False, False), 0)])
def test_a_branch_of_which_no_point_is_on_all_meshes_is_none(reached, left):
    def at_position(point, *_):
        if not reached[point.index]:
            raise ConvergenceError("Newton stalled")
        return SimpleNamespace(values={"u": 1.0 + point.index})

    points = [SimpleNamespace(index=i, arclength=float(i)) for i in range(2)]
    coarse = SimpleNamespace(at_position=at_position)
    fine = SimpleNamespace(
        points=points,
        shown=["u"],
        control="p",
        direction=always(None),
        columns=always({"u": np.array([1, 2.0])}),
    )
    told = bare(
        BranchFamily, levels=[coarse, fine], fine=fine, name="primary", across=(), failures=[], slow=None
    )
    told._cap = always(2.0)
    if left:
        assert len(told.branch()) == left
    else:
        refused(r"^branch primary: no point could be solved for on all meshes$", told.branch)
    named = [] if left == 2 else [f"branch primary, points 0 to {1 - left}, {2 - left} of them left out"]
    assert [(f.what, f.reason) for f in told.failures] == [(what, "Newton stalled") for what in named]
