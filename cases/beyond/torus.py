"""The inflated torus: pressure over volume, limit point and meridian, against two other methods.

A torus of circular cross-section is the benchmark of a closed membrane whose linear theory fails: without
pressure it bends freely along its highest and lowest circles. It has one limit point and is taut everywhere.
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    torus,
)

USUAL = torus(b=0.4, alpha=0.0, v_end=4.2)
SLENDER = torus(b=0.2, v_end=4.2)
THICK = torus(b=0.6)
TORI = {"usual": USUAL, "slender": SLENDER, "thick": THICK}
STATE = At("V", 6.316547, profile=())
"""Twice the volume without stress."""

ASKED = 1e-7
OUTER = 1.7 + 0.2 * np.cos(np.pi * np.arange(10, -1, -1) / 10)
"""Outer radii of the usual torus between which the work of the gas is integrated."""


def taut(solutions: Solutions) -> Finding:
    """Both resultants along the meridian, at two volumes of each torus."""
    found = []
    for name, spec in TORI.items():
        for at in states(name):
            for resultant in ("t1", "t2"):
                values = solutions.column(spec, at, resultant)
                found.append(decide.positive(f"{resultant} of the {name} torus", values))
    return decide.all_of(*found)


def states(name: str) -> tuple[At, ...]:
    """States of one torus at which its resultants are looked at."""
    radii = {"usual": (1.45, 1.9), "slender": (1.25, 1.55), "thick": (1.65, 2.2)}[name]
    return tuple(At("r_out", radius, profile=()) for radius in radii)


def work(solutions: Solutions) -> Finding:
    """The energy changes by the integral of p dV, by polynomials over the outer radius."""
    ats = [At("r_out", float(r)) for r in OUTER]
    p, volume, stored = (solutions.numbers(USUAL, ats, name) for name in ("p", "V", "U"))
    exact = decide.work(OUTER, p.value, volume.value)
    return decide.agree("work of the gas", stored[-1] - stored[0], exact, 1e-6)


CASE = Case(
    title="Inflation of a torus",
    source="a benchmark of codes for membranes: the toroidal membrane",
    panels=(
        Panel(
            "pressure",
            x=Axis("V", 0, 13),
            y=Axis("p", 0, 10),
            markers="limit_point",
            note="Not a figure of the thesis.",
            curves=(
                Curve(USUAL, r"$b = 0.4,\ \alpha = 0$", reference="torus"),
                Curve(SLENDER, r"$b = 0.2,\ \alpha = 0.1$", reference="torus_slender"),
            ),
        ),
        Panel(
            "meridian",
            x=Axis("t", 0, 3.1416),
            y=Axis("lam1", 1.2, 1.6),
            note="Twice the volume without stress.",
            curves=(Curve(USUAL, r"$b = 0.4,\ \alpha = 0$", reference="torus_meridian", at=STATE, y="lam1"),),
        ),
    ),
    checks=(
        Count("limit_point", dict.fromkeys(TORI.values(), 1), "number of limit points"),
        Points("limit_point", "torus_limit", USUAL, (), dict.fromkeys(("p", "V", "r_out", "U"), ASKED)),
        Points(
            "limit_point", "torus_slender_limit", SLENDER, (), dict.fromkeys(("p", "V", "r_out", "U"), ASKED)
        ),
        Claim(
            "taut",
            "a torus is taut everywhere, before and after its limit point",
            tuple((spec, at) for name, spec in TORI.items() for at in states(name)),
            taut,
        ),
        Claim(
            "work",
            "the work of the gas is the change of strain energy",
            tuple((USUAL, At("r_out", float(r))) for r in OUTER),
            work,
        ),
    ),
    asked=dict.fromkeys(("p", "r_out", "r_in", "U", "virial", "r", "z"), ASKED)
    | {"z_top": ASKED, "lam1": 1e-6, "lam2": 1e-6},
)
