"""Paper 4, figure 6: profiles of the gas-filled membrane, M = 0.5, Case 1, Af = (Af)_c.

(a) all pressures; (b) p = 0 and 0.55 on equal scales in the paper. The text's two crests with a trough
between them exist in a range of pressures only. "Radial expansion grows with pre-stretch" is true for r/Af at
every pressure, but for the radius only from p = 0.42 on.
"""

import numpy as np

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
    decide,
    reference,
    wrinkled_tube,
)

PRESSURES = (0, 0.05, 0.1, 0.2, 0.35, 0.45, 0.55)
TUBES = {d: wrinkled_tube(M=0.5, delta=d, load="gas") for d in (2, 3)}
UNIFORM = wrinkled_tube(M=1, delta=2, load="gas")
CRESTS, WINDOW, CROSSING = (reference(4, name) for name in ("crests", "crest_window", "r_max_crossing"))
GRID = tuple(np.linspace(0.0, 8.0, 321))
CLEAR = 5e-3
"""Distance in pressure from the ends of the range, at which crests are counted."""
ASIDE = 1e-3
"""Distance of samples on both sides of an extreme."""
NEAR = decide.Stated(
    0.1, "near the quarter heights", "no number is printed; less than half way to the next quarter"
)


def crests(solutions: Solutions, d: int, p: float) -> list[tuple[float, bool]]:
    """Relative heights of the extremes of the radius, and whether each is a crest."""
    slope, z = (solutions.samples(TUBES[d], sampled(p), name) for name in ("slope", "z"))
    falling, rising = decide.sides(slope, 0)
    known = np.flatnonzero(falling | rising)
    signs = rising[known]
    turns = np.flatnonzero(signs[1:] != signs[:-1])
    return [(float(z.value[known[i]] / (8 * d)), bool(signs[i])) for i in turns]


def sampled(p: float) -> At:
    """The state with its profile for the search of extremes."""
    return At("p", float(p), profile=GRID)


def two_crests(solutions: Solutions) -> Finding:
    """At p = 0.45 (delta = 2) and 0.35 (3): crests near the quarter heights, a trough near the middle."""
    found = []
    for d, p in ((2, 0.45), (3, 0.35)):
        extremes = crests(solutions, d, p)
        found.append(
            decide.same(f"delta = {d}: crests", [crest for _, crest in extremes], [True, False, True])
        )
        off = [abs(h - wanted) for (h, _), wanted in zip(extremes, (0.25, 0.5, 0.75), strict=True)]
        found.append(decide.at_most("heights off the quarters", off, NEAR))
    return decide.all_of(found)


def one_crest(solutions: Solutions) -> Finding:
    """One crest in the thick half at p = 0.3, in the thin half at 0.55; M = 1: at mid-height."""
    low, high = crests(solutions, 2, 0.3), crests(solutions, 2, 0.55)
    return decide.all_of(
        decide.same("crests", [[crest for _, crest in found] for found in (low, high)], [[True], [True]]),
        decide.less("heights at p = 0.55 and 0.3, and the middle", high[0][0], 0.5, low[0][0]),
        decide.zero(
            "M = 1: slope at mid-height",
            solutions.samples(UNIFORM, At("p", 0.3, profile=(4.0,)), "slope"),
            5e-9,
        ),
    )


def window(solutions: Solutions) -> Finding:
    """One crest outside and two inside the reference's range, at the distance CLEAR from its ends."""
    found = []
    for d, event, p in zip(*(WINDOW.columns[n] for n in ("delta", "event", "p")), strict=True):
        counts = [len(crests(solutions, int(d), float(p + shift))) for shift in (-CLEAR, CLEAR)]
        found.append(
            decide.same(f"delta = {d:g}, p = {p:.6f}: extremes", counts, [1, 3] if event == 1 else [3, 1])
        )
    return decide.all_of(found)


def crest_states() -> list[tuple[float, int, At]]:
    """Row by row of the table: pre-stretch, row, and the state sampled there and to each side."""
    columns = (CRESTS.columns[n] for n in ("M", "delta", "p", "Z"))
    return [
        (d, row, At("p", float(p), profile=(z - ASIDE, float(z), z + ASIDE)))
        for row, (M, d, p, z) in enumerate(zip(*columns, strict=True))
        if M == 0.5
    ]


