"""The free tube of Paper 2 with the relaxed energy: what changes where the ordinary membrane is compressed.

The neo-Hookean tube of figure 2(a) is in hoop compression beside its disks from u_max = 1.533 to 3.321. With
the relaxed energy it wrinkles there. Pressure, volume and both ends of the zone are compared with two other
codes, for a zone that opens and closes beside the disk and for one that ends at the disk. Up to the first
wrinkle, and from where the zone closes on, the states are those of the ordinary membrane.
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
    tube,
)

MESH = {"degree": 6, "cells": 48, "step": 0.15}
INSIDE = tube(energy="relaxed", alpha=0.0, delta1=1.0, lf=6.0, u_end=3.6).on(**MESH)
STIFFER = tube(energy="relaxed", alpha=0.02, delta1=1.0, lf=6.0, u_end=2.8).on(**MESH)
AT_DISK = tube(energy="relaxed", alpha=0.0, delta1=1.2, lf=8.0, u_end=4.1).on(**MESH)
WHOLE = INSIDE.at(extent="full", u_end=1.9)
ORDINARY = INSIDE.at(energy="standard", n=(0,))
TABLES = {INSIDE: "relaxed_tube_inside", STIFFER: "relaxed_tube_stiffer", AT_DISK: "relaxed_tube_disk"}
BEYOND, FULL = At("u_max", 2.5), At("u_max", 1.8)
FILLED = At("V", 14.0)
ONSET = "wrinkling_onset"
COLUMNS = ("p", "u_max", "V")
LEGEND = {
    INSIDE: r"$\alpha = 0,\ \delta_1 = 1,\ l_f = 6$",
    STIFFER: r"$\alpha = 0.02,\ \delta_1 = 1,\ l_f = 6$",
    AT_DISK: r"$\alpha = 0,\ \delta_1 = 1.2,\ l_f = 8$",
}


def unchanged(solutions: Solutions) -> Finding:
    """The limit point, before the first wrinkle, is that of the ordinary membrane to all digits."""
    return decide.all_of(
        decide.agree(
            f"limit point, {name}",
            solutions.point(INSIDE, "limit_point", name),
            solutions.point(ORDINARY, "limit_point", name),
            1e-10,
        )
        for name in COLUMNS
    )


def closes(solutions: Solutions) -> Finding:
    """The zone opens and closes at the states where the ordinary membrane's smallest resultant is zero."""
    found = [
        decide.agree(
            f"{what}, {name}",
            solutions.point(INSIDE, ONSET, name, index),
            solutions.point(ORDINARY, ONSET, name, index),
            1e-7,
        )
        for index, what in enumerate(("opens", "closes"))
        for name in COLUMNS
    ]
    return decide.all_of(*found)


def softer(solutions: Solutions) -> Finding:
    """At the same volume the tube that wrinkles stores less energy than the one that bears compression."""
    stored, ordinary = (
        solutions.number(spec, FILLED, "Pi")
        + solutions.number(spec, FILLED, "p") * solutions.number(spec, FILLED, "V")
        for spec in (INSIDE, ORDINARY)
    )
    return decide.less("energy at V = 14", stored, ordinary)


def differs(solutions: Solutions) -> Finding:
    """Beyond the first wrinkle the pressure is another one: at u_max = 2.5 it is higher."""
    p = [solutions.number(spec, BEYOND, "p") for spec in (ORDINARY, INSIDE)]
    return decide.less("p at u_max = 2.5", *p)


def both_sides(solutions: Solutions) -> Finding:
    """A whole tube, with a zone at either disk, has the states of half of it."""
    names = ("p", "Z_front_1", "Z_front_2", "wrinkled_fraction", "lam1_mid")
    return decide.all_of(
        decide.agree(name, solutions.number(WHOLE, FULL, name), solutions.number(INSIDE, FULL, name), 1e-7)
        for name in names
    )


CASE = Case(
    title="The free tube that wrinkles instead of being compressed",
    source="beyond Patil, Nordmark & Eriksson (2014), figure 2(a)",
    panels=(
        Panel(
            "a",
            x=Axis("u_max", 1.0, 3.6),
            y=Axis("p", 0.8, 1.75),
            title="Pressure: with the relaxed energy",
            markers=(ONSET,),
            curves=tuple(Curve(spec, LEGEND[spec], reference=table) for spec, table in TABLES.items()),
        ),
        *(
            Panel(
                name,
                x=Axis("u_max", 1.0, 4.0),
                y=Axis(column, *axis),
                title=title,
                curves=tuple(Curve(spec, LEGEND[spec], reference=TABLES[spec]) for spec in specs),
            )
            for name, column, axis, title, specs in (
                ("b", "V", (4, 40), "Volume", TABLES),
                ("c", "Z_front_1", (2.5, 4.1), "End of the zone nearer to mid-length", TABLES),
                ("d", "Z_front_2", (2.5, 4.1), "Its other end", (INSIDE, STIFFER)),
            )
        ),
        Panel(
            "e",
            x=Axis("Z", 2.4, 3.0),
            y=Axis("t2", -0.15, 0.5),
            title=r"Hoop resultant beside the disk, $u_{max} = 2.5$",
            curves=tuple(
                Curve(spec, name, at=BEYOND, y="t2")
                for spec, name in ((INSIDE, "relaxed energy"), (ORDINARY, "ordinary membrane"))
            ),
        ),
    ),
    checks=(
        Claim(
            "unchanged",
            "before the first wrinkle the limit point is that of the ordinary membrane",
            ((INSIDE, None), (ORDINARY, None)),
            unchanged,
        ),
        Claim(
            "closes",
            "the zone opens and closes where the ordinary membrane's smallest resultant is zero",
            ((INSIDE, None), (ORDINARY, None)),
            closes,
        ),
        Claim(
            "softer",
            "at the same volume it stores less energy than the ordinary membrane",
            ((INSIDE, FILLED), (ORDINARY, FILLED)),
            softer,
        ),
        Claim(
            "differs",
            "beyond the first wrinkle the pressure is another one",
            ((INSIDE, BEYOND), (ORDINARY, BEYOND)),
            differs,
        ),
        Claim(
            "both_sides",
            "half a tube is half of the whole one, with a zone at either disk",
            ((WHOLE, FULL), (INSIDE, FULL)),
            both_sides,
        ),
        Count(ONSET, {INSIDE: 2, STIFFER: 2, AT_DISK: 1}, "zones that open and close"),
    ),
    asked=dict.fromkeys(("p", "u_max", "V", "Z_front_1", "Z_front_2"), 1e-7),
    slow=True,
)
