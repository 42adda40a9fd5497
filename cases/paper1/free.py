"""Paper 1: free inflation before any contact, its limit points and its limits of small pressure.

A neo-Hookean disk has a limit point of the pressure; with pre-stretch it tends to that of a film of constant
tension, p = 4 at t0 = 1. A Mooney-Rivlin disk (alpha = 0.1, beta = 1) has none.
"""

import numpy as np

from weakforms import At, Axis, Case, Claim, Count, Curve, Finding, Panel, Points, Solutions, circular

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
ENDS = {(0, 1): 3.1, (0, 2): 3.1, (0.1, 1): 4.1, (0.1, 2): 4.1}
# Twice the usual cells: at t0 = 4 the stretches reach 20 and fall steeply at the clamp.
FREE = {s: circular(alpha=s[0], beta=s[1], t_end=ENDS[s]).on(cells=192) for s in SETS}
FILM = {beta: circular(alpha=0, beta=beta, t_end=2.0) for beta in (1.2, 1.5, 2, 3, 5, 10)}
SMALL = (0.06, 0.12)


def isotropic_rest(solutions: Solutions) -> Finding:
    """lam1 - lam2 of the pre-stretched disk without pressure."""
    columns = solutions.profile(FREE[0.1, 2], At("p", 0.0, profile=())).columns
    worst = float(np.abs(columns["lam1"] - columns["lam2"]).max())
    return worst < 1e-11, f"largest difference {worst:.1e}"


def film(solutions: Solutions) -> Finding:
    """Limit pressure and pole height against the pre-stretch."""
    points = [solutions.points(spec, "limit_point")[0].values for spec in FILM.values()]
    p, t0 = np.array([[v["p"], v["t0"]] for v in points]).T
    # Both distances to the film's values fall monotonically.
    good = (
        np.all(np.diff(np.abs(p - 4)) < 0) and np.all(np.diff(np.abs(t0 - 1)) < 0) and abs(p[-1] - 4) < 1e-3
    )
    return bool(good), f"beta = 10: p = {p[-1]:.6f}, t0 = {t0[-1]:.6f}"


def stretched_start(solutions: Solutions) -> Finding:
    """dp/dt0 at rest against 8 (1 - beta^-6)(1 + alpha beta^2), by two small heights."""
    rows, good = [], True
    for s in ((0, 2), (0.1, 2)):
        exact = 8 * (1 - s[1] ** -6) * (1 + s[0] * s[1] ** 2)
        found = [solutions.value(FREE[s], At("t0", t), "p") / t for t in SMALL]
        limit = found[0] + (found[0] - found[1]) / 3  # the next term is of second order in t0
        good &= abs(limit / exact - 1) < 2e-4
        rows.append(f"{limit:.5f} (exact {exact:.5f})")
    return good, "; ".join(rows)


def cubic_start(solutions: Solutions) -> Finding:
    """p/((1 + alpha) t0^3) of the unstretched disk for both laws."""
    found = {
        a: [solutions.value(FREE[a, 1], At("t0", t), "p") / ((1 + a) * t**3) for t in SMALL] for a in (0, 0.1)
    }
    limits = {a: v[0] + (v[0] - v[1]) / 3 for a, v in found.items()}
    good = abs(limits[0] / limits[0.1] - 1) < 1e-4
    return good, ", ".join(f"alpha = {a}: C = {c:.5f}" for a, c in limits.items())


CASE = Case(
    title="Free inflation and its limit points",
    source="Patil, DasGupta & Eriksson (2015), sections 2 and 5",
    panels=(
        Panel(
            "p",
            x=Axis("p", 0, 12),
            y=Axis("t0", 0, 4),
            markers="limit_point",
            curves=tuple(
                Curve(
                    FREE[s],
                    rf"$\alpha = {s[0]}$, $\beta = {s[1]}$",
                    reference=f"free_alpha_{s[0]}_beta_{s[1]}",
                )
                for s in SETS
            ),
        ),
    ),
    checks=(
        Count(
            "limit_point",
            {FREE[0, 1]: 1, FREE[0, 2]: 1, FREE[0.1, 1]: 0},
            "neo-Hookean disks have a limit point, the Mooney-Rivlin one has none up to t0 = 4",
        ),
        Points(
            "limit_point",
            reference="free_limit_points",
            base=circular(t_end=3.1),
            parameters=("alpha", "beta"),
            asked={"p": 1e-8, "t0": 1e-8, "lam_pole": 1e-8},
        ),
        Claim(
            "isotropic_rest",
            "without pressure both stretches are equal",
            ((FREE[0.1, 2], At("p", 0.0, profile=())),),
            isotropic_rest,
        ),
        Claim(
            "film",
            "with pre-stretch the limit point tends to p = 4, t0 = 1",
            tuple((s, None) for s in FILM.values()),
            film,
        ),
        Claim(
            "stretched_start",
            "at rest dp/dt0 = 8 (1 - beta^-6)(1 + alpha beta^2)",
            tuple((FREE[s], At("t0", t)) for s in ((0, 2), (0.1, 2)) for t in SMALL),
            stretched_start,
        ),
        Claim(
            "cubic_start",
            "without pre-stretch p = C (1 + alpha) t0^3 at small heights, C independent of alpha",
            tuple((FREE[a, 1], At("t0", t)) for a in (0, 0.1) for t in SMALL),
            cubic_start,
        ),
    ),
    asked={"p": 1e-8, "lam_pole": 1e-8, "V": 1e-8, "lam1_rim": 1e-6},
)
