"""Classes of displacements of a square by the mirrors in its diagonals, the group C4v."""

import numpy as np
import pytest
from mpi4py import MPI

from weakforms import solve
from weakforms.errors import ConvergenceError
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.rectangle.branch import C4V, RectangleModes, traced
from weakforms.problems.rectangle.model import RectangleModel, Sheet
from weakforms.solvers.equilibrium.state import State

ALPHA = 0.1


def stress(delta):
    return 2 * (1 - delta**-6) * (1 + ALPHA * delta**2)


def ponding(gamma, delta):
    """The flat sheet is unstable in waves with m^2 + n^2 below this number."""
    return gamma * delta**2 / (stress(delta) * (np.pi / 2) ** 2)


def named(m, n):
    """Class of the wave (m, n); of a pair of waves that is not E, the sum comes first."""
    if m % 2 != n % 2:
        return "E"
    return ("A1" if m <= n else "B1") if m % 2 else ("B2" if m <= n else "A2")


def sheet(of=10.5, delta=1.1, **given):
    """A square sheet on which a liquid ponds in all waves with m^2 + n^2 below a number."""
    law = mooney_rivlin_of(ALPHA)
    given = {"gamma": of / ponding(1.0, delta), "cells": 6, **given}
    return RectangleModel(MPI.COMM_SELF, Sheet(law, delta=delta, delta_y=delta, **given))


def flat(model):
    return State(0 * model.system.initial.u, model.system.initial.loads | {"zw": 1e-300})


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("below", [5.5, 8.5, 10.5, 20.5])
def test_a_flat_sheet_ponds_in_each_class_at_the_closed_form(below, degree):
    """Counts of all waves with m^2 + n^2 below a number, in the class of each."""
    model = sheet(of=below, degree=degree, cells=6 * (3 - degree))
    waves = [named(m, n) for m in range(1, 6) for n in range(1, 6) if m * m + n * n < below]
    with model.system.at(flat(model)):
        found = RectangleModes(model).observe()
    assert {name: found[f"n_{name}"] for name in ("A1", "A2", "B1", "B2")} == {
        name: waves.count(name) for name in ("A1", "A2", "B1", "B2")
    }
    assert 2 * found["n_odd_even"] == waves.count("E")
    assert found["n_all"] == len(waves)
    assert found["n_odd_odd"] == found["n_A2"] + found["n_B2"]


@pytest.mark.parametrize(("n", "names"), [(0, ("A1", "B1")), (3, ("A2", "B2"))])
@pytest.mark.parametrize("load", ["gas", "liquid"])
def test_both_classes_of_the_diagonals_have_the_eigenvalues_of_their_class_of_the_mirrors(n, names, load):
    """Of a deflected state, on the same mesh: to round-off."""
    model = sheet(load=load)
    loads = {"p": 0.8} if load == "gas" else {"zw": -0.1}
    with model.system.at(State(model.cosine(0.5), model.system.initial.loads | loads)):
        whole = np.sort(model.variation(n).spectrum(6).eigenvalues)
        parts = np.sort([value for name in names for value in model.variation(name).spectrum(6).eigenvalues])
    assert parts[:6] == pytest.approx(whole, rel=1e-8)


@pytest.mark.parametrize(("squares", "n", "name"), [(2, 0, "A1"), (5, 1, 1), (8, 3, "B2")])
def test_the_class_that_breaks_is_that_of_the_zero_eigenvalue(squares, n, name):
    model = sheet(of=squares)
    with model.system.at(flat(model)):
        assert RectangleModes(model).breaking(n) == C4V[name]


@pytest.mark.parametrize("name", ["A2", "B1", "B2"])
def test_rates_of_a_class_along_the_states_are_those_of_its_form(name):
    """What locates a zero eigenvalue: the derivative of phi K phi in the states, of the part that is seen."""
    model = sheet(load="gas")
    system, octant = model.system, model.variation(name)
    rng = np.random.default_rng(3)
    phi = rng.standard_normal(system.size)
    phi[octant.bc_dofs] = 0.0

    def quadratic(height):
        with system.at(State(model.cosine(height), system.initial.loads | {"p": 0.4})):
            octant.tangent()
            with_rate = octant.quadratic_gradient(phi, ())[0] @ model.cosine(1.0)
            return phi @ octant.multiply(octant.matrix, phi), with_rate

    h = 1e-5
    (low, _), (_, rate), (high, _) = (quadratic(0.3 + step) for step in (-h, 0.0, h))
    assert (high - low) / (2 * h) == pytest.approx(rate, rel=1e-6)


def test_a_drop_breaks_in_the_pair_of_classes():
    """A deep narrow drop on a coarse mesh: a bifurcation of the mesh, at which a mirror is lost."""
    law = mooney_rivlin_of(0.0)
    drop = Sheet(law, gamma=12.0, cells=4)
    branch = traced(RectangleModel(MPI.COMM_SELF, drop), 0.02, 3.0, 0.2)
    (found,) = (solved.values for solved in branch.special() if solved.kind == "bifurcation_point")
    assert (found["n"], found["C4v"]) == (1, C4V[1])


def test_limit_loads_of_a_square_keep_all_its_mirrors():
    found = solve("rectangle", gamma=5.0, w_end=1.0, numerics={"cells": 4, "levels": 2})
    assert [point.values["C4v"] for point in found.points("limit_point")] == [C4V["A1"]] * 2
    branch = found.branch()
    rest = sum(branch[name] for name in ("n_odd_even", "n_even_odd", "n_odd_odd"))
    assert (branch["n_A1"] + branch["n_B1"] == branch["n_all"] - rest).all()
    assert set(branch["n_A1"]) == {0, 1}
    assert not any(branch[f"n_{name}"].any() for name in ("A2", "B1", "B2"))


def test_a_rectangle_has_no_diagonals():
    found = solve("rectangle", gamma=5.0, c=1.5, w_end=0.31, numerics={"cells": 4, "levels": 2})
    assert "n_A1" not in found.branch().columns


def test_a_state_without_the_mirrors_in_the_diagonals_is_refused():
    model = sheet()
    modes = RectangleModes(model)
    place = model.space.tabulate_dof_coordinates()[: model.system.size // 3]
    for power, refused in ((0, False), (2, True)):
        u = model.cosine(0.3).reshape(-1, 3)
        u[:, 2] *= 1 + 1e-4 * place[:, 0] ** power
        with model.system.at(State(u.ravel(), model.system.initial.loads)):
            if refused:
                with pytest.raises(ConvergenceError, match="has lost the mirrors in its diagonals by "):
                    modes.observe()
            else:
                modes.observe()
