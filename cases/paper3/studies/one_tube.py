"""Paper 3: critical points and signs of eigenvalues of one tube, L = 8, delta = 2, gamma = 0.116.

The case paper3.critical checks the same for every tube; this case is small enough for the quick profile.
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


def signs_without_mass(solutions: Solutions) -> Finding:
    """Number of negative eigenvalues from the inertia of the stiffness alone, and sign with the mass."""
    counts = solutions.branch(TUBE).columns["n_negative"]
    below, above = decide.sides(solutions.along(TUBE, "Lambda_n0"), 0)
    return decide.all_of(
        decide.every("some negative where the lowest eigenvalue is", counts[below] > 0),
        decide.every("none where it is positive", counts[above] == 0),
    )


def hardening(solutions: Solutions) -> Finding:
    """Limit points, and levels at the first one, for alpha = 0, 0.1 and 0.3."""
    counts = [len(solutions.points(spec, "limit_point")) for spec in (TUBE, *HARDER.values())]
    soft, harder = (solutions.point(spec, "limit_point", "zw") for spec in (TUBE, HARDER[0.1]))
    return decide.all_of(
        decide.same("limit points", counts, [1, 1, 0]), decide.less("their levels", soft, harder)
    )


HARDER = {a: TUBE.at(alpha=a, n_max=1) for a in (0.1, 0.3)}

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
            "signs_without_mass",
            "the mass matrix leaves the signs of eigenvalues as they are (chapter 4.4)",
            ((TUBE, None),),
            signs_without_mass,
        ),
        Claim(
            "hardening",
            "a second Mooney-Rivlin constant changes the response: with 0.1 the limit level rises, with 0.3 "
            "there is no limit point up to a mean radius of 10",
            ((TUBE, None), *((spec, None) for spec in HARDER.values())),
            hardening,
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
