"""Paper 4, figure 7: profiles with almost uniform thickness under fluid, delta = 2, zw = 4.5, M = 0.99 and 1.

A uniform membrane is on the verge of wrinkling without load and does not wrinkle under a fluid; in its dry
part gw - 1 decays to 1e-9 and below, so gw > 1 - 1e-7 is what is tested. Under gas it wrinkles after all, at
both disks, shortly before the limit pressure.
"""

from weakforms import At, Axis, Case, Claim, Curve, Dashed, Finding, Panel, Solutions, wrinkled_tube

TUBES = {M: wrinkled_tube(M=M, delta=2) for M in (0.99, 1)}
LEVEL = At("zw", 4.5, profile=())
LOADED = tuple(At("zw", v, profile=()) for v in (1.0, 4.5, 12.0))
OTHERS = (0.1, 0.7, 0.9, 1.1, 1.9)
UNEVEN = {M: wrinkled_tube(M=M, delta=2) for M in OTHERS}
SMALL_DISKS = wrinkled_tube(M=1, delta=2, load="gas", Af=0.6)
INFLATED = At("p", 0.2, profile=())
UNIFORM_GAS = wrinkled_tube(M=1, delta=2, load="gas", load_end=1.1)
FAR_INFLATED = tuple(At("p", v, profile=()) for v in (0.9, 1.02))


def uniform_is_taut(solutions: Solutions) -> Finding:
    """M = 1: least gw at some levels."""
    lowest = min(solutions.profile(TUBES[1], at).columns["gw"].min() for at in LOADED)
    return lowest > 1 - 1e-7, f"least gw = 1 {lowest - 1:+.1e}"


def uniform_wrinkles_at_last(solutions: Solutions) -> Finding:
    """M = 1 under gas: taut at p = 0.9; wrinkled zones open at both ends before the limit point."""
    gw = [solutions.profile(UNIFORM_GAS, at).columns["gw"] for at in FAR_INFLATED]
    opened = solutions.points(UNIFORM_GAS, "zone_opening")
    limit = solutions.points(UNIFORM_GAS, "limit_point")[0].values["p"]
    p = [point.values["p"] for point in opened]
    wrinkled = all(point.values["state"] == -1 for point in opened)
    good = wrinkled and len(p) == 2 and abs(p[0] - p[1]) <= 2 * opened[0].uncertainty["p"] + 1e-12
    good &= 0.9 < p[0] < 1.02 < limit and gw[0].min() > 1 and gw[1][0] < 1 and gw[1][-1] < 1
    return bool(good), f"zones open at p = {p[0]:.8f}; limit point at p = {limit:.8f}"


def almost_uniform_wrinkles(solutions: Solutions) -> Finding:
    """M = 0.99: taut below a front, wrinkled above; the taut part grows with the level."""
    places, good = [], True
    for at in LOADED:
        state = solutions.state(TUBES[0.99], at)
        gw = state.fields[0].columns["gw"]
        good &= gw[0] > 1 > gw[-1] and "Z_front_2" not in state.quantities
        places.append(state.quantities["Z_front_1"].value)
    return bool(good and places == sorted(places)), "fronts at zw = 1, 4.5, 12: " + ", ".join(
        f"{z:.5f}" for z in places
    )


def any_variation_wrinkles(solutions: Solutions) -> Finding:
    """Wrinkled share at zw = 4.5 for M from 0.1 to 1.9."""
    shares = {M: solutions.value(UNEVEN[M], At("zw", 4.5), "wrinkled_fraction") for M in OTHERS}
    return min(shares.values()) > 0, ", ".join(f"{M}: {s:.3f}" for M, s in shares.items())


def small_disks(solutions: Solutions) -> Finding:
    """M = 1 with Af = 0.6: wrinkled, taut, wrinkled at p = 0.2."""
    state = solutions.state(SMALL_DISKS, INFLATED)
    fronts = [q.value for name, q in state.quantities.items() if name.startswith("Z_front")]
    gw = state.fields[0].columns["gw"]
    return len(fronts) == 2 and gw[0] < 1 and gw[-1] < 1, "fronts " + ", ".join(f"{z:.6f}" for z in fronts)


CASE = Case(
    title="Almost uniform thickness",
    source="Patil, Nordmark & Eriksson (2015), figure 7",
    panels=(
        Panel(
            "7",
            x=Axis("r", 0, 1),
            y=Axis("z", 0, 16),
            title=r"$\delta = 2$, $z_w = 4.5$",
            dashed=Dashed("gw", 1 - 1e-7, "taut", "wrinkled"),
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
            "beyond the paper's pressures, under gas, a uniform membrane too wrinkles at both disks",
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
    asked={"r": 1e-6, "z": 1e-6, "lam1": 1e-6, "lam2": 1e-6, "gw": 1e-6, "tension": 1e-6},
)