def at_crests(solutions: Solutions) -> Finding:
    """The meridian is vertical at the crests and troughs of the reference."""
    found = []
    for d, row, at in crest_states():
        slope = solutions.samples(TUBES[int(d)], at, "slope")
        bend = (slope[2] - slope[0]) / (2 * ASIDE)
        off = slope[1] / bend + CRESTS.number("Z")[row] - float(CRESTS.columns["Z"][row])
        found.append(decide.zero(f"distance of the extreme, {at}", off, 5e-6))
    return decide.all_of(found)


def grows_with_stretch(solutions: Solutions) -> Finding:
    """r_max/Af at every pressure; r_max itself falls with delta below the crossing and grows above."""
    found, crossing = [], CROSSING.number("p")[0]
    p0 = float(crossing.value)
    disks = [solutions.whole(TUBES[d], "Af_critical") for d in (2, 3)]
    for p in PRESSURES[1:]:
        radii = [solutions.number(TUBES[d], At("p", p), "r_max") for d in (2, 3)]
        found.append(decide.less(f"p = {p}: r_max/Af", radii[0] / disks[0], radii[1] / disks[1]))
        found.append(decide.less("r_max", *(radii if p > p0 else radii[::-1])))
    two, three = (solutions.number(TUBES[d], At("p", p0), "r_max") for d in (2, 3))
    found.append(decide.agree(f"radii at p = {p0:.9f}", two, three + (crossing - p0), 5e-9))
    return decide.all_of(found)


COUNTED = tuple(
    (TUBES[int(d)], sampled(p + shift))
    for d, p in zip(WINDOW.columns["delta"], WINDOW.columns["p"], strict=True)
    for shift in (-CLEAR, CLEAR)
)


def panel(name: str, d: int, pressures: tuple[float, ...], note: str) -> Panel:
    """Profiles at some pressures."""
    return Panel(
        f"{name}, delta = {d}",
        x=Axis("r", 0, 1 if d == 2 else 2),
        y=Axis("z", 0, 8 * d),
        title=rf"$M = 0.5$, $\delta = {d}$",
        dashed=Dashed("gw", 1.0, "taut", "wrinkled"),
        curves=tuple(
            Curve(
                TUBES[d],
                rf"$p = {p}$",
                reference=f"fig05_delta_{d}_p_{p}",
                at=At("p", float(p), profile=()),
            )
            for p in pressures
        ),
        note=note,
    )


CASE = Case(
    title="Profiles under gas",
    source="Patil, Nordmark & Eriksson (2015), figure 6",
    panels=(
        *(panel("a", d, PRESSURES, "") for d in TUBES),
        *(panel("b", d, (0, 0.55), "On equal scales in the paper.") for d in TUBES),
    ),
    checks=(
        Claim(
            "two_crests",
            "two crests near 1/4 and 3/4 of the height and a trough near the middle, at p = 0.45 "
            "(delta = 2) and 0.35 (delta = 3)",
            ((TUBES[2], sampled(0.45)), (TUBES[3], sampled(0.35))),
            two_crests,
        ),
        Claim(
            "one_crest",
            "at other pressures there is one crest: in the thick half at p = 0.3, in the thin half at 0.55; "
            "at "
            "mid-height for uniform thickness",
            (
                (TUBES[2], sampled(0.3)),
                (TUBES[2], sampled(0.55)),
                (UNIFORM, At("p", 0.3, profile=(4.0,))),
            ),
            one_crest,
        ),
        Claim(
            "window",
            "the range of pressures with two crests",
            COUNTED,
            window,
            differs="according to the text there are two crests and a trough under gas; they exist in a "
            "range of pressures only, with one crest below and above it",
        ),
        Claim(
            "at_crests",
            "crests and troughs agree with the reference",
            tuple((TUBES[int(d)], at) for d, _, at in crest_states()),
            at_crests,
        ),
        Claim(
            "grows_with_stretch",
            "r_max/Af grows with the pre-stretch at every pressure, r_max itself from p = 0.42 on",
            tuple(
                (TUBES[d], At("p", float(p)))
                for d in TUBES
                for p in (*PRESSURES[1:], CROSSING.columns["p"][0])
            ),
            grows_with_stretch,
            differs="according to the text the radial expansion grows with the pre-stretch; relative to the "
            "disks it does at every pressure, but the radius only from p = 0.42 on",
        ),
    ),
    asked={"r": 5e-9, "z": 5e-9},
)
