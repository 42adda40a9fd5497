"""Lines of critical points of systems with known exact solutions."""

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from weakforms.solvers.continuation.continuation import StepControl
from weakforms.solvers.continuation.line import (
    LineContinuation,
    Meeting,
    line_of,
    singular_too,
    tips,
    zeros_of,
)
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.least import LeastValue
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modes import OwnVariation, SecondVariation, Singular
from weakforms.solvers.stability.spectra import Stability

COMM = MPI.COMM_SELF
STEPS = StepControl(first=0.02, largest=0.05)


def systems():
    """``u^3 - a u = load, w = 1``, and a mode outside with the stiffness ``(u - 0.2)^2 + a - 1`` and 1."""
    domain = mesh.create_unit_interval(COMM, 1)
    space = fem.functionspace(domain, basix.ufl.element("DG", "interval", 0, shape=(2,)))
    unknown, v, trial = fem.Function(space), ufl.TestFunction(space), ufl.TrialFunction(space)
    loads = {name: (c := fem.Constant(domain, 0.0), ufl.variable(c)) for name in ("load", "a")}
    (_, p), (_, a) = loads.values()
    (u, w), dx = unknown, ufl.dx
    mass = ufl.inner(trial, v) * dx
    residual = (u**3 - a * u - p) * v[0] * dx + (w - 1) * v[1] * dx
    base = System(Formulation(unknown, residual, loads, [], mass, {"u": u * dx}))
    perturbation = fem.Function(space, name="mode")
    stiffness = ((u - 0.2) ** 2 + a - 1) * trial[0] * v[0] * dx + trial[1] * v[1] * dx
    form = Formulation(perturbation, ufl.inner(perturbation, v) * dx, loads, [], mass, {}, tangent=stiffness)
    return base, SecondVariation(form, base)


FIRST = np.array([1.0, 0.0])
"""The mode that becomes singular."""


def state(base, u, a):
    return State(np.array([u, 1.0]), {"load": u**3 - a * u, "a": a})


def mirror_line(base, form, meetings):
    solver = ExtendedNewton(base, ["load", "a"])
    continuation = LineContinuation(solver, Singular(lambda: form, FIRST), STEPS)
    begin = state(base, -0.7, 1 - 0.9**2)
    return line_of(continuation, begin, "a", 1.0, lambda p: p.state.u[0] > 0.9, meetings)


def test_a_line_of_symmetry_breaking_passes_folds_and_its_tip():
    base, form = systems()
    own = OwnVariation(ExtendedNewton(base, ["load"]))
    meetings = [
        Meeting("tip_mirror", tips),
        Meeting("fold_mirror", singular_too(lambda: own, Stability(base).nearest_by_index)),
        Meeting("wrinkling_mirror", zeros_of(lambda columns: columns["u"] - 0.3)),
    ]
    line = mirror_line(base, form, meetings)
    assert line.stalled is None
    for point in line.points:
        u, a = point.state.u[0], point.state.loads["a"]
        assert a == pytest.approx(1 - (u - 0.2) ** 2, abs=1e-10)
        assert point.state.loads["load"] == pytest.approx(u**3 - a * u, abs=1e-12)
    # The state is a limit point where 3 u^2 = a: 4 u^2 - 0.4 u - 0.96 = 0.
    folds = (0.4 + np.array([-1, 1]) * np.sqrt(0.16 + 15.36)) / 8
    found = [(at.kind, at.values["u"]) for at in line.special()]
    names = ("fold_mirror", "tip_mirror", "wrinkling_mirror", "fold_mirror")
    wanted = list(zip(names, (folds[0], 0.2, 0.3, folds[1]), strict=True))
    assert [kind for kind, _ in found] == [kind for kind, _ in wanted]
    assert [u for _, u in found] == pytest.approx([u for _, u in wanted], abs=1e-9)


def test_inertia_beside_a_line_differs_by_one_across_it():
    """On both sides of a line the number of negative eigenvalues is that on it, and one more."""
    base, form = systems()
    line = mirror_line(base, form, ())
    assert line.counts(lambda: form, 1e-6).tolist() == [0] * len(line.points)
    at = line.points[3].state
    counts = []
    for change in (-1e-6, 1e-6):
        with base.at(State(at.u, at.loads | {"a": at.loads["a"] + change})):
            counts.append(form.negative_count())
    assert counts == [1, 0]


