"""The fluid-loaded tube as a surface: forms as in the paper, and a mesh that follows the free surface."""

import dolfinx.fem.petsc as fem_petsc
import numpy as np
import pytest
import ufl
from bent_surfaces import DELTA, GAMMA, ONE, L, data
from dolfinx import fem

from weakforms import InputError, solve
from weakforms.forms.fluid import hydrostatic, membrane_work, pressure_work, strain_energy, submerged_flux
from weakforms.problems.liquid_tube.bent.bifurcation_point import position
from weakforms.problems.liquid_tube.bent.fitted import Fitting, KeptNewton
from weakforms.problems.liquid_tube.bent.front import front_of
from weakforms.problems.liquid_tube.bent.model import SurfaceModel
from weakforms.problems.material_choice import Chosen
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.state import State

pytestmark = pytest.mark.paper3
TANGENTS = [f"{vector}_{name}" for vector in "ab" for name in "xyz"]


def fitted(cells=6, around=4, degree=4, front=3.5):
    model = SurfaceModel(ONE, data(cells, around, degree, front=front))
    return model, Fitting(model, KeptNewton(model.system, ["zw"]))


@pytest.fixture(scope="module")
def model():
    return SurfaceModel(ONE, data())


def bulged(z, theta):
    """A smooth surface out of equilibrium, symmetric to the mirror plane only, that meets the rings."""
    t = np.pi * z / (L / DELTA)
    out = 1 + np.sin(t) * (0.6 + 0.3 * np.cos(theta) + 0.1 * np.cos(2 * theta))
    up = DELTA * z - 0.4 * np.sin(t) * (1 + 0.5 * np.cos(theta))
    return np.vstack([out * np.cos(theta), out * np.sin(theta), up])


def placed(model, zw, shape=bulged, front=None):
    """The state with a position, on a mesh that follows a front."""
    return model.state_of(shape, {"zw": zw} | (model.front.loads(front) if front is not None else {}))


def moved(model, by):
    return model.front.fitted(by(model.front.angles))


def assembled(model, form):
    vector = fem_petsc.assemble_vector(fem.form(form))
    out = vector.array.copy()
    out[model.system.bc_dofs] = 0.0
    return out


# -- meshes ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("uneven", [0.0, 0.3])
def test_prism_has_the_area_of_the_tube_and_its_angles(uneven):
    model = SurfaceModel(ONE, data(full=True, uneven=uneven))
    area = fem.assemble_scalar(fem.form(fem.Constant(model.mesh, 1.0) * model.dx))
    assert area == pytest.approx(2 * np.pi * L / DELTA, rel=1e-13)
    # The cylinder's tangent vectors, found from its interpolated position.
    state = placed(model, 0.0, lambda z, theta: np.vstack([np.cos(theta), np.sin(theta), DELTA * z]))
    at = model.surface(model.unknown)
    wanted = (ufl.dot(at.a, at.a) - DELTA**2) ** 2 + (ufl.dot(at.b, at.b) - 1) ** 2 + ufl.dot(at.a, at.b) ** 2
    with model.system.at(state):
        assert fem.assemble_scalar(fem.form(wanted * model.dx)) < 1e-4


# -- forms -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("zw", [3.37, 6.1, 9.0])
def test_tangent_is_the_residuals_derivative_and_symmetric(model, zw):
    check_tangent(model, placed(model, zw))


def check_tangent(model, state):
    system = model.system
    direction = np.random.default_rng(0).standard_normal(system.size)
    direction[system.bc_dofs] = 0.0
    h, sides = 1e-6, []
    for sign in (1, -1):
        with system.at(State(state.u + sign * h * direction, state.loads)):
            out = system.residual()
        out[system.bc_dofs] = 0.0
        sides.append(out)
    with system.at(state):
        matrix = system.tangent()
    product = system.multiply(matrix, direction)
    error = abs((sides[0] - sides[1]) / (2 * h) - product).max()
    assert error < 1e-5 * abs(product).max()  # a random direction moves the front across a few points
    rows = range(system.size)
    dense = matrix.getValues(rows, rows)
    assert abs(dense - dense.T).max() < 1e-12 * abs(dense).max()


