"""Relaxed energies: the table of states, the modified gradient and the form in C are one function."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI

from weakforms.forms.loads import enclosed_volume, liquid_potential
from weakforms.forms.materials import mooney_rivlin, mooney_rivlin_surface, neo_hookean
from weakforms.forms.wrinkling import (
    modified_gradient,
    relaxed,
    surface_tension_field,
    tension_field,
)

pytestmark = pytest.mark.paper4


def varga(a, b):
    return a + b + 1 / (a * b) - 3


def ogden(a, b):
    return sum(mu / n * (a**n + b**n + (a * b) ** -n - 3) for mu, n in ((1.3, 1.7), (-0.2, -2.0)))


def mooney(a, b):
    return mooney_rivlin(a, b, 0.01)


LAWS = {"neo_hookean": neo_hookean, "mooney_rivlin": mooney, "varga": varga, "ogden": ogden}
STATES = {
    "taut": [(1.5, 1.2), (0.95, 1.3), (1.05, 1.05), (2.0, 0.9)],
    "along 1": [(1.5, 0.5), (2.5, 0.05), (1.01, 0.6)],
    "along 2": [(0.5, 1.5), (0.05, 2.5), (0.6, 1.01)],
    "slack": [(0.9, 0.8), (0.3, 0.99), (0.05, 0.05)],
}


def derivatives(law, form):
    """Energy ``W``, stresses and tangent of a law in a form, by UFL, as functions of two stretches."""
    mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
    stretches = fem.Constant(mesh, np.ones(2))
    l1, l2 = ufl.variable(stretches[0]), ufl.variable(stretches[1])
    w = form(law)(l1, l2)
    first = [ufl.diff(w, l1), ufl.diff(w, l2)]
    second = [ufl.diff(first[0], l1), ufl.diff(first[0], l2), ufl.diff(first[1], l2)]
    expression = fem.Expression(ufl.as_vector([w, *first, *second]), np.array([[0.5]]))

    def at(a, b):
        stretches.value[:] = a, b
        values = expression.eval(mesh, np.array([0], dtype=np.int32)).ravel()
        return dict(zip(("W", "W1", "W2", "W11", "W12", "W22"), values.tolist(), strict=True))

    return at


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("state", STATES)
def test_both_forms_agree_in_energy_stress_and_tangent(law, state):
    table, widened = (derivatives(LAWS[law], form) for form in (tension_field, modified_gradient))
    for point in STATES[state]:
        assert widened(*point) == pytest.approx(table(*point), rel=1e-13, abs=1e-13)
        assert (table(*point)["W"] == 0) == (state == "slack")


@pytest.mark.parametrize("law", LAWS)
def test_natural_width_leaves_no_stress_across_and_the_least_energy(law):
    full = derivatives(LAWS[law], lambda w: w)
    for stretch in (1.1, 1.6, 3.0):
        width = stretch**-0.5
        assert full(stretch, width)["W2"] == pytest.approx(0, abs=1e-13)
        nearby = [full(stretch, width + d)["W"] for d in (-0.01, 0.0, 0.01)]
        assert nearby[1] == min(nearby)


def test_relaxed_mooney_rivlin_is_the_printed_one():
    mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
    stretch = fem.Constant(mesh, 1.7)
    value = fem.Expression(relaxed(mooney)(stretch), np.array([[0.5]])).eval(mesh, np.array([0]))
    assert value.item() == pytest.approx(1.7**2 + 2 / 1.7 - 3 + 0.01 * (2 * 1.7 + 1.7**-2 - 3), rel=1e-14)


@pytest.mark.parametrize("state", STATES)
def test_the_form_by_the_metric_has_the_same_energy_and_stress(state):
    """C of principal stretches in rotated directions; its derivative is the stress in these directions."""
    mesh = dmesh.create_unit_interval(MPI.COMM_SELF, 1)
    c = fem.Constant(mesh, np.eye(2))
    tensor = ufl.variable(ufl.as_tensor([[c[0, 0], c[0, 1]], [c[1, 0], c[1, 1]]]))
    energy = surface_tension_field(tensor, mooney_rivlin_surface(0.01))
    stress = ufl.diff(energy, tensor)
    every = fem.Expression(
        ufl.as_vector([energy, *(stress[i, j] for i in (0, 1) for j in (0, 1))]), np.array([[0.5]])
    )
    table = derivatives(mooney, tension_field)
    for a, b in STATES[state]:
        expected = table(a, b)
        for angle in (0.0, 0.4, 1.2):
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            c.value[:] = turn @ np.diag([a**2, b**2]) @ turn.T
            value = every.eval(mesh, np.array([0])).ravel()
            # dw/dC has eigenvalues w_i/(2 l_i).
            turned = turn.T @ value[1:].reshape(2, 2) @ turn
            assert value[0] == pytest.approx(expected["W"], abs=1e-12)
            assert np.diag(turned) == pytest.approx(
                [expected["W1"] / (2 * a), expected["W2"] / (2 * b)], abs=2e-7
            )


def test_liquid_potential_is_the_printed_one_up_to_a_constant():
    """With fixed ends, -int Phi r r' and -int gamma max(zw - z, 0) r^2 z'/2 have the same variations."""
    mesh = dmesh.create_interval(MPI.COMM_SELF, 40, [0.0, 1.0])
    space = fem.functionspace(mesh, ("Lagrange", 3, (2,)))
    shape = fem.Function(space)
    wavy = fem.Function(space)
    wavy.interpolate(lambda x: np.vstack([np.sin(np.pi * x[0]), np.sin(2 * np.pi * x[0])]))

    def both(amplitude):
        shape.interpolate(lambda x: np.vstack([1 + 0 * x[0], x[0]]))
        shape.x.array[:] += amplitude * wavy.x.array
        r, z = shape
        level = 1.3  # above all of it: nothing is cut by the surface
        by_ring = liquid_potential(r, r.dx(0), z, level, 0.7, ufl.lt(z, level))
        by_volume = -0.7 * (level - z) * enclosed_volume(r, z.dx(0))
        dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": 12})
        return [fem.assemble_scalar(fem.form(part * dx)) for part in (by_ring, by_volume)]

    first, second = both(0.0), both(0.1)
    assert second[0] - first[0] == pytest.approx(second[1] - first[1], rel=1e-12)
