"""The tube of Paper 2 in frictionless contact with the relaxed energy: it wrinkles between patch and disk.

At high pressure the ordinary membrane of a tube against its substrate is in hoop compression where it turns
in before the disk. With the relaxed energy it wrinkles there. Displacement, volume, the edge of the patch and
both ends of the zone are compared with two other codes. While it is taut the states are those of the ordinary
membrane. A third tube, far from its substrate, wrinkles in free inflation already. It touches with its zone
open, becomes taut in contact, and wrinkles again at a higher pressure. A fourth one touches with a zone that
ends at the disk and leaves it in contact.
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
    reference,
    tube,
)

MESH = {"degree": 6, "cells": 48}
SOFT = tube(
    energy="relaxed", contact="frictionless", alpha=0.02, delta1=1.0, lf=6.0, k=20.0, s=1.8, p_end=6.5
).on(**MESH)
STRETCHED = SOFT.at(alpha=0.0, delta1=1.2, lf=8.0, p_end=7.5)
WHOLE = SOFT.at(extent="full", p_end=5.8)
EARLY = SOFT.at(alpha=0.0, s=3.0, p_end=5.6).on(degree=6, cells=96)
LEAVING = EARLY.at(alpha=0.037, delta1=1.09, lf=8.7, s=2.84, p_end=1.83)
FREE = tube(alpha=0.0, delta1=1.0, lf=6.0, u_end=1.7, n=(0,)).on(degree=6, cells=48, step=0.15)
TABLES = {SOFT: "relaxed_tube_contact", STRETCHED: "relaxed_tube_contact_stretched"}
ORDINARY = {spec: spec.at(energy="standard") for spec in TABLES}
LEGEND = {
    SOFT: r"$\alpha = 0.02,\ \delta_1 = 1,\ l_f = 6$",
    STRETCHED: r"$\alpha = 0,\ \delta_1 = 1.2,\ l_f = 8$",
}
BEYOND, BEFORE, FULL = At("p", 6.4), At("p", 5.0), At("p", 5.6)
ONSET, TOUCH = "wrinkling_onset", "contact_onset"
OF_EARLY = reference("beyond", "relaxed_tube_early")
TAUT = At("u_max", 2.1)


def unchanged(solutions: Solutions) -> Finding:
    """First contact, and a state in contact before the first wrinkle, are those of the ordinary membrane."""
    asked = [(f"p = 5, {name}", BEFORE, name) for name in ("u_max", "V", "Z_front")]
    return decide.all_of(
        [
            *(
                decide.agree(
                    f"first contact, {name}, {LEGEND[spec]}",
                    solutions.point(spec, "contact_onset", name),
                    solutions.point(ORDINARY[spec], "contact_onset", name),
                    1e-9,
                )
                for spec in TABLES
                for name in ("p", "V")
            ),
            *(
                decide.agree(
                    what, solutions.number(SOFT, at, name), solutions.number(ORDINARY[SOFT], at, name), 1e-9
                )
                for what, at, name in asked
            ),
        ]
    )


def softer(solutions: Solutions) -> Finding:
    """At the same pressure the potential of the tube that wrinkles is lower: the energy is."""
    return decide.all_of(
        decide.less(
            f"potential at p = 6.4, {LEGEND[spec]}",
            solutions.number(spec, BEYOND, "Pi"),
            solutions.number(ORDINARY[spec], BEYOND, "Pi"),
        )
        for spec in TABLES
    )


def differs(solutions: Solutions) -> Finding:
    """The ordinary membrane is compressed around the axis, and more than the one that wrinkles."""
    found = []
    for spec, legend in LEGEND.items():
        ordinary, relaxed = (solutions.number(s, BEYOND, "t2_min") for s in (ORDINARY[spec], spec))
        found.append(decide.negative(f"t2 of the ordinary membrane at p = 6.4, {legend}", ordinary))
        found.append(decide.less(f"t2 at p = 6.4, {legend}", ordinary, relaxed))
    return decide.all_of(*found)


def both_sides(solutions: Solutions) -> Finding:
    """A whole tube, with an edge of contact and a zone on either side, has the states of half of it."""
    names = ("u_max", "Z_front", "Z_front_1", "Z_front_2", "wrinkled_fraction", "lam1_mid")
    return decide.all_of(
        decide.agree(name, solutions.number(WHOLE, FULL, name), solutions.number(SOFT, FULL, name), 1e-7)
        for name in names
    )


def in_order(solutions: Solutions) -> Finding:
    """A tube far from its substrate wrinkles, touches, becomes taut, and wrinkles again."""
    first, closes, second = (solutions.point(EARLY, ONSET, "u_max", k) for k in range(3))
    return decide.less("u_max of its points", first, solutions.point(EARLY, TOUCH, "u_max"), closes, second)


def as_if_free(solutions: Solutions) -> Finding:
    """Its first wrinkle is where the smallest resultant of the ordinary free tube is zero."""
    return decide.all_of(
        decide.agree(
            f"first wrinkle, {name}",
            solutions.point(EARLY, ONSET, name),
            solutions.point(FREE, ONSET, name),
            1e-6,
        )
        for name in ("p", "u_max", "V")
    )


def touches_wrinkled(solutions: Solutions) -> Finding:
    """Pressure, volume and both ends of the zone at first contact are those of the table."""
    row = OF_EARLY.columns["u_max"].tolist().index(2.0)
    return decide.all_of(
        decide.agree(
            f"first contact, {name}", solutions.point(EARLY, TOUCH, name), OF_EARLY.number(name)[row], 1e-7
        )
        for name in ("p", "V", "Z_front_1", "Z_front_2")
    )


def taut_again(solutions: Solutions) -> Finding:
    """Between both zones its states in contact are those of the ordinary membrane."""
    return decide.all_of(
        decide.agree(
            f"u_max = {TAUT.value:g}, {name}",
            solutions.number(EARLY, TAUT, name),
            solutions.number(EARLY.at(energy="standard"), TAUT, name),
            1e-9,
        )
        for name in ("p", "V", "Z_front", "Pi")
    )


CASE = Case(
    title="The tube in contact that wrinkles instead of being compressed",
    source="beyond Patil, Nordmark & Eriksson (2014), constrained inflation",
    panels=(
        *(
            Panel(
                name,
                x=Axis("p", 5.0, 7.6),
                y=Axis(column, *axis),
                title=title,
                markers=(ONSET,) if column == "u_max" else (),
                curves=tuple(Curve(spec, LEGEND[spec], reference=table) for spec, table in TABLES.items()),
            )
            for name, column, axis, title in (
                ("a", "u_max", (0.95, 1.15), "Displacement of the mid-plane"),
                ("b", "V", (7, 15), "Volume"),
                ("c", "Z_front", (1.5, 3.0), "Edge of the patch"),
                ("d", "Z_front_1", (2.0, 3.8), "End of the zone nearer to mid-length"),
                ("e", "Z_front_2", (2.5, 4.0), "Its other end"),
            )
        ),
        Panel(
            "f",
            x=Axis("Z", 1.6, 3.0),
            y=Axis("t2", -1.0, 2.0),
            title="Hoop resultant between patch and disk, $p = 6.4$",
            curves=tuple(
                Curve(spec, name, at=BEYOND, y="t2")
                for spec, name in ((SOFT, "relaxed energy"), (ORDINARY[SOFT], "ordinary membrane"))
            ),
        ),
        *(
            Panel(
                name,
                x=Axis("u_max", 1.5, 2.3),
                y=Axis(column, *axis),
                title=f"{title}, a tube far from its substrate",
                markers=(ONSET, TOUCH) if column == "p" else (),
                curves=(
                    Curve(EARLY, r"$\alpha = 0,\ s = 3$, relaxed energy", reference="relaxed_tube_early"),
                ),
            )
            for name, column, axis, title in (
                ("g", "p", (1.0, 6.0), "Pressure"),
                ("h", "Z_front", (0.0, 1.6), "Edge of the patch"),
                ("i", "Z_front_1", (2.0, 3.0), "End of the zone nearer to mid-length"),
                ("j", "Z_front_2", (2.4, 3.0), "Its other end"),
            )
        ),
        Panel(
            "k",
            x=Axis("u_max", 1.84, 1.88),
            y=Axis("Z_front_2", 4.15, 4.4),
            title="Other end of a zone that leaves the disk in contact",
            curves=(
                Curve(
                    LEAVING,
                    r"$\alpha = 0.037,\ \delta_1 = 1.09,\ l_f = 8.7,\ s = 2.84$",
                    reference="relaxed_tube_leaving",
                ),
            ),
        ),
    ),
    checks=(
        Claim(
            "unchanged",
            "up to the first wrinkle the states are those of the ordinary membrane",
            (
                *((spec, None) for both in ORDINARY.items() for spec in both),
                (SOFT, BEFORE),
                (ORDINARY[SOFT], BEFORE),
            ),
            unchanged,
        ),
        Claim(
            "softer",
            "at the same pressure its potential is lower than that of the ordinary membrane",
            tuple((spec, BEYOND) for both in ORDINARY.items() for spec in both),
            softer,
        ),
        Claim(
            "differs",
            "the ordinary membrane is compressed around the axis, and more than the one that wrinkles",
            tuple((spec, BEYOND) for both in ORDINARY.items() for spec in both),
            differs,
        ),
        Claim(
            "both_sides",
            "half a tube is half of the whole one, with an edge of contact and a zone on either side",
            ((WHOLE, FULL), (SOFT, FULL)),
            both_sides,
        ),
        Claim(
            "in_order",
            "a tube far from its substrate wrinkles, touches, becomes taut, and wrinkles again",
            ((EARLY, None),),
            in_order,
        ),
        Claim(
            "as_if_free",
            "its first wrinkle is where the smallest resultant of the ordinary free tube is zero",
            ((EARLY, None), (FREE, None)),
            as_if_free,
        ),
        Claim(
            "touches_wrinkled",
            "it touches with the pressure, the volume and the zone of two other codes",
            ((EARLY, None),),
            touches_wrinkled,
        ),
        Claim(
            "taut_again",
            "between both zones its states in contact are those of the ordinary membrane",
            ((EARLY, TAUT), (EARLY.at(energy="standard"), TAUT)),
            taut_again,
        ),
        Count(ONSET, {SOFT: 1, STRETCHED: 1, EARLY: 3, LEAVING: 1}, "zones that open or close"),
    ),
    asked=dict.fromkeys(("p", "u_max", "V", "Z_front", "Z_front_1", "Z_front_2"), 1e-7),
    slow=True,
)
