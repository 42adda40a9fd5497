"""Paper 2, limits: the long tube before and at bulging, the unloaded tube, and the two halves of a whole one.

A tube of length l_f = 40 is almost uniform in its middle. The paper's closed form for the infinite tube
holds where lam1 = delta1; what the finite tube's own lam1 changes is stated, not hidden.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, tube

LONG = tube(alpha=0.1, delta1=1.5, lf=40, u_end=1)
TAUT = tube(alpha=0.1, delta1=1.3)
HALF, FULL = tube(alpha=0.1, delta1=1), tube(alpha=0.1, delta1=1, extent="full")
MIDDLE = [At("u_max", u, profile=()) for u in (0.05, 0.4)]
LENGTHS = {lf: tube(alpha=0.1, delta1=1, lf=lf, u_end=2) for lf in (6, 20, 40)}
WHOLE_BRANCH = {lf: tube(alpha=0.1, delta1=1, lf=lf) for lf in (10, 20)}


def closed_form(solutions: Solutions) -> Finding:
    """P = 2 (1 - 1/(delta1^2 lam2^4)) (1 + alpha delta1^2)/delta1^(3/2) against the computed pressure."""
    alpha, delta1, rows = 0.1, 1.5, []
    for u in (0.3, 0.4, 0.5):
        lam2 = (1 + u) / np.sqrt(delta1)
        exact = 2 * (1 - 1 / (delta1**2 * lam2**4)) * (1 + alpha * delta1**2) / delta1**1.5
        rows.append(abs(solutions.value(LONG, At("u_max", u), "p") / exact - 1))
    return max(rows) < 1e-3, "relative difference at u_max = 0.3, 0.4, 0.5: " + ", ".join(
        f"{r:.1e}" for r in rows
    )


def middle_equilibrium(solutions: Solutions) -> Finding:
    """With the tube's own lam1 the uniform balance t2 = p rho is left with the curvature term only."""
    rows = []
    for at in MIDDLE:
        columns = solutions.profile(LONG, at).columns
        p = solutions.value(LONG, at, "p")
        rows.append(abs(columns["t2"][0] / (p * columns["rho"][0]) - 1))
    return rows[0] < 1e-8 and rows[1] < 1e-5, "relative defect of t2 = p rho at u_max = 0.05, 0.4: " + (
        ", ".join(f"{r:.1e}" for r in rows)
    )


def unloaded(solutions: Solutions) -> Finding:
    """At p = 0 the taut tube is the pre-stretched cylinder, exactly."""
    columns = solutions.profile(TAUT, At("p", 0.0, profile=())).columns
    error = max(np.abs(columns["rho"] - 1).max(), np.abs(columns["eta"] - columns["Z"]).max())
    return error < 1e-13, f"largest displacement {error:.1e}"


def halves_agree(solutions: Solutions) -> Finding:
    """The whole tube, without the symmetry condition, has the same limit points."""
    half, full = solutions.points(HALF, "limit_point"), solutions.points(FULL, "limit_point")
    worst, bound = 0.0, 0.0
    for a, b in zip(half, full, strict=True):
        worst = max(worst, abs(a.values["p"] - b.values["p"]))
        bound = max(bound, 2 * np.hypot(a.uncertainty["p"], b.uncertainty["p"]))
    return bool(half) and worst <= bound, f"{len(full)} limit points, p differs by {worst:.1e} <= {bound:.1e}"


def rises(solutions: Solutions) -> Finding:
    """u_max rises all along the branch of longer tubes too."""
    rows = []
    for lf, spec in WHOLE_BRANCH.items():
        steps = np.diff(solutions.branch(spec).columns["u_max"])
        rows.append((lf, steps.min()))
    return all(step > 0 for _, step in rows), "smallest step of u_max: " + ", ".join(
        f"{step:.1e} (lf = {lf})" for lf, step in rows
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


def localised(solutions: Solutions) -> Finding:
    """The condition is that p is stationary at fixed N; first limit points rise towards its pressure."""
    lam2 = localisation_stretch()
    critical, level, found = pressure(1.0, lam2), axial_force(1.0, lam2), []
    for l2 in (lam2 - 1e-3, lam2 + 1e-3):
        l1 = brentq(lambda x, l2=l2: axial_force(x, l2) - level, 0.9, 1.1, xtol=1e-15)
        found.append(pressure(l1, l2) - critical)
    stationary = max(abs(d) for d in found) < 1e-5 and abs(found[1] - found[0]) < 1e-7
    limits = [solutions.points(spec, "limit_point")[0].values["p"] for spec in LENGTHS.values()]
    rising = limits[1] < limits[2] < critical
    return stationary and rising, (
        f"p = {critical:.6f}; p changes by {found[0]:.1e}, {found[1]:.1e} to either side at fixed N; "
        "first limit points at lf = "
        + ", ".join(f"{lf}: {v:.6f}" for lf, v in zip(LENGTHS, limits, strict=True))
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
            tuple((LONG, At("u_max", u)) for u in (0.3, 0.4, 0.5)),
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
            tuple((spec, None) for spec in WHOLE_BRANCH.values()),
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
    asked={"p": 1e-7, "lam1_mid": 1e-6, "V": 1e-6},
)
