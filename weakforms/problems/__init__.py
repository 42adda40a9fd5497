"""Which physical problem: mesh, unknowns, energy, boundary conditions, functionals, contact history."""

from weakforms.problems import tube_problem  # noqa: F401  (registers its problems)
from weakforms.problems.base import registry

__all__ = ["registry"]
