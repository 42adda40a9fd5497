"""Paper 2, figure 2: mid-plane displacement against pressure in free inflation.

Panel (a) neo-Hookean, panel (b) Mooney-Rivlin with alpha = 0.1, each for three pre-stretches. Past a limit
point the pressure is not a valid abscissa, so that the curves are compared over the displacement.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    CutOff,
    Finding,
    Panel,
    Points,
    PrintedExact,
    Solutions,
    decide,
    tube,
)

STRETCHES = (1, 1.5, 2)
NH = {d: tube(alpha=0, delta1=d) for d in STRETCHES}
MR = {d: tube(alpha=0.1, delta1=d) for d in STRETCHES}
FALLING = At("p", 1.2, crossing=2)
PRESSURE, DISPLACEMENT = Axis("p", 0, 3), Axis("u_max", 0, 4)


def softens(solutions: Solutions) -> Finding:
    """u_max rises with delta1 at equal pressure below every limit point, for both materials."""
    return decide.all_of(
        decide.less(
            f"u_max at p = {p}", *(solutions.number(curves[d], At("p", p), "u_max") for d in STRETCHES)
        )
        for curves, p in ((NH, 0.5), (NH, 0.8), (MR, 0.5), (MR, 1.0), (MR, 1.5))
    )


def falling_branch_softens(solutions: Solutions) -> Finding:
    """On the falling neo-Hookean branches u_max at equal pressure rises with delta1."""
    return decide.less("u_max at p = 1.2", *(solutions.number(NH[d], FALLING, "u_max") for d in STRETCHES))


def curves_cross(solutions: Solutions) -> Finding:
    """Mooney-Rivlin: the order of the curves is reversed at large displacement."""
    return decide.all_of(
        decide.less("u_max at p = 1.9", *(solutions.number(MR[d], At("p", 1.9), "u_max") for d in (2, 1.5))),
        decide.less("p at u_max = 3", *(solutions.number(MR[d], At("u_max", 3.0), "p") for d in STRETCHES)),
    )


def first_branch_at_1_9(solutions: Solutions) -> Finding:
    """At p = 1.9 the unstretched tube is before its limit point; that with delta1 = 1.5 is far inflated."""
    low, high = (solutions.number(MR[d], At("p", 1.9), "u_max") for d in (1, 1.5))
    first, second = (solutions.point(MR[1], "limit_point", "u_max", index) for index in (0, 1))
    return decide.all_of(
        decide.less(
            "u_max for delta1 = 1, at its limit points, and for delta1 = 1.5", low, first, second, high
        ),
        decide.less("p", 1.9, solutions.point(MR[1], "limit_point", "p", 1)),
    )


def not_monotone(solutions: Solutions) -> Finding:
    """Limit pressures of neo-Hookean tubes: they fall to a least one near delta1 = 1.65, then rise."""
    tubes = [tube(alpha=0, delta1=d) for d in LEAST]
    low, least, high = (solutions.point(t, "limit_point", "p") for t in tubes)
    return decide.all_of(
        decide.less("delta1 = 1.65 and 1.5", least, low), decide.less("1.65 and 2", least, high)
    )


LEAST = (1.5, 1.65, 2.0)
SOFTENING_AT = [(NH[d], At("p", p)) for d in STRETCHES for p in (0.5, 0.8)] + [
    (MR[d], At("p", p)) for d in STRETCHES for p in (0.5, 1.0, 1.5)
]

CASE = Case(
    title="Free inflation: displacement against pressure",
    source="Patil, Nordmark & Eriksson (2014), figure 2",
    panels=tuple(
        Panel(
            name,
            x=PRESSURE,
            y=DISPLACEMENT,
            title=title,
            markers="limit_point",
            curves=tuple(
                Curve(curves[d], rf"$\delta_1 = {d}$", reference=f"fig02{name}_delta1_{d}") for d in STRETCHES
            ),
        )
        for name, title, curves in (
            ("a", "neo-Hookean", NH),
            ("b", r"Mooney-Rivlin, $\alpha = 0.1$", MR),
        )
    ),
    checks=(
        Count(
            "limit_point",
            {NH[1]: 1, NH[1.5]: 1, NH[2]: 1, MR[1]: 2, MR[1.5]: 0, MR[2]: 0},
            "neo-Hookean tubes have one limit point, Mooney-Rivlin ones two or none",
        ),
        Points(
            "limit_point",
            reference="limit_points_alpha_0",
            base=tube(alpha=0),
            parameters=("delta1",),
            asked={"p": 5e-10, "u_max": 5e-10},
        ),
        PrintedExact(
            "delta2 for delta1 = 1.5",
            "0.8164",
            exact=1.5**-0.5,
            evidence="uniaxial pre-stretch leaves delta2 = 1/sqrt(delta1) = 0.816497",
            source="section on results",
            reading=CutOff(),
        ),
        PrintedExact(
            "delta2 for delta1 = 2",
            "0.7071",
            exact=2**-0.5,
            evidence="delta2 = 1/sqrt(delta1) = 0.707107",
            source="section on results",
        ),
        Claim(
            "softening",
            "at a given pressure below the limit points, u_max grows with the pre-stretch",
            tuple(SOFTENING_AT),
            softens,
        ),
        Claim(
            "softening_falling_branch",
            "the neo-Hookean tube softens with pre-stretch on its falling branch too",
            tuple((NH[d], FALLING) for d in STRETCHES),
            falling_branch_softens,
        ),
        Claim(
            "not_monotone",
            "the neo-Hookean limit pressure falls with the pre-stretch up to about 1.65 and rises after it",
            tuple((tube(alpha=0, delta1=d), None) for d in LEAST),
            not_monotone,
        ),
        Claim(
            "curves_cross",
            "past its steep part the Mooney-Rivlin tube does not soften: the curves of panel (b) cross "
            "(the paper's text claims softening before and after the limit point)",
            (
                *((MR[d], At("p", 1.9)) for d in (1.5, 2)),
                *((MR[d], At("u_max", 3.0)) for d in STRETCHES),
            ),
            curves_cross,
            differs="the text says that the tube softens with pre-stretch before and after the limit point; "
            "past the steep part of its branch the Mooney-Rivlin tube stiffens, and the curves of the "
            "paper's own panel (b) cross",
        ),
        Claim(
            "states_at_1.9",
            "at p = 1.9 the unstretched tube is on its first branch, but the one with delta1 = 1.5 is not",
            ((MR[1], At("p", 1.9)), (MR[1.5], At("p", 1.9))),
            first_branch_at_1_9,
        ),
    ),
    asked={"p": 1e-9, "lam1_mid": 1e-6, "t1_mid": 1e-6, "V": 5e-10},
)
