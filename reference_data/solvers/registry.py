"""Which tables exist: every module ``paperN*`` or ``GROUP_tables*`` here offers a dictionary TABLES."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable

from reference_data import solvers
from reference_data.solvers.tables import Table

Builder = Callable[[], Table]


GROUPS = ("materials", "closed_form")
"""Folders of tables that belong to no paper."""


def tables() -> dict[str, tuple[int | str, Builder]]:
    """Name of each table, with the number of its paper, or its group, and the function that computes it.

    Raises:
        ValueError: If two modules claim one name.
    """
    found: dict[str, tuple[int | str, Builder]] = {}
    for info in sorted(pkgutil.iter_modules(solvers.__path__), key=lambda i: i.name):
        match = re.match(rf"paper(\d+)|({'|'.join(GROUPS)})_tables", info.name)
        if not match:
            continue
        module = importlib.import_module(f"{solvers.__name__}.{info.name}")
        for name, builder in module.TABLES.items():
            if name in found:
                raise ValueError(f"table {name} is defined twice")
            found[name] = (int(match[1]) if match[1] else match[2], builder)
    return found
