"""Which physical problem: mesh, unknowns, energy, boundary conditions, functionals, contact history."""

from weakforms.problems import (  # noqa: F401  (they register their problems)
    circular_problem,
    circular_scheme,
    fluid_tube_coincidence,
    fluid_tube_problem,
    fluid_tube_whole,
    tube_problem,
    tube_schemes,
    wrinkled_material,
    wrinkled_sheet,
    wrinkled_threshold,
    wrinkled_tube,
)
from weakforms.problems.base import registry

__all__ = ["registry"]