@pytest.mark.parametrize("zw", [3.37, 6.1, 9.0])
@pytest.mark.parametrize("full", [False, True])
def test_potential_has_the_papers_first_variation(zw, full):
    """The vertical flux equals ``w_a.v_Z + w_b.v_Theta - P v.N`` by one rule; the kink's error falls."""
    model = SurfaceModel(ONE, data(full=full, alpha=0.1))
    state = placed(model, zw)
    at, v = model.surface(model.unknown), model.surface(ufl.TestFunction(model.space))
    level = fem.Constant(model.mesh, zw)  # not a number, for which the forms would be compiled each time
    pressure = hydrostatic(at.x[2], level, GAMMA, ufl.conditional(ufl.lt(at.x[2], level), 1.0, 0.0))
    energy = strain_energy(at.a, at.b, 0.1) + GAMMA * submerged_flux(at, model.zw, 2)
    errors = []
    for degree in (20, 80):
        rule = ufl.Measure("dx", model.mesh, metadata={"quadrature_degree": degree})
        with model.system.at(state):
            typed = assembled(model, (membrane_work(at, v, 0.1) + pressure_work(at, v, pressure)) * rule)
            derived = assembled(model, ufl.derivative(energy * rule, model.unknown))
            load = assembled(model, pressure_work(at, v, pressure) * rule)
        errors.append(abs(derived - typed).max() / abs(load).max())
    assert errors[1] < max(errors[0] / 5, 1e-12)
    assert errors[1] < 1e-3
    with model.system.at(state):
        own = model.system.residual()
    own[model.system.bc_dofs] = 0.0
    assert own == pytest.approx(model.copies * typed, abs=1e-2 * model.copies * abs(load).max())


def test_another_law_replaces_the_constant_in_energy_and_resultants():
    """Ogden's law with the exponents 2 and -2 is that of Mooney and Rivlin."""
    alpha, found = 0.1, []
    halves = {"mu2": -alpha, "alpha2": -2.0, "mu3": -alpha, "alpha3": -2.0}
    ogden = Chosen("ogden", tuple({"mu1": 2.0, "alpha1": 2.0, **halves}.items()))
    for given in ({"alpha": alpha}, {"material": ogden}):
        model = SurfaceModel(ONE, data(front=3.5, cells=6, **given))
        state = placed(model, 6.1)
        with model.system.at(state):
            values = np.array([[0.2], [0.1], [1.7], [0.3], [1.4], [-0.2]])
            profile = dict(zip(TANGENTS, values, strict=True))
            read = model.readings(dict.fromkeys("xyz", np.zeros(1)) | profile)
            found.append((model.system.residual(), [read["T1"][0], read["T2"][0]], model.system.monitors()))
    (one, read_one, columns), (other, read_other, others) = found
    assert other == pytest.approx(one, abs=1e-12 * abs(one).max())
    assert read_other == pytest.approx(read_one, rel=1e-13)
    assert others == pytest.approx(columns, rel=1e-12)


def test_volume_is_the_one_between_membrane_and_surface(model):
    for zw in (3.3, 7.1, 11.0):
        state = placed(model, zw, lambda z, theta: np.vstack([np.cos(theta), np.sin(theta), DELTA * z]))
        with model.system.at(state):
            assert model.system.monitor("V") == pytest.approx(np.pi * min(zw, L), abs=1e-5)
            area = model.system.monitor_gradient("V")[1]["zw"]
        assert area == pytest.approx(np.pi if zw < L else 0.0, abs=1e-3)


@pytest.mark.parametrize("zw", [3.37, 6.1, 9.0])
def test_level_and_volume_are_work_conjugate(model, zw):
    values = placed(model, zw).u
    h, sides = 1e-4, []
    for sign in (1, -1):
        with model.system.at(State(values, {"zw": zw + sign * h})):
            sides.append(model.system.monitor("Pi"))
    with model.system.at(State(values, {"zw": zw})):
        # V has a finer rule than Pi: what is left is the kink's quadrature error.
        assert (sides[0] - sides[1]) / (2 * h) == pytest.approx(-GAMMA * model.system.monitor("V"), rel=5e-4)


def test_points_read_the_position_they_name(model):
    state = placed(model, 5.0)
    with model.system.at(state):
        values = model.system.monitors()
        row, _ = model.system.monitor_gradient("r_mid")
    half, quarter = (bulged(np.array([f * L / DELTA] * 2), np.array([0.0, np.pi])) for f in (0.5, 0.25))
    assert [values["r_mid"], -values["r_mid_pi"]] == pytest.approx(half[0], abs=2e-4)
    assert [values["x_quarter_0"], values["x_quarter_pi"]] == pytest.approx(quarter[0], abs=2e-4)
    assert [values["z_quarter_0"], values["z_quarter_pi"]] == pytest.approx(quarter[2], abs=2e-4)
    assert row @ state.u == pytest.approx(values["r_mid"], rel=1e-12), "linear in the position"


def test_a_spline_of_the_position_is_a_guess_for_another_mesh(model):
    other = SurfaceModel(ONE, data(cells=16, around=8, degree=4))
    exact = placed(other, 5.0).u
    fitting = Fitting(model, KeptNewton(model.system, ["zw"]))
    assert other.interpolated(fitting.shape(placed(model, 5.0))) == pytest.approx(exact, abs=2e-3)


