"""Problem ``membrane``: exact states, the problems it shares bodies with, and balances."""

import numpy as np
import pytest
import shapes_of_gmsh as shapes
import ufl
from dolfinx import fem
from mpi4py import MPI
from numpy.polynomial import Chebyshev
from scipy.optimize import brentq

import weakforms
from weakforms import solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.membrane.files import from_file
from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.problems.membrane.readings import Highest
from weakforms.problems.membrane.shapes import disk, square
from weakforms.solvers.equilibrium.state import State

COARSE = {"cells": 8, "levels": 2}
ALPHA, DELTA = 0.1, 1.1


def model(reference, **given):
    return MembraneModel(MPI.COMM_SELF, Body(reference, mooney_rivlin_of(ALPHA), **given))


def bulge(of, seed=0):
    """A state far from equilibrium, with all supports."""
    u = 0.1 * np.random.default_rng(seed).standard_normal(of.system.size)
    u[of.system.bc_dofs] = 0.0
    return State(u, of.system.initial.loads | {"p": 0.7})


@pytest.fixture(scope="module")
def bowl(tmp_path_factory):
    """A curved sheet with a held edge that lies in no plane: a saddle's edge, and curved triangles."""
    given = disk(3, 2)
    points = given.points.copy()
    points[:, 2] = 0.5 * (1 - points[:, 0] ** 2) + 0.3 * points[:, 1] ** 2 + 0.1 * points[:, 0]
    return type(given)(points, given.cells, given.held, {})


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("curved", [1, 2])
def test_a_flat_sheet_is_uniform(degree, curved):
    of = model(disk(3, curved), degree=degree)
    with of.system.at(of.system.initial):
        assert np.abs(of.system.residual()).max() < 1e-13
        found = of.system.monitors()
    trace, area = 2 * DELTA**2, DELTA**4
    energy = trace + 1 / area - 3 + ALPHA * (area + trace / area - 3)
    assert found["U"] == pytest.approx(of.area * energy, rel=1e-12)
    assert (found["V"], found["w_c"]) == pytest.approx((0, 0), abs=1e-13)


@pytest.mark.parametrize("degree", [1, 2])
def test_the_deflection_is_read_at_its_node_and_its_maximum_between_nodes(degree):
    of = model(disk(3, 2), degree=degree)
    field = fem.Function(of.space)
    field.interpolate(
        lambda x: np.vstack([0 * x[0], 0 * x[0], 1 - (x[0] - 0.1) ** 2 - 2 * (x[1] - 0.05) ** 2])
    )
    with of.system.at(State(field.x.array[: of.system.size].copy(), of.system.initial.loads)):
        assert of.system.monitor("w_c") == pytest.approx(1 - 0.01 - 0.005, rel=1e-12)
        highest = Highest(of)()
    assert highest == pytest.approx(1.0, rel=1e-12) if degree == 2 else 0.98 < highest < 1


@pytest.mark.parametrize("relaxed", [True, False])
def test_residual_and_tangent_are_derivatives_of_the_potential(bowl, relaxed):
    of = model(bowl, relaxed=relaxed)
    at, system = bulge(of), of.system
    step = np.random.default_rng(1).standard_normal(system.size)
    step[system.bc_dofs] = 0.0
    h = 1e-7

    def shifted(by):
        with system.at(State(at.u + by * step, at.loads)):
            return system.monitor("Pi"), system.residual()

    (up, forces_up), (down, forces_down) = shifted(h), shifted(-h)
    with system.at(at):
        slope, product = system.residual() @ step, system.multiply(system.tangent(), step)
        skew = system.tangent().copy()
    assert (up - down) / (2 * h) == pytest.approx(slope, rel=1e-5)
    assert np.linalg.norm((forces_up - forces_down) / (2 * h) - product) < 2e-3 * np.linalg.norm(product)
    skew.axpy(-1.0, skew.copy().transpose())
    assert skew.norm() < 1e-12 * system.matrix.norm()


