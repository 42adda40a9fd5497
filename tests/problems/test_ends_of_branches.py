"""Where the branches of each problem end, for every kind of its parameters; nothing is solved."""

import numpy as np
import pytest

from weakforms.problems.problem import validated
from weakforms.problems.registry import get

COLUMNS = {name: np.array([1.0, 4.0, 2.0]) for name in ("p", "zw", "V")}
"""A branch by which ends are told that depend on it."""
DEFLATION = {"contact": "adhesive", "phase": "deflation"}
ENDS = [
    ("circular", {}, "primary", "t_end: t0 = 2, largest"),
    ("circular", {"contact": "frictionless", "p_end": 2.5}, "primary", "p_end: p = 2.5, largest"),
    (
        "circular",
        DEFLATION,
        "primary",
        "unloaded: p = 0; slack: t0 = 0.05; p_end: p = 3.477, largest, begins",
    ),
    ("circular", {"phase": "peeling"}, "primary", "smallest patch: X_contact = 0.04; inflation: X_contact"),
    ("tube", {"u_end": 2.0}, "primary", "u_end: u_max = 2, largest"),
    ("tube", {"extent": "full", "secondary": True}, "secondary", "primary: w_mid = 0; u_end: V"),
    ("controls", {"body": "sphere"}, "primary", "lam_end: lam = 4, largest"),
    ("sphere", {"lam_end": 3.0}, "primary", "lam_end: lam = 3, largest"),
    (
        "sphere",
        {"vary": "alpha", "vary_end": 0.2},
        "fold",
        "vary_end: alpha = 0.2; lam_end: lam = 4; start: alpha = 0.1",
    ),
    ("infinite_tube", {}, "primary", "lam_end: lam2 = 6, largest"),
    ("homogeneous", {"lam_end": 0.5}, "primary", "lam_end: lam = 0.5"),
    ("homogeneous", {"lam_end": 3.0}, "primary", "lam_end: lam = 3, largest"),
    ("fluid_tube", {"zw_end": 0.5}, "primary", "zw_end: zw = 2; stiffening: zw"),
    ("fluid_tube", {"secondary": True}, "secondary", "secondary_end: zw"),
    ("hemisphere", {"past": 0.25}, "primary", "past: zw = 3.75; full: zw = 0"),
    ("hemisphere", {"load": "gas"}, "primary", "past: p = 3.99; load_end: p = 10; volume_end: V = 30; at: p"),
    (
        "wrinkled_tube",
        {"load_end": 5.0, "volume_end": 1.5},
        "primary",
        "load_end: zw = 5; volume_end: V = 1.5; past limit: zw = 3.2; at: zw",
    ),
    (
        "wrinkled_tube",
        {"load": "gas"},
        "primary",
        "load_end: p = 0.6; volume_end: V = 30; past limit: p = 3.2; at: p",
    ),
    ("annulus", {}, "primary", "psi_end: psi = 0.5, largest"),
    ("torus", {}, "primary", "v_end: v = 4, largest"),
    ("rectangle", {}, "primary", "w_end: w_c = 1.5, largest"),
    ("membrane", {"w_end": 0.7}, "primary", "w_end: w_max = 0.7, largest"),
    ("sheet", {"gam_end": 0.7}, "primary", "gam_end: gam = 0.7, largest"),
    ("sheet", {"loading": "strip"}, "primary", "lam_end: lam = 2, largest"),
    (
        "diagram",
        {"low": 1.1, "high": 1.5},
        "fold",
        "low: delta1 = 1.1; high: delta1 = 1.5; p_low: p = 0; u_end: u_max = 5; closed: delta1",
    ),
    (
        "diagram",
        {"low": 1.1, "high": 1.5},
        "end",
        "low: delta1 = 1.1; high: delta1 = 1.5; p_low: p = 0; closed: delta1",
    ),
]


def told(end) -> str:
    """An end in a line."""
    value = end.value(COLUMNS) if callable(end.value) else end.value
    out = f"{end.by}: {end.column}" + (f" = {value:g}" if value is not None else "")
    return out + ", largest" * end.largest + ", begins" * end.begins


@pytest.mark.parametrize(("problem", "given", "branch", "expected"), ENDS)
def test_branches_end_where_parameters_say(problem, given, branch, expected):
    chosen = get(problem)
    parameters = validated(chosen.parameters, dict(given), problem)
    assert "; ".join(told(end) for end in chosen.ends(parameters, branch)) == expected
