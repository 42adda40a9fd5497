"""Compiled forms as shared libraries: built by the C compiler alone, loaded by their symbols.

ffcx makes a Python module of each set of forms. For that, cffi writes a wrapper, setuptools calls the
compiler, and the compiler reads Python's headers. This takes half of the time of a small form, and is not
needed: DOLFINx asks only for the address of a structure in C.
"""

from __future__ import annotations

import ctypes
import functools
import os
import re
import shlex
import subprocess
import sysconfig
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import cffi
from ffcx.codegeneration import jit

from weakforms.errors import EnvironmentLackError

SUFFIX = ".so"

MARK = "-DWEAKFORMS_LIBRARY"
"""An argument of the C compiler without effect, which keeps these libraries apart from modules of Python."""


class Library:
    """What ffcx uses of :class:`cffi.FFI` to compile forms, without a wrapper for Python."""

    def set_source(self, name: str, source: str, **options: Any) -> None:
        """Keep the code and how it is to be compiled."""
        self.name, self.source, self.options = name, source, options

    def cdef(self, declarations: str) -> None:
        """Declarations are those of :func:`_types`, for every form."""

    def compile(self, tmpdir: Path, **_about_the_messages: Any) -> None:
        """Write ``NAME.c`` into a folder, and compile it to ``NAME.so``.

        Raises:
            OSError: If the folder cannot be written.
            EnvironmentLackError: If there is no compiler, or if it fails; its first error is named.
        """
        source = Path(tmpdir) / f"{self.name}.c"
        source.write_text(self.source)
        options = self.options
        folders = [f"-I{folder}" for folder in options["include_dirs"]]
        needed = [f"-l{name}" for name in options["libraries"]]
        target = source.with_suffix(SUFFIX)
        command = [*_linker(), "-fPIC", *options["extra_compile_args"], *folders]
        files = [str(source), "-o", str(target), *needed, "-lm"]
        try:
            done = subprocess.run([*command, *files], check=False, capture_output=True, text=True)
        except OSError as error:
            reason = f"the C compiler {command[0]} cannot be started: {error.strerror}"
            raise EnvironmentLackError(reason) from error
        if done.returncode:
            said = done.stderr.strip().splitlines() or [f"exit status {done.returncode}"]
            first = next((line for line in said if "error:" in line), said[-1])
            raise EnvironmentLackError(f"the C compiler {command[0]} fails: {first}")


def load(path: Path, names: tuple[str, ...]) -> tuple[list[Any], Any]:
    """The forms of a compiled library by their names, and what stands for their module.

    Raises:
        ImportError: If the library is damaged or lacks a form.
    """
    types = _types()
    try:
        library = ctypes.CDLL(str(path))
        addresses = [ctypes.addressof(ctypes.c_char.in_dll(library, name)) for name in names]
    except (OSError, ValueError) as error:
        raise ImportError(f"{path.name} is no library with these forms: {error}") from error
    kinds = ["ufcx_expression" if name.startswith("expression") else "ufcx_form" for name in names]
    forms = [types.cast(f"{kind} *", at)[0] for kind, at in zip(kinds, addresses, strict=True)]
    return forms, SimpleNamespace(ffi=types, library=library)


@functools.cache
def _types() -> cffi.FFI:
    """Structures that describe forms and expressions to DOLFINx."""
    types = cffi.FFI()
    declarations = (
        jit.UFC_HEADER_DECL.format("float64")
        + jit.UFC_INTEGRAL_DECL
        + jit.UFC_FORM_DECL
        + jit.UFC_EXPRESSION_DECL
    )
    # Complex numbers are known to cffi only in compiled wrappers; here only pointers to them occur.
    types.cdef(re.sub(r"(float|double) _Complex", "void", declarations))
    return types


def _linker() -> list[str]:
    """The command that makes libraries, with the user's compiler if ``CC`` names one."""
    given = os.environ.get("CC")
    if given:
        return [*shlex.split(given), "-shared"]
    return shlex.split(sysconfig.get_config_var("LDSHARED"))
