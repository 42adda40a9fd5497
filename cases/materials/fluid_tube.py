"""The fluid-loaded tube of paper 3 with other rubbers: Ogden's, Gent's, Arruda and Boyce's, Mooney's.

L = 8, delta = 2, gamma = 0.116 with mu = 2 S, where S is the stress by which the constants are divided.
Primary branch, limit point, bifurcation with one wave and eigenvalues are compared with the paper's reference
codes, which implement the laws separately. All tubes except Ogden's bifurcate much later than the neo-Hookean
one. The Mooney-Rivlin tube is the paper's form with alpha = 0.1, which is zero in the paper.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    fluid_tube,
)

ENDS = {"ogden": 0.9, "gent": 0.8, "arruda_boyce": 0.8}
"""Fraction of the highest level at which a branch ends, beyond the first bifurcation."""
TUBES = {
    **{m: fluid_tube(model=m, zw_end=end) for m, end in ENDS.items()},
    "mooney_rivlin": fluid_tube(alpha=0.1, zw_end=0.9),
}
NEO_HOOKEAN = fluid_tube()
SAME = fluid_tube(model="neo_hookean")
LIMIT, FIRST = At("limit_point", 1.0), At("bifurcation_point", 1.0)
EIGENVALUES = ("Lambda_n0", "Lambda_n1", "Lambda_n2", "Lambda_n3", "Lambda_torsion", "LambdaV_n0")
KINDS = {"limit_point": 0, "bifurcation_point": 1}


def zeros(solutions: Solutions) -> Finding:
    """The axisymmetric eigenvalue at the limit point, the eigenvalue of one wave at the first bifurcation."""
    return decide.all_of(
        decide.zero(f"{model} {name}", solutions.number(spec, at, name), 5e-10)
        for model, spec in TUBES.items()
        for at, name in ((LIMIT, "Lambda_n0"), (FIRST, "Lambda_n1"))
    )


def order(solutions: Solutions) -> Finding:
    """Negative eigenvalues (axisymmetric) before and after the limit point, by inertia."""
    found = []
    for model, spec in TUBES.items():
        counts = solutions.branch(spec).columns["n_negative"]
        limit = solutions.point(spec, "limit_point", "V")
        before, behind = decide.sides(solutions.along(spec, "V"), limit)
        found += [
            decide.every(f"{model}: none before", counts[before] == 0),
            decide.every("one behind", counts[behind] == 1),
            decide.same("waves", solutions.points(spec, "bifurcation_point")[0].values["n"], 1),
            decide.less("V", limit, solutions.point(spec, "bifurcation_point", "V")),
        ]
    return decide.all_of(found)


def same_law(solutions: Solutions) -> Finding:
    """The neo-Hookean law of the catalogue, against the paper's form."""
    return decide.all_of(
        decide.agree(
            f"{kind} {name}", *(solutions.point(spec, kind, name) for spec in (SAME, NEO_HOOKEAN)), 5e-10
        )
        for kind in KINDS
        for name in ("zw", "V")
    )


CASE = Case(
    title="The fluid-loaded tube of paper 3 with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2015) with laws of the thesis's chapter 3",
    panels=(
        Panel(
            "branch",
            x=Axis("V", 0, 600),
            y=Axis("zw", 0, 12),
            markers=("limit_point", "bifurcation_point"),
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(spec, m.replace("_", " "), reference=f"fluid_tube_{m}") for m, spec in TUBES.items()
            ),
        ),
        *(
            Panel(
                f"eigenvalues_{m}",
                x=Axis("V", 0, 600),
                y=Axis("Lambda", -1, 1),
                title=m.replace("_", " "),
                note="Not a figure of the paper.",
                curves=tuple(
                    Curve(spec, name, reference=f"fluid_tube_spectrum_{m}", y=name) for name in EIGENVALUES
                ),
            )
            for m, spec in TUBES.items()
        ),
    ),
    checks=(
        *(
            Points(
                kind,
                reference=f"fluid_tube_critical_{m}",
                base=spec,
                parameters=(),
                where={"n": float(n)},
                asked={"zw": 5e-10, "V": 5e-10, "r_mid": 2e-9, "r_max": 1e-8, "Pi": 5e-10},
            )
            for m, spec in TUBES.items()
            for kind, n in KINDS.items()
        ),
        Claim(
            "zeros",
            "the maximum of the level is a zero of the axisymmetric eigenvalue, the first bifurcation a zero "
            "of that with one wave, for every law",
            tuple((spec, at) for spec in TUBES.values() for at in (LIMIT, FIRST)),
            zeros,
        ),
        Claim(
            "order",
            "one negative axisymmetric eigenvalue after the limit point and none before; the bifurcation "
            "with one wave comes later",
            tuple((spec, None) for spec in TUBES.values()),
            order,
        ),
        Claim(
            "same_law",
            "the neo-Hookean tube with the catalogue's law is the paper's tube",
            ((SAME, None), (NEO_HOOKEAN, None)),
            same_law,
        ),
    ),
    asked={
        **dict.fromkeys(("zw", "Pi"), 5e-10),
        "r_mid": 5e-9,
        "r_max": 5e-8,
        "T1_ring": 2e-7,
        "T2_ring": 5e-8,
        "T1_mid": 1e-05,
        "T2_mid": 1e-6,
        **dict.fromkeys(EIGENVALUES, 2e-9),
    },
    slow=True,
)
