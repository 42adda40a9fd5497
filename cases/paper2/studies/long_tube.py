"""Paper 2, limits: the long tube before and at bulging, the unloaded tube, and the whole tube.

A tube of length l_f = 40 is almost uniform in its middle. The paper's closed form for the infinite tube
assumes lam1 = delta1; the effect of the finite tube's lam1 is stated.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, reference, tube

LONG = tube(alpha=0.1, delta1=1.5, lf=40, u_end=1)
TAUT = tube(alpha=0.1, delta1=1.3)
HALF, FULL = tube(alpha=0.1, delta1=1), tube(alpha=0.1, delta1=1, extent="full")
MIDDLE = [At("u_max", u, profile=()) for u in (0.05, 0.4)]
PLATEAU = (0.3, 0.35, 0.4, 0.45, 0.5)
"""Displacements at which most of the tube is uniform, with the closed form's table."""
LENGTHS = {lf: tube(alpha=0.1, delta1=1, lf=lf, u_end=2) for lf in (6, 20, 40)}
WHOLE_BRANCH = {lf: tube(alpha=0.1, delta1=1, lf=lf) for lf in (10, 20)}


NEAR = (4e-3, 2e-3)
"""Steps of the hoop stretch on both sides of the stationary pressure."""
FOLLOWS = decide.Stated(
    1e-3, "follows to 1e-3", "the claim's own number; lam1 at mid-plane changes with 1/lf"
)
FLAT = decide.Stated(
    1e-8, "small", "t1 times the curvature of the plateau, which decays like exp(-lf) before bulging"
)
CURVED = decide.Stated(1e-5, "small", "the same at u_max = 0.4, where the plateau is shorter")


def uniform(l1: decide.Number | float, l2: decide.Number | float) -> decide.Number | float:
    """Pressure of the uniform tube with the data of the long one, t2/rho with t2 = w_2/lam1."""
    alpha, delta1 = 0.1, 1.5
    return 2 * (1 - 1 / (l1**2 * l2**4)) * (1 + alpha * l1**2) / (l1 * delta1**0.5)


def closed_form(solutions: Solutions) -> Finding:
    """P = 2 (1 - 1/(delta1^2 lam2^4)) (1 + alpha delta1^2)/delta1^(3/2) against the computed pressure."""
    table = reference(2, "long_tube")
    rows = np.isin(table.columns["u_max"], PLATEAU)
    found = solutions.numbers(LONG, [At("u_max", u) for u in PLATEAU], "p")
    return decide.at_most("relative difference", abs(found / table.number("p")[rows] - 1), FOLLOWS)


def middle_equilibrium(solutions: Solutions) -> Finding:
    """With the tube's own lam1, the defect of the uniform balance t2 = p rho is the curvature term only."""
    found = []
    for at, limit in zip(MIDDLE, (FLAT, CURVED), strict=True):
        p, lam1, u = (solutions.number(LONG, at, name) for name in ("p", "lam1_mid", "u_max"))
        found.append(
            decide.at_most(
                f"defect of t2 = p rho, {at}", abs(p / uniform(lam1, (1 + u) / 1.5**0.5) - 1), limit
            )
        )
    return decide.all_of(found)


def unloaded(solutions: Solutions) -> Finding:
    """At p = 0 the taut tube is exactly the pre-stretched cylinder."""
    columns = solutions.profile(TAUT, At("p", 0.0, profile=())).columns
    return decide.all_of(
        decide.exact("rho", columns["rho"], np.ones(len(columns["Z"]))),
        decide.exact("eta", columns["eta"], columns["Z"]),
    )


def halves_agree(solutions: Solutions) -> Finding:
    """The whole tube, without the symmetry condition, has the same limit points."""
    counts = [len(solutions.points(spec, "limit_point")) for spec in (HALF, FULL)]
    return decide.all_of(
        decide.same("limit points", counts, [2, 2]),
        *(
            decide.agree(
                f"p at limit point {i + 1}",
                *(solutions.point(s, "limit_point", "p", i) for s in (FULL, HALF)),
                5e-10,
            )
            for i in range(2)
        ),
    )


def rises(solutions: Solutions) -> Finding:
    """u_max also rises along the whole branch of longer tubes."""
    return decide.all_of(
        decide.rises(f"u_max, lf = {lf}", solutions.along(spec, "u_max")) for lf, spec in WHOLE_BRANCH.items()
    )


R0 = 1.0
"""Reference radius sqrt(delta1) of the unstretched tube."""


def pressure(l1: float, l2: float) -> float:
    """Pressure of the uniform tube, p = w_2/(r0 lam1 lam2), alpha = 0.1."""
    return 2 * (l2 - 1 / (l1**2 * l2**3)) * (1 + 0.1 * l1**2) / (R0 * l1 * l2)


