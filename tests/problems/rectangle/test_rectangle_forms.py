"""The weak form of a rectangular membrane: exact states, thresholds, balances, and its derivatives."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms.forms.relaxed_surface import depth
from weakforms.forms.wrinkling import COALESCENCE
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.rectangle.model import CLASSES, RectangleModel, Sheet
from weakforms.problems.rectangle.readings import Centre
from weakforms.problems.triangles.readings import LeastStress
from weakforms.problems.triangles.weak_form import RULE
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

ALPHA, DELTA = 0.1, 1.1
STRESS = 2 * (1 - DELTA**-6) * (1 + ALPHA * DELTA**2)


def model(**given):
    return RectangleModel(MPI.COMM_SELF, Sheet(mooney_rivlin_of(ALPHA), **{"cells": 4, **given}))


def arbitrary(of, height=0.3, loads=None, seed=0):
    """A deflected state far from equilibrium, with all conditions."""
    u = of.cosine(height) + 0.02 * np.random.default_rng(seed).standard_normal(of.system.size)
    u[of.system.bc_dofs] = 0.0
    return State(u, of.system.initial.loads | (loads or {}))


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize("whole", [False, True])
def test_flat_sheet_is_uniform_and_stable(degree, whole):
    of = model(degree=degree, whole=whole, c=1.5)
    with of.system.at(of.system.initial):
        found = of.system.monitors()
        assert np.abs(of.system.residual()).max() < 1e-13
        assert of.variation(0).negative_count() == 0
        least = LeastStress(of.mesh, of.least_stress, RULE[degree]).least()[1]
        assert least == pytest.approx(STRESS, rel=COALESCENCE)
        assert Centre(of).stretch() == pytest.approx(DELTA, rel=1e-12)
    trace, area = 2 * DELTA**2, DELTA**4
    energy = trace + 1 / area - 3 + ALPHA * (area + trace / area - 3)
    assert found["U"] == pytest.approx(4 * 1.5 * energy, rel=1e-12)
    assert (found["w_c"], found["V_f"], found["f_w"]) == pytest.approx((0, 0, 0), abs=1e-13)


@pytest.mark.parametrize("degree", [1, 2])
def test_the_centre_is_read_at_the_centre(degree):
    of = model(degree=degree, load="gas")
    with of.system.at(State(of.cosine(0.37), of.system.initial.loads)):
        assert of.system.monitor("w_c") == pytest.approx(0.37, rel=1e-13)


@pytest.mark.parametrize(("load", "loads"), [("gas", {"p": 0.7}), ("liquid", {"zw": -0.05})])
def test_residual_and_tangent_are_derivatives_of_the_potential(load, loads):
    of = model(load=load, gamma=3.0)
    at, system = arbitrary(of, loads=loads), of.system
    step = np.random.default_rng(1).standard_normal(system.size)
    step[system.bc_dofs] = 0.0
    h = 1e-6

    def shifted(by):
        with system.at(State(at.u + by * step, at.loads)):
            return system.monitor("Pi"), system.residual()

    (up, forces_up), (down, forces_down) = shifted(h), shifted(-h)
    with system.at(at):
        slope, product = system.residual() @ step, system.multiply(system.tangent(), step)
        skew = system.tangent().copy()
    assert (up - down) / (2 * h) == pytest.approx(slope, rel=1e-6)
    assert np.linalg.norm((forces_up - forces_down) / (2 * h) - product) < 2e-4 * np.linalg.norm(product)
    skew.axpy(-1.0, skew.copy().transpose())
    assert skew.norm() < 1e-12 * system.matrix.norm()


@pytest.mark.parametrize(("load", "loads"), [("gas", {"p": 0.7}), ("liquid", {"zw": 0.2})])
@pytest.mark.parametrize("degree", [1, 2])
def test_the_load_is_normal_to_the_deformed_sheet(load, loads, degree):
    """The derivative of the potential against the pressure times the deformed normal, dof by dof."""
    of = model(load=load, gamma=3.0, degree=degree)
    at, test = of.membrane, ufl.TestFunction(of.space)
    z = at.position[2]
    pressure = of.scalars["p"][1] if load == "gas" else -3.0 * depth(z, of.scalars["zw"][1])
    exact = ufl.Measure("dx", of.mesh, metadata={"quadrature_degree": 3 * degree + 2})
    follower = fem.form(-pressure * ufl.dot(at.normal, test) * exact)
    potential = fem.form(ufl.derivative(at.load * exact, of.unknown, test))
    with of.system.at(arbitrary(of, loads=loads)):
        pushed, derived = (fem.assemble_vector(form).array for form in (follower, potential))
    for vector in (pushed, derived):
        vector[of.system.bc_dofs] = 0.0
    assert np.abs(pushed - derived).max() < 1e-14


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize(("load", "loads"), [("gas", {"p": 0.7}), ("liquid", {"zw": 0.1})])
def test_the_frame_bears_the_whole_load(degree, load, loads):
    """The sum of all vertical forces is -p times the frame's area, or the weight of the liquid, exactly."""
    of = model(load=load, gamma=3.0, degree=degree, whole=True, c=1.5, delta_y=1.2)
    forces = fem.form(of.system.formulation.residual)
    with of.system.at(arbitrary(of, loads=loads)):
        total = fem.assemble_vector(forces).array[2::3].sum()
        held = of.system.monitors()
    expected = -0.7 * 4 * 1.5 * 1.1 * 1.2 if load == "gas" else 3.0 * held["V_f"]
    assert total == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "waves"),
    [("even_even", (1, 1)), ("odd_even", (2, 1)), ("even_odd", (1, 2)), ("odd_odd", (2, 2))],
)
@pytest.mark.parametrize("c", [1.0, 1.5])
def test_a_flat_sheet_ponds_at_the_closed_form(name, waves, c):
    """Gamma delta^2 = S (pi/2)^2 (m^2 + (n/c)^2) in the class of each wave, to the accuracy of the mesh."""
    m, n = waves
    critical = STRESS / DELTA**2 * (np.pi / 2) ** 2 * (m**2 + (n / c) ** 2)
    number = next(k for k, other in CLASSES.items() if other == name)
    for side, count in ((-1, 0), (1, 1)):
        of = model(gamma=critical * (1 + side * 2e-4), c=c, cells=8)
        with of.system.at(State(0 * of.system.initial.u, of.system.initial.loads | {"zw": 1e-300})):
            assert of.variation(number).negative_count() == count


