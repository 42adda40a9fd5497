"""Which tables exist: every module ``paperN*`` of this package offers a dictionary TABLES."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable

from reference_data import solvers
from reference_data.solvers.tables import Table

Builder = Callable[[], Table]


def tables() -> dict[str, tuple[int, Builder]]:
    """Name of each table, with the number of its paper and the function that computes it.

    Raises:
        ValueError: If two modules claim one name.
    """
    found: dict[str, tuple[int, Builder]] = {}
    for info in sorted(pkgutil.iter_modules(solvers.__path__), key=lambda i: i.name):
        match = re.match(r"paper(\d+)", info.name)
        if not match:
            continue
        module = importlib.import_module(f"{solvers.__name__}.{info.name}")
        for name, builder in module.TABLES.items():
            if name in found:
                raise ValueError(f"table {name} is defined twice")
            found[name] = (int(match[1]), builder)
    return found