def axial_force(l1: float, l2: float) -> float:
    """Axial resultant of the uniform tube, N = r0 w_1 - p (r0 lam2)^2/2, alpha = 0.1."""
    w1 = 2 * (l1 - 1 / (l1**3 * l2**2)) * (1 + 0.1 * l2**2)
    return R0 * w1 - pressure(l1, l2) * (R0 * l2) ** 2 / 2


def localisation_stretch() -> float:
    """Hoop stretch at which d(p, N)/d(lam1, lam2) = 0 at lam1 = 1: the first root above 1."""

    def slope(f: Callable[[float, float], float], l2: float, d1: float, d2: float) -> float:
        h = 1e-5
        return (f(1 + d1 * h, l2 + d2 * h) - f(1 - d1 * h, l2 - d2 * h)) / (2 * h)

    def determinant(l2: float) -> float:
        return slope(pressure, l2, 1, 0) * slope(axial_force, l2, 0, 1) - slope(pressure, l2, 0, 1) * slope(
            axial_force, l2, 1, 0
        )

    grid = np.linspace(1.02, 4.0, 400)
    values = [determinant(l2) for l2 in grid]
    first = next(i for i in range(len(grid) - 1) if values[i] * values[i + 1] < 0)
    return brentq(determinant, grid[first], grid[first + 1], xtol=1e-12)


def stretch_at(force: float, l2: float) -> float:
    """Meridional stretch of the uniform tube at an axial force and a hoop stretch."""
    return brentq(lambda l1: axial_force(l1, l2) - force, 0.9, 1.1, xtol=1e-15)


def localised(solutions: Solutions) -> Finding:
    """The condition is that p is stationary at fixed N; first limit pressures rise towards this value."""
    lam2 = localisation_stretch()
    critical, level, even, odd = pressure(1.0, lam2), axial_force(1.0, lam2), [], []
    for step in NEAR:
        low, high = (pressure(stretch_at(level, l2), l2) - critical for l2 in (lam2 - step, lam2 + step))
        even.append((high + low) / 2)
        odd.append((high - low) / 2)
    cells = [1 / step for step in NEAR]
    limits = [solutions.point(spec, "limit_point", "p") for spec in LENGTHS.values()]
    return decide.all_of(
        # For a stationary value the difference is of second order in the step, and its odd part of third
        # order.
        decide.order("p at fixed N, even part", cells, even, 2),
        decide.order("odd part", cells, odd, 3),
        decide.less(
            "first limit pressures of lf = 20 and 40, and the condition's", limits[1], limits[2], critical
        ),
    )


CASE = Case(
    title="Limits: long tube, no pressure, whole tube",
    source="Patil, Nordmark & Eriksson (2014), sections 2 and 4",
    panels=(
        Panel(
            "long",
            x=Axis("p", 0, 1.4),
            y=Axis("u_max", 0, 1),
            title=r"$\alpha = 0.1$, $\delta_1 = 1.5$, $l_f = 40$",
            curves=(Curve(LONG, r"$l_f = 40$", reference="long_tube_lf_40"),),
            note="Not a figure of the paper.",
        ),
    ),
    checks=(
        Claim(
            "closed_form",
            "before bulging the long tube follows the uniform tube's pressure to 1e-3 for u_max in 0.3..0.5 "
            "(the O(1/lf) change of lam1 at mid-plane is the difference; it is larger below and above)",
            tuple((LONG, At("u_max", u)) for u in PLATEAU),
            closed_form,
        ),
        Claim(
            "middle_equilibrium",
            "the mid-plane balance t2 = p rho of a plateau holds up to the small curvature term",
            tuple((LONG, at) for at in MIDDLE),
            middle_equilibrium,
        ),
        Claim(
            "unloaded",
            "with p = 0 the solution is u = w = 0 exactly",
            ((TAUT, At("p", 0.0, profile=())),),
            unloaded,
        ),
        Claim(
            "halves_agree",
            "half tube and full tube have the same limit points",
            ((HALF, None), (FULL, None)),
            halves_agree,
        ),
        Claim(
            "u_max_rises",
            "u_max is monotone along the branch for long tubes",
            tuple((spec, at) for spec in WHOLE_BRANCH.values() for at in (None, At("u_max", 1.0))),
            rises,
        ),
        Claim(
            "localised_bulging",
            "the zero-wave-number condition of the infinite tube is stationarity of p at fixed N; the first "
            "limit pressures of tubes with lf = 20 and 40 rise towards it from below",
            tuple((spec, None) for spec in LENGTHS.values()),
            localised,
        ),
    ),
    asked={"p": 5e-10, "lam1_mid": 1e-9, "V": 5e-10},
)
