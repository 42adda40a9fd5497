"""What is compiled once is found again."""

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem, mesh
from ffcx.naming import compute_signature
from mpi4py import MPI

import weakforms.solvers  # noqa: F401  (puts the cache in place)

POINTS = np.array([[0.0], [1.0]])


def expression(cells: int, variables: int = 1, swapped: bool = False) -> ufl.core.expr.Expr:
    """Of a new function and new constants on a new mesh, as a problem makes them for each of its meshes."""
    body = mesh.create_unit_interval(MPI.COMM_SELF, cells)
    u = fem.Function(fem.functionspace(body, basix.ufl.element("Lagrange", "interval", 2)))
    loads = [fem.Constant(body, 1.0) for _ in range(2)]
    a, b = (ufl.variable(load) for load in loads[:: -1 if swapped else 1])
    stretch = ufl.variable(u.dx(0))
    energy = a * stretch**2 + b**2 * stretch
    if variables == 2:
        energy += ufl.variable(u.dx(0)) ** 3
    return ufl.as_vector([ufl.diff(energy, stretch), energy])


def signature(of: ufl.core.expr.Expr) -> str:
    return compute_signature([(of, POINTS)], "")


def test_an_expression_has_the_same_name_on_every_mesh_and_after_any_other():
    first = signature(expression(2))
    for _ in range(11):
        ufl.variable(ufl.as_ufl(1.0))
    assert signature(expression(5)) == first


@pytest.mark.parametrize("other", [{"variables": 2}, {"swapped": True}])
def test_different_expressions_have_different_names(other):
    assert signature(expression(2, **other)) != signature(expression(2))


def test_both_compile_to_what_they_say():
    """The shared module reads the constants of the expression it is given."""
    for swapped, expected in ((False, 2 * 3.0 * 2 + 5.0**2), (True, 2 * 5.0 * 2 + 3.0**2)):
        body = mesh.create_unit_interval(MPI.COMM_SELF, 1)
        u = fem.Function(fem.functionspace(body, basix.ufl.element("Lagrange", "interval", 1)))
        u.interpolate(lambda x: 2 * x[0])
        loads = [fem.Constant(body, value) for value in (3.0, 5.0)]
        a, b = (ufl.variable(load) for load in loads[:: -1 if swapped else 1])
        stretch = ufl.variable(u.dx(0))
        slope = fem.Expression(ufl.diff(a * stretch**2 + b**2 * stretch, stretch), POINTS)
        assert slope.eval(body, np.array([0], dtype=np.int32)).ravel() == pytest.approx([expected] * 2)
