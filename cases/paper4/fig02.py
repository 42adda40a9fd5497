"""Paper 4, figure 2: wrinkling function along the fluid-filled membrane, delta = 2, Case 1, Af = (Af)_c.

(a) M = 0.5, lower end thin; (b) M = 1.5, upper end thin. The text gives only the level zw = 7.44; the others
are chosen here. With the exact critical radius there is a narrow taut zone at the thin end at every level
above 0, thinner than 1e-3 at low levels.
"""

import numpy as np

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, wrinkled_tube

LEVELS = (0, 3, 4.5, 6, 7.44, 10, 12, 16)
TUBES = {M: wrinkled_tube(M=M, delta=2) for M in (0.5, 1.5)}
EMPTY, PRINTED = At("zw", 0.0, profile=()), At("zw", 7.44, profile=())
CLOSE = 1e-4
"""Distance of samples near a kink from the front and from each other."""


def fronts(solutions: Solutions, M: float, level: float) -> list[decide.Number]:
    """Fronts from the lower end."""
    quantities = solutions.state(TUBES[M], At("zw", float(level))).quantities
    return [decide.number(q) for name, q in quantities.items() if name.startswith("Z_front")]


def unloaded(solutions: Solutions) -> Finding:
    """Zero load: gw = 1 at the thin end, less elsewhere; constant radius, no radial force at the ends."""
    found = []
    for M, thin in ((0.5, 0), (1.5, -1)):
        gw, r, slope = (solutions.column(TUBES[M], EMPTY, name) for name in ("gw", "r", "slope"))
        others = np.delete(np.arange(len(gw)), thin)
        found += [
            decide.agree(f"M = {M}: gw at the thin end", gw[thin], 1.0, 5e-9),
            decide.negative("gw - 1 elsewhere", gw[others] - 1),
            decide.constant("r", r, 5e-9),
            decide.zero("slope at the ends", slope[[0, -1]], 5e-9),
        ]
    return decide.all_of(found)


def pattern(solutions: Solutions) -> Finding:
    """M = 1.5, zw = 7.44: wrinkled, taut, wrinkled, taut from the bottom."""
    gw = solutions.column(TUBES[1.5], PRINTED, "gw")
    return decide.all_of(
        decide.same("fronts", len(fronts(solutions, 1.5, 7.44)), 3),
        decide.less("gw at both ends", gw[0], 1, gw[-1]),
    )


def thin_end_taut(solutions: Solutions) -> Finding:
    """The thin end has gw above 1, the thick end below 1, at every level from 3 on."""
    found = []
    for M, tube in TUBES.items():
        for level in LEVELS[1:]:
            gw = solutions.column(tube, At("zw", float(level), profile=()), "gw")
            thin, thick = (gw[0], gw[-1]) if M < 1 else (gw[-1], gw[0])
            found.append(decide.less(f"M = {M}, zw = {level}: gw", thick, 1, thin))
    return decide.all_of(found)


def front_rises(solutions: Solutions) -> Finding:
    """M = 0.5: one front, which moves up with the level."""
    found = [fronts(solutions, 0.5, level) for level in LEVELS[1:]]
    return decide.all_of(
        decide.same("fronts", [len(row) for row in found], [1] * len(found)),
        decide.rises("Z", [row[0] for row in found]),
    )


def kink(solutions: Solutions) -> Finding:
    """At each front gw is continuous and its slope is not (with two samples on each side)."""
    found = []
    for z in PLACES:
        gw = solutions.samples(TUBES[1.5], At("zw", 7.44, profile=around(z)), "gw")
        below, above = (gw[1] - gw[0]) / CLOSE, (gw[3] - gw[2]) / CLOSE
        # A line through two samples gives the value at the front up to the curvature of gw, of second order.
        gap = (2 * gw[1] - gw[0]) - (2 * gw[2] - gw[3])
        bent = decide.Number(0.0, CLOSE**2)
        found.append(decide.zero(f"Z = {z:.4f}: gap", gap + bent, 5e-7))
        found.append(decide.positive("change of slope", abs(above - below)))
    return decide.all_of(found)


def around(z: float) -> tuple[float, ...]:
    """Two points on each side of a front."""
    return tuple(z + d * CLOSE for d in (-2, -1, 1, 2))


PLACES = (1.511572660117, 5.069224906584, 7.595374980714)
"""Fronts at zw = 7.44, M = 1.5, from the reference, at which the kink is sampled."""

STATES = tuple((TUBES[M], At("zw", float(v), profile=())) for M in TUBES for v in LEVELS)

CASE = Case(
    title="Wrinkling function under fluid, delta = 2",
    source="Patil, Nordmark & Eriksson (2015), figure 2",
    panels=tuple(
        Panel(
            name,
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.65, 1.4),
            title=rf"$M = {M}$, $\delta = 2$",
            curves=tuple(
                Curve(
                    TUBES[M],
                    rf"$z_w = {v}$",
                    reference=f"fig02_M_{M}_zw_{v}",
                    at=At("zw", float(v), profile=()),
                )
                for v in LEVELS
            ),
        )
        for name, M in (("a", 0.5), ("b", 1.5))
    ),
    checks=(
        Claim(
            "unloaded",
            "without load gw <= 1 everywhere, with equality at the thin end; the radius is constant and the "
            "disks feel no radial force",
            tuple((TUBES[M], EMPTY) for M in TUBES),
            unloaded,
        ),
        Claim(
            "pattern",
            "M = 1.5, delta = 2, zw = 7.44: two wrinkled and two taut zones in turn, wrinkled at the bottom",
            ((TUBES[1.5], PRINTED),),
            pattern,
        ),
        Claim("thin_end_taut", "the thin end is taut and the thick end wrinkled", STATES, thin_end_taut),
        Claim(
            "front_rises", "for M = 0.5 there is one front, which rises with the level", STATES, front_rises
        ),
        Claim(
            "kink",
            "gw is continuous at a front and has a kink there",
            tuple((TUBES[1.5], At("zw", 7.44, profile=around(z))) for z in PLACES),
            kink,
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9, "lam1": 5e-9, "lam2": 5e-9, "gw": 5e-9, "tension": 5e-9},
)
