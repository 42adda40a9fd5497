"""Solves that go wrong on purpose: each failure is noticed and named, and no number is returned."""

import json

import numpy as np
import pytest
import ufl
from abuse_tools import call, orderly, start
from dolfinx import fem, mesh
from mpi4py import MPI

from weakforms.errors import ConvergenceError, EnvironmentLackError
from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import Continuation, StepControl
from weakforms.solvers.equilibrium import newton
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.spectra import Spectrum, Stability
from weakforms.solvers.uncertainty.family import BranchFamily

COMM = MPI.COMM_SELF


def points(energy, count: int = 1) -> System:
    """A system with ``count`` degrees of freedom ``u`` and the energy ``energy(u, load)``."""
    domain = mesh.create_unit_interval(COMM, 1)
    shape = () if count == 1 else (count,)
    space = fem.functionspace(domain, ("DG", 0, shape))
    u, v = fem.Function(space), ufl.TestFunction(space)
    load = fem.Constant(domain, 0.0)
    variable = ufl.variable(load)
    first = u if count == 1 else u[0]
    return System(
        Formulation(
            unknown=u,
            residual=ufl.derivative(energy(u, variable) * ufl.dx, u, v),
            loads={"load": (load, variable)},
            bcs=[],
            mass=ufl.inner(ufl.TrialFunction(space), v) * ufl.dx,
            monitors={"u": first * ufl.dx},
        )
    )


def branch_of(
    system: System, begin: float, end: float, step: float = 0.1, **control: float
) -> EquilibriumBranch:
    """Follow the branch through ``u = begin`` (its first component) to ``end``."""
    solver = ExtendedNewton(system, ["load"])
    continuation = Continuation(solver, control=StepControl(first=step, largest=step, **control))
    state = system.initial.copy()
    state.u[0], state.loads["load"] = begin, begin
    first = continuation.start(state, Held("u", begin), towards={"u": 1.0})
    return EquilibriumBranch(continuation, "load", first, stop=lambda point: point.monitors["u"] > end)


# -- pairs that are missed -----------------------------------------------------------------------


def well(at: float, width: float, other: float | None = None):
    """On a short part of ``u_0 = load`` the stiffness of ``u_1`` is negative.

    With ``other`` the stiffness of ``u_1`` becomes negative at ``at``, and the stiffness of ``u_2`` positive.
    """

    def energy(u, load):
        tilted = (u[0] - load) ** 2 / 2
        if other is None:
            return tilted + ((u[0] - at) ** 2 - width**2) * u[1] ** 2 / 2 + u[2] ** 2
        return tilted + (at - u[0]) * u[1] ** 2 / 2 + (u[0] - other) * u[2] ** 2 / 2

    return energy


def family_of(*args: object, **more: object) -> BranchFamily:
    return BranchFamily(lambda _: branch_of(*args, **more), 2, 2.0, ("u",))


def loads(family: BranchFamily) -> list[float]:
    """Loads of its special points."""
    return [point.values["load"] for point in family.special_points()]


@pytest.mark.parametrize("at", [0.45, 0.5, 0.52, 0.55])
def test_an_eigenvalue_that_crosses_zero_and_returns_within_a_step(at):
    family = family_of(points(well(at, 0.03), 3), 0.0, 1.0, step=0.141)
    assert loads(family) == pytest.approx([at - 0.03, at + 0.03], abs=1e-6)


def test_two_eigenvalues_that_cross_in_opposite_directions_within_a_step():
    family = family_of(points(well(0.45, 0, 0.55), 3), 0.0, 1.0, step=0.5)
    assert {point.n_negative for point in family.fine.points} == {1}
    assert loads(family) == pytest.approx([0.45, 0.55], abs=1e-6)


@pytest.mark.parametrize("other", [0.53, 0.52])
def test_two_eigenvalues_that_cross_together(other):
    """They are told apart, unless they are equal, as by a symmetry."""

    def energy(u, load):
        return (u[0] - load) ** 2 / 2 + (0.52 - u[0]) * u[1] ** 2 / 2 + (other - u[0]) * u[2] ** 2 / 2

    family = family_of(points(energy, 3), 0.0, 1.0, step=0.2)
    if other != 0.52:
        assert loads(family) == pytest.approx([0.52, other], abs=1e-6)
    else:
        with pytest.raises(ConvergenceError, match="several eigenvalues change sign"):
            loads(family)


def test_an_undisturbed_branch_is_not_accused():
    family = family_of(
        points(lambda u, load: (u[0] - load) ** 2 / 2 + u[1] ** 2 + (0.5 - u[0]) * u[2] ** 2, 3), 0, 1
    )
    (found,) = family.special_points()
    assert (found.kind, found.values["load"]) == ("bifurcation_point", pytest.approx(0.5, abs=1e-8))


# -- another branch ------------------------------------------------------------------------------


@pytest.mark.parametrize(("gap", "step"), [(0.02, 0.1), (0.05, 0.1), (0.05, 0.3), (0.1, 0.3), (0.1, 0.1)])
def test_a_jump_to_a_parallel_branch_is_refused(gap, step, monkeypatch):
    """Equal parallel lines ``u = load + k gap``; every long guess is moved onto the next line."""
    period = 2 * np.pi / gap
    system = points(lambda u, load: -ufl.cos(period * (u - load)) / period**2)
    right, thrown = Continuation.predict, []

    def elsewhere(self, before, at, length):
        state = right(self, before, at, length)
        if length > gap / 2:
            state.u[:] += gap
            thrown.append(length)
        return state

    monkeypatch.setattr(Continuation, "predict", elsewhere)
    branch = branch_of(system, 0.0, 1.0, step=step)
    assert branch.stalled is None
    assert thrown
    for point in branch.points:
        assert point.state.u[0] == pytest.approx(point.state.loads["load"], abs=1e-9)


