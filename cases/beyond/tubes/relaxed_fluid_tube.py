"""The tube of liquid of Paper 3 with the relaxed energy: a zone of wrinkles above the lower ring.

With a small pre-stretch the ordinary tube is in hoop compression near its lower ring, once its level has
fallen from the highest one. With the relaxed energy it wrinkles there. Level, radius, tension and both ends
of the zone are compared with two other codes, for a full tube that stiffens and for a neo-Hookean one that a
heavy liquid fills in part, where the free surface is one more unknown. Up to the first wrinkle the states are
those of the ordinary membrane.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Solutions,
    decide,
    fluid_tube,
)

MESH = {"degree": 6, "cells": 96}
FULL = fluid_tube(energy="relaxed", L=8.0, delta=1.05, gamma=0.116, alpha=0.2, n_max=1).on(**MESH)
PART = fluid_tube(energy="relaxed", L=8.0, delta=1.05, gamma=0.5, alpha=0.0, n_max=1, zw_end=0.5).on(**MESH)
TABLES = {FULL: "relaxed_fluid_full", PART: "relaxed_fluid_part"}
ORDINARY = {spec: spec.at(energy="standard").on(degree=6, cells=128) for spec in TABLES}
LEGEND = {
    FULL: r"$\alpha = 0.2,\ \gamma = 0.116$, full",
    PART: r"$\alpha = 0,\ \gamma = 0.5$, partially filled",
}
BEYOND = {FULL: At("V", 400.0), PART: At("V", 32.0)}
OPENING = "zone_opening"


def unchanged(solutions: Solutions) -> Finding:
    """Highest levels, and the bending before the first wrinkle, are those of the ordinary membrane."""
    asked = [(spec, "limit_point") for spec in TABLES] + [(PART, "bifurcation_point")]
    return decide.all_of(
        decide.agree(
            f"{kind} of {LEGEND[spec]}, {name}",
            solutions.point(spec, kind, name),
            solutions.point(ORDINARY[spec], kind, name),
            1e-6,
        )
        for spec, kind in asked
        for name in ("zw", "V", "r_mid", "T1_ring")
    )


def softer(solutions: Solutions) -> Finding:
    """At the same volume the full tube that wrinkles stores less energy than one that bears compression.

    For a full tube ``dPi/dzw = -gamma V``, so that ``Pi + gamma zw V`` is the energy at a volume.
    """
    stored, ordinary = (
        solutions.number(spec, BEYOND[FULL], "Pi")
        + 0.116 * 400.0 * solutions.number(spec, BEYOND[FULL], "zw")
        for spec in (FULL, ORDINARY[FULL])
    )
    return decide.less("energy at V = 400", stored, ordinary)


def differs(solutions: Solutions) -> Finding:
    """Beyond the first wrinkle the same volume has a lower level."""
    return decide.all_of(
        decide.less(
            f"zw at {BEYOND[spec].name} = {BEYOND[spec].value:g}, {LEGEND[spec]}",
            *(solutions.number(one, BEYOND[spec], "zw") for one in (spec, ORDINARY[spec])),
        )
        for spec in TABLES
    )


CASE = Case(
    title="The tube of liquid that wrinkles instead of being compressed",
    source="beyond Patil, Nordmark & Eriksson (2015), figure 2",
    panels=(
        *(
            Panel(
                name,
                x=Axis("V", 0, 460 if spec == FULL else 36),
                y=Axis("zw", 0, 14 if spec == FULL else 3.5),
                title=LEGEND[spec],
                markers=("limit_point", OPENING),
                curves=(
                    Curve(spec, "relaxed energy", reference=TABLES[spec]),
                    Curve(ORDINARY[spec], "ordinary membrane"),
                ),
            )
            for name, spec in (("a", FULL), ("b", PART))
        ),
        *(
            Panel(
                name,
                x=Axis("V", 180, 450) if spec == FULL else Axis("V", 28, 33.5),
                y=Axis(f"Z_front_{k}", 0.2, 1.5),
                title=f"{'Lower' if k == 1 else 'Upper'} end of the zone, {LEGEND[spec]}",
                curves=(Curve(spec, "relaxed energy", reference=TABLES[spec]),),
            )
            for name, spec, k in (("c", FULL, 1), ("d", FULL, 2), ("e", PART, 1), ("f", PART, 2))
        ),
        Panel(
            "g",
            x=Axis("Z", 0, 2),
            y=Axis("T2", -0.4, 1.0),
            title="Hoop resultant above the lower ring, $V = 400$",
            curves=tuple(
                Curve(spec, name, at=BEYOND[FULL], y="T2")
                for spec, name in ((FULL, "relaxed energy"), (ORDINARY[FULL], "ordinary membrane"))
            ),
        ),
    ),
    checks=(
        Claim(
            "unchanged",
            "up to the first wrinkle limit and bifurcation points are those of the ordinary membrane",
            tuple((spec, None) for both in ORDINARY.items() for spec in both),
            unchanged,
        ),
        Claim(
            "softer",
            "at the same volume it stores less energy than the ordinary membrane",
            ((FULL, BEYOND[FULL]), (ORDINARY[FULL], BEYOND[FULL])),
            softer,
        ),
        Claim(
            "differs",
            "beyond the first wrinkle the level of the same volume is lower",
            tuple((spec, BEYOND[one]) for one, other in ORDINARY.items() for spec in (one, other)),
            differs,
        ),
        Count(OPENING, {FULL: 1, PART: 1}, "zones that open"),
    ),
    asked=dict.fromkeys(("zw", "V", "r_max", "T1_ring", "Z_front", "Z_front_1", "Z_front_2"), 1e-6),
    slow=True,
)
