"""Paper 4: equations that the exact solution satisfies, checked for the computed solution.

The tension is constant in wrinkled zones. The axial force is constant along a gas-filled membrane and in dry
parts. Dry wrinkled parts are cones. Gas-filled wrinkled parts have the first integral of the Mylar balloon.
At a front the second derivatives of r and z jump, in the ratio r' : z'. The printed statement that u is C2
and w is C1 is thus true only if r' is small there.
"""

import numpy as np

from weakforms.cases import (
    At,
    Case,
    Claim,
    Constant,
    Finding,
    Solutions,
    continuity,
    decide,
    reference,
    wrinkled_tube,
)

GAS = {d: wrinkled_tube(M=0.5, delta=d, load="gas") for d in (2, 3)}
FLUID = wrinkled_tube(M=1.5, delta=2)
ALL_WRINKLED = wrinkled_tube(M=0.5, delta=2, Af=0.4)
INFLATED, PRINTED, LOW = (
    At("p", 0.2, profile=()),
    At("zw", 7.44, profile=()),
    At("zw", 4.5, profile=()),
)
DENSE = At("zw", 7.44, profile=tuple(np.linspace(0.0, 8.0, 801)))
FRONTS = {
    "fluid": (FLUID, PRINTED, (1.511572660117, 5.069224906584, 7.595374980714)),
    "gas": (GAS[2], INFLATED, (6.305956442427,)),
}
"""States, and their fronts from the reference, at which jumps are measured."""
TABLE = reference(4, "front_jumps")
STEEP = 1.0
"""Scale of second derivatives, which are of the order of one over the radius."""
GAMMA = 1000 * 9.81 * 0.01**2 / (0.2111e6 * 0.1e-3)
WINDOW, NODES = 0.3, 24
OFFSETS = WINDOW * (1 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)) / 2
VERGE = 1 - 1e-6
"""Rows with gw closer to 1 than this are near a front and belong to no zone."""
ASKED = 1e-3
"""Accuracy asked of second derivatives by polynomials fitted to samples."""
MUCH_SMALLER = decide.Stated(
    0.15, "much smaller", "no number is printed; the ratio is r'/z' of a steep meridian"
)


def jumps_at(kind: str) -> At:
    """The state sampled on both sides of its fronts."""
    _, at, fronts = FRONTS[kind]
    places = sorted(z + side * d for z in fronts for d in OFFSETS for side in (-1, 1))
    return At(at.name, at.value, profile=tuple(places))


def wrinkled(gw: decide.Number) -> np.ndarray:
    """Wrinkled rows away from any front."""
    return decide.sides(gw, VERGE)[0]


def tension_constant(solutions: Solutions) -> Finding:
    """Spread of N over each wrinkled zone."""
    found = []
    for spec, at in ((FLUID, PRINTED), (GAS[2], INFLATED), (ALL_WRINKLED, LOW)):
        tension = solutions.column(spec, at, "tension")
        inside = wrinkled(solutions.column(spec, at, "gw"))
        zones = np.split(np.arange(len(inside)), np.flatnonzero(np.diff(inside)) + 1)
        found.append(decide.every("there are wrinkled rows", [bool(inside.any())]))
        found += [decide.constant("N", tension[zone], 5e-9) for zone in zones if inside[zone[0]]]
    return decide.all_of(found)


def cones(solutions: Solutions) -> Finding:
    """Spread of dr/dz over the dry wrinkled part: Af = 0.4 at zw = 4.5 above the surface."""
    dry = solutions.profile(ALL_WRINKLED, LOW).columns["z"] > LOW.value
    return decide.constant("dr/dz", solutions.column(ALL_WRINKLED, LOW, "slope")[dry], 5e-9, 1.0)


def mylar(solutions: Solutions) -> Finding:
    """Spread of cos(phi) - p r^2/(2 N) over the wrinkled zone under gas."""
    slope, r, tension, gw = (solutions.column(GAS[2], INFLATED, n) for n in ("slope", "r", "tension", "gw"))
    integral = (1 + slope**2) ** -0.5 - INFLATED.value * r**2 / (2 * tension)
    return decide.constant("cos(phi) - p r^2/(2 N)", integral[wrinkled(gw)], 5e-10)


