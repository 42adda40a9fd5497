"""Spherical balloons of every law: pressure over stretch, limit points, and the constants at which two merge.

P = p r_o/(S h_o) = 2 w1(lam, lam)/lam^2, S the stress of the law's constants (C1 for neo-Hookean and
Mooney-Rivlin, the small-strain shear modulus for Ogden's three-term rubber).
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
    Printed,
    PrintedExact,
    Solutions,
    decide,
    sphere,
)

LIMITS = {
    "neo_hookean": 1,
    "mooney_rivlin": 2,
    "rivlin": 2,
    "ogden": 1,
    "biderman": 2,
    "rivlin_saunders": 1,
    "three_chain": 2,
    "arruda_boyce": 1,
    "beda_chevalier": 1,
    "saint_venant_kirchhoff": 0,
    "varga": 1,
    "gent": 1,
    "harmonic": 1,
}
"""Laws and their number of limit points up to lam = 4."""
MERGES = {
    "mooney_rivlin": sphere(model="mooney_rivlin", alpha=0.1, vary="alpha", vary_end=0.3),
    "gent": sphere(model="gent", jm=25.0, vary="jm", vary_end=12.0, lam_end=3.0),
    "arruda_boyce": sphere(model="arruda_boyce", links=10.0, vary="links", vary_end=4.0, lam_end=2.5),
}
CONSTANT = {"mooney_rivlin": "alpha", "gent": "jm", "arruda_boyce": "links"}
ASKED_OF_DIGITS = 1e-10
"""Relative accuracy asked of a number published with eleven digits."""
SOURCE = "closed form of the balloon"


def printed(
    what: str, text: str, model: str, column: str, index: int = 0, kind: str = "limit_point"
) -> Printed:
    """A published number of a balloon."""
    of = MERGES[model] if kind == "cusp_point" else sphere(model=model)
    return Printed(what, text, of=of, kind=kind, column=column, source=SOURCE, index=index)


def merging_pressure(solutions: Solutions) -> Finding:
    """The next digits are close to one half, so that our uncertainty does not decide the rounding."""
    found = solutions.point(MERGES["mooney_rivlin"], "cusp_point", "P")
    digits = "3.6556338082"
    half = 10.0 ** -len(digits.partition(".")[2]) / 2
    return decide.agree("P", found, decide.Number(float(digits), half / 2), ASKED_OF_DIGITS)


CASE = Case(
    title="Spherical balloons: limit points, and the constants at which they merge",
    source="Patil (2016), chapter 3; Ogden (1972)",
    panels=(
        Panel(
            "P",
            x=Axis("lam", 1, 4, r"$\lambda$"),
            y=Axis("P", 0, 12, r"$P$"),
            markers="limit_point",
            curves=tuple(
                Curve(sphere(model=m), m.replace("_", " "), reference=f"sphere_{m}") for m in LIMITS
            ),
        ),
    ),
    checks=(
        Count(
            "limit_point",
            {sphere(model=m): n for m, n in LIMITS.items()},
            "number of limit points up to lam = 4",
        ),
        *(
            Points(
                "limit_point",
                reference=f"sphere_limits_{m}",
                base=sphere(model=m),
                parameters=(),
                asked={"P": 1e-9, "lam": 1e-9},
            )
            for m, n in LIMITS.items()
            if n
        ),
        *(
            Points(
                "cusp_point",
                reference=f"sphere_merge_{m}",
                base=spec,
                parameters=(),
                asked={CONSTANT[m]: 1e-8, "P": 1e-8, "lam": 1e-8},
            )
            for m, spec in MERGES.items()
        ),
        printed("neo-Hookean maximum", "2.47892580", "neo_hookean", "P"),
        PrintedExact(
            "neo-Hookean maximum, closed form",
            "2.47892580",
            exact=4 * (7 ** (-1 / 6) - 7 ** (-7 / 6)),
            evidence="P = 4 (1/lam - lam^-7), stationary at lam = 7^(1/6)",
            source=SOURCE,
        ),
        printed("neo-Hookean stretch at the maximum", "1.38308755", "neo_hookean", "lam"),
        printed("c2/c1 = 0.1: maximum", "2.98123511", "mooney_rivlin", "P"),
        printed("c2/c1 = 0.1: stretch at the maximum", "1.47606985", "mooney_rivlin", "lam"),
        printed("c2/c1 = 0.1: minimum", "2.52724500", "mooney_rivlin", "P", 1),
        printed("c2/c1 = 0.1: stretch at the minimum", "3.14262133", "mooney_rivlin", "lam", 1),
        printed("c2/c1 at which they merge", "0.2144583510", "mooney_rivlin", "alpha", kind="cusp_point"),
        printed("stretch at which they merge", "1.8407344175", "mooney_rivlin", "lam", kind="cusp_point"),
        Claim(
            "merging_pressure",
            "P at which they merge is the published 3.6556338082 to half a unit of its last digit",
            ((MERGES["mooney_rivlin"], None),),
            merging_pressure,
        ),
        printed("Ogden's rubber: maximum", "1.29931514", "ogden", "P"),
        printed("Ogden's rubber: stretch at the maximum", "1.37380869", "ogden", "lam"),
    ),
    asked={"P": 1e-8},
    quick=True,
)