def test_the_gradient_of_a_singular_form_is_that_of_its_difference():
    """``g_u = -d(φᵀ K φ)`` against central differences of ``g``, with the null vector on the line."""
    base, form = systems()
    solver = ExtendedNewton(base, ["load", "a"])
    condition = Singular(lambda: form, FIRST)
    at = state(base, 0.5, 1 - 0.09)
    with base.at(at):
        row, loads = condition.gradient(solver)
    h = 1e-5

    def g(u, a):
        with base.at(State(np.array([u, 1.0]), {"load": 0.0, "a": a})):
            return condition.vectors()[1]

    u, a = 0.5, at.loads["a"]
    assert row[0] == pytest.approx((g(u + h, a) - g(u - h, a)) / (2 * h), rel=1e-8)
    assert loads["a"] == pytest.approx((g(u, a + h) - g(u, a - h)) / (2 * h), rel=1e-8)
    assert loads["load"] == 0.0


def test_the_border_turns_with_the_null_vector_and_keeps_its_sense():
    base, form = systems()
    condition = Singular(lambda: form, -3.0 * FIRST)
    with base.at(state(base, 0.5, 1 - 0.09)):
        condition.turn()
    # The mass of the cell is 1, so that the unit null vector is 1 up to its sign.
    assert condition.border == pytest.approx([-1.0, 0.0])


def bowed(cells=7, comm=COMM):
    """``u = load``, and the expression ``(x - s)^2 + u - 1/2`` on the unit interval, with ``s`` a load."""
    domain = mesh.create_unit_interval(comm, cells)
    space = fem.functionspace(domain, ("Lagrange", 3))
    u, v, trial = fem.Function(space), ufl.TestFunction(space), ufl.TrialFunction(space)
    loads = {name: (c := fem.Constant(domain, 0.3), ufl.variable(c)) for name in ("load", "s")}
    (_, p), (_, s) = loads.values()
    system = System(Formulation(u, (u - p) * v * ufl.dx, loads, [], trial * v * ufl.dx, {"u": u * ufl.dx}))
    x = ufl.SpatialCoordinate(domain)[0]
    return system, LeastValue(system, (x - s) ** 2 + u - 0.5, 6)


@pytest.mark.parametrize(("s", "place"), [(0.37, 0.37), (1.0, 1.0), (1.05, 1.0), (1.2, 1.0)])
def test_an_onset_is_where_the_least_value_is_zero_inside_or_at_the_end(s, place):
    system, least = bowed()
    begin = State(np.full(system.size, 0.45), {"load": 0.45, "s": s})
    with system.at(begin):
        least.turn()
    found, _ = ExtendedNewton(system, ["load"]).solve(begin, [least])
    assert found.loads["load"] == pytest.approx(0.5 - (place - s) ** 2, abs=1e-12)
    assert least.place == pytest.approx(place, abs=1e-7)
    assert least.at_end == (place == 1.0)


def test_a_line_of_onsets_moves_from_inside_to_the_end():
    system, least = bowed()
    solver = ExtendedNewton(system, ["load", "s"])
    begin = State(np.full(system.size, 0.5), {"load": 0.5, "s": 0.7})
    line = line_of(
        LineContinuation(solver, least, STEPS), begin, "s", 1.0, lambda p: p.state.loads["s"] > 1.3
    )
    assert line.stalled is None
    for point in line.points:
        s = point.state.loads["s"]
        assert point.state.loads["load"] == pytest.approx(0.5 - max(s - 1, 0) ** 2, abs=1e-10)


def test_an_onset_held_by_a_functional_is_a_line_too():
    system, _ = bowed()
    solver = ExtendedNewton(system, ["load", "s"])
    begin = State(np.full(system.size, 0.5), {"load": 0.5, "s": 0.7})
    line = line_of(
        LineContinuation(solver, Held("u", 0.4), STEPS), begin, "s", 1.0, lambda p: p.state.loads["s"] > 1
    )
    assert [point.state.loads["load"] for point in line.points] == pytest.approx([0.4] * len(line.points))
