"""Paper 3, figure 4: the response for fluids of half, one and two times the density of water, delta = 2.

The aspect ratio is not printed; both of figure 2 are shown.
"""

from weakforms.cases import Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, fluid_tube

LENGTHS, GAMMAS = (8, 24), (0.058, 0.116, 0.232)
DENSITY = {g: {} if g == 0.116 else {"gamma": g} for g in GAMMAS}
"""Without the default value, so that figures share solutions."""
TUBES = {(length, g): fluid_tube(L=length, delta=2, gamma=g) for length in LENGTHS for g in GAMMAS}
BENT = {key: fluid_tube(L=key[0], delta=2, secondary=True, **DENSITY[key[1]]) for key in TUBES}
for gamma in (0.058, 0.232):
    BENT[24, gamma] = BENT[24, gamma].on(secondary_around=8)
"""With half as many cells around as by default, which are enough for what is asked: no other figure has these
two tubes."""
BENT_ASKED = {length: dict.fromkeys(("V", "r_mid", "r_mid_pi"), a) for length, a in ((8, 5e-7), (24, 1e-5))}


def critical(solutions: Solutions, length: int, kind: str) -> list[decide.Number]:
    """Levels at the first critical points of a kind, by density."""
    found = []
    for gamma in GAMMAS:
        points = solutions.points(TUBES[length, gamma], kind)
        found.append(next(decide.of_point(p, "zw") for p in points if p.values.get("n", 1) == 1))
    return found


def lighter_is_higher(solutions: Solutions) -> Finding:
    """Both critical levels fall with the density."""
    return decide.all_of(
        decide.falls(f"L = {length}, {kind}", critical(solutions, length, kind))
        for length in LENGTHS
        for kind in ("limit_point", "bifurcation_point")
    )


def density_fills(solutions: Solutions) -> Finding:
    """Whether the short tube is over-filled at its limit point, by density."""
    levels = critical(solutions, 8, "limit_point")
    return decide.less(
        "limit levels for twice and once the density of water, and the length", levels[2], 8, levels[1]
    )


EVERY = tuple((tube, None) for tube in TUBES.values())

CASE = Case(
    title="Response for other fluid densities",
    source="Patil, Nordmark & Eriksson (2015), figure 4",
    panels=tuple(
        Panel(
            f"L_{length}",
            x=Axis("zw", 0, 15),
            y=Axis("r_mid", low, high),
            title=rf"$L/A = {length}$, $\delta = 2$",
            markers=("limit_point", "bifurcation_point"),
            note="The aspect ratio and the axes of this figure are not printed.",
            curves=tuple(
                Curve(
                    TUBES[length, g],
                    rf"$\rho g A^2/\mu H = {g}$",
                    reference=f"primary_L_{length}_delta_2" + ("" if g == 0.116 else f"_gamma_{g}"),
                )
                for g in GAMMAS
            )
            + tuple(
                Curve(
                    BENT[length, g],
                    rf"$\rho g A^2/\mu H = {g}$, secondary",
                    reference=f"secondary_L_{length}_delta_2" + ("" if g == 0.116 else f"_gamma_{g}"),
                    branch="secondary",
                    asked=BENT_ASKED[length],
                )
                for g in GAMMAS
            ),
        )
        for length, low, high in ((8, 0.5, 5), (24, 0.6, 0.9))
    ),
    checks=(
        Claim(
            "lighter_is_higher",
            "halving the density raises the levels of limit point and bifurcation, doubling lowers them",
            EVERY,
            lighter_is_higher,
        ),
        Claim(
            "density_fills",
            "whether the tube is over-filled at the limit point depends on the density too: with twice that "
            "of "
            "water the tube of L/A = 8 is partially filled there",
            EVERY,
            density_fills,
        ),
    ),
    asked={"zw": 5e-10, "r_mid": 5e-9},
)
