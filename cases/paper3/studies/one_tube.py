"""Paper 3: critical points and signs of eigenvalues of one tube, L = 8, delta = 2, gamma = 0.116.

Case ``critical`` checks the same for every tube; this case is small enough for the quick profile.
"""

from weakforms.cases import Case, Claim, Finding, Points, Solutions, decide, fluid_tube

TUBE = fluid_tube(L=8, delta=2, gamma=0.116)
ASKED = {"zw": 5e-10, "V": 5e-10, "r_mid": 2e-9, "r_max": 1e-8, "Pi": 2e-9}
HERE = {"L": 8.0, "delta": 2.0, "gamma": 0.116}


def in_order(solutions: Solutions) -> Finding:
    """The highest level comes first along the branch; the bifurcation with one wave has a larger volume."""
    volumes, levels = (
        [solutions.point(TUBE, kind, name) for kind in ("limit_point", "bifurcation_point")]
        for name in ("V", "zw")
    )
    before, behind = decide.sides(solutions.along(TUBE, "V"), volumes[0])
    axisymmetric = solutions.along(TUBE, "Lambda_n0")
    return decide.all_of(
        decide.rises("V at limit point and bifurcation", volumes),
        decide.falls("zw", levels),
        decide.positive("Lambda(n = 0) before the limit point", axisymmetric[before]),
        decide.negative("behind it", axisymmetric[behind]),
    )


CASE = Case(
    title="Critical points of one tube",
    source="Patil, Nordmark & Eriksson (2015), figures 2 and 3",
    checks=(
        *(
            Points(
                kind, "critical_points", TUBE, ("L", "delta", "gamma"), ASKED, where=HERE | {"n": float(n)}
            )
            for n, kind in enumerate(("limit_point", "bifurcation_point"))
        ),
        Claim(
            "in_order",
            "the highest level comes before the bifurcation with one wave; past it Lambda(n = 0) is negative",
            ((TUBE, None),),
            in_order,
        ),
    ),
    quick=True,
)