@pytest.mark.parametrize(("curved", "degree"), [(False, 1), (True, 1), (True, 2)])
def test_the_supports_bear_the_pressure_on_the_frame(bowl, curved, degree):
    """The sum of all nodal forces is -p times the area vector that the held edge spans, on any mesh."""
    of = model(bowl if curved else square(3), degree=degree)
    forces = fem.form(of.system.formulation.residual)
    with of.system.at(bulge(of)):
        total = fem.assemble_vector(forces).array.reshape(-1, 3).sum(axis=0)
    flat = model(disk(3, 2)).area if curved else 4.0
    assert total[2] == pytest.approx(-0.7 * DELTA**2 * flat, rel=1e-9)


@pytest.mark.parametrize(("held", "mirrors"), [([], "xyz"), (["z"], "xy"), (["x"], "yz")])
def test_the_load_is_a_pressure_along_the_normals_with_any_supports(tmp_path, held, mirrors):
    """Of the potential, against its virtual work: edges on a horizontal mirror move and bear no load."""
    path = shapes.written(tmp_path / "ball.msh", shapes.octant, 0.5, order=2)
    of = model(from_file(str(path), 1.0, held, [*mirrors]), delta=1.3)
    system, p = of.system, 0.7
    reference = ufl.Jacobian(of.mesh)
    deformed = ufl.dot(ufl.grad(of.membrane.position), reference)
    normal = ufl.cross(deformed[:, 0], deformed[:, 1]) / ufl.sqrt(ufl.det(reference.T * reference))
    pushed = fem.form(-p * ufl.inner(normal, ufl.TestFunction(of.space)) * of.dx)
    forces = []
    for pressure in (0.0, p):
        with system.at(State(bulge(of).u, system.initial.loads | {"p": pressure})):
            forces.append(system.residual())
            wanted = fem.assemble_vector(pushed).array[: system.size].copy()
    wanted[system.bc_dofs] = 0.0
    assert np.abs(forces[1] - forces[0] - wanted).max() < 1e-12 * np.abs(wanted).max()


def test_gas_derives_its_volume(bowl):
    of = model(bowl)
    h, values = 1e-5, []
    for p in (0.3 - h, 0.3, 0.3 + h):
        with of.system.at(State(bulge(of).u, of.system.initial.loads | {"p": p})):
            values.append(of.system.monitors())
    assert (values[2]["Pi"] - values[0]["Pi"]) / (2 * h) == pytest.approx(-values[1]["V"], rel=1e-8)


def test_the_square_is_that_of_rectangle():
    """The same triangles by another model, without its symmetry: the same numbers to round-off."""
    at = {"w_c": 0.5}
    given = {"alpha": 0.0, "w_end": 0.8, "at": at, "numerics": {"cells": 4, "levels": 2}}
    (own,) = solve("membrane", mesh="square", **given).states
    (other,) = solve("rectangle", load="gas", symmetry="full", **given).states
    for name in ("p", "V", "Pi", "U", "S_least"):
        assert own.quantities[name].value == pytest.approx(other.quantities[name].value, rel=1e-9), name
    assert own.quantities["w_max"].value == pytest.approx(0.5, rel=1e-9)


def test_an_eighth_of_a_balloon_is_a_balloon(tmp_path):
    """Curved triangles, no held edge, three mirrors: P = 4 (1/lam - 1/lam^7), its limit at lam^6 = 7."""
    path = shapes.written(tmp_path / "ball.msh", shapes.octant, 0.25, order=2)
    given = {"mirror": "x,y,z", "delta": 1, "alpha": 0, "w_end": 0.6}
    found = solve("membrane", mesh=str(path), **given, at={"p": 2.0}, numerics={"levels": 2})
    (limit,), (state,) = found.points("limit_point"), found.states
    # The surface is that of the file: quadratic triangles of this size.
    assert limit.values["p"] == pytest.approx(4 * (7 ** (-1 / 6) - 7 ** (-7 / 6)), rel=1e-4)
    volume = np.pi / 6 * (np.sqrt(7) - 1)
    assert limit.values["V"] == pytest.approx(volume, rel=1e-3)
    sheet = next(f for f in state.fields if f.name == "triangles").columns
    assert np.ptp(sheet["lam1"]) < 0.01
    assert (sheet["state"] == 1).all()


