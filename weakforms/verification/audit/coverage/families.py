"""The sets of parameters over which uncertainties were tuned, from the folders of the problems."""

from __future__ import annotations

from dataclasses import replace

from weakforms.problems.about import SEED, Family
from weakforms.problems.registry import abouts

__all__ = ["FAMILIES", "QUICK", "SEED", "WIDE"]

FAMILIES: tuple[Family, ...] = tuple(
    replace(family, problem=about.name) for about in abouts().values() for family in about.tuned
)
"""Families for the test of uncertainties; every set of parameters has the requested states."""

QUICK = {family.name: family.quick for family in FAMILIES if family.quick}
"""Number of sets of each family for a test of a minute or two."""

WIDE = 16
"""Number of sets of every family for a long test."""
