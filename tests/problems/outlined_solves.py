"""Solves on coarse meshes, and every number and word of their results.

Cases hold a few numbers of a problem against references. An outline holds all of them against what they were:
each column, where a branch ends, how many points its trace has, uncertainties, warnings, what is absent. A
rebuild that is to change no number changes none of them.
"""

import re
from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from weakforms import solve
from weakforms.results import Result

LINE = {"cells": 32, "degree": 3, "levels": 3}
BLOCKS = {"cells": 8, "degree": 3, "levels": 2}
LIQUID = {"cells": 32, "degree": 3, "levels": 2}
BENT = {"secondary_cells": 12, "secondary_levels": 2, "secondary_degree": 3}
CLAMPED = {"alpha": 0.2, "delta1": 1.2, "lf": 5.0}
GLUED = {"contact": "adhesive", "phase": "deflation"}
DISK = {"alpha": 0.15, "beta": 1.2}
LINES = {"alpha": 0.1, "high": 2.0, "numerics": LINE}

SOLVES: dict[str, dict[str, Any]] = {
    "tube": {"n": (0, 1), **CLAMPED, "at": {"u_max": 1.0}, "numerics": LINE},
    "tube, whole, of Gent's law": {
        "model": "gent",
        "jm": 40.0,
        "extent": "full",
        "delta1": 1.1,
        "at": {"p": 1.0},
        "numerics": LINE,
    },
    "tube, lopsided": {
        "alpha": 0.0,
        "extent": "full",
        "secondary": True,
        "u_end": 1.5,
        "numerics": {"cells": 16, "levels": 2, "step": 0.2},
    },
    "tube, lopsided and wrinkled": {
        **{"alpha": 0.0, "extent": "full", "secondary": True, "u_end": 1.5, "energy": "relaxed"},
        "at": {"V": 13.0},
        "branch": "secondary",
        "numerics": {"cells": 16, "levels": 2, "step": 0.2},
    },
    "tube, bent": {
        **{"alpha": 0.0, "lf": 10.0, "u_end": 0.7, "secondary": True, "secondary_n": 1, "V_r": 60.0},
        "numerics": {
            "cells": 16,
            "levels": 2,
            "secondary_cells": 8,
            "secondary_around": 8,
            "secondary_degree": 3,
        },
    },
    "tube, bent and wrinkled": {
        **{"alpha": 0.0, "lf": 10.0, "u_end": 1.1, "secondary": True, "secondary_n": 1, "energy": "relaxed"},
        "at": {"V": 7.2},
        "branch": "secondary",
        "numerics": {
            "cells": 32,
            "levels": 2,
            "secondary_cells": 8,
            "secondary_around": 4,
            "secondary_degree": 3,
        },
    },
    "tube, relaxed": {
        "alpha": 0.0,
        "energy": "relaxed",
        "u_end": 2.0,
        "at": {"u_max": 1.8},
        "numerics": {"cells": 32, "levels": 2, "step": 0.2},
    },
    "tube, frictionless": {"contact": "frictionless", **CLAMPED, "at": {"p": 2.0}, "numerics": LINE},
    "tube, glued": {**GLUED, **CLAMPED, "p_end": 2.5, "at": {"p": 1.0}, "numerics": LINE},
    "tube_fold": {"alpha": 0.1, "numerics": LINE},
    "tube_scheme": {"numerics": {"cells": 40, "steps": 8}},
    "diagram": {"kind": "fold,mirror,wrinkling", **LINES},
    "diagram, waves": {"kind": "n1", **LINES},
    "diagram, long waves": {
        "body": "infinite_tube",
        "ends": "held",
        "kind": "localisation,n1",
        "at": {"lam1": 1.3},
        "branch": "localisation",
        "high": 1.5,
    },
    "controls": {"V_r": 20.0, "u_end": 2.0, "at": {"u_max": 1.4}, "numerics": LINE},
    "circular": {**DISK, "t_end": 1.3, "at": {"t0": 1.0}, "numerics": LINE},
    "circular, frictionless": {"contact": "frictionless", **DISK, "at": {"p": 2.0}, "numerics": LINE},
    "circular, glued": {**GLUED, **DISK, "p_end": 2.0, "at": {"p": 1.0}, "numerics": LINE},
    "circular, peeling": {"contact": "adhesive", "phase": "peeling", **DISK, "p": 1.5, "numerics": LINE},
    "circular_scheme": {"t_end": 0.57, "numerics": {"cells": 100, "steps": 14}},
    "fluid_tube": {"n_max": 2, "delta": 1.9, "at": {"zw": 6.0}, "numerics": LIQUID},
    "fluid_tube, relaxed": {
        "energy": "relaxed",
        "delta": 1.05,
        "gamma": 0.5,
        "n_max": 1,
        "at": {"V": 30.0},
        "numerics": LIQUID,
    },
    "fluid_tube, bent": {"secondary": True, "n_max": 1, "numerics": LIQUID | BENT},
    "fluid_tube, bent and relaxed": {
        **{"secondary": True, "energy": "relaxed", "L": 12.0, "delta": 1.4, "gamma": 0.03, "n_max": 1},
        **{"at": {"zw": 17.2}, "branch": "secondary"},
        "numerics": LIQUID | BENT | {"secondary_step": 0.4, "secondary_end": 0.8},
    },
    "fluid_tube_coincidence": {"gamma": 0.12, "numerics": LIQUID},
    "fluid_tube_imperfect": {
        **{"tilt": 0.1, "v_start": 0.9, "u_end": 0.3, "at": {"zw": 8.9}},
        "numerics": {"cells": 8, "around": 4, "levels": 2, "degree": 3},
    },
    "fluid_tube_surface": {"numerics": {"cells": 8}},
    "wrinkled_tube": {"M": 0.9, "Af": 1.0, "n": (20,), "at": {"zw": 3.0}, "numerics": BLOCKS},
    "wrinkled_tube, gas": {
        "M": 0.85,
        "Af": 1.0,
        "load": "gas",
        "load_end": 0.15,
        "c2": 0.1,
        "at": {"p": 0.1},
        "numerics": BLOCKS,
    },
    "wrinkled_tube, standard": {"M": 0.9, "energy": "standard", "Af": 1.0, "numerics": BLOCKS},
    "wrinkled_tube_threshold": {"delta": 2.5, "numerics": BLOCKS},
    "wrinkled_linear": {"numerics": BLOCKS},
    "wrinkled_bending": {"numerics": BLOCKS},
    "wrinkled_sheet": {"at_load": 3.5, "numerics": {"along": 2, "around": 2}},
    "wrinkled_material": {},
    "wrinkled_patch": {},
    "hemisphere": {"c2": 0.1, "at": {"zw": -0.9}, "numerics": BLOCKS},
    "hemisphere, gas": {"load": "gas", "n": (2,), "numerics": BLOCKS},
    "surface": {"meridional": 12, "circumferential": 8, "numerics": {"scan": 10, "shown": 1}},
    "membrane": {"mesh": "square", "w_end": 0.6, "at": {"w_c": 0.4}, "numerics": {"cells": 4}},
    "membrane, seam": {
        **{"mesh": "airbag", "delta": 1, "model": "saint_venant_kirchhoff", "shear": 0.357, "poisson": 0.4},
        **{
            "w_end": 0.56,
            "at": {"p": 0.06},
            "numerics": {"cells": 4, "levels": 2, "degree": 1, "p_start": 0.05},
        },
    },
    "rectangle": {"w_end": 0.6, "load": "gas", "at": {"w_c": 0.4}, "numerics": {"cells": 4}},
    "rectangle, liquid": {"gamma": 1.0, "w_end": 0.6, "numerics": {"cells": 4}},
    "sheet": {"s": 1.1, "gam_end": 0.5, "at": {"gam": 0.4}, "numerics": {"cells": 4, "levels": 2}},
    "sheet, strip": {"loading": "strip", "lam_end": 1.4, "numerics": {"cells": 4, "levels": 2}},
    "sheet, bent": {
        **{"loading": "bend", "c": 0.5, "kap_end": 0.6, "at": {"kap": 0.5}},
        "numerics": {"cells": 4, "levels": 2},
    },
    "annulus": {"s": 1.05, "psi_end": 0.3, "at": {"psi": 0.2}, "numerics": LINE},
    "torus": {"b": 0.3, "v_end": 2.5, "at": {"v": 1.8}, "numerics": LINE},
    "torus, waves": {"alpha": 0.0, "v_end": 3.5, "n": (0, 1), "at": {"v": 1.8}, "numerics": LINE},
    "material": {"model": "ogden"},
    "sphere": {"model": "biderman"},
    "infinite_tube": {"force": 0.5},
    "homogeneous": {"model": "arruda_boyce"},
}
"""Solves by title; the problem is the first word."""

