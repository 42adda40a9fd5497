"""The product of two matrices in compiled forms, by the BLAS that SciPy uses.

The code of a form calls a small function in C, which calls BLAS through a variable. Its address is set when
the library is loaded, so that no library of BLAS has to be found by the linker.
"""

from __future__ import annotations

import ctypes
import functools

ADD_PRODUCT = "weakforms_add_product"
"""Name of the C function that adds a product of two matrices to an element matrix."""

_BLAS = "weakforms_dgemm"
"""Name of the variable, in C, that holds the address of BLAS's product."""

CODE = f"""
void (*{_BLAS})(const char*, const char*, const int*, const int*, const int*, const double*, const double*,
                const int*, const double*, const int*, const double*, double*, const int*);

// A += transpose(table) * sums. The rows of A start at `offset`, and lie `stride` apart.
// BLAS expects columns in memory, and so it is given the transposed equation.
static int {ADD_PRODUCT}(double* A, int offset, int stride, int rows, int columns, int points,
                         const double* table, const double* sums)
{{
  const double one = 1.0;
  {_BLAS}("N", "T", &columns, &rows, &points, &one, sums, &columns, table, &rows, &one, A + offset, &stride);
  return 0;
}}
"""
"""That function, which the code of a form that calls it needs before it."""


def connect(library: ctypes.CDLL) -> None:
    """Set the address of BLAS's product in a library of compiled forms, if they use it."""
    try:
        variable = ctypes.c_void_p.in_dll(library, _BLAS)
    except ValueError:
        return
    variable.value = _address()


@functools.cache
def _address() -> int:
    from scipy.linalg import cython_blas  # most solves do without it

    capsule = cython_blas.__pyx_capi__["dgemm"]
    name_of, pointer_of = ctypes.pythonapi.PyCapsule_GetName, ctypes.pythonapi.PyCapsule_GetPointer
    name_of.restype, name_of.argtypes = ctypes.c_char_p, [ctypes.py_object]
    pointer_of.restype, pointer_of.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    return pointer_of(capsule, name_of(capsule))
