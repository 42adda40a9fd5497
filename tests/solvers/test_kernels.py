"""Element matrices that BLAS adds up are those that ffcx's loops would add up."""

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem, mesh
from ffcx.codegeneration import integral_generator
from mpi4py import MPI

from weakforms.solvers.support import kernels

BODIES = {
    "interval": lambda: mesh.create_unit_interval(MPI.COMM_SELF, 3),
    "triangle": lambda: mesh.create_unit_square(MPI.COMM_SELF, 2, 2),
    "quadrilateral": lambda: mesh.create_unit_square(
        MPI.COMM_SELF, 2, 2, cell_type=mesh.CellType.quadrilateral
    ),
}


def space_on(cell: str, degree: int = 2, size: int = 2) -> fem.FunctionSpace:
    """Functions of some components on a body of a few cells."""
    return fem.functionspace(BODIES[cell](), basix.ufl.element("Lagrange", cell, degree, shape=(size,)))


def tangent(cell: str, degree: int = 2) -> ufl.Form:
    """A second variation in two components, with values and derivatives of both."""
    u = fem.Function(space_on(cell, degree))
    u.interpolate(lambda x: np.vstack([x[0] + 0.3 * x[0] ** 2, 0.5 + x[0] * np.cos(x[1])]))
    g = ufl.grad(u)
    energy = ufl.inner(g, g) ** 2 + (u[0] * u[1] + g[0, 0] * g[1, 0]) * ufl.exp(u[0]) + u[1] ** 3
    return ufl.derivative(ufl.derivative(energy * ufl.dx(degree=4), u), u)


def with_gaps(cell: str) -> ufl.Form:
    """Forms of three components in which most pairs of them, and most derivatives, do not occur."""
    space = space_on(cell, 3, 3)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    x = ufl.SpatialCoordinate(space.mesh)
    parts = u[0] * v[0] + x[0] * u[2].dx(0) * v[2] + x[0] ** 2 * u[0] * v[1].dx(0) - u[2] * v[0].dx(0)
    return parts * ufl.dx(degree=8)


def of_unlike_spaces(cell: str) -> ufl.Form:
    """Rows and columns of different degrees."""
    columns = space_on(cell, 2, 2)
    rows = fem.functionspace(columns.mesh, basix.ufl.element("Lagrange", cell, 3, shape=(2,)))
    u, v = ufl.TrialFunction(columns), ufl.TestFunction(rows)
    return (u[0].dx(0) * v[1] + u[1] * v[0].dx(0) + u[1] * v[1]) * ufl.dx(degree=6)


def on_the_edge(cell: str) -> ufl.Form:
    """An integral along the edges of a body, whose tables depend on the edge of the cell."""
    space = space_on(cell, 3, 2)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    x = ufl.SpatialCoordinate(space.mesh)
    return (1 + x[0]) * (ufl.inner(u, v) + u[0].dx(0) * v[1]) * ufl.ds(degree=6)


def assembled(form: ufl.Form, folder) -> tuple[np.ndarray, str]:
    """The matrix, and the C code that assembles it."""
    matrix = fem.assemble_matrix(fem.form(form, jit_options={"cache_dir": folder})).to_dense()
    return matrix, "".join(path.read_text() for path in folder.glob("*.c"))


FORMS = {
    **{f"tangent-{cell}": (tangent, cell) for cell in BODIES},
    **{f"gaps-{cell}": (with_gaps, cell) for cell in BODIES},
    **{f"degrees-{cell}": (of_unlike_spaces, cell) for cell in BODIES},
    "edges-triangle": (on_the_edge, "triangle"),
    "edges-quadrilateral": (on_the_edge, "quadrilateral"),
}


@pytest.mark.parametrize("name", FORMS)
def test_blas_adds_up_the_same_matrix(name, tmp_path, monkeypatch):
    make, cell = FORMS[name]
    form = make(cell)
    ours, code = assembled(form, tmp_path / "ours")
    monkeypatch.setattr(kernels, "LARGEST", 0)
    usual, usual_code = assembled(form, tmp_path / "usual")
    assert "weakforms_add_product(A" in code
    assert "weakforms_add_product" not in usual_code
    assert np.abs(usual).max() > 0
    assert np.abs(ours - usual).max() < 1e-14 * np.abs(usual).max()


def test_tables_without_a_row_for_each_point_are_left_to_ffcx(tmp_path):
    """Derivatives of linear functions on triangles are the same at each point."""
    _, code = assembled(tangent("triangle", 1), tmp_path)
    assert "weakforms_add_product" not in code


def test_code_of_another_kind_is_left_to_ffcx(tmp_path, monkeypatch):
    """Where the loops do not look as expected, ffcx's own treatment follows."""
    form = tangent("interval")
    ours, _ = assembled(form, tmp_path / "ours")

    def unlike(_section):
        raise NotImplementedError

    monkeypatch.setattr(kernels, "_gathered", unlike)
    usual, code = assembled(form, tmp_path / "usual")
    assert "weakforms_add_product" not in code
    assert np.abs(ours - usual).max() < 1e-14 * np.abs(usual).max()


def test_products_are_not_lost_where_no_loop_takes_them(tmp_path, monkeypatch):
    """An ffcx that calls its treatment of loops from elsewhere gets its own loops."""
    form = tangent("quadrilateral")
    ours, _ = assembled(form, tmp_path / "ours")
    generator = integral_generator.IntegralGenerator
    usual = generator.generate_quadrature_loop.__wrapped__
    monkeypatch.setattr(generator, "generate_quadrature_loop", usual)
    found, code = assembled(form, tmp_path / "usual")
    assert "weakforms_add_product" not in code
    assert np.abs(ours - found).max() < 1e-14 * np.abs(found).max()
