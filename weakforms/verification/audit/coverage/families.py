"""The sets of parameters over which uncertainties were tuned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.stats import qmc

SEED = 2016


@dataclass(frozen=True)
class Family:
    """Sets of parameters of a problem, and the meshes whose uncertainties are tested.

    Requested states may depend on the parameters: a value may be the name of one of ``ranges``.
    """

    problem: str
    ranges: Mapping[str, tuple[float, float]]
    coarse: Mapping[str, Any]
    fine: Mapping[str, Any]
    fixed: Mapping[str, Any] = field(default_factory=dict)
    at: tuple[tuple[str, float], ...] = ()
    label: str = ""
    branch: str = "primary"
    """That of the states."""

    def sets(self, count: int, seed: int = SEED) -> list[dict[str, Any]]:
        """The first points of a scrambled Sobol sequence over the ranges, the same in every run of a seed."""
        sobol = qmc.Sobol(len(self.ranges), seed=seed)
        draws = sobol.random_base2(int(np.ceil(np.log2(count))))[:count]
        low, high = (np.array(ends) for ends in zip(*self.ranges.values(), strict=True))
        rows = low + draws * (high - low)
        return [dict(self.fixed) | dict(zip(self.ranges, row.tolist(), strict=True)) for row in rows]

    @property
    def name(self) -> str:
        """Name of the family in the table."""
        return self.label or self.problem


LINE = {"coarse": {"cells": 16, "degree": 3}, "fine": {"cells": 48, "degree": 5, "levels": 2}}
MORE = {"coarse": {"cells": 32, "degree": 3}, "fine": {"cells": 64, "degree": 5, "levels": 2}}
BLOCKS = {"coarse": {"cells": 8, "degree": 3}, "fine": {"cells": 12, "degree": 6, "levels": 2}}
DEFLATION = {"contact": "adhesive", "phase": "deflation", "delta1": 1.2, "p_end": 2.4}
FLUID = {"load_end": 7.0, "Af": 0.6}
FAMILIES = (
    Family(
        "tube",
        {"alpha": (0.02, 0.3), "delta1": (1.0, 1.6), "lf": (4.0, 8.0)},
        **LINE,
        fixed={"u_end": 1.6},
        at=(("u_max", 0.6), ("u_max", 1.5)),
    ),
    Family(
        "circular",
        {"alpha": (0.02, 0.3), "beta": (1.0, 2.0)},
        **LINE,
        fixed={"t_end": 1.3},
        at=(("t0", 0.6), ("t0", 1.2)),
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.3), "k": (5.0, 40.0)},
        **LINE,
        fixed={"contact": "frictionless", "delta1": 1.2, "p_end": 1.95},
        at=(("p", 1.9),),
        label="tube, contact",
    ),
    Family(
        "circular",
        {"k": (10.0, 60.0), "l": (0.35, 0.55)},
        **MORE,
        fixed={"contact": "frictionless"},
        at=(("p", 3.3),),
        label="circular, contact",
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.15), "k": (5.0, 40.0)},
        **LINE,
        fixed={"contact": "adhesive", "delta1": 1.2, "p_end": 2.45},
        at=(("p", 2.4),),
        label="tube, adhesive",
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.15), "k": (5.0, 40.0)},
        **LINE,
        fixed=DEFLATION,
        at=(("p", 2.2),),
        label="tube, deflation",
    ),
    Family(
        "tube",
        {"alpha": (0.05, 0.15), "k": (5.0, 40.0)},
        coarse=LINE["coarse"],
        fine={"cells": 128, "degree": 5},
        fixed=DEFLATION | {"spring": "unilateral"},
        at=(("p", 2.2),),
        label="tube, unilateral",
    ),
    Family(
        "circular",
        {"alpha": (0.06, 0.15), "beta": (1.0, 1.2)},
        **MORE,
        fixed={"contact": "adhesive", "p_end": 4.05},
        at=(("p", 4.0),),
        label="circular, adhesive",
    ),
    Family(
        "circular",
        {"alpha": (0.06, 0.15), "beta": (1.0, 1.2)},
        **MORE,
        fixed={"contact": "adhesive", "phase": "peeling", "p_end": 4.0, "p": 2.4},
        label="circular, peeling",
    ),
    Family(
        "fluid_tube",
        {"delta": (1.6, 2.4), "gamma": (0.05, 0.11)},
        **MORE,
        fixed={"n_max": 1},
        at=(("zw", 6.0),),
    ),
    Family(
        "wrinkled_tube",
        {"M": (0.8, 0.95), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed={"load": "gas", "load_end": 0.15, "Af": 1.0},
        at=(("p", 0.1),),
        label="wrinkled_tube, gas",
    ),
    Family(
        "wrinkled_tube",
        {"M": (1.3, 1.6), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed=FLUID,
        at=(("zw", 6.0),),
        label="wrinkled_tube, fluid",
    ),
    Family(
        "wrinkled_tube",
        {"M": (1.3, 1.6), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed={"load_end": 7.0},
        at=(("zw", 6.0),),
        label="wrinkled_tube, critical",
    ),
    Family(
        "wrinkled_tube",
        {"M": (1.3, 1.6), "delta": (1.9, 2.2)},
        **BLOCKS,
        fixed=FLUID | {"n": [2]},
        at=(("zw", 6.0),),
        label="wrinkled_tube, waves",
    ),
    Family(
        "hemisphere",
        {"c2": (0.0, 0.2), "gamma": (1.5, 4.0)},
        **BLOCKS,
        at=(("zw", -0.9),),
    ),
    Family(
        "hemisphere",
        {"c2": (0.0, 0.2), "gamma": (1.5, 4.0)},
        **BLOCKS,
        fixed={"n": [2, 10]},
        at=(("zw", -0.9),),
        label="hemisphere, waves",
    ),
)
"""Families for the test of uncertainties; every set of parameters has the requested states."""


QUICK = {"tube": 4, "circular": 2, "circular, contact": 2, "wrinkled_tube, gas": 1, "wrinkled_tube, fluid": 1}
"""Number of sets of each family for a test of a minute or two."""

WIDE = 16
"""Number of sets of every family for a long test."""
