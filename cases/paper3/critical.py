"""Paper 3: limit points and bifurcations of the primary branch, and the order of the eigenvalues' zeros.

Level control unless it says volume; n waves around the circumference, n = 0 axisymmetric without torsion.
"""

import numpy as np

from weakforms import At, Case, Claim, Finding, Points, Solutions, States, fluid_tube

LENGTHS, STRETCHES = (8, 24), (1.5, 2, 3)
TUBES = {(length, d): fluid_tube(L=length, delta=d, gamma=0.116) for length in LENGTHS for d in STRETCHES}
DENSITIES = {
    (length, g): fluid_tube(L=length, delta=2, gamma=g) for length in LENGTHS for g in (0.058, 0.232)
}
EVERY = (*TUBES.values(), *DENSITIES.values())
LIMIT, FIRST = At("limit_point", 1.0), At("bifurcation_point", 1.0)
ASKED = {"zw": 1e-7, "V": 1e-7, "r_mid": 1e-7, "r_max": 1e-7, "Pi": 1e-7}


def signs(solutions: Solutions) -> Finding:
    """Eigenvalue columns to both sides of the critical points."""
    good, least = True, []
    for tube in EVERY:
        columns = solutions.branch(tube).columns
        limit = solutions.points(tube, "limit_point")[0].values["V"]
        first = next(p for p in solutions.points(tube, "bifurcation_point") if p.values["n"] == 1)
        volume, end = columns["V"], first.values["V"]
        off = abs(volume - limit) > 1e-6  # the limit point itself is on the trace
        good &= bool(np.all((columns["Lambda_n0"] < 0)[off] == (volume > limit)[off]))
        good &= bool(np.all((columns["Lambda_n1"] < 0) == (volume > end)))
        before = volume < end
        rest = np.array([columns[n][before] for n in ("Lambda_n2", "Lambda_n3", "Lambda_torsion")])
        least.append(rest.min())
    detail = f"lowest of n = 2, 3 and torsion up to the first bifurcation: {min(least):.3g}"
    return good and min(least) > 0, detail


def limit_is_a_zero(solutions: Solutions) -> Finding:
    """At the maximum of zw the axisymmetric eigenvalue, at the first bifurcation that of one wave."""
    rows = []
    for tube in EVERY:
        for at, name in ((LIMIT, "Lambda_n0"), (FIRST, "Lambda_n1")):
            found = solutions.quantity(tube, at, name)
            rows.append((abs(found.value), found.uncertainty))
    worst = max(rows, key=lambda row: row[0] / row[1])
    return all(v <= 2 * u for v, u in rows), f"largest: {worst[0]:.1e}, its uncertainty {worst[1]:.1e}"


def one_negative(solutions: Solutions) -> Finding:
    """Negative eigenvalues at the limit point and at the bifurcation, besides those points' own zeros."""
    counts = [[int(solutions.value(tube, at, "n_negative")) for at in (LIMIT, FIRST)] for tube in EVERY]
    return all(c == [0, 1] for c in counts), f"at limit point and bifurcation: {counts}"


def falls_with_stretch(solutions: Solutions) -> Finding:
    """Limit levels over the pre-stretch."""
    good, rows = True, []
    for length in LENGTHS:
        levels = [solutions.points(TUBES[length, d], "limit_point")[0].values["zw"] for d in STRETCHES]
        good &= levels[0] > levels[1] > levels[2]
        rows.append(f"L = {length}: " + " > ".join(f"{zw:.5f}" for zw in levels))
    return good, "; ".join(rows)


CASE = Case(
    title="Limit points and bifurcations of the primary branch",
    source="Patil, Nordmark & Eriksson (2015), figures 2 to 4 and section 10.1",
    checks=(
        *(
            Points(kind, "critical_points", base, ("L", "delta", "gamma"), ASKED, where={"n": float(n)})
            for n, (kind, base) in enumerate(
                (
                    ("limit_point", fluid_tube()),
                    ("bifurcation_point", fluid_tube()),
                    ("bifurcation_point", fluid_tube(zw_end=0.45)),
                )
            )
        ),
        States(
            "dry",
            fluid_tube(gamma=0.116),
            ("L", "delta"),
            At("zw", 0.0),
            {"r_mid": 1e-7, "Pi": 1e-7, "T1_ring": 1e-5, "T2_ring": 1e-5, "T1_mid": 1e-5},
        ),
        Claim(
            "signs",
            "Lambda(n = 0) changes sign at the limit point only, Lambda(n = 1) at the first bifurcation "
            "only; "
            "n = 2, n = 3 and torsion stay positive up to there",
            tuple((tube, None) for tube in EVERY),
            signs,
        ),
        Claim(
            "limit_is_a_zero",
            "the maximum of the level is a zero of the axisymmetric eigenvalue, the first bifurcation one of "
            "that with one wave",
            tuple((tube, at) for tube in EVERY for at in (LIMIT, FIRST)),
            limit_is_a_zero,
        ),
        Claim(
            "one_negative",
            "between limit point and bifurcation there is exactly one negative eigenvalue (axisymmetric "
            "space)",
            tuple((tube, at) for tube in EVERY for at in (LIMIT, FIRST)),
            one_negative,
        ),
        Claim(
            "falls_with_stretch",
            "the limit level falls from delta = 1.5 to 3",
            tuple((tube, None) for tube in TUBES.values()),
            falls_with_stretch,
        ),
    ),
    slow=True,
)
