"""Paper 3, figure 7: axisymmetric profiles of the long tube before and after the limit point.

The pre-stretch is not printed. It is assumed to be delta = 2: zw = 8.356 lies just below the limit level of
that tube, and the tube with delta = 3 does not reach it.
"""

import numpy as np
from scipy.interpolate import CubicSpline

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    PrintedState,
    Solutions,
    Surface,
    decide,
    fluid_tube,
)

TUBE, OTHER = (fluid_tube(L=24, delta=d, gamma=0.116) for d in (2, 3))
BEFORE, AFTER = At("zw", 7.1019), At("zw", 8.356, crossing=2)
SHOWN = {"a": (BEFORE, "before the limit point, $z_w = 7.1019$"), "b": (AFTER, "after it, $z_w = 8.356$")}
BULGE = tuple(np.linspace(0.5, 2.5, 81).tolist())
"""Material points around the widest place."""
LATER = (At("limit_point", 1.0, profile=BULGE), *(At("V", v, profile=BULGE) for v in (80.0, 100.0, 120.0)))
AXES = (Axis("x", -3, 3), Axis("y", -3, 3), Axis("z", 0, 24))


def delta_2_is_meant(solutions: Solutions) -> Finding:
    """8.356 compared with the limit levels of two pre-stretches."""
    two, three = (solutions.point(tube, "limit_point", "zw") for tube in (TUBE, OTHER))
    return decide.less("limit levels of delta = 3 and 2, around the printed level", three, AFTER.value, two)


def crest(z: np.ndarray, r: np.ndarray) -> decide.Number:
    """Height of the largest radius, by splines through all rows and through every other one."""
    heights = []
    for step in (1, 2):
        rows = slice(int(r.argmax()) % step, None, step)  # with the widest row in both
        turns = CubicSpline(z[rows], r[rows]).derivative().roots(extrapolate=False)
        heights.append(turns[np.argmin(np.abs(turns - z[r.argmax()]))])
    return decide.Number(heights[0], abs(heights[0] - heights[1]))


def goes_down(solutions: Solutions) -> Finding:
    """Past the limit point: level, largest radius and its height, radius at the free surface."""
    found = [
        decide.falls("zw", solutions.numbers(TUBE, LATER, "zw")),
        decide.rises("r_max", solutions.numbers(TUBE, LATER, "r_max")),
        decide.rises("radius at the free surface", solutions.numbers(TUBE, LATER, "r_front")),
    ]
    ends = (LATER[0], LATER[-1])
    heights = [crest(*(solutions.sampled(TUBE, at, n)[0] for n in ("z", "r"))) for at in ends]
    return decide.all_of(*found, decide.falls("height of r_max", heights))


UPPER = tuple(At(at.name, at.value, at.crossing, (9.0,)) for at in (BEFORE, AFTER))
MORE_FOCUSSED = decide.Stated(
    3, "localised", "no number is printed; figure 7 shows a bulge of several times the height"
)


def localised(solutions: Solutions) -> Finding:
    """Largest radius beyond that at mid-length, after the limit point over before it."""
    bulge = [solutions.number(TUBE, at, "r_max") - solutions.number(TUBE, at, "r_mid") for at in UPPER]
    along = [solutions.samples(TUBE, at, "lam1")[0] for at in UPPER]
    return decide.all_of(
        decide.at_least("bulge after over before", bulge[1] / bulge[0], MORE_FOCUSSED),
        decide.falls("lam1 near the upper end", along),
    )


CASE = Case(
    title="Axisymmetric profiles before and after the limit point",
    source="Patil, Nordmark & Eriksson (2015), figure 7",
    panels=(
        Panel(
            "profiles",
            x=Axis("r", 0, 3),
            y=Axis("z", 0, 24),
            title=r"$L/A = 24$, $\delta = 2$",
            note="The meridians of the two surfaces.",
            curves=tuple(
                Curve(TUBE, label, reference=f"fig07{name}", at=at) for name, (at, label) in SHOWN.items()
            ),
        ),
    ),
    surfaces=tuple(Surface(name, TUBE, at, AXES, title=label) for name, (at, label) in SHOWN.items()),
    checks=(
        Claim(
            "delta_2_is_meant",
            "zw = 8.356 is below the limit level of delta = 2 and above the limit level of delta = 3",
            ((TUBE, None), (OTHER, None)),
            delta_2_is_meant,
        ),
        Claim(
            "goes_down",
            "after the limit point the level recedes while the bulge grows and moves down and the free "
            "surface widens",
            tuple((TUBE, at) for at in LATER),
            goes_down,
        ),
        Claim(
            "localised",
            "after the limit point the deformation is localised below, and it is smaller near the upper end",
            tuple((TUBE, at) for at in UPPER),
            localised,
        ),
        PrintedState(
            "zw",
            "7.1019",
            of=TUBE,
            at=BEFORE,
            column="zw",
            shown=("V", "r_max"),
            n_negative=0,
            source="figure 7(a), before the limit point",
        ),
        PrintedState(
            "zw after the limit",
            "8.356",
            of=TUBE,
            at=AFTER,
            column="zw",
            shown=("V", "r_max"),
            n_negative=1,
            source="figure 7(b), after the limit point",
        ),
    ),
    asked={"r": 2e-9, "z": 5e-10, "lam1": 1e-7, "lam2": 2e-9, "T1": 5e-8, "T2": 1e-7},
)
