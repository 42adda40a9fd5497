"""Sets of parameters over which uncertainties are tested and nothing is tuned.

Drawn with another seed, over ranges wider than those of :mod:`.families` about the same middle, and over
those of the problems that are not among them. A rule for uncertainties is never changed because of what comes
out here; where one must be, another seed is taken.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from weakforms.problems import registry
from weakforms.verification.audit.coverage.families import BLOCKS, FAMILIES, LINE, MORE, Family

SEED = 20261123

WIDER = 1.5
"""Width of a range over that of the tuned set."""

SCHEME = "the errors of a published scheme are what it tabulates; none is estimated"
ONE_MESH = "its numbers are those of one mesh, which says so"
CLOSED = "expressions evaluated at a point; tables by two methods hold them"
WITHOUT: Mapping[str, str] = {
    "circular_scheme": SCHEME,
    "tube_scheme": SCHEME,
    "fluid_tube_surface": ONE_MESH,
    "wrinkled_sheet": ONE_MESH,
    "material": CLOSED,
    "wrinkled_material": CLOSED,
}
"""Problems that state no uncertainty from refinement, and why."""

STEPS = {"coarse": {"step": 0.1}, "fine": {"step": 0.02, "levels": 4}}
BENT = {
    "coarse": {"cells": 32, "degree": 3, "secondary_cells": 24, "secondary_degree": 4},
    "fine": {"cells": 64, "degree": 5, "secondary_cells": 24, "secondary_degree": 6, "secondary_levels": 2},
}
SURFACE = {"coarse": {"scan": 15, "tolerance": 1e-4}, "fine": {"scan": 15, "tolerance": 1e-8}}
FURTHER = (
    Family("sphere", {"alpha": (0.02, 0.3)}, **STEPS, fixed={"lam_end": 3.0}, at=(("lam", 1.7),)),
    Family("infinite_tube", {"alpha": (0.02, 0.3), "force": (0.0, 3.0)}, **STEPS, fixed={"lam_end": 3.0}),
    Family("homogeneous", {"alpha": (0.02, 0.3)}, **STEPS, fixed={"lam_end": 3.0}, at=(("lam", 1.7),)),
    Family("tube_fold", {"alpha": (0.05, 0.15), "lf": (4.0, 8.0)}, **LINE),
    Family(
        "fluid_tube",
        {"delta": (1.9, 3.0), "gamma": (0.112, 0.12)},
        **BENT,
        fixed={"n_max": 1, "secondary": True},
        label="fluid_tube, secondary",
        branch="secondary",
    ),
    Family("fluid_tube_coincidence", {"L": (7.0, 9.0), "gamma": (0.1, 0.12)}, **MORE),
    Family("wrinkled_tube_threshold", {"delta": (1.7, 2.5), "Af": (0.8, 1.2)}, **BLOCKS),
    Family("wrinkled_linear", {"zw": (4.5, 5.5), "c2": (0.005, 0.03)}, **BLOCKS),
    Family("wrinkled_bending", {"zw": (4.5, 5.5), "n": (8.0, 14.0)}, **BLOCKS, fixed={"beta": 1e-6}),
    Family("wrinkled_patch", {"a": (0.2, 0.5), "n": (6.0, 14.0)}, **LINE, at=(("e", 0.02),)),
    Family(
        "surface",
        {"M": (1.45, 1.55), "delta": (2.8, 3.2)},
        **SURFACE,
        fixed={"meridional": 60, "circumferential": 48, "load_start": 4.5, "load_end": 7.5},
    ),
)
"""Families of problems and branches without tuned ones."""


def held_out() -> tuple[Family, ...]:
    """Every family of the hold-out."""
    return (*(widened(family) for family in FAMILIES), *FURTHER)


def widened(family: Family) -> Family:
    """The family over ranges wider about the same middle, as far as the problem allows them."""
    known = registry.get(family.problem).parameters.model_json_schema()["properties"]
    ranges = {}
    for name, (low, high) in family.ranges.items():
        more = (WIDER - 1) / 2 * (high - low)
        least = known[name].get("minimum", known[name].get("exclusiveMinimum", low - more))
        most = known[name].get("maximum", known[name].get("exclusiveMaximum", high + more))
        ranges[name] = (max(low - more, least), min(high + more, most))
    return replace(family, ranges=ranges)