def test_the_mass_in_an_eighth_of_a_balloon_folds_at_the_closed_form(tmp_path):
    """V is the volume beyond that at rest, which is part of the reservoir: 4/3 pi lam^3/8 and V_r - pi/6."""
    path = shapes.written(tmp_path / "ball.msh", shapes.octant, 0.25, order=2)
    given = {"mirror": "x,y,z", "delta": 1, "alpha": 0, "w_end": 0.8}
    gas = {"kappa": 1.4, "p_atm": 0.5, "V_r": 20.0}
    found = solve("membrane", mesh=str(path), **given, **gas, numerics={"levels": 2})
    (fold,) = found.points("mass_fold")

    def slope(lam):
        p, rate = 4 * (1 / lam - 1 / lam**7), 4 * (-1 / lam**2 + 7 / lam**8)
        volume = np.pi / 6 * (lam**3 - 1)
        return (volume + 20.0) * rate + 1.4 * (p + 0.5) * np.pi / 2 * lam**2

    lam = brentq(slope, 7 ** (1 / 6), 1.7)
    assert fold.values["p"] == pytest.approx(4 * (1 / lam - 1 / lam**7), rel=1e-4)
    assert fold.values["V"] == pytest.approx(np.pi / 6 * (lam**3 - 1), rel=2e-3)


def test_a_quarter_has_the_numbers_of_the_whole(tmp_path):
    path = shapes.written(tmp_path / "quarter.msh", shapes.quarter_disk, 0.2, order=2)
    given = {"alpha": 0.0, "w_end": 0.6, "at": {"w_c": 0.5}, "numerics": {"levels": 2}}
    (part,) = solve("membrane", mesh=str(path), mirror="left, bottom", **given).states
    given["numerics"] = {"cells": 12, "levels": 2}
    (whole,) = solve("membrane", **given).states
    for name, copies in (("p", 1), ("V", 4), ("U", 4)):
        own, other = part.quantities[name], whole.quantities[name]
        assert copies * own.value == pytest.approx(other.value, rel=3e-5), name


@pytest.mark.slow
def test_work_of_gas_is_the_change_of_strain_energy(tmp_path):
    """DU = p dV on a mesh without any symmetry, with a held hole."""
    path = shapes.written(tmp_path / "hole.msh", lambda: shapes.round_sheet(True), 0.4)
    nodes = 0.3 + 0.15 * np.cos(np.pi * np.arange(8, -1, -1) / 8)
    given = {"at": [("w_c", float(w)) for w in nodes], "w_end": 0.6, "numerics": {"levels": 2}}
    found = solve("membrane", mesh=str(path), **given)
    assert found.failures == []
    p, volume, energy = ([s.quantities[n].value for s in found.states] for n in ("p", "V", "U"))
    rate = (Chebyshev.fit(nodes, p, 8) * Chebyshev.fit(nodes, volume, 8).deriv()).integ()
    assert rate(nodes[-1]) - rate(nodes[0]) == pytest.approx(energy[-1] - energy[0], rel=1e-6)


def test_the_order_of_a_file_does_not_matter(tmp_path):
    path = shapes.written(tmp_path / "ell.msh", shapes.ell, 0.4)
    given = from_file(str(path), 1.0, [], [])
    turn = np.random.default_rng(0).permutation(len(given.points))
    other = type(given)(given.points[np.argsort(turn)], turn[given.cells], turn[given.held], {})
    assert other.points[other.centre] == pytest.approx(given.points[given.centre])


@pytest.mark.slow
def test_an_ell_rises_most_near_its_inner_corner(tmp_path):
    path = shapes.written(tmp_path / "ell.msh", shapes.ell, 0.25)
    found = weakforms.solve("membrane", mesh=str(path), w_end=0.4, at={"w_max": 0.3}, numerics={"levels": 2})
    place = [found.quantities[f"{name}_c"].value for name in "XY"]
    assert np.abs(np.array(place) + 0.4).max() < 0.2
    (state,) = found.states
    assert state.quantities["w_max"].value == pytest.approx(0.3, rel=1e-8)
    assert 0.28 < state.quantities["w_c"].value <= 0.3