def test_a_state_found_elsewhere_is_refused(monkeypatch):
    branch = branch_of(points(lambda u, load: (u**2 / 2 - load) ** 2 / 2), 1.0, 2.0)
    right = branch.between
    monkeypatch.setattr(branch, "between", lambda i, x: mirrored(right(i, x)))
    with pytest.raises(ConvergenceError, match="away from where it was bracketed"):
        branch.at("load", 1.0)


def mirrored(state):
    state.u[:] *= -1
    return state


# -- no convergence, no number, no factorisation ---------------------------------------------------

TUBE = ("solve", "tube", "--set", "u_end=0.6", "--mesh", "cells=16", "--mesh", "levels=2")


def left(called) -> dict:
    """The result of a solve that failed in part: it is valid and names its failures."""
    assert called.status == 3
    data = json.loads(called.out)
    assert data["failures"]
    for failure in data["failures"]:
        assert failure["what"]
        assert failure["reason"]
        assert f"not converged: {failure['what']}" in called.err
    for branch in data["branches"]:
        assert max(branch["columns"]["residual"]) < newton.RESIDUAL_LIMIT
        numbers = [x for values in branch["columns"].values() for x in values]
        assert np.all(np.isfinite(np.array(numbers, float)))
    return data


def test_no_convergence_at_all():
    called = orderly(start(*TUBE, env={"PETSC_OPTIONS": "-weakforms_snes_max_it 1"}).wait(), 3)
    assert called.out == ""
    assert "SNES ended with" in called.err


def test_no_convergence_from_some_point_on(monkeypatch):
    right = ExtendedNewton.solve

    def solve(self, guess, constraints=(), chord=False):
        with self.system.at(guess):
            u_max = self.system.monitors()["u_max"]
        if u_max > 0.4:
            raise ConvergenceError("SNES ended with DIVERGED_MAX_IT after 25 iterations, residual 1.0e-01")
        return right(self, guess, constraints, chord)

    monkeypatch.setattr(ExtendedNewton, "solve", solve)
    data = left(call(*TUBE))
    assert any("DIVERGED_MAX_IT" in failure["reason"] for failure in data["failures"])
    assert max(data["branches"][0]["columns"]["u_max"]) < 0.5


def test_residuals_that_are_no_numbers(monkeypatch):
    right = System.residual

    def residual(self):
        values = right(self)
        if self.monitors().get("u_max", 0) > 0.4:
            values[:] = np.nan
        return values

    monkeypatch.setattr(System, "residual", residual)
    data = left(call(*TUBE))
    assert max(data["branches"][0]["columns"]["u_max"]) < 0.5


def test_a_small_step_with_a_large_residual_is_no_state(monkeypatch):
    monkeypatch.setattr(newton, "residual_limit", lambda *_: 1e-30)
    called = orderly(call(*TUBE), 3)
    assert called.out == ""
    assert "residual" in called.err


def test_a_tangent_that_is_singular(monkeypatch):
    right = System.tangent

    def tangent(self):
        matrix = right(self)
        if self.monitors().get("u_max", 0) > 0.4:
            matrix.zeroEntries()
            matrix.assemble()
        return matrix

    monkeypatch.setattr(System, "tangent", tangent)
    called = call(*TUBE)
    assert called.status == 3
    data = json.loads(called.out)
    assert max(data["branches"][0]["columns"]["u_max"]) < 0.5
    assert data["failures"]


def test_eigenvalues_that_the_inertia_denies(monkeypatch):
    monkeypatch.setattr(Stability, "_eigenvalues", lambda self, wanted, *_: -np.ones(wanted))
    data = left(call(*TUBE, "--at", "p=0.5"))
    assert data["states"] == []
    assert any("inertia counts" in failure["reason"] for failure in data["failures"])


def test_stability_that_depends_on_the_mesh(monkeypatch):
    seen = []

    def spectrum(self, state, count=2, shift=0.0):
        seen.append(state)
        return Spectrum((0.5, 1.0), len(seen) % 2)

    monkeypatch.setattr(Stability, "spectrum", spectrum)
    data = left(call(*TUBE, "--at", "p=0.5"))
    assert data["states"] == []
    assert any("depends on the mesh" in failure["reason"] for failure in data["failures"])


def test_special_points_that_depend_on_the_mesh(monkeypatch):
    right, seen = EquilibriumBranch.special, []

    def special(self):
        seen.append(self)
        return right(self)[: -1 if len(seen) == 1 else None]

    monkeypatch.setattr(EquilibriumBranch, "special", special)
    called = call("solve", "tube", "--mesh", "cells=16", "--mesh", "levels=2")
    data = left(called)
    assert data["special_points"] == []
    assert any("depend on the mesh" in failure["reason"] for failure in data["failures"])


def test_a_form_that_cannot_be_compiled_is_no_divergence(monkeypatch):
    def tangent(self):
        raise EnvironmentLackError("a form cannot be compiled")

    monkeypatch.setattr(System, "tangent", tangent)
    assert "cannot be compiled" in orderly(call(*TUBE), 4).err
