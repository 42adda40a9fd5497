"""Paper 3: the secondary branch of bent shapes, its stability and its beginning; the symmetry of the circle.

Level control unless it says volume. Mirror-symmetric displacements keep the plane of symmetry (C1v); the
others break it, and among them the turn of the pattern about the axis is an exact zero eigenvalue.
"""

import numpy as np

from weakforms import At, Case, Claim, Finding, Points, Solutions, fluid_tube, fluid_tube_surface

LENGTHS, STRETCHES = (8, 24), (1.5, 2, 3)
TUBES = {(length, d): fluid_tube(L=length, delta=d, secondary=True) for length in LENGTHS for d in STRETCHES}
PUBLISHED = {8: At("zw", 7.336, branch="secondary"), 24: At("zw", 7.779, branch="secondary")}
STATES = tuple((TUBES[length, 2], at) for length, at in PUBLISHED.items())
EVERY = tuple((tube, None) for tube in TUBES.values())
HALF, FULL = (fluid_tube_surface(L=8, delta=2, extent=extent) for extent in ("half", "full"))
UNEVEN = FULL.at(uneven=0.2)
SAME = ("zw_bifurcation", "V_bifurcation", "zw_bent", "V_bent", "Pi_bent")
STEP = 1e-3
AROUND = tuple(At("zw", 7.6 + s * STEP, branch="secondary") for s in (-1, 0, 1))


def falls(solutions: Solutions) -> Finding:
    """Level and volume along the branch, and the negative eigenvalues."""
    rows, good = [], True
    for key, tube in TUBES.items():
        columns = solutions.branch(tube, "secondary").columns
        good &= bool(np.all(np.diff(columns["zw"]) < 0) and np.all(np.diff(columns["V"]) < 0))
        good &= bool(np.all(columns["n_negative"] == 1))
        good &= bool(np.all(columns["r_mid"][1:] > columns["r_mid_pi"][1:]))
        rows.append(f"L = {key[0]}, delta = {key[1]}: zw {columns['zw'][0]:.4f} to {columns['zw'][-1]:.4f}")
    return good, "; ".join(rows)


def turns_down(solutions: Solutions) -> Finding:
    """Radius at mid-length on the bulge's side, delta = 2."""
    short, long = (solutions.branch(TUBES[length, 2], "secondary").columns for length in LENGTHS)
    k = int(short["r_mid"].argmax())
    published = long["zw"] > 7.779
    good = 0 < k < len(short["zw"]) - 1 and short["zw"][k] > 7.336
    good &= bool(np.all(np.diff(long["r_mid"][published]) > 0))
    return (
        good,
        f"L = 8: largest {short['r_mid'][k]:.4f} near zw = {short['zw'][k]:.2f}; L = 24: rises past 7.779",
    )


def stability(solutions: Solutions) -> Finding:
    """Negative eigenvalues of the published states: by level, by volume, breaking the symmetry."""
    names = ("n_negative", "n_negative_V", "n_negative_breaking")
    counts = [[int(solutions.value(tube, at, name)) for name in names] for tube, at in STATES]
    lowest = [solutions.value(tube, at, "LambdaV_1") for tube, at in STATES]
    detail = "; ".join(
        f"L = {length}: {c}, lowest at fixed volume {v:.5f}"
        for length, c, v in zip(PUBLISHED, counts, lowest, strict=True)
    )
    return all(c == [1, 1, 0] for c in counts), f"level, volume, breaking: {detail}"


def turn_is_a_zero(solutions: Solutions) -> Finding:
    """Eigenvalue of the turn of the pattern, against its uncertainty and the next one."""
    rows, good = [], True
    for tube, at in STATES:
        turn, other = (solutions.quantity(tube, at, f"Lambda_{n}") for n in ("rotation", "breaking"))
        good &= abs(turn.value) <= 2 * turn.uncertainty and abs(turn.value) < 1e-6 * other.value
        rows.append(f"{turn.value:.1e} (next {other.value:.6f})")
    return good, "; ".join(rows)


def starts_at_the_bifurcation(solutions: Solutions) -> Finding:
    """Zero of the surface's mirror-symmetric tangent against the zero of the n = 1 eigenvalue."""
    worst, good = 0.0, True
    for tube in TUBES.values():
        points = solutions.points(tube, "bifurcation_point")
        one = next(p for p in points if p.branch == "primary" and p.values["n"] == 1)
        two = next(p for p in points if p.branch == "secondary")
        for name in ("zw", "V", "r_mid"):
            off = abs(one.values[name] - two.values[name])
            good &= off <= 2 * np.hypot(one.uncertainty[name], two.uncertainty[name])
            worst = max(worst, off / abs(one.values[name]))
    return bool(good), f"largest relative difference {worst:.1e}"


