"""What is said of a problem besides its weak form: its numbers, its example, how it is tested.

A folder of problems has a module ``about`` with an :class:`About` for each of them. Lists, pages, figures,
units, the names that cases import, the audit and the test of uncertainties are all made from these. Nothing
here needs dolfinx.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from weakforms.problems.column import NO_UNITS, Column, Units


@dataclass(frozen=True)
class Example:
    """The example of a problem's page and its picture: a branch, or a quantity over a parameter."""

    x: str
    """Abscissa of the picture: a column, or the parameter that is varied."""
    y: str
    """A column, or a quantity."""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    """Parameters that differ from their defaults."""
    values: tuple[float, ...] = ()
    """Values of the parameter; none for a branch."""
    numerics: Mapping[str, Any] = field(default_factory=dict)
    """Meshes of the picture, coarser than the default ones."""


SEED = 2016
"""Seed of the sets on which uncertainties were tuned."""


@dataclass(frozen=True)
class Family:
    """Sets of parameters over which uncertainties are tested, and the meshes whose uncertainties they are.

    Requested states may depend on the parameters: a value may be the name of one of ``ranges``.
    """

    ranges: Mapping[str, tuple[float, float]]
    coarse: Mapping[str, Any]
    fine: Mapping[str, Any]
    fixed: Mapping[str, Any] = field(default_factory=dict)
    at: tuple[tuple[str, float], ...] = ()
    label: str = ""
    branch: str = "primary"
    """That of the states."""
    quick: int = 0
    """Number of sets for a test of a minute or two."""
    problem: str = ""
    """Filled in where families are found."""

    def sets(self, count: int, seed: int = SEED) -> list[dict[str, Any]]:
        """The first points of a scrambled Sobol sequence over the ranges, the same in every run of a seed."""
        import numpy as np
        from scipy.stats import qmc

        sobol = qmc.Sobol(len(self.ranges), seed=seed)
        draws = sobol.random_base2(int(np.ceil(np.log2(count))))[:count]
        low, high = (np.array(ends) for ends in zip(*self.ranges.values(), strict=True))
        rows = low + draws * (high - low)
        return [dict(self.fixed) | dict(zip(self.ranges, row.tolist(), strict=True)) for row in rows]

    @property
    def name(self) -> str:
        """Name of the family in the table."""
        return f"{self.problem}, {self.label}" if self.label else self.problem


LINE = {"coarse": {"cells": 16, "degree": 3}, "fine": {"cells": 48, "degree": 5, "levels": 2}}
MORE = {"coarse": {"cells": 32, "degree": 3}, "fine": {"cells": 64, "degree": 5, "levels": 2}}
BLOCKS = {"coarse": {"cells": 8, "degree": 3}, "fine": {"cells": 12, "degree": 6, "levels": 2}}
"""Coarse and fine meshes of families."""

SCHEME = "the errors of a published scheme are what it tabulates; none is estimated"
ONE_MESH = "its numbers are those of one mesh, which says so"
CLOSED = "expressions evaluated at a point; tables by two methods hold them"
"""Why a problem states no uncertainty from refinement."""


@dataclass(frozen=True)
class About:
    """A problem in words and numbers."""

    name: str
    title: str
    paper: int | str
    """Number of the paper, or name of the group of cases."""
    source: str
    energy: str
    """The functional as text."""
    control: str
    """The load over which branches are drawn, and what to compare over past a limit point."""
    unknown: str = "the unknown"
    """The unknowns and their conditions."""
    forms: tuple[str, ...] = ()
    """Functions that define the functional, ``module:name`` below ``weakforms``."""
    units: Units = NO_UNITS
    columns: tuple[Column, ...] = ()
    """Columns of the branches, in their order."""
    numbers: tuple[Column, ...] = ()
    """Other numbers: parameters, quantities, columns of fields."""
    special_points: tuple[str, ...] = ()
    branches: tuple[str, ...] = ("primary",)
    on_demand: bool = True
    """Whether a state can be solved for at any point of a branch."""
    example: Example | None = None
    tuned: tuple[Family, ...] = ()
    """Sets that were in view when the rules for uncertainties were chosen; wider ones are held out."""
    held_out: tuple[Family, ...] = ()
    """Further sets on which no rule was tuned."""
    unestimated: str = ""
    """Why a problem states no uncertainty from refinement; empty if it does."""
    audit_numerics: Mapping[str, Any] = field(default_factory=dict)
    """Numerics that the audit tries first where the defaults take minutes."""
    audit_held: Mapping[str, Any] = field(default_factory=dict)
    """Mesh sizes that are parameters, limited in the audit to affordable values."""
    missed: Mapping[str, str] = field(default_factory=dict)
    """Columns that no check judges in every solution, and why: a debt, not an exemption."""
    unstated: str = ""
    """What holds the columns of a problem for which no identity is stated."""

    @property
    def derived(self) -> tuple[str, ...]:
        """Names of columns by which no state can be requested."""
        return tuple(column.name for column in self.columns if column.derived)

    @property
    def scales(self) -> dict[str, str]:
        """Meaning and scaling of every number that has a text."""
        return {c.name: c.scale(self.units) for c in (*self.columns, *self.numbers) if c.text}

    @property
    def dimensions(self) -> dict[str, str]:
        """Dimension of every number that has one."""
        declared = (*self.columns, *self.numbers)
        named = {name: c.dimension for c in declared for name in (c.name, *c.also)}
        return {name: dimension for name, dimension in named.items() if dimension != "number"}

    @property
    def is_traced(self) -> bool:
        """Whether its results are branches, with states on demand at every point."""
        return bool(self.columns) and self.on_demand
