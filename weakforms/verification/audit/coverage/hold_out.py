"""Sets of parameters over which uncertainties are tested and nothing is tuned.

Drawn with another seed, over ranges wider than those of :mod:`.families` about the same middle, and over
those of the problems that are not among them. A rule for uncertainties is never changed because of what comes
out here; where one must be, another seed is taken.
"""

from __future__ import annotations

from dataclasses import replace

from weakforms.problems.about import Family
from weakforms.problems.registry import abouts, get
from weakforms.verification.audit.coverage.families import FAMILIES

SEED = 20261123

WIDER = 1.5
"""Width of a range over that of the tuned set."""

WITHOUT = {name: about.unestimated for name, about in abouts().items() if about.unestimated}
"""Problems that state no uncertainty from refinement, and why."""

FURTHER: tuple[Family, ...] = tuple(
    replace(family, problem=about.name) for about in abouts().values() for family in about.held_out
)
"""Families of problems and branches without tuned ones."""


def held_out() -> tuple[Family, ...]:
    """Every family of the hold-out."""
    return (*(widened(family) for family in FAMILIES), *FURTHER)


def widened(family: Family) -> Family:
    """The family over ranges wider about the same middle, as far as the problem allows them."""
    known = get(family.problem).parameters.model_json_schema()["properties"]
    ranges = {}
    for name, (low, high) in family.ranges.items():
        more = (WIDER - 1) / 2 * (high - low)
        least = known[name].get("minimum", known[name].get("exclusiveMinimum", low - more))
        most = known[name].get("maximum", known[name].get("exclusiveMaximum", high + more))
        ranges[name] = (max(low - more, least), min(high + more, most))
    return replace(family, ranges=ranges)
