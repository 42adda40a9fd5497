"""Table of the thin limit of a published rubber disk, by the two methods of Paper 1's disk."""

from __future__ import annotations

from dataclasses import replace

from reference_data.solvers.core.tables import Table
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.tables_free import branch
from reference_data.solvers.registry import Builder

ALPHA = 20 / 80
"""Second constant over the first one, both in psi."""


def disk(name: str) -> Table:
    """Inflation over the height of the pole, clamped without pre-stretch."""
    table = branch(name, Disk(ALPHA, 1.0), "")
    source = "Inflation of a rubber disk (Oden 1972; Hughes & Carnoy 1983), as a membrane"
    return replace(table, paper="beyond", title="Rubber disk", source=source)


TABLES: dict[str, Builder] = {"rubber_disk": lambda: disk("rubber_disk")}
"""Inflation of a rubber disk."""
