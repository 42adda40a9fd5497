"""Which physical problem: mesh, unknowns, energy, boundary conditions, functionals, contact history."""

from weakforms.problems import tube_problem, tube_schemes  # noqa: F401  (they register their problems)
from weakforms.problems.base import registry

__all__ = ["registry"]
