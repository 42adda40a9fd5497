"""Paper 4, figure 5: wrinkling function along the gas-filled membrane, M = 0.5, Case 1, Af = (Af)_c.

The text gives only the pressure p = 0.55. Under gas, M and 2 - M give mirror images.
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Solutions,
    decide,
    reference,
    wrinkled_tube,
)

PRESSURES = (0, 0.05, 0.1, 0.2, 0.35, 0.45, 0.55)
TUBES = {d: wrinkled_tube(M=0.5, delta=d, load="gas") for d in (2, 3)}
CHANGES = reference(4, "stretch_change")
MIRRORED = wrinkled_tube(M=1.5, delta=2, load="gas")
ALIKE = At("p", 0.2, profile=tuple(np.linspace(0, 8, 81)))


def states(pressures: tuple[float, ...]) -> tuple:
    """States of both membranes."""
    return tuple((TUBES[d], At("p", float(p), profile=())) for d in TUBES for p in pressures)


def wrinkled_zone_shrinks(solutions: Solutions) -> Finding:
    """One front, taut below it; the wrinkled fraction decreases with p and stays above 0."""
    found = []
    for d, spec in TUBES.items():
        ats = [At("p", p, profile=()) for p in PRESSURES[1:]]
        for at in ats:
            gw = solutions.column(spec, at, "gw")
            count = sum(name.startswith("Z_front") for name in solutions.state(spec, at).quantities)
            found += [
                decide.less(f"gw at both ends, {at}", gw[-1], 1, gw[0]),
                decide.same("fronts", count, 1),
            ]
        shares = solutions.numbers(spec, ats, "wrinkled_fraction")
        found += [
            decide.falls(f"wrinkled fraction, delta = {d}", shares),
            decide.positive("last wrinkled fraction", shares[-1]),
        ]
    return decide.all_of(found)


def mirror_images(solutions: Solutions) -> Finding:
    """The state of M = 1.5 turned upside down is the state of M = 0.5."""
    return decide.all_of(
        decide.agree(
            name,
            solutions.samples(TUBES[2], ALIKE, name),
            solutions.samples(MIRRORED, ALIKE, name)[::-1],
            5e-9,
        )
        for name in ("r", "lam1", "gw")
    )


MUCH = decide.Stated(
    20, "much faster", "no number is printed; figure 5 and 6 show no change of the meridional one"
)


def sampled(p: float) -> At:
    """A state at the points of the table of changes."""
    return At("p", p, profile=tuple(np.linspace(0, 8, 161)))


def hoop_changes_most(solutions: Solutions) -> Finding:
    """Largest relative changes of the stretches from p = 0, against the table, and their ratios."""
    found = []
    for row, (d, p) in enumerate(zip(CHANGES.columns["delta"], CHANGES.columns["p"], strict=True)):
        hoop, along = (
            abs(
                solutions.samples(TUBES[int(d)], sampled(float(p)), name)
                / solutions.samples(TUBES[int(d)], sampled(0.0), name)
                - 1
            ).largest()
            for name in ("lam2", "lam1")
        )
        found += [
            decide.agree(f"hoop, delta = {d:g}, p = {p:g}", hoop, CHANGES.number("hoop_change")[row], 1e-7),
            decide.agree("meridional", along, CHANGES.number("meridional_change")[row], 1e-6),
            decide.at_least("hoop over meridional", hoop / along, MUCH),
        ]
    return decide.all_of(found)


CASE = Case(
    title="Wrinkling function under gas",
    source="Patil, Nordmark & Eriksson (2015), figure 5",
    panels=tuple(
        Panel(
            name,
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.6 if d == 2 else 4),
            title=rf"$M = 0.5$, $\delta = {d}$",
            curves=tuple(
                Curve(
                    TUBES[d],
                    rf"$p = {p}$",
                    reference=f"fig05_delta_{d}_p_{p}",
                    at=At("p", float(p), profile=()),
                )
                for p in PRESSURES
            ),
            note="Without load the state is the same as in figures 2 and 3.",
        )
        for name, d in (("a", 2), ("b", 3))
    ),
    checks=(
        Claim(
            "wrinkled_zone_shrinks",
            "for 0 < p <= 0.55 the thin side is taut and the thick one wrinkled; the wrinkled zone shrinks "
            "with p and does not vanish",
            states(PRESSURES[1:]),
            wrinkled_zone_shrinks,
        ),
        Claim(
            "mirror_images",
            "under gas M and 2 - M give mirror images",
            ((TUBES[2], ALIKE), (MIRRORED, ALIKE)),
            mirror_images,
        ),
        Claim(
            "hoop_changes_most",
            "the hoop stretch changes much faster with pressure than the meridional one",
            tuple((TUBES[d], sampled(p)) for d in TUBES for p in (0.0, 0.1, 0.2, 0.3)),
            hoop_changes_most,
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9, "lam1": 5e-9, "lam2": 5e-9, "gw": 5e-9, "tension": 5e-9},
)