# -- the mesh that follows the free surface ------------------------------------------------------


def test_the_map_moves_the_row_and_is_inverted():
    model, _ = fitted()
    front, theta = model.front, np.linspace(0, np.pi, 9)
    front.put(front.fitted(3.4 + 0.1 * np.cos(front.angles)))
    assert front.at(theta) == pytest.approx(3.4 + 0.1 * np.cos(theta), abs=1e-14)
    assert front.material(np.full(9, 3.5), theta) == pytest.approx(front.at(theta), abs=1e-14)
    z = np.linspace(0, 4, 9)
    assert front.material(front.mesh(z, theta), theta) == pytest.approx(z, abs=1e-13)
    assert front.material(np.array([1.7, 2.0, 4.0]), np.zeros(3)) == pytest.approx([1.7, 2.0, 4.0])
    area = fem.assemble_scalar(fem.form(model.front.function.dx(0) * model.dx))
    assert area == pytest.approx(np.pi * L / DELTA, rel=1e-13)
    assert front.fitted(np.full(9, 4.1))[0] == pytest.approx(4.0 - 2e-4), "kept off the ring"


def test_a_surface_is_the_same_on_a_mesh_that_has_moved():
    """Position, tangent vectors and integrals do not depend on where the mesh has its rows."""
    (one, first), (two, _) = fitted(12, 6, 5), fitted(12, 6, 5)
    state, like = placed(one, 9.0), placed(two, 9.0, front=moved(two, lambda t: 3.55 + 0.02 * np.cos(t)))
    with one.system.at(state), two.system.at(like):
        a, b = one.system.monitors(), two.system.monitors()
    assert {k: b[k] for k in a} == pytest.approx(a, rel=1e-11)
    assert first.moved(state, like).u == pytest.approx(like.u, abs=1e-4)


def test_tangent_on_a_moved_mesh_is_the_residuals_derivative_and_symmetric():
    model, _ = fitted()
    front = moved(model, lambda t: 3.4 + 0.1 * np.cos(t))
    check_tangent(model, placed(model, 6.1, front=front))


def test_resultants_are_read_more_accurately_than_the_elements_have_them():
    errors = []
    for cells, around in ((6, 4), (12, 8)):
        model, _ = fitted(cells, around)
        h = 1e-5
        with model.system.at(placed(model, 9.0)):
            got = model.system.monitors()
        for side, theta in (("0", 0.0), ("pi", np.pi)):
            z, t = np.array([1.0 - h, 1.0 + h, 1.0, 1.0]), theta + np.array([0, 0, -h, h])
            x = bulged(z, t)
            lam1, lam2 = (np.linalg.norm(x[:, k + 1] - x[:, k]) / (2 * h) for k in (0, 2))
            errors.append(abs(got[f"T1_quarter_{side}"] - (lam1 / lam2 - (lam1 * lam2) ** -3)))
    assert max(errors[2:]) < 1e-5
    assert max(errors[2:]) < max(errors[:2]) / 16


def test_the_mesh_comes_to_rest_on_the_free_surface_and_keeps_the_order(primary):
    """Differences of the volumes on three meshes fall faster than the sixth power of the mesh size."""
    state, volumes = primary.at("zw", 7.0, np.linspace(0, L / DELTA, 121)), []
    for cells, around in ((6, 4), (12, 8), (24, 16)):
        model, fitting = fitted(cells, around)
        guess = model.state_of(position(state), {"zw": 7.0})
        found = fitting.solve(guess, [Held("zw", 7.0)])
        assert np.abs(fitting.refitted(found).u - found.u).max() < 1e-8
        with model.system.at(found):
            volumes.append(model.system.monitor("V"))
    errors = abs(np.array(volumes) / state.values["V"] - 1)
    assert errors[1] < errors[0] / 32
    assert errors[2] < 1e-9


def test_a_full_tube_has_no_free_surface_to_follow(primary):
    model, fitting = fitted()
    state = primary.at("zw", 8.1, np.linspace(0, L / DELTA, 121))
    loads = {"zw": 8.1} | model.front.loads(model.front.fitted(np.full(9, 3.7)))
    found = fitting.solve(model.state_of(position(state), loads), [Held("zw", 8.1)])
    assert front_of(found.loads) == pytest.approx([model.front.row] + [0.0] * 8)


# -- bad input -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"extent": "half", "uneven": 0.1}, "uneven = 0.1 needs extent = 'full'"),
        ({"uneven": 0.9}, "uneven = 0.9"),
        ({"at": {"zw": 7.0}}, "it has no states"),
        ({"numerics": {"cells": 10}}, "multiple of 4"),
    ],
)
def test_bad_input_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        solve("fluid_tube_surface", **given)
