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
from typing import Any

import cffi
from ffcx.codegeneration import jit

from weakforms.errors import EnvironmentLackError
from weakforms.solvers.support import products

SUFFIX = ".so"

MARK = "-DWEAKFORMS_LIBRARY"
"""An argument of the C compiler without effect, which keeps these libraries apart from modules of Python."""


ARGUMENTS = "-O1", "-g0"
"""Arguments of the C compiler. With -O2, which is DOLFINx's choice, it takes half as long again, and forms on
lines run no faster."""

SURFACES = re.compile(r"for \(int j = 0; j < (1[6-9]|[2-9]\d|\d{3,});"), "-O2"
"""A loop over at least 16 scalar basis functions, as on surfaces of degree three, and the argument with which
a branch of bent tubes takes 4 % less time."""


class Library:
    """What ffcx uses of :class:`cffi.FFI` to compile forms, without a wrapper for Python."""

    def set_source(self, name: str, source: str, **options: Any) -> None:
        """Keep the code and how it is to be compiled."""
        needed = products.CODE if products.ADD_PRODUCT in source else ""
        self.name, self.source, self.options = name, needed + source, options

    def cdef(self, declarations: str) -> None:
        """Do nothing: :func:`_types` has the declarations for all forms."""

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
        wide, optimised = SURFACES
        arguments = [*options["extra_compile_args"], *([optimised] if wide.search(self.source) else [])]
        command = [*_linker(), "-fPIC", *arguments, *folders]
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


class Loaded:
    """A compiled library, as DOLFINx sees the module of a form.

    Raises:
        ImportError: If the library is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.name, self.ffi = path.stem, _types()
        try:
            self._library = ctypes.CDLL(str(path))
        except OSError as error:
            raise ImportError(f"{path.name} is no library: {error}") from error
        products.connect(self._library)

    def form(self, name: str) -> Any:
        """A form or expression by its name.

        Raises:
            ImportError: If the library lacks it.
        """
        try:
            address = ctypes.addressof(ctypes.c_char.in_dll(self._library, name))
        except ValueError as error:
            raise ImportError(f"{self.name} has no such form: {error}") from error
        kind = "ufcx_expression" if name.startswith("expression") else "ufcx_form"
        return self.ffi.cast(f"{kind} *", address)[0]


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