LEFT_OUT = {"schema", "scales", "provenance", "residual", "iterations", "order"}
"""Entries that say where and when, or that are round-off or its quotients."""

UNDECIDED = re.compile(r"/[XYZ]_least|branches.*/Z_t_min|/Lambda_rotation")
"""Places of a smallest resultant are left out too. In a uniform state, and where two places mirror each
other, the resultants are equal and round-off chooses the place. The eigenvalue of a rotation is zero but for
round-off."""


def sections() -> dict[str, Any]:
    """Titles with functions that give the texts."""
    return {title: partial(solved, title) for title in SOLVES}


def solved(title: str) -> str:
    """The outline of a solve."""
    given = SOLVES[title]
    return outline(solve(title.partition(",")[0], **given))


def outline(result: Result) -> str:
    """All entries of a result, a line each."""
    return "\n".join(f"{place}: {text}" for place, text in _entries("", result.to_json()))


def _entries(place: str, value: Any) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for name, item in value.items():
            inner = f"{place}/{name}" if place else str(name)
            if name not in LEFT_OUT and not UNDECIDED.search(inner):
                yield from _entries(inner, item)
    elif isinstance(value, np.ndarray) or (isinstance(value, list) and _are_numbers(value)):
        yield place, _numbers(np.array(value, dtype=float))
    elif isinstance(value, list | tuple):
        for k, item in enumerate(value):
            yield from _entries(f"{place}[{k}]", item)
    else:
        yield place, f"{value:.10g}" if isinstance(value, float) else str(value)


def _are_numbers(values: list) -> bool:
    return bool(values) and all(v is None or isinstance(v, int | float) for v in values)


def _numbers(values: np.ndarray) -> str:
    """First and last number, how many there are, and their mean and root mean square."""
    shown = values[np.isfinite(values)]
    if not len(shown):
        return f"{len(values)} without a value"
    read = (shown[0], shown[-1], shown.mean(), np.sqrt((shown**2).mean()))
    return f"{len(shown)} of {len(values)} " + " ".join(f"{number:.10g}" for number in read)
