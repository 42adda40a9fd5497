"""Paper 4, figure 10: wrinkling function in Case 2 (disks of radius Ao), under gas (a) and fluid (b).

M = 0.5, delta = 2, and M = 0.3, delta = 3. The text gives no loads. Without load a zone in the middle is
wrinkled and both ends are taut; the zone disappears at a very small pressure, or at a moderate level.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    wrinkled_tube,
)

DATA = {2: 0.5, 3: 0.3}
PRESSURES, LEVELS = (0, 0.001, 0.002, 0.005, 0.05, 0.2), (0, 2, 4, 6, 8, 12)
GAS = {d: wrinkled_tube(M=M, delta=d, load="gas", Af=1) for d, M in DATA.items()}
FLUID = {d: wrinkled_tube(M=M, delta=d, Af=1) for d, M in DATA.items()}
EMPTY = At("p", 0.0, profile=())


VERY_SMALL = decide.Stated(
    5e-3, "very small", "no number is printed; a hundredth of the largest pressure, 0.55"
)


def wrinkled_middle(solutions: Solutions) -> Finding:
    """Taut, wrinkled, taut without load."""
    found = []
    for d in DATA:
        count = sum(name.startswith("Z_front") for name in solutions.state(GAS[d], EMPTY).quantities)
        found.append(decide.same(f"fronts, delta = {d}", count, 2))
        found.append(
            decide.positive("gw - 1 at the ends", solutions.column(GAS[d], EMPTY, "gw")[[0, -1]] - 1)
        )
    return decide.all_of(found)


def vanishes(solutions: Solutions) -> Finding:
    """The wrinkled zone closes at a pressure of a few 1e-3 and at a level within the height."""
    return decide.all_of(
        decide.at_most(
            "p", decide.stack(solutions.point(GAS[d], "zone_closing", "p") for d in DATA), VERY_SMALL
        ),
        *(decide.between("zw", solutions.point(FLUID[d], "zone_closing", "zw"), 0, 8 * d) for d in DATA),
    )


def curves(spec: dict, d: int, control: str, loads: tuple, table: str) -> tuple[Curve, ...]:
    """One curve for each load."""
    label = "p" if control == "p" else "z_w"
    return tuple(
        Curve(
            spec[d],
            rf"${label} = {v}$",
            reference=f"{table}_delta_{d}_{control}_{v}" if v else f"fig10a_delta_{d}_p_0",
            at=At(control, float(v), profile=()),
        )
        for v in loads
    )


CASE = Case(
    title="Disks attached before stretching",
    source="Patil, Nordmark & Eriksson (2015), figure 10",
    panels=tuple(
        Panel(
            f"{name}, delta = {d}{part}",
            x=Axis("Z", *x),
            y=Axis("gw", *y),
            title=rf"$M = {M}$, $\delta = {d}$, $A_f = A_o$",
            curves=curves(GAS, d, "p", PRESSURES, "fig10a")
            if name == "a"
            else curves(FLUID, d, "zw", LEVELS, "fig10b"),
            note="Without load the state is the same as in panel (a)." if name == "b" else "",
        )
        for name in "ab"
        for d, M in DATA.items()
        for part, x, y in (("", (0, 8), (0.9, 2)), (", inset", (2.5, 6), (0.99, 1.03)))
        if part == "" or name == "b"
    ),
    checks=(
        Claim(
            "wrinkled_middle",
            "without load the middle is wrinkled and both ends are taut",
            tuple((GAS[d], EMPTY) for d in DATA),
            wrinkled_middle,
        ),
        Claim(
            "vanishes",
            "the wrinkled zone disappears at a very small pressure, and under fluid at a moderate level",
            tuple((spec[d], None) for spec in (GAS, FLUID) for d in DATA),
            vanishes,
        ),
        *(
            Points(
                "zone_closing",
                reference="case2_vanishing",
                base=base,
                parameters=("M", "delta"),
                where={"fluid": fluid},
                asked={"load": 1e-5, "Z": 5e-7},
            )
            for fluid, base in ((0.0, wrinkled_tube(load="gas", Af=1)), (1.0, wrinkled_tube(Af=1)))
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9, "lam1": 5e-9, "lam2": 5e-9, "gw": 5e-9, "tension": 5e-9},
)
