"""Paper 4, figure 6: profiles of the gas-filled membrane, M = 0.5, Case 1, Af = (Af)_c.

(a) all pressures; (b) p = 0 and 0.55 on equal scales in the paper. The text's two crests with a trough
between them are there in a window of pressures only, and "radial expansion grows with pre-stretch" holds
for r/Af at every pressure, for the radius itself from p = 0.42 on.
"""

import numpy as np

from weakforms import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Dashed,
    Finding,
    Panel,
    Solutions,
    reference,
    wrinkled_tube,
)

PRESSURES = (0, 0.05, 0.1, 0.2, 0.35, 0.45, 0.55)
TUBES = {d: wrinkled_tube(M=0.5, delta=d, load="gas") for d in (2, 3)}
UNIFORM = wrinkled_tube(M=1, delta=2, load="gas")
CRESTS, WINDOW, CROSSING = (reference(4, name) for name in ("crests", "crest_window", "r_max_crossing"))
GRID = tuple(np.linspace(0.0, 8.0, 321))
CLEAR = 5e-3
"""Distance in pressure from the ends of a window at which crests are counted."""
QUARTER = 0.1
"""How near the quarter heights the text's "near" is taken to be."""


def crests(solutions: Solutions, d: int, p: float) -> list[tuple[float, bool]]:
    """Relative heights of the extremes of the radius, and whether each is a crest."""
    slope, z = (solutions.sampled(TUBES[d], sampled(p), name)[0] for name in ("slope", "z"))
    turns = np.flatnonzero(slope[:-1] * slope[1:] < 0)
    return [(float(z[i] / (8 * d)), bool(slope[i] > 0)) for i in turns]


def sampled(p: float) -> At:
    """The state with its profile where extremes are looked for."""
    return At("p", float(p), profile=GRID)


def two_crests(solutions: Solutions) -> Finding:
    """At p = 0.45 (delta = 2) and 0.35 (3): crests near the quarter heights, a trough near the middle."""
    good, rows = True, []
    for d, p in ((2, 0.45), (3, 0.35)):
        found = crests(solutions, d, p)
        near = [abs(h - wanted) <= QUARTER for (h, _), wanted in zip(found, (0.25, 0.5, 0.75), strict=False)]
        good &= len(found) == 3 and all(near) and [c for _, c in found] == [True, False, True]
        rows.append(f"delta = {d}, p = {p}: heights " + ", ".join(f"{h:.3f}" for h, _ in found))
    return good, "; ".join(rows)


def one_crest(solutions: Solutions) -> Finding:
    """One crest in the thick half at p = 0.3, in the thin half at 0.55; M = 1: at mid-height."""
    low, high = crests(solutions, 2, 0.3), crests(solutions, 2, 0.55)
    slope, u = solutions.sampled(UNIFORM, At("p", 0.3, profile=(4.0,)), "slope")
    good = len(low) == len(high) == 1 and low[0][0] > 0.5 > high[0][0] and abs(slope[0]) <= 2 * u
    return bool(
        good
    ), f"heights {low[0][0]:.3f} and {high[0][0]:.3f}; M = 1: slope {slope[0]:.0e} at mid-height"


def window(solutions: Solutions) -> Finding:
    """One crest outside and two inside the reference's window, CLEAR of its ends."""
    good, rows = True, []
    for d, event, p in zip(*(WINDOW.columns[n] for n in ("delta", "event", "p")), strict=True):
        opens = event == 1
        counts = [len(crests(solutions, int(d), float(p + shift))) for shift in (-CLEAR, CLEAR)]
        good &= counts == ([1, 3] if opens else [3, 1])
        rows.append(f"delta = {d:g}, p = {p:.6f}: {counts[0]} -> {counts[1]} extremes")
    return good, "; ".join(rows)


def crest_states() -> list[tuple[float, float, At]]:
    """Row by row of the table: pre-stretch, position, and the state sampled there and to each side."""
    columns = (CRESTS.columns[n] for n in ("M", "delta", "p", "Z"))
    return [
        (d, z, At("p", float(p), profile=(z - 1e-3, float(z), z + 1e-3)))
        for M, d, p, z in zip(*columns, strict=True)
        if M == 0.5
    ]


def at_crests(solutions: Solutions) -> Finding:
    """The meridian is upright where the reference has its crests and troughs."""
    worst, least = 0.0, np.inf
    for d, _, at in crest_states():
        slope, u = solutions.sampled(TUBES[int(d)], at, "slope")
        bend = abs(slope[2] - slope[0]) / 2e-3
        bound = 2 * np.hypot(u, bend * CRESTS.uncertainty["Z"])
        worst, least = max(worst, abs(slope[1]) / bound), min(least, bend)
    return bool(worst <= 1), f"largest slope over its bound {worst:.2g}; least bend {least:.1e}"


def grows_with_stretch(solutions: Solutions) -> Finding:
    """r_max/Af at every pressure; r_max itself falls with delta below the crossing and grows above."""
    good = True
    p0 = float(CROSSING.columns["p"][0])
    for p in PRESSURES[1:]:
        radii = [solutions.value(TUBES[d], At("p", p), "r_max") for d in (2, 3)]
        disks = [solutions.result(TUBES[d]).quantities["Af_critical"].value for d in (2, 3)]
        good &= radii[1] / disks[1] > radii[0] / disks[0] and (radii[1] > radii[0]) == (p > p0)
    two, three = (solutions.quantity(TUBES[d], At("p", p0), "r_max") for d in (2, 3))
    bound = 2 * np.hypot(two.uncertainty, three.uncertainty) + 2 * CROSSING.uncertainty["p"]
    gap = abs(two.value - three.value)
    return bool(good and gap <= bound), f"equal radii at p = {p0:.9f}: {two.value:.9f}, gap {gap:.0e}"


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
                reference=f"fig05_delta_{d}_p_{p}" if p else None,
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
            "elsewhere there is one crest: in the thick half at p = 0.3, in the thin half at 0.55; at "
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
            "the window of pressures with two crests",
            COUNTED,
            window,
            differs="the text has two crests and a trough under gas; they are there in a window of pressures "
            "only, with one crest below and above it",
        ),
        Claim(
            "at_crests",
            "crests and troughs are where the reference has them",
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
            differs="the text has the radial expansion grow with the pre-stretch; relative to the disks it "
            "does at every pressure, the radius itself only from p = 0.42 on",
        ),
    ),
    asked={"r": 1e-6, "z": 1e-6},
)
