"""A spring that only pushes: where it lets go of the tube, and its tractions."""

from dataclasses import replace

import numpy as np
import pytest
from mpi4py import MPI
from tube_data import LONG_STEPS, data

from weakforms import reference, solve
from weakforms.problems.tube.phases import TubePhases
from weakforms.solvers.support.sampling import Sampler

pytestmark = pytest.mark.paper2


@pytest.fixture(scope="module")
def unilateral():
    given = replace(data(delta1=2.0), unilateral=True)
    return TubePhases(MPI.COMM_SELF, given, p_end=3.0, step=0.08, terms=19)


def test_the_mesh_follows_the_place_where_the_spring_lets_go(unilateral):
    pressed, going, released = (getattr(unilateral, part) for part in unilateral.deflations)
    front, places = pressed.points[0].state.loads["front"], going.over_points("let_go")
    assert places[0] == pytest.approx(front, rel=1e-4)
    assert np.all(np.diff(places) < 0)
    assert places[-1] == pytest.approx(0.012, abs=1e-12)
    for point in going.points:
        assert abs(point.monitors["let_go_gap"]) < 1e-11
        assert point.state.loads["front"] == front
    u = [branch.over_points("u_max") for branch in (pressed, going, released)]
    assert u[0][-1] == pytest.approx(u[1][0], abs=1e-10)
    assert u[2][0] == pytest.approx(0.3, abs=1e-12)
    assert u[1][-1] == pytest.approx(0.3, abs=1e-5)
    assert np.all(np.diff(np.concatenate(u)) < 1e-9)


def test_the_spring_pushes_up_to_where_it_lets_go_and_not_beyond(unilateral):
    going = unilateral.letting_go
    system, point = going.system, going.points[len(going.points) // 2]
    places = np.array([0.5, 0.99, 1.01, 1.1]) * point.state.loads["let_go"]
    with system.at(point.state):
        at = system.formulation.locate(places, point.state.loads)
        f_k = Sampler(system.unknown, system.formulation.profile, at)()["f_k"]
    assert np.all(f_k[:2] < 0)
    assert np.all(f_k[2:] == 0)


def lets_go(alpha, at=()):
    given = {"contact": "adhesive", "phase": "deflation", "spring": "unilateral", "delta1": 2.0}
    return solve("tube", alpha=alpha, **given, at=at, numerics=LONG_STEPS)


@pytest.fixture(scope="module")
def of_the_table():
    """Deflation with some of the rows of a table, and these rows."""
    table = reference(2, "fig06b_deflation_unilateral_alpha_0.1_delta1_2")
    rows = [list(table.columns["p"]).index(p) for p in (2.8, 1.2, 0.0)]
    return lets_go(0.1, [("p", float(table.columns["p"][row])) for row in rows]), table, rows


@pytest.mark.parametrize("alpha", [0.0, 0.1])
def test_tractions_where_a_spring_just_lets_go_have_the_uncertainty_of_round_off(alpha, of_the_table):
    """The state at which the mesh begins to follow that place is there twice, on both meshes."""
    (branch,) = (of_the_table[0] if alpha else lets_go(alpha)).branches
    (i,) = np.flatnonzero(np.diff(branch.columns["p"]) == 0)[:1]
    for name in ("traction_max", "traction_front", "line_force", "V"):
        values, uncertainty = branch.columns[name][i : i + 2], branch.uncertainty[name][i : i + 2]
        assert abs(values[1] - values[0]) <= 2 * np.hypot(*uncertainty), name
        assert 2 * uncertainty.max() < 1e-3, "sharp enough to be judged"


def test_tractions_of_a_unilateral_spring_are_those_of_the_table(of_the_table):
    result, table, rows = of_the_table
    for row, state in zip(rows, result.states, strict=True):
        for name in ("traction_max", "line_force", "u_max"):
            found, theirs = state.quantities[name], table.columns[name][row]
            bound = 2 * np.hypot(found.uncertainty, table.uncertainty[name])
            assert abs(found.value - theirs) <= bound < 1e-4