def wet_part(solutions: Solutions) -> Finding:
    """Under fluid the axial force increases by the integral of gamma z' r^2/2 on the wet part only."""
    z, r, lam1, slope, force = (
        solutions.samples(FLUID, DENSE, n) for n in ("z", "r", "lam1", "slope", "axial")
    )
    wet, dry = decide.sides(z, PRINTED.value)
    # Simpson's rule, with z' r^2 from the profile; the rule with twice the step gives its error.
    density = lam1 * (1 + slope**2) ** -0.5 * r**2 * (GAMMA / 2)
    last = int(wet.sum()) - 1 - (int(wet.sum()) - 1) % 4
    h = DENSE.profile[1] - DENSE.profile[0]
    fine, coarse = (simpson(density.value[: last + 1 : step], step * h) for step in (1, 2))
    gained = decide.Number(fine, abs(fine - coarse) + last * h * np.max(density.uncertainty))
    return decide.all_of(
        decide.constant("dry, axial force", force[dry], 5e-9),
        decide.agree("wet, gain of it", force[last] - force[0], gained, 5e-6),
    )


def simpson(values: np.ndarray, h: float) -> float:
    """Integral over an even number of equal steps."""
    return float(h / 3 * (values[0] + 4 * values[1:-1:2].sum() + 2 * values[2:-1:2].sum() + values[-1]))


def jumps(solutions: Solutions) -> Finding:
    """[r''] and [z''] at each front against the table, [r''] z' = [z''] r', and [r''] much smaller."""
    found = []
    for kind, (spec, _, fronts) in FRONTS.items():
        at = jumps_at(kind)
        for front in fronts:
            offset = np.asarray(at.profile) - front
            slope, lam1 = (solutions.samples(spec, at, name) for name in ("slope", "lam1"))
            along = lam1 * (1 + slope**2) ** -0.5
            slopes, bends = {}, {}
            for name, values in (("r", slope * along), ("z", along)):  # r' and z'
                below, above = (continuity.one_sided(offset, values, side, WINDOW)[0] for side in (-1, 1))
                slopes[name], bends[name] = above[0], above[1] - below[1]
            (row,) = np.flatnonzero(np.isclose(TABLE.columns["Z"], front))
            crossed = bends["r"] * slopes["z"], bends["z"] * slopes["r"]
            found += [
                decide.agree(
                    f"Z = {front:.3f}: [r''] z' and [z''] r'", *crossed, ASKED, abs(bends["z"] * slopes["z"])
                ),
                *(
                    decide.agree(f"[{n}'']", bends[n], TABLE.number(f"jump_{n}2")[row], ASKED, STEEP)
                    for n in "rz"
                ),
                decide.positive("|[z'']|", abs(bends["z"])),
                decide.at_most("|[r''] / [z'']|", abs(bends["r"] / bends["z"]), MUCH_SMALLER),
            ]
    return decide.all_of(found)


CASE = Case(
    title="First integrals and jumps at fronts",
    source="Patil, Nordmark & Eriksson (2015), sections 2 and 3",
    checks=(
        *(
            Constant(
                "axial", spec, INFLATED, 5e-9, "under gas the axial force N cos(phi) - p r^2/2 is constant"
            )
            for spec in GAS.values()
        ),
        Constant(
            "tension",
            ALL_WRINKLED,
            LOW,
            5e-9,
            "the tension is constant along a membrane that is wrinkled everywhere",
        ),
        Claim(
            "tension_constant",
            "the tension is constant in every wrinkled zone",
            ((FLUID, PRINTED), (GAS[2], INFLATED), (ALL_WRINKLED, LOW)),
            tension_constant,
        ),
        Claim("cones", "dry wrinkled parts are cones", ((ALL_WRINKLED, LOW),), cones),
        Claim(
            "mylar",
            "cos(phi) - p r^2/(2N) is constant in gas-filled wrinkled parts",
            ((GAS[2], INFLATED),),
            mylar,
        ),
        Claim(
            "wet_part",
            "(N cos(phi) - P r^2/2)' = gamma z' r^2/2 where wet and 0 where dry",
            ((FLUID, DENSE),),
            wet_part,
        ),
        Claim(
            "jumps",
            "at a front r'' and z'' jump in the ratio r' : z', so that the jump of r'' is much smaller",
            tuple((spec, jumps_at(kind)) for kind, (spec, _, _) in FRONTS.items()),
            jumps,
            differs="according to the text u is C2 and w is C1 at a front; the second derivatives of both "
            "jump, in the ratio r' : z', so that the jump of u is small where the meridian is steep, but not "
            "zero",
        ),
    ),
    quick=True,
)
