"""A cache of compiled forms for several processes: one compiles a form, which appears only when complete.

ffcx marks a form that is being compiled by the file ``NAME.c``, and a finished one by ``NAME.c.cached``. A
process that is killed in between leaves the first file without the second, and every later process would wait
in vain. Here the process that compiles holds a lock, which the system releases when the process ends. It
compiles in a separate folder and then moves the finished files.

A separate module for each form costs more than the form, because of the compiler's start, its headers and the
linker. :func:`compile_together` makes one module of all forms that a system needs. A form is compiled once:
a file ``KEY.form`` names its module. Systems with the same forms, such as two phases of a contact history,
share them.

ffcx names an expression by the number of variables (``ufl.variable``) that the process has made before. It
would compile the same expression again on another mesh, or after another solve. Here the numbers start from
zero for each expression.
"""

from __future__ import annotations

import fcntl
import functools
import os
import shutil
import sysconfig
import tempfile
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import ufl
from dolfinx import default_scalar_type
from dolfinx import jit as dolfinx_jit
from ffcx import options as ffcx_options
from ffcx.codegeneration import jit
from ffcx.naming import compute_signature, form_name
from mpi4py import MPI
from ufl.algorithms import signature
from ufl.classes import Label
from ufl.core.expr import Expr
from ufl.corealg.traversal import traverse_unique_terminals

from weakforms.errors import EnvironmentLackError
from weakforms.solvers.support import kernels, libraries

PATIENCE = 180
"""Seconds for which a process waits for another one that compiles the same form, if files cannot be locked.
dolfinx's default of 10 is too small for our forms."""

_held: list[int] = []
"""The lock of the form that this process is compiling."""

_known: dict[tuple[Path, str], tuple[Any, Any]] = {}
"""Compiled forms and their modules, by the folder of the cache and the key of the form."""

_together: set[str] = set()
"""Signatures of the forms that this process has asked for together."""


def install() -> None:
    """Make ffcx use this cache; repeated calls have no effect."""
    if jit.get_cached_module is _find:
        return
    kernels.install()
    defaults = dolfinx_jit.DOLFINX_DEFAULT_JIT_OPTIONS
    _, about = defaults["cffi_extra_compile_args"]
    arguments = [*libraries.ARGUMENTS, kernels.MARK, libraries.MARK]
    defaults["cffi_extra_compile_args"] = (arguments, about)
    _, about = defaults["timeout"]
    defaults["timeout"] = (PATIENCE, about)
    # Files in the current folder, written by anybody, must not change how forms are compiled: neither the
    # arguments of the compiler (which can load a plugin) nor the precision of numbers.
    for options in (dolfinx_jit, ffcx_options):
        options._load_options = lambda: ({}, {})
    signature.compute_expression_signature = _counting_from_zero(signature.compute_expression_signature)
    jit.get_cached_module = _find
    jit.cffi = SimpleNamespace(FFI=libraries.Library)
    jit._compile_objects = _compiling(jit._compile_objects)
    jit._load_objects = lambda folder, name, objects: _forms(Path(folder), name, objects)
    for name in ("compile_forms", "compile_expressions"):
        setattr(jit, name, _releasing(getattr(jit, name)))
    jit.compile_forms = _looking(jit.compile_forms)


def compile_together(comm: MPI.Intracomm, forms: Iterable[ufl.Form]) -> None:
    """Compile those forms that no module has yet into one; :func:`dolfinx.fem.form` finds all of them.

    Collective. Signatures do not depend on the mesh, so that forms on the next mesh use the same module.
    """
    missing = {form.signature(): form for form in forms}
    if not missing.keys() <= _together:
        _compile_module(comm, list(missing.values()))
        _together.update(missing)


@dolfinx_jit.mpi_jit_decorator
def _compile_module(forms: list[ufl.Form]) -> None:
    options = ffcx_options.get_options({"scalar_type": default_scalar_type})
    jit.compile_forms(forms, options=options, **dolfinx_jit.get_options())


def _looking(compile_forms: Callable) -> Callable:
    """Wrap the function that compiles forms, so that it compiles only those that no module has yet.

    The module that it returns is the one with the first form.
    """

    @functools.wraps(compile_forms)
    def compiled(forms: list[ufl.Form], options: dict, cache_dir: Path, **how: Any) -> Any:
        machine = sysconfig.get_config_var("SOABI")
        tag = repr((sorted(options.items()), how["cffi_extra_compile_args"], machine))
        keys = [(Path(cache_dir), compute_signature([form], tag)) for form in forms]
        left = {key: form for key, form in zip(keys, forms, strict=True) if not _is_known(*key)}
        if left:
            made, module, _ = compile_forms(list(left.values()), options=options, cache_dir=cache_dir, **how)
            for i, (key, form) in enumerate(left.items()):
                _known[key] = made[i], module
                _note(*key, f"{module.name} {form_name(form, i, module.name)}")
        return [_known[key][0] for key in keys], _known[keys[0]][1], (None, None)

    return compiled


