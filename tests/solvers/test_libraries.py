"""Forms are compiled to shared libraries; what cannot be compiled or loaded is said."""

import shutil

import pytest
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI

from weakforms.errors import EnvironmentLackError
from weakforms.solvers.support import jit_cache, libraries


def compiled(tmp_path, power=5, **options):
    """A form that no other test has, in a cache of its own."""
    x = ufl.SpatialCoordinate(mesh.create_unit_interval(MPI.COMM_SELF, 3))[0]
    return fem.form(x**power * ufl.dx, jit_options={"cache_dir": tmp_path, **options})


def test_a_library_needs_nothing_of_python(tmp_path):
    form = compiled(tmp_path)
    assert fem.assemble_scalar(form) == pytest.approx(1 / 6, rel=1e-14)
    (source,) = tmp_path.glob("*.c")
    assert "Python.h" not in source.read_text()


@pytest.mark.parametrize("compiler", ["false", "no-such-compiler"])
def test_a_compiler_that_fails_is_named(tmp_path, monkeypatch, compiler):
    monkeypatch.setenv("CC", compiler)
    with pytest.raises(
        EnvironmentLackError, match=rf"cannot be compiled .*{compiler}.* a C compiler and room"
    ):
        compiled(tmp_path, power=6)
    assert not list(tmp_path.glob("*.so"))


def test_the_first_error_of_the_compiler_is_kept(tmp_path):
    library = libraries.Library()
    library.set_source(
        "broken", "int f(void) { return g; }", include_dirs=[], extra_compile_args=[], libraries=[]
    )
    with pytest.raises(EnvironmentLackError, match=r"C compiler .* fails: .*error: .g. undeclared"):
        library.compile(tmp_path)


def test_a_damaged_library_or_one_without_the_form_is_not_used(tmp_path):
    (tmp_path / "cut.so").write_bytes(b"\x7fELF")
    with pytest.raises(ImportError, match=r"cut\.so"):
        libraries.Loaded(tmp_path / "cut.so")
    compiled(tmp_path)
    (path,) = tmp_path.glob("libffcx*.so")
    with pytest.raises(ImportError, match="form_missing"):
        libraries.Loaded(path).form("form_missing")


def test_a_damaged_library_in_the_cache_is_compiled_again(tmp_path):
    """A crash of the machine can leave a file that is marked complete but cut short."""
    whole, damaged = tmp_path / "whole", tmp_path / "damaged"
    compiled(whole)
    shutil.copytree(whole, damaged)
    (path,) = damaged.glob("*.so")
    path.write_bytes(b"\x7fELF")
    assert fem.assemble_scalar(compiled(damaged)) == pytest.approx(1 / 6, rel=1e-14)
    assert path.stat().st_size > 4


@pytest.mark.parametrize("locks", [True, False])
def test_what_another_process_compiles_meanwhile_is_used(tmp_path, monkeypatch, locks):
    """With locks it has ended when the lock is there; without, its file without a mark says that it works."""
    other, here = tmp_path / "other", tmp_path / "here"
    compiled(other)

    def finished(_):
        shutil.copytree(other, here, ignore=shutil.ignore_patterns("*.form"), dirs_exist_ok=True)
        return locks

    monkeypatch.setattr(jit_cache, "_lock", finished)
    monkeypatch.setattr(libraries.Library, "compile", lambda *_, **__: pytest.fail("it is compiled again"))
    assert fem.assemble_scalar(compiled(here)) == pytest.approx(1 / 6, rel=1e-14)


def test_a_process_that_does_not_finish_is_not_waited_for_for_ever(tmp_path, monkeypatch):
    compiled(tmp_path)
    for path in [*tmp_path.glob("*.form"), *tmp_path.glob("*.cached")]:
        path.unlink()
    monkeypatch.setattr(jit_cache, "_known", {})
    monkeypatch.setattr(jit_cache, "_lock", lambda _: False)
    with pytest.raises(
        TimeoutError, match=r"has not finished libffcx_forms_\w+ in 1 s; if none runs, delete .*\.c"
    ):
        compiled(tmp_path, timeout=1)


@pytest.mark.parametrize(("degree", "level"), [(2, "-O1"), (3, "-O2")])
def test_element_matrices_of_surfaces_are_optimised_further(tmp_path, monkeypatch, degree, level):
    commands, run = [], libraries.subprocess.run

    def noted(command, **how):
        commands.append(command)
        return run(command, **how)

    monkeypatch.setattr(libraries.subprocess, "run", noted)
    square = mesh.create_unit_square(MPI.COMM_SELF, 1, 1, mesh.CellType.quadrilateral)
    space = fem.functionspace(square, ("Lagrange", degree))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    fem.form(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, jit_options={"cache_dir": tmp_path})
    (command,) = commands
    assert [argument for argument in command if argument.startswith("-O")][-1] == level  # the last one counts
