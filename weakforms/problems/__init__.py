"""Which physical problem: mesh, unknowns, energy, boundary conditions, functionals, contact history."""

import pkgutil
from importlib import import_module

from weakforms.problems.problem import registry

__all__ = ["registry"]

# A module that defines a problem registers it when it is imported: a new one is found, not listed.
for _found in pkgutil.walk_packages(__path__, f"{__name__}."):
    import_module(_found.name)