def _is_known(cache_dir: Path, key: str) -> bool:
    """Whether a form is compiled; if another process did it, its library is loaded."""
    if (cache_dir, key) not in _known:
        try:
            name, form = (cache_dir / f"{key}.form").read_text().split()
            (one,), module = _forms(cache_dir, name, [form])
        except (OSError, ValueError, ImportError):  # not there, or cut short by a crash of the machine
            return False
        _known[cache_dir, key] = one, module
    return True


def _note(cache_dir: Path, key: str, place: str) -> None:
    """Write where a form is compiled. Without the file another process compiles it again."""
    partial = cache_dir / f".{key}.{os.getpid()}"
    with suppress(OSError):
        partial.write_text(place)
        os.replace(partial, cache_dir / f"{key}.form")


def _counting_from_zero(compute: Callable) -> Callable:
    """Wrap the signature of an expression, so that its variables are numbered by their position in it."""

    @functools.wraps(compute)
    def computed(expression: Expr, renumbering: dict[Any, int]) -> str:
        terminals = traverse_unique_terminals(expression)
        labels = dict.fromkeys(terminal for terminal in terminals if isinstance(terminal, Label))
        return compute(expression, renumbering | {label: i for i, label in enumerate(labels)})

    return computed


def _find(name: str, forms: list[str], cache_dir: Path, timeout: int) -> tuple[list[Any] | None, Any]:
    """Forms of a finished module, and the module; without it nothing, and then the lock is held.

    Raises:
        TimeoutError: If another process does not finish the module in time, where files cannot be locked.
    """
    source = Path(cache_dir) / f"{name}.c"
    ready = source.with_suffix(".c.cached")
    if ready.exists():
        try:
            return _forms(ready.parent, name, forms)
        except ImportError:  # cut short by a crash of the machine
            ready.unlink(missing_ok=True)
    try:
        ready.parent.mkdir(parents=True, exist_ok=True)
        if _lock(ready.with_name(f"{name}.lock")) and not ready.exists() and source.exists():
            source.unlink(missing_ok=True)  # the process that made it has ended
            for left in ready.parent.glob(f".{name}.*"):
                shutil.rmtree(left, ignore_errors=True)
        with suppress(FileExistsError), open(source, "x"):
            return None, None
    except OSError as error:
        raise _lack(ready.parent, error) from error
    for _ in range(timeout):
        if ready.exists():
            return _forms(ready.parent, name, forms)
        time.sleep(1)
    raise TimeoutError(
        f"another process has not finished {name} in {timeout} s; if none runs, delete {source}"
    )


def _forms(cache_dir: Path, name: str, forms: list[str]) -> tuple[list[Any], Any]:
    """Forms of a finished module by their names, and the module."""
    module = _loaded(cache_dir, name)
    return [module.form(one) for one in forms], module


@functools.cache
def _loaded(cache_dir: Path, name: str) -> libraries.Loaded:
    """Load a finished module, once in each process.

    It is loaded by its full name. ffcx would list the whole folder each time, which is slow with thousands of
    files.
    """
    return libraries.Loaded(cache_dir / f"{name}{libraries.SUFFIX}")


def _lock(path: Path) -> bool:
    """Wait for the lock of a form; False if the file system has no locks."""
    handle = os.open(path, os.O_CREAT | os.O_RDONLY | os.O_CLOEXEC, 0o666)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
    except OSError:
        os.close(handle)
        return False
    except BaseException:
        os.close(handle)
        raise
    _held.append(handle)
    return True


def _releasing(compile_them: Callable) -> Callable:
    """Wrap the function that compiles forms, so that it releases the lock however it ends."""

    @functools.wraps(compile_them)
    def compiled(*args: Any, **kwargs: Any) -> Any:
        try:
            return compile_them(*args, **kwargs)
        finally:
            while _held:
                os.close(_held.pop())

    return compiled


def _compiling(compile_one: Callable) -> Callable:
    """Wrap the call of the C compiler, so that it works in a separate folder."""

    @functools.wraps(compile_one)
    def compiled(decl: str, forms: list, names: list, module: str, *rest: Any, **more: Any) -> Any:
        options, cache_dir, *rest = rest
        try:
            with tempfile.TemporaryDirectory(prefix=f".{module}.", dir=cache_dir) as folder:
                code = compile_one(decl, forms, names, module, options, Path(folder), *rest, **more)
                _publish(Path(folder), module, Path(cache_dir))
        except (OSError, EnvironmentLackError) as error:
            raise _lack(cache_dir, error) from error
        return code

    return compiled


def _publish(folder: Path, module: str, cache_dir: Path) -> None:
    """Move the compiled files into the cache, the mark of completeness last."""
    made = [path for path in folder.iterdir() if path.name.startswith(f"{module}.") and path.suffix != ".o"]
    for path in sorted(made, key=lambda path: path.suffix == ".cached"):
        os.replace(path, cache_dir / path.name)
    with suppress(OSError):
        (cache_dir / f"{module}.lock").unlink()


def _lack(cache_dir: Path, error: Exception) -> EnvironmentLackError:
    reason = getattr(error, "strerror", None) or str(error).strip().splitlines()[0]
    return EnvironmentLackError(
        f"a form cannot be compiled into {cache_dir}: {reason}; a C compiler and room in that folder are "
        "needed (XDG_CACHE_HOME names another)"
    )
