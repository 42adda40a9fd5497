"""How it is solved: SNES, continuation, critical points, SLEPc, dolfinx versions. No physics."""

from weakforms.solvers.support import jit_cache

jit_cache.install()
