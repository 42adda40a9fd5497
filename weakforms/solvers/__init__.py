"""Solvers without physics: SNES, continuation, critical points, SLEPc, dolfinx releases."""

from weakforms.solvers.support import jit_cache

jit_cache.install()