def test_an_unstable_pond_counts_alike_by_classes_and_whole():
    """Above the threshold of the pair, the flat sheet has three unstable waves, also on a whole mesh."""
    critical = STRESS / DELTA**2 * (np.pi / 2) ** 2 * 2
    counts = {}
    for whole in (False, True):
        of = model(gamma=2.6 * critical, whole=whole)
        with of.system.at(State(0 * of.system.initial.u, of.system.initial.loads | {"zw": 1e-300})):
            counts[whole] = [of.variation(n).negative_count() for n in of.classes]
    assert counts == {False: [1, 1, 1, 0], True: [3]}


@pytest.mark.parametrize("load", ["gas", "liquid"])
def test_the_load_derives_the_volume(load):
    """dPi/dp = -V at a fixed shape; dPi/dzw = -gamma V_f and the column over the frame."""
    of = model(load=load, gamma=3.0)
    control, amount = ("p", "V") if load == "gas" else ("zw", "V_f")
    h, values = 1e-5, []
    for value in (0.3 - h, 0.3, 0.3 + h):
        with of.system.at(arbitrary(of, loads={control: value})):
            values.append(of.system.monitors())
    slope = (values[2]["Pi"] - values[0]["Pi"]) / (2 * h)
    over = 0.0 if load == "gas" else 0.3 * 4 * DELTA**2
    factor = 1.0 if load == "gas" else 3.0
    assert slope == pytest.approx(-factor * (values[1][amount] - over), rel=1e-7)


def test_corners_keep_the_stretch_of_the_frame():
    """Both edges fix the tangent there, so that F = delta I for every load; the error falls with the mesh."""
    errors = []
    for cells in (4, 8):
        of = model(load="gas", cells=cells)
        newton = ExtendedNewton(of.system, ["p"])
        at = State(of.cosine(0.2), of.system.initial.loads | {"p": 0.6})
        state, _ = newton.solve(at, [Held("w_c", 0.2)])
        vertices = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
        with of.system.at(state):
            c = of.membrane.cauchy_green
            metric = fem.Expression(ufl.as_vector([c[0, 0], c[1, 1], c[0, 1]]), vertices)
            triangles = np.arange(of.mesh.topology.index_map(2).size_local, dtype=np.int32)
            values = metric.eval(of.mesh, triangles).reshape(-1, 3, 3)
        places = of.mesh.geometry.x[of.mesh.geometry.dofmap]
        corner = np.linalg.norm(places - [1.0, 1.0, 0.0], axis=2) < 1e-9
        errors.append(np.abs(values[corner] - [DELTA**2, DELTA**2, 0.0]).max())
    assert errors[1] < 0.7 * errors[0] < 0.02