def sub_critical(solutions: Solutions) -> Finding:
    """Initial slopes of the secondary branches."""
    rows = {}
    for key, tube in TUBES.items():
        point = next(p for p in solutions.points(tube, "bifurcation_point") if p.branch == "secondary")
        rows[key] = point.values["dzw_dV"], point.values["dzw_dr2"]
    good = all(slope > 0 and curvature < 0 for slope, curvature in rows.values())
    return good, "dzw/dV: " + "; ".join(
        f"L = {k[0]}, delta = {k[1]}: {slope:.6f}" for k, (slope, _) in rows.items()
    )


def work_conjugate(solutions: Solutions) -> Finding:
    """Central difference of the potential over the level against the volume, on the secondary branch."""
    before, here, after = (solutions.state(TUBES[8, 2], at).quantities for at in AROUND)
    slope = (after["Pi"].value - before["Pi"].value) / (2 * STEP)
    error = abs(slope / (-0.116 * here["V"].value) - 1)
    return error < 10 * STEP**2, f"relative difference {error:.1e}, of order step^2"


def quantities(solutions: Solutions, spec) -> dict[str, float]:  # noqa: ANN001
    """The numbers of a solution that has no branch."""
    return {name: q.value for name, q in solutions.result(spec).quantities.items()}


def double_zero(solutions: Solutions) -> Finding:
    """Critical eigenvalues and the bent state on half and full circumference."""
    half, full = (quantities(solutions, spec) for spec in (HALF, FULL))
    worst = max(abs(full[name] / half[name] - 1) for name in SAME)
    good = half["multiplicity"] == 1 and full["multiplicity"] == 2 and worst < 1e-9
    return good, (
        f"multiplicity {half['multiplicity']:g} and {full['multiplicity']:g}, pair apart by "
        f"{full['Lambda_split']:.1e}; level, volume and potential of both states differ by {worst:.1e}"
    )


def mesh_breaks_it(solutions: Solutions) -> Finding:
    """The pair on a mesh that is not uniform around."""
    even, uneven = (quantities(solutions, spec) for spec in (FULL, UNEVEN))
    good = uneven["Lambda_split"] > 1e4 * abs(even["Lambda_split"])
    good &= abs(uneven["phase"]) > 1e4 * abs(even["phase"])
    return good, (
        f"pair apart by {uneven['Lambda_split']:.1e} (even: {even['Lambda_split']:.1e}), force that holds "
        f"the pattern {uneven['phase']:.1e} (even: {even['phase']:.1e})"
    )


CASE = Case(
    title="The secondary branch and the symmetry of the circle",
    source="Patil, Nordmark & Eriksson (2015), figures 2, 3, 6 and 8",
    checks=(
        Points(
            "bifurcation_point",
            reference="secondary_slopes",
            base=fluid_tube(secondary=True),
            parameters=("L", "delta"),
            asked={"dzw_dV": 1e-4, "dzw_dr2": 1e-4, "dr_mean_dzw": 1e-3},
            branch="secondary",
        ),
        Claim(
            "falls",
            "along the secondary branch level and volume decrease, one eigenvalue is negative (unstable, on "
            "the side where the primary states have one more: super-critical in the level), and the bulge is "
            "at Theta = 0",
            EVERY,
            falls,
        ),
        Claim(
            "turns_down",
            "the radius at mid-length of the short tube rises, then falls before zw = 7.336 (the sudden "
            "downward turn of figure 2a); that of the long tube rises through zw = 7.779",
            EVERY,
            turns_down,
        ),
        Claim(
            "stability",
            "the published states have one negative eigenvalue under level control, one under volume control "
            "too (beyond the paper), and none among displacements that break the symmetry",
            STATES,
            stability,
        ),
        Claim(
            "turn_is_a_zero",
            "the turn of the pattern about the axis is a zero eigenvalue of the symmetry-breaking space",
            STATES,
            turn_is_a_zero,
        ),
        Claim(
            "starts_at_the_bifurcation",
            "the zero of the n = 1 eigenvalue is the simple zero of the surface's mirror-symmetric tangent",
            EVERY,
            starts_at_the_bifurcation,
        ),
        Claim(
            "sub_critical",
            "level and volume decrease from the start with the square of the amplitude: sub-critical in the "
            "volume (beyond the paper)",
            EVERY,
            sub_critical,
        ),
        Claim(
            "work_conjugate",
            "dPi/dzw = -gamma V along the secondary branch",
            tuple((TUBES[8, 2], at) for at in AROUND),
            work_conjugate,
        ),
        Claim(
            "double_zero",
            "on the full circumference the critical eigenvalue is double, on the half single, with the same "
            "zero and the same secondary branch",
            ((HALF, None), (FULL, None)),
            double_zero,
        ),
        Claim(
            "mesh_breaks_it",
            "a mesh that is not uniform around splits the pair and makes the bifurcation imperfect",
            ((FULL, None), (UNEVEN, None)),
            mesh_breaks_it,
        ),
    ),
)
