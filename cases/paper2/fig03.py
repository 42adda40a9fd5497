"""Paper 2, figure 3: limit points of the freely inflated Mooney-Rivlin tube, and the cusp where they merge.

Panel (a) shows displacement against pressure near the limit points, panel (b) the limit pressures over the
pre-stretch: a fold line that turns back in a cusp, printed at delta1 = 1.163.
"""

from weakforms import (
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
    tube,
    tube_fold,
)

STRETCHES = (1, 1.1, 1.15, 1.2)
TUBES = {d: tube(alpha=0.1, delta1=d) for d in STRETCHES}
FOLD = tube_fold(alpha=0.1)


def pressures_within_axis(solutions: Solutions) -> Finding:
    """All limit pressures up to the cusp lie within the printed axis."""
    p = solutions.branch(FOLD).columns["p"]
    inside = solutions.branch(FOLD).columns["delta1"] >= 1
    low, high = p[inside].min(), p[inside].max()
    return bool(low > 1.85 and high < 2.05), f"limit pressures in [{low:.5f}, {high:.5f}]"


def folds_fall(solutions: Solutions) -> Finding:
    """Both limit pressures fall with the pre-stretch: p falls to the cusp and rises back after it."""
    columns = solutions.branch(FOLD).columns
    (cusp,) = solutions.points(FOLD, "cusp_point")
    before = columns["p"][columns["u_max"] < cusp.values["u_max"]]
    after = columns["p"][columns["u_max"] > cusp.values["u_max"]]
    falls = bool((before[1:] < before[:-1]).all() and (after[1:] > after[:-1]).all())
    return falls, f"{len(before)} points to the cusp, {len(after)} back"


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
            y=Axis("p", 1.85, 2.05),
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
            asked={"p": 1e-8, "u_max": 1e-6},
        ),
        Points(
            "cusp_point",
            reference="cusp",
            base=tube_fold(),
            parameters=("alpha", "lf"),
            asked={"delta1": 1e-7, "p": 1e-7, "u_max": 1e-3},
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
    asked={"p": 1e-7, "u_max": 1e-7, "delta1": 1e-7, "lam1_mid": 1e-6, "t1_mid": 1e-6, "V": 1e-6},
    quick=True,
)
