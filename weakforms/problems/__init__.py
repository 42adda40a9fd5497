"""Physical problems: mesh, unknowns, energy, boundary conditions, functionals, contact history."""

import pkgutil
from importlib import import_module

from weakforms.problems.problem import registry

__all__ = ["registry"]

# A module that defines a problem registers it when it is imported, so that no list of problems is needed.
for _found in pkgutil.walk_packages(__path__, f"{__name__}."):
    import_module(_found.name)
