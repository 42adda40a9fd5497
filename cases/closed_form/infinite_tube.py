"""Long tubes with closed ends that stay cylinders: limit pressures and Maxwell pressure.

Uniform states have w1 = p lam2^2/2 and w2 = p lam1 lam2. A bulge that spreads along a long tube joins two of
them with the same pressure and the same potential w - p lam1 lam2^2/2. This is Maxwell's rule of equal areas
over the volume.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    infinite_tube,
)

TUBES = {
    "mooney_rivlin": (infinite_tube(model="mooney_rivlin", alpha=0.1), 1),
    "ogden": (infinite_tube(model="ogden", lam_end=9.0), 2),
    "gent": (infinite_tube(model="gent"), 2),
    "arruda_boyce": (infinite_tube(model="arruda_boyce"), 2),
}
COEXISTING = ("ogden", "gent", "arruda_boyce")


def between(solutions: Solutions) -> Finding:
    """The Maxwell pressure against the two limit pressures."""
    found = []
    for model in COEXISTING:
        spec = TUBES[model][0]
        high, low = (solutions.point(spec, "limit_point", "p", index) for index in (0, 1))
        found.append(decide.less(model, low, solutions.whole(spec, "p_maxwell"), high))
    return decide.all_of(found)


CASE = Case(
    title="Long tubes: limit and Maxwell pressures",
    source="Patil (2016), chapter 3; Maxwell's rule for bulges: Chater & Hutchinson (1984)",
    panels=(
        Panel(
            "p",
            x=Axis("lam2", 1, 9, r"$\lambda_2$"),
            y=Axis("p", 0, 3),
            markers="limit_point",
            curves=tuple(Curve(spec, model.replace("_", " ")) for model, (spec, _) in TUBES.items()),
        ),
    ),
    checks=(
        Count("limit_point", dict(TUBES.values()), "number of limit pressures of the uniform tube"),
        *(
            Points(
                "limit_point",
                reference=f"infinite_tube_limits_{m}",
                base=spec,
                parameters=(),
                asked={"p": 1e-9, "lam1": 1e-9, "lam2": 1e-9},
            )
            for m, (spec, _) in TUBES.items()
        ),
        *(
            Points(
                "quantity",
                reference=f"infinite_tube_maxwell_{m}",
                base=TUBES[m][0],
                parameters=(),
                asked=dict.fromkeys(
                    ("p_maxwell", "lam1_thin", "lam2_thin", "lam1_thick", "lam2_thick"), 1e-9
                ),
            )
            for m in COEXISTING
        ),
        Claim(
            "between",
            "the Maxwell pressure lies between the two limit pressures",
            tuple((TUBES[m][0], None) for m in COEXISTING),
            between,
        ),
    ),
    quick=True,
)
