"""Which physical problem: mesh, unknowns, energy, boundary conditions, functionals, contact history."""

from weakforms.problems import (  # noqa: F401  (they register their problems)
    circular_problem,
    circular_scheme,
    closed_problem,
    fluid_tube_coincidence,
    fluid_tube_problem,
    fluid_tube_whole,
    hemisphere,
    material,
    surface,
    tube_problem,
    tube_schemes,
    wrinkled_load,
    wrinkled_material,
    wrinkled_patch,
    wrinkled_sheet,
    wrinkled_threshold,
    wrinkled_tube,
)
from weakforms.problems.base import registry

__all__ = ["registry"]
