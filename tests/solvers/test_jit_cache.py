"""Compiled forms are found again in the cache."""

import os

import basix.ufl
import ffcx
import numpy as np
import pytest
import ufl
from dolfinx import default_scalar_type, fem, mesh
from dolfinx import jit as dolfinx_jit
from ffcx.codegeneration import jit as ffcx_jit
from ffcx.naming import compute_signature
from mpi4py import MPI

from weakforms.solvers.support import jit_cache

POINTS = np.array([[0.0], [1.0]])


def expression(cells: int, variables: int = 1, swapped: bool = False) -> ufl.core.expr.Expr:
    """A form of a new function and constants on a new mesh, as a problem makes for each mesh."""
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
    """The shared module uses the constants of the expression it is given."""
    for swapped, expected in ((False, 2 * 3.0 * 2 + 5.0**2), (True, 2 * 5.0 * 2 + 3.0**2)):
        body = mesh.create_unit_interval(MPI.COMM_SELF, 1)
        u = fem.Function(fem.functionspace(body, basix.ufl.element("Lagrange", "interval", 1)))
        u.interpolate(lambda x: 2 * x[0])
        loads = [fem.Constant(body, value) for value in (3.0, 5.0)]
        a, b = (ufl.variable(load) for load in loads[:: -1 if swapped else 1])
        stretch = ufl.variable(u.dx(0))
        slope = fem.Expression(ufl.diff(a * stretch**2 + b**2 * stretch, stretch), POINTS)
        assert slope.eval(body, np.array([0], dtype=np.int32)).ravel() == pytest.approx([expected] * 2)


def volume_and_moment(cells: int) -> list[ufl.Form]:
    """Integrals over ``[0, 1]`` of 2 and of ``3 x``, each on a new mesh with a new constant."""
    body = mesh.create_unit_interval(MPI.COMM_SELF, cells)
    x, factors = ufl.SpatialCoordinate(body)[0], [fem.Constant(body, value) for value in (2.0, 3.0)]
    return [factors[0] * ufl.dx(body), factors[1] * x * ufl.dx(body)]


def test_forms_compiled_together_are_one_module_and_are_found_alone_on_every_mesh():
    jit_cache.compile_together(MPI.COMM_SELF, volume_and_moment(2))
    one, two = (fem.form(form) for form in volume_and_moment(5))
    assert one.module is two.module
    assert [fem.assemble_scalar(form) for form in (one, two)] == pytest.approx([2.0, 1.5])
    alone = fem.form(2.0 * ufl.dx(mesh.create_unit_interval(MPI.COMM_SELF, 2)))  # no constant: another form
    assert alone.module is not one.module


def test_a_form_of_another_module_is_not_compiled_again(tmp_path, monkeypatch):
    """Neither alone nor with others, in this process or in another one."""
    here = mesh.create_unit_interval(MPI.COMM_SELF, 2)
    x = ufl.SpatialCoordinate(here)[0]
    shared, first, second = x**3 * ufl.dx, x**5 * ufl.dx, x**6 * ufl.dx
    options = (
        ffcx.get_options({"scalar_type": default_scalar_type}),
        {**dolfinx_jit.get_options(), "cache_dir": tmp_path},
    )

    def together(*forms):
        found, _, _ = ffcx_jit.compile_forms(list(forms), options=options[0], **options[1])
        return [fem.form(form, jit_options={"cache_dir": tmp_path}) for form in forms], found

    (one, _), _ = together(shared, first)
    monkeypatch.setattr(jit_cache, "_known", {})  # as in another process
    (two, three), compiled = together(shared, second)
    assert [fem.assemble_scalar(form) for form in (one, two, three)] == pytest.approx([1 / 4, 1 / 4, 1 / 7])
    assert len(compiled) == 2
    places = [path.read_text().split()[0] for path in tmp_path.glob("*.form")]
    assert sorted(places.count(path.stem) for path in tmp_path.glob("*.so")) == [1, 2]
    next(path for path in tmp_path.glob("*.form")).write_text("cut short by a crash")
    monkeypatch.setattr(jit_cache, "_known", {})
    (again, _), _ = together(shared, first)
    assert fem.assemble_scalar(again) == pytest.approx(1 / 4)


def test_no_form_is_locked_once_it_is_compiled(tmp_path):
    here = mesh.create_unit_interval(MPI.COMM_SELF, 2)
    fem.form(ufl.SpatialCoordinate(here)[0] ** 7 * ufl.dx, jit_options={"cache_dir": tmp_path})
    assert list(tmp_path.glob("*.so"))
    assert jit_cache._held == []


def test_a_form_is_locked_where_files_can_be_locked(tmp_path, monkeypatch):
    monkeypatch.setattr(jit_cache, "_held", held := [])
    assert jit_cache._lock(tmp_path / "form.lock")
    assert len(held) == 1

    def without_locks(*_):
        raise OSError("no locks here")

    monkeypatch.setattr(jit_cache.fcntl, "flock", without_locks)
    before = len(os.listdir("/proc/self/fd"))
    assert not jit_cache._lock(tmp_path / "form.lock")
    assert len(held) == 1
    assert len(os.listdir("/proc/self/fd")) == before  # each form would leave a file open
    os.close(held[0])


def test_folders_above_the_cache_are_made(tmp_path):
    folder = tmp_path / "above" / "cache"
    here = mesh.create_unit_interval(MPI.COMM_SELF, 2)
    fem.form(ufl.SpatialCoordinate(here)[0] ** 9 * ufl.dx, jit_options={"cache_dir": folder})
    assert list(folder.glob("*.so"))


def test_no_file_stays_open_where_files_cannot_be_locked(tmp_path, monkeypatch):
    def refused(*_):
        raise OSError("no locks")

    monkeypatch.setattr(jit_cache.fcntl, "flock", refused)
    before = len(os.listdir("/proc/self/fd"))
    assert not jit_cache._lock(tmp_path / "form.lock")
    assert len(os.listdir("/proc/self/fd")) == before
