"""A square and a disk of any triangles under liquids, and disks of uneven thickness, against other methods.

The square is that of rectangle, whose tables come from spectral methods. The disks have tables by shooting
and by collocation. A shallow disk under a liquid is a drum with a negative restoring force, whose closed
forms are Bessel functions.
"""

import numpy as np
from scipy.special import j0, j1, jn_zeros

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    decide,
    membrane,
)

ALPHA, DELTA = 0.1, 1.1
LIGHT = membrane(mesh="square", load="liquid", gamma=1, alpha=ALPHA, delta=DELTA, w_end=1.5).on(cells=12)
HEAVY = membrane(mesh="square", load="liquid", gamma=5, alpha=ALPHA, delta=DELTA, w_end=1.0).on(cells=12)
DISK = membrane(load="liquid", gamma=1, alpha=ALPHA, delta=DELTA, w_end=1.25)
FOLDED = membrane(load="liquid", gamma=3, alpha=0, delta=DELTA, w_end=1.6).on(cells=32)
THICKER = "1 + 0.4*(X**2 + Y**2)"
UNEVEN = membrane(load="liquid", gamma=1, alpha=ALPHA, delta=DELTA, thickness=THICKER, w_end=1.25)
UNEVEN_GAS = membrane(alpha=ALPHA, delta=DELTA, thickness=THICKER, w_end=1.25)

ROUNDING = 1e-9
"""Round-off of the place of a limit level, which is a point of the branch and counted like the one before."""

ASKED = 1e-4
"""Asked of taut states that are wet all over, as of the same bodies under gas."""

PLACE = 5e-4
"""Asked of all but the volume itself where it is largest: an extremum is flat, its place has fewer digits."""

STRESS = 2 * (1 - DELTA**-6) * (1 + ALPHA * DELTA**2)
ZERO = float(jn_zeros(0, 1)[0])
NEARLY = 0.95
"""Share of the weight at which the flat disk ponds."""

THRESHOLD = STRESS * ZERO**2 / DELTA**2
HEIGHTS = 2e-3, 1e-3
"""Heights at which the linear membrane is compared."""

NEAR = membrane(load="liquid", gamma=round(NEARLY * THRESHOLD, 9), alpha=ALPHA, delta=DELTA, w_end=0.31).on(
    start=5e-4
)
POND = membrane(load="liquid", gamma=8, alpha=ALPHA, delta=DELTA, w_end=0.31).on(start=5e-4, cells=32)


def vanishing(once: decide.Number, half: decide.Number) -> decide.Number:
    """A ratio at vanishing height, from two heights: the quadratic term is removed, and is the bound."""
    limit = half + (half - once) / 3
    return decide.Number(limit.value, limit.uncertainty + abs((limit - half).value) / 2)


def shallow(solutions: Solutions) -> Finding:
    """Height over level of a vanishing pond, near the threshold."""
    both = (h / solutions.number(NEAR, At("w_c", h), "zw") for h in HEIGHTS)
    return decide.agree("w_c/zw", vanishing(*both), 1 / j0(np.sqrt(NEARLY) * ZERO) - 1, 1e-3)


def ponded(solutions: Solutions) -> Finding:
    """Level over height of a vanishing pond, heavier than the threshold, which wets the middle only."""
    k = np.sqrt(8 * DELTA**2 / STRESS)
    q = ZERO * j1(ZERO) * np.log(k / ZERO)
    both = (-1 * solutions.number(POND, At("w_c", h), "zw") / h for h in HEIGHTS)
    return decide.agree("-zw/w_c", vanishing(*both), q / (1 + q), 5e-3)


def limit(kind: str, table: str, spec: Spec, asked: dict[str, float]) -> Points:
    """One special point."""
    return Points(kind, table, spec, (), asked)


def held(solutions: Solutions) -> Finding:
    """Past the limit level a state is stable for a given liquid only, past the largest volume not at all."""
    branch = solutions.branch(FOLDED).columns
    level, fold = (solutions.point(FOLDED, kind, "w_c").value for kind in ("limit_point", "volume_fold"))
    past = branch["w_c"] > level + ROUNDING
    return decide.all_of(
        [
            decide.every("negative, level held", branch["n_negative"] == past),
            decide.every("negative, liquid held", branch["n_held"] == (branch["w_c"] > fold)),
        ]
    )


LEVELS = dict.fromkeys(("zw", "w_c", "V_f", "U"), ASKED)
CASE = Case(
    title="Membranes of any shape under liquids, and of uneven thickness",
    source="Patil (2016), section 6.4 (future work)",
    panels=(
        Panel(
            "liquid",
            x=Axis("w_c", 0, 1.6, "$w_c$"),
            y=Axis("zw", -0.2, 5, "$z_w$"),
            markers="limit_point",
            note="Not a figure of the thesis.",
            curves=(
                Curve(LIGHT, r"square, $\gamma = 1$", reference="rectangle_liquid"),
                Curve(HEAVY, r"square, $\gamma = 5$", reference="rectangle_heavy"),
                Curve(DISK, r"disk, $\gamma = 1$", reference="disk_liquid"),
                Curve(UNEVEN, "disk, thicker at the rim", reference="disk_uneven_liquid"),
            ),
        ),
        Panel(
            "gas",
            x=Axis("w_c", 0, 1.3, "$w_c$"),
            y=Axis("p", 0, 6, "$p$"),
            note="Not a figure of the thesis.",
            curves=(Curve(UNEVEN_GAS, "disk, thicker at the rim", reference="disk_uneven_gas"),),
        ),
    ),
    checks=(
        Count("limit_point", {HEAVY: 2, FOLDED: 1, DISK: 0}, "number of limit levels up to w_end"),
        Count("volume_fold", {FOLDED: 1, DISK: 0}, "number of folds of the volume"),
        limit("limit_point", "rectangle_heavy_upper", HEAVY, LEVELS),
        limit("limit_point", "disk_liquid_limit", FOLDED, LEVELS),
        limit(
            "volume_fold",
            "disk_liquid_fold",
            FOLDED,
            {"V_f": ASKED} | dict.fromkeys(("zw", "w_c", "U"), PLACE),
        ),
        Claim(
            "held",
            "between limit level and largest volume a state is stable for a given liquid only",
            ((FOLDED, None),),
            held,
        ),
        Claim(
            "shallow",
            "a shallow disk follows the linear membrane close to the threshold of ponding",
            tuple((NEAR, At("w_c", h)) for h in HEIGHTS),
            shallow,
        ),
        Claim(
            "ponded",
            "above the threshold the level leaves zero downwards, in a finite ratio to the height",
            tuple((POND, At("w_c", h)) for h in HEIGHTS),
            ponded,
        ),
    ),
    asked=dict.fromkeys(("p", "zw", "V", "V_f", "U"), ASKED),
    slow=True,
)
