"""Paper 3: limit points and bifurcations of the primary branch, and the order of the eigenvalues' zeros.

Stability is under level control unless volume is mentioned; n is the number of waves around the
circumference, and n = 0 is axisymmetric without torsion.
"""

from weakforms.cases import At, Case, Claim, Finding, Points, Solutions, States, decide, fluid_tube

LENGTHS, STRETCHES = (8, 24), (1.5, 2, 3)
TUBES = {(length, d): fluid_tube(L=length, delta=d, gamma=0.116) for length in LENGTHS for d in STRETCHES}
DENSITIES = {
    (length, g): fluid_tube(L=length, delta=2, gamma=g) for length in LENGTHS for g in (0.058, 0.232)
}
EVERY = (*TUBES.values(), *DENSITIES.values())
LIMIT, FIRST = At("limit_point", 1.0), At("bifurcation_point", 1.0)
ASKED = {"zw": 5e-10, "V": 1e-9, "r_mid": 1e-7, "r_max": 1e-7, "Pi": 1e-7}


def signs(solutions: Solutions) -> Finding:
    """Eigenvalue columns on both sides of the critical points."""
    found = []
    for tube in EVERY:
        volume = solutions.along(tube, "V")
        first = next(p for p in solutions.points(tube, "bifurcation_point") if p.values["n"] == 1)
        ends = {
            "Lambda_n0": solutions.point(tube, "limit_point", "V"),
            "Lambda_n1": decide.of_point(first, "V"),
        }
        for name, at in ends.items():
            before, behind = decide.sides(volume, at)
            values = solutions.along(tube, name)
            found += [
                decide.positive(f"{name} before", values[before]),
                decide.negative("behind", values[behind]),
            ]
        found += [
            decide.positive(name, solutions.along(tube, name)[before])
            for name in ("Lambda_n2", "Lambda_n3", "Lambda_torsion")
        ]
    return decide.all_of(found)


def limit_is_a_zero(solutions: Solutions) -> Finding:
    """The axisymmetric eigenvalue at the maximum of zw, and one wave's at the first bifurcation."""
    return decide.all_of(
        decide.zero(name, solutions.number(tube, at, name), 5e-10)
        for tube in EVERY
        for at, name in ((LIMIT, "Lambda_n0"), (FIRST, "Lambda_n1"))
    )


def one_negative(solutions: Solutions) -> Finding:
    """Negative eigenvalues at the limit point and at the bifurcation, without the zeros of these points."""
    counts = [[int(solutions.value(tube, at, "n_negative")) for at in (LIMIT, FIRST)] for tube in EVERY]
    return decide.same("at limit point and bifurcation", counts, [[0, 1]] * len(EVERY))


def falls_with_stretch(solutions: Solutions) -> Finding:
    """Limit levels over the pre-stretch."""
    return decide.all_of(
        decide.falls(
            f"L = {length}", [solutions.point(TUBES[length, d], "limit_point", "zw") for d in STRETCHES]
        )
        for length in LENGTHS
    )


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
            {"r_mid": 1e-7, "Pi": 1e-7, "T1_ring": 1e-6, "T2_ring": 1e-6, "T1_mid": 5e-9},
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
            "the maximum of the level is a zero of the axisymmetric eigenvalue, the first bifurcation a zero "
            "of that with one wave",
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
