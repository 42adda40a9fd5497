"""Finds tables: every module ``tables*`` in or below a folder of a paper or a group has a dictionary."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable

from reference_data import solvers
from reference_data.solvers.core.tables import Table

Builder = Callable[[], Table]


GROUPS = ("materials", "closed_form", "beyond")
"""Folders of tables that do not belong to a paper."""


def tables() -> dict[str, tuple[int | str, Builder]]:
    """Name of each table, with the number of its paper, or its group, and the function that computes it.

    Raises:
        ValueError: If two modules use one name.
    """
    found: dict[str, tuple[int | str, Builder]] = {}
    for folder in solvers_folders():
        group = int(folder.removeprefix("paper")) if folder.startswith("paper") else folder
        package = importlib.import_module(f"{solvers.__name__}.{folder}")
        below = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
        for info in sorted(below, key=lambda i: i.name):
            if not info.name.rpartition(".")[2].startswith("tables"):
                continue
            for name, builder in importlib.import_module(info.name).TABLES.items():
                if name in found:
                    raise ValueError(f"table {name} is defined twice")
                found[name] = (group, builder)
    return found


def solvers_folders() -> list[str]:
    """The folders with tables: one for each paper, and the groups."""
    names = (info.name for info in pkgutil.iter_modules(solvers.__path__) if info.ispkg)
    return sorted((name for name in names if name != "core"), key=lambda n: (n in GROUPS, n))
