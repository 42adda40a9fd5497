"""Paper 4, figure 7: profiles with almost uniform thickness under fluid, delta = 2, zw = 4.5, M = 0.99 and 1.

Without load a uniform membrane has gw = 1, at the limit of wrinkling. Under a fluid it does not wrinkle; in
its dry part gw - 1 decays to 1e-9 and below, so that gw > 1 - 1e-7 is tested. Under gas it wrinkles at both
disks, shortly before the limit pressure.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Dashed,
    Finding,
    Panel,
    Solutions,
    Spec,
    decide,
    wrinkled_tube,
)

TUBES = {M: wrinkled_tube(M=M, delta=2) for M in (0.99, 1)}
LEVEL = At("zw", 4.5, profile=())
LOADED = tuple(At("zw", v, profile=()) for v in (1.0, 4.5, 12.0))
VERGE = decide.Stated(
    1 - 1e-7, "does not wrinkle", "in the dry part gw tends to 1 from above, to less than its uncertainty"
)
OTHERS = (0.1, 0.7, 0.9, 1.1, 1.9)
UNEVEN = {M: wrinkled_tube(M=M, delta=2) for M in OTHERS}
SMALL_DISKS = wrinkled_tube(M=1, delta=2, load="gas", Af=0.6)
INFLATED = At("p", 0.2, profile=())
UNIFORM_GAS = wrinkled_tube(M=1, delta=2, load="gas", load_end=1.1)
FAR_INFLATED = tuple(At("p", v, profile=()) for v in (0.9, 1.02))


def uniform_is_taut(solutions: Solutions) -> Finding:
    """M = 1: smallest gw at some levels, where gw - 1 decays to 1e-9 and below in the dry part."""
    return decide.all_of(
        decide.at_least(f"gw at {at}", solutions.column(TUBES[1], at, "gw"), VERGE) for at in LOADED
    )


def uniform_wrinkles_at_last(solutions: Solutions) -> Finding:
    """M = 1 under gas: taut at p = 0.9; wrinkled zones open at both ends before the limit point."""
    before, after = (solutions.column(UNIFORM_GAS, at, "gw") for at in FAR_INFLATED)
    opened = solutions.points(UNIFORM_GAS, "zone_opening")
    first, second = (decide.of_point(point, "p") for point in opened)
    return decide.all_of(
        decide.same(
            "zones that open, and their states", [point.values["state"] for point in opened], [-1, -1]
        ),
        decide.agree("p at both disks", first, second, 5e-9),
        decide.less("p", 0.9, first, 1.02, solutions.point(UNIFORM_GAS, "limit_point", "p")),
        decide.positive("gw - 1 at p = 0.9", before - 1),
        decide.negative("gw - 1 at the disks, p = 1.02", after[[0, -1]] - 1),
    )


def almost_uniform_wrinkles(solutions: Solutions) -> Finding:
    """M = 0.99: taut below a front, wrinkled above; the taut part grows with the level."""
    found = []
    for at in LOADED:
        gw = solutions.column(TUBES[0.99], at, "gw")
        found.append(decide.less(f"gw at both ends, {at}", gw[-1], 1, gw[0]))
        found.append(decide.same("fronts", count_fronts(solutions, TUBES[0.99], at), 1))
    found.append(decide.rises("front", solutions.numbers(TUBES[0.99], LOADED, "Z_front_1")))
    return decide.all_of(found)


def count_fronts(solutions: Solutions, spec: Spec, at: At) -> int:
    """Number of fronts of a state."""
    return sum(name.startswith("Z_front") for name in solutions.state(spec, at).quantities)


def any_variation_wrinkles(solutions: Solutions) -> Finding:
    """Wrinkled fraction at zw = 4.5 for M from 0.1 to 1.9."""
    shares = decide.stack(solutions.number(UNEVEN[M], At("zw", 4.5), "wrinkled_fraction") for M in OTHERS)
    return decide.positive("wrinkled share", shares)


def small_disks(solutions: Solutions) -> Finding:
    """M = 1 with Af = 0.6: wrinkled, taut, wrinkled at p = 0.2."""
    gw = solutions.column(SMALL_DISKS, INFLATED, "gw")
    return decide.all_of(
        decide.same("fronts", count_fronts(solutions, SMALL_DISKS, INFLATED), 2),
        decide.negative("gw - 1 at the disks", gw[[0, -1]] - 1),
    )


CASE = Case(
    title="Almost uniform thickness",
    source="Patil, Nordmark & Eriksson (2015), figure 7",
    panels=(
        Panel(
            "7",
            x=Axis("r", 0, 1),
            y=Axis("z", 0, 16),
            title=r"$\delta = 2$, $z_w = 4.5$",
            dashed=Dashed("gw", VERGE.value, "taut", "wrinkled"),
            curves=tuple(
                Curve(TUBES[M], rf"$M = {M}$", reference=f"fig07_M_{M}_zw_4.5", at=LEVEL) for M in TUBES
            ),
        ),
    ),
    checks=(
        Claim(
            "uniform_is_taut",
            "a membrane of uniform thickness does not wrinkle under a fluid",
            tuple((TUBES[1], at) for at in LOADED),
            uniform_is_taut,
        ),
        Claim(
            "uniform_wrinkles_at_last",
            "under gas, at pressures above the paper's, a uniform membrane wrinkles at both disks too",
            tuple((UNIFORM_GAS, at) for at in FAR_INFLATED),
            uniform_wrinkles_at_last,
        ),
        Claim(
            "almost_uniform_wrinkles",
            "M = 0.99: the lower part is taut and the upper one wrinkled; the taut part grows with the level",
            tuple((TUBES[0.99], at) for at in LOADED),
            almost_uniform_wrinkles,
        ),
        Claim(
            "any_variation_wrinkles",
            "wrinkling persists for every M other than 1",
            tuple((spec, At("zw", 4.5)) for spec in UNEVEN.values()),
            any_variation_wrinkles,
        ),
        Claim(
            "small_disks",
            "a uniform membrane on disks smaller than (Af)_c wrinkles near both of them",
            ((SMALL_DISKS, INFLATED),),
            small_disks,
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9, "lam1": 5e-9, "lam2": 5e-9, "gw": 5e-9, "tension": 5e-9},
)
