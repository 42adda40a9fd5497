"""Element matrices with gathered products are those that ffcx would write."""

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem, mesh
from ffcx.codegeneration import optimizer
from mpi4py import MPI

from weakforms.solvers.support import kernels

BODIES = {
    "interval": lambda: mesh.create_unit_interval(MPI.COMM_SELF, 3),
    "triangle": lambda: mesh.create_unit_square(MPI.COMM_SELF, 2, 2),
    "quadrilateral": lambda: mesh.create_unit_square(
        MPI.COMM_SELF, 2, 2, cell_type=mesh.CellType.quadrilateral
    ),
}


def tangent(cell: str) -> ufl.Form:
    """A second variation in two components, with values and derivatives of both."""
    body = BODIES[cell]()
    u = fem.Function(fem.functionspace(body, basix.ufl.element("Lagrange", cell, 2, shape=(2,))))
    u.interpolate(lambda x: np.vstack([x[0] + 0.3 * x[0] ** 2, 0.5 + x[0] * np.cos(x[1])]))
    g = ufl.grad(u)
    energy = ufl.inner(g, g) ** 2 + (u[0] * u[1] + g[0, 0] * g[1, 0]) * ufl.exp(u[0]) + u[1] ** 3
    return ufl.derivative(ufl.derivative(energy * ufl.dx(degree=4), u), u)


def assembled(form: ufl.Form, folder) -> tuple[np.ndarray, str]:
    """The matrix, and the C code that assembles it."""
    matrix = fem.assemble_matrix(fem.form(form, jit_options={"cache_dir": folder})).to_dense()
    return matrix, "".join(path.read_text() for path in folder.glob("*.c"))


@pytest.mark.parametrize("cell", BODIES)
def test_gathered_products_add_up_to_the_same_matrix(cell, tmp_path, monkeypatch):
    form = tangent(cell)
    ours, code = assembled(form, tmp_path / "ours")
    monkeypatch.setattr(optimizer, "licm", optimizer.licm.__wrapped__)
    usual, usual_code = assembled(form, tmp_path / "usual")
    assert "sum_0[" in code
    assert "sum_0[" not in usual_code
    assert np.abs(ours - usual).max() < 1e-14 * np.abs(usual).max()


def test_code_of_another_kind_is_left_to_ffcx(tmp_path, monkeypatch):
    """Where the loops do not look as expected, ffcx's own treatment follows."""
    form = tangent("interval")
    ours, _ = assembled(form, tmp_path / "ours")

    def unlike(_section):
        raise NotImplementedError

    monkeypatch.setattr(kernels, "_gathered", unlike)
    usual, code = assembled(form, tmp_path / "usual")
    assert "sum_0[" not in code
    assert np.abs(ours - usual).max() < 1e-14 * np.abs(usual).max()
