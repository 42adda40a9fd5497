"""How it is solved: SNES, continuation, critical points, SLEPc, dolfinx versions. No physics."""

from weakforms.solvers import compat  # noqa: F401  (it sets how long a process waits for a compiler)
