"""A tube of uneven thickness: the crossing of the even tube comes apart, with Koiter's two-thirds law.

The thickness of the free tube of Paper 2 is 1 + uneven Z/(lf/2) over its mean. Its bulge moves to the thin
end by itself. States with the bulge at the thick end are detached from free inflation. They have a largest
pressure and a smallest volume, which are compared with two other codes, and for small unevenness with the
coefficients of the even tube's crossing.
"""

from math import log10

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    decide,
    tube,
)

EVEN = tube(extent="full", secondary=True, alpha=0.0, delta1=1.0, lf=6.0, u_end=2.1).on(
    degree=6, cells=64, step=0.15
)
LARGE, WIDE, MIDDLE, SMALL = 1e-2, 1e-3, 1e-4, 1e-5
DETACHED = EVEN.at(uneven=-LARGE)
FREE = EVEN.at(uneven=LARGE)
BRANCH = "secondary"
EXTREMA = {"p": ("limit_point", "uneven_tube_limits"), "V": ("volume_fold", "uneven_tube_smallest")}
ASKED = dict.fromkeys(("p", "V", "u_max", "w_mid"), 1e-7)
PLACES = dict.fromkeys(("p", "V", "u_max", "w_mid"), 1e-6)

NEXT = (MIDDLE / SMALL) ** (2 / 3)
"""Ratio of the next terms of the law at neighbouring values of the unevenness, which is their power of it."""


def over_law(solutions: Solutions, name: str, uneven: float) -> decide.Number:
    """The extremum's distance from the even tube's crossing, over that of the two-thirds law."""
    crossing, slope = (solutions.point(EVEN, "mirror_breaking", n) for n in (name, f"{name}_s"))
    kind, _ = EXTREMA[name]
    points = solutions.points(EVEN.at(uneven=-uneven), kind)
    found = decide.of_point(next(point for point in points if point.branch == BRANCH), name)
    return (found - crossing) / (slope * uneven ** (2 / 3))


def koiter(solutions: Solutions) -> Finding:
    """Koiter's constant: the limit of the ratio for vanishing unevenness is one.

    The ratio is a series in the power of the unevenness. Its first three terms give the limit; what the
    third one changes is the bound.
    """
    found = []
    for name in EXTREMA:
        near, far, farthest = (over_law(solutions, name, uneven) for uneven in (SMALL, MIDDLE, WIDE))
        two, wider = near + (near - far) / (NEXT - 1), far + (far - farthest) / (NEXT - 1)
        limit = two + (two - wider) / (NEXT**2 - 1)
        known = decide.Number(limit.value, limit.uncertainty + abs((limit - two).value) / 2)
        found.append(decide.agree(f"{name} over law", known, 1.0, 1e-3))
    return decide.all_of(*found)


def power(solutions: Solutions) -> Finding:
    """The power of the unevenness, between the two smallest ones."""
    found = []
    for name in EXTREMA:
        near, far = (over_law(solutions, name, uneven).value for uneven in (SMALL, MIDDLE))
        observed = 2 / 3 + log10(far / near) / log10(MIDDLE / SMALL)
        found.append(decide.between(f"power of {name}", observed, 0.6567, 0.6767))
    return decide.all_of(*found)


def runs(solutions: Solutions, branch: str) -> list[int]:
    """Numbers of negative eigenvalues at fixed volume along a branch, without repetition."""
    return decide.runs(solutions.branch(DETACHED, branch).columns["n_negative_volume"])


def stability(solutions: Solutions) -> Finding:
    """Free inflation loses no stability; detached states gain it at their smallest volume."""
    return decide.all_of(
        decide.same("free inflation", runs(solutions, "primary"), [0]),
        decide.same("detached states", runs(solutions, BRANCH), [1, 0]),
    )


SOLVED = tuple((EVEN.at(uneven=-uneven), None) for uneven in (SMALL, MIDDLE, WIDE))
CASE = Case(
    title="The free tube of uneven thickness",
    source="beyond Patil, Nordmark & Eriksson (2014); Koiter (1945)",
    panels=(
        Panel(
            "a",
            x=Axis("V", 8, 20),
            y=Axis("w_mid", -0.6, 0.6),
            title="Even tube (crossing) and uneven = -0.01: the diagram comes apart",
            markers=("mirror_breaking", "limit_point", "volume_fold"),
            counted=("n_negative_volume",),
            curves=(
                Curve(EVEN, "even, lopsided", branch=BRANCH),
                Curve(DETACHED, "uneven, free inflation"),
                Curve(DETACHED, "uneven, thick end", reference="uneven_tube_detached", branch=BRANCH),
            ),
        ),
        Panel(
            "b",
            x=Axis("V", 8, 20),
            y=Axis("p", 1.2, 1.75),
            title="Pressure: even, and uneven = 0.01",
            markers=("mirror_breaking", "limit_point"),
            counted=("n_negative_volume",),
            curves=(
                Curve(EVEN, "even, symmetric"),
                Curve(EVEN, "even, lopsided", branch=BRANCH),
                Curve(FREE, "uneven, free inflation", reference="uneven_tube_free"),
                Curve(FREE, "uneven, thick end", branch=BRANCH),
            ),
        ),
    ),
    checks=(
        *(
            Points(kind, table, EVEN, ("uneven",), PLACES | {name: 1e-7}, branch=BRANCH)
            for name, (kind, table) in EXTREMA.items()
        ),
        Claim(
            "koiter",
            "largest pressure and smallest volume follow the two-thirds law of the even tube's crossing",
            ((EVEN, None), *SOLVED),
            koiter,
        ),
        Claim("power", "the power of the unevenness is two thirds", ((EVEN, None), *SOLVED), power),
        Claim(
            "stability",
            "at fixed volume free inflation is stable, the detached states are beyond their smallest volume",
            ((DETACHED, None),),
            stability,
        ),
    ),
    asked=ASKED,
    slow=True,
)
