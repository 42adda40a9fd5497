"""Paper 5, figure 4: wrinkling function along the cylinder, M = 1.5, delta = 3, under liquid (a) and gas (b).

The levels and pressures are chosen here; the paper names none. At low and moderate levels the whole membrane
is wrinkled, and its upper part becomes taut as the level rises; under gas the thick lower part is wrinkled
and the thin upper part taut.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Printed,
    Solutions,
    decide,
    wrinkled_tube,
)

DATA = {"M": 1.5, "delta": 3, "Af": 0.4362}
FLUID, GAS = wrinkled_tube(**DATA), wrinkled_tube(**DATA, load="gas")
LEVELS, PRESSURES = (1.5, 3, 4.5, 6, 6.6), (0.02, 0.05, 0.1, 0.2, 0.38)
LAST = At("zw", 5.73)
"""Level up to which the paper calls the whole membrane wrinkled."""


LAYER = decide.Stated(1e-3, "but for a layer thinner than 0.001 L", "the claim's own number")
VERGE = decide.Stated(1e-4, "wrinkled", "no number is printed; in that layer gw exceeds 1 only slightly")
PART = decide.Stated(0.05, "the upper part", "the length's last twentieth and more")


def at(control: str, load: float) -> At:
    """A state with its profile."""
    return At(control, float(load), profile=())


def share(solutions: Solutions, state: At, spec: object = FLUID) -> decide.Number:
    """Wrinkled fraction of the length."""
    return solutions.number(spec, state, "wrinkled_fraction")


def all_wrinkled(solutions: Solutions) -> Finding:
    """Wrinkled fraction of the length up to zw = 5.73: everything except a layer at the upper disk."""
    levels = [*(at("zw", v) for v in LEVELS if v < LAST.value), LAST]
    return decide.all_of(
        decide.at_most(
            "taut part of the length", 1 - decide.stack(share(solutions, level) for level in levels), LAYER
        ),
        decide.at_most(f"gw - 1 at zw = {LAST.value}", solutions.number(FLUID, LAST, "gw_max") - 1, VERGE),
    )


def upper_part_taut(solutions: Solutions) -> Finding:
    """Taut part of the length at zw = 6 and 6.6."""
    low, high = (1 - share(solutions, at("zw", v)) for v in LEVELS[-2:])
    gw = solutions.column(FLUID, at("zw", LEVELS[-1]), "gw")
    return decide.all_of(
        decide.less("taut part", low, high),
        decide.at_least("at 6.6", high, PART),
        decide.less("gw at both ends", gw[0], 1, gw[-1]),
    )


def gas_pattern(solutions: Solutions) -> Finding:
    """One front at every pressure from 0.02 on: wrinkled below it, taut above."""
    found = []
    for p in PRESSURES:
        gw = solutions.column(GAS, at("p", p), "gw")
        count = sum(name.startswith("Z_front") for name in solutions.state(GAS, at("p", p)).quantities)
        found += [decide.same(f"p = {p}: fronts", count, 1), decide.less("gw at both ends", gw[0], 1, gw[-1])]
    return decide.all_of(found)


def straight_when_dry(solutions: Solutions) -> Finding:
    """Level 3: spread of dr/dz above the level, and spread of the tension along the whole membrane."""
    dry = solutions.profile(FLUID, at("zw", 3)).columns["z"] > 3
    return decide.all_of(
        decide.constant("dr/dz", solutions.column(FLUID, at("zw", 3), "slope")[dry], 5e-9, 1.0),
        decide.constant("tension", solutions.column(FLUID, at("zw", 3), "tension"), 5e-9),
    )


CASE = Case(
    title="Wrinkling function of the cylinder",
    source="Patil, Nordmark & Eriksson (2016), figure 4",
    panels=(
        Panel(
            "a",
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.05),
            title="liquid",
            curves=tuple(
                Curve(FLUID, rf"$z_w = {v}$", reference=f"gw_fluid_zw_{v}", at=at("zw", v)) for v in LEVELS
            ),
        ),
        Panel(
            "b",
            x=Axis("Z", 0, 8),
            y=Axis("gw", 0.6, 1.8),
            title="gas",
            curves=tuple(
                Curve(GAS, f"$p = {v}$", reference=f"gw_gas_p_{v}", at=at("p", v)) for v in PRESSURES
            ),
        ),
    ),
    checks=(
        Claim(
            "all_wrinkled",
            "up to zw = 5.73 the whole membrane is wrinkled (except for a layer thinner than 0.001 L)",
            (*((FLUID, at("zw", v)) for v in LEVELS), (FLUID, LAST)),
            all_wrinkled,
        ),
        Claim(
            "upper_part_taut",
            "the upper part becomes taut as the level rises",
            tuple((FLUID, at("zw", v)) for v in LEVELS[-2:]),
            upper_part_taut,
        ),
        Claim(
            "gas_pattern",
            "under gas the thick lower part is wrinkled and the thin upper part taut (p >= 0.02)",
            tuple((GAS, at("p", p)) for p in PRESSURES),
            gas_pattern,
        ),
        Claim(
            "straight_when_dry",
            "in a wrinkled zone the tension is constant, and where it is dry the meridian is straight",
            ((FLUID, at("zw", 3)),),
            straight_when_dry,
        ),
        Printed(
            "(Af)_c for M = 1.5, delta = 3",
            "0.4362",
            of=FLUID,
            kind="quantity",
            column="Af_critical",
            source="section 3.1",
        ),
    ),
    asked={"gw": 5e-9},
    quick=True,
)
