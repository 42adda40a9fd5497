"""Paper 2, figure 3: limit points of the freely inflated Mooney-Rivlin tube, and the cusp where they merge.

Panel (a) shows displacement against pressure near the limit points, panel (b) the limit pressures over the
pre-stretch: a fold line that turns back in a cusp, printed at delta1 = 1.163.
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
    Solutions,
    decide,
    tube,
    tube_fold,
)

STRETCHES = (1, 1.1, 1.15, 1.2)
TUBES = {d: tube(alpha=0.1, delta1=d) for d in STRETCHES}
FOLD = tube_fold(alpha=0.1)
LIMIT_PRESSURES = Axis("p", 1.85, 2.05)


def pressures_within_axis(solutions: Solutions) -> Finding:
    """All limit pressures up to the cusp lie within the printed axis."""
    inside = solutions.branch(FOLD).columns["delta1"] >= 1
    return decide.between(
        "limit pressures", solutions.along(FOLD, "p")[inside], LIMIT_PRESSURES.low, LIMIT_PRESSURES.high
    )


def folds_fall(solutions: Solutions) -> Finding:
    """Both limit pressures fall with the pre-stretch: p falls to the cusp and rises back after it."""
    p, u = (solutions.along(FOLD, name) for name in ("p", "u_max"))
    before, after = decide.sides(u, solutions.point(FOLD, "cusp_point", "u_max"))
    return decide.all_of(decide.falls("p to the cusp", p[before]), decide.rises("p back", p[after]))


CASE = Case(
    title="Limit points and their cusp",
    source="Patil, Nordmark & Eriksson (2014), figure 3",
    panels=(
        Panel(
            "a",
            x=Axis("p", 1.70, 2.05),
            y=Axis("u_max", 0, 5),
            title=r"$\alpha = 0.1$",
            markers="limit_point",
            curves=tuple(
                Curve(TUBES[d], rf"$\delta_1 = {d}$", reference=f"fig03a_delta1_{d}") for d in STRETCHES
            ),
        ),
        Panel(
            "b",
            x=Axis("delta1", 1, 1.2),
            y=LIMIT_PRESSURES,
            title=r"fold line, $\alpha = 0.1$",
            markers="cusp_point",
            curves=(Curve(FOLD, "limit pressure", reference="fig03b"),),
        ),
    ),
    checks=(
        Count(
            "limit_point",
            {TUBES[1]: 2, TUBES[1.1]: 2, TUBES[1.15]: 2, TUBES[1.2]: 0},
            "two limit points below the cusp, none above",
        ),
        Count("cusp_point", {FOLD: 1}, "the fold line has one cusp"),
        Points(
            "limit_point",
            reference="limit_points_alpha_0.1",
            base=tube(alpha=0.1),
            parameters=("delta1",),
            asked={"p": 5e-10, "u_max": 5e-10},
        ),
        Points(
            "cusp_point",
            reference="cusp",
            base=tube_fold(),
            parameters=("alpha", "lf"),
            asked={"delta1": 5e-10, "p": 1e-9, "u_max": 1e-9},
        ),
        Claim(
            "axis",
            "all limit pressures for 1 <= delta1 <= cusp lie within the printed axis 1.85..2.05",
            ((FOLD, None),),
            pressures_within_axis,
        ),
        Claim(
            "folds_fall",
            "both limit pressures fall with the pre-stretch",
            ((FOLD, None),),
            folds_fall,
        ),
        Printed(
            "cusp delta1",
            "1.163",
            of=FOLD,
            kind="cusp_point",
            column="delta1",
            source="figure 3(b)",
        ),
    ),
    asked={"p": 1e-9, "u_max": 1e-7, "delta1": 5e-10, "lam1_mid": 5e-8, "t1_mid": 5e-8, "V": 5e-10},
    quick=True,
)
