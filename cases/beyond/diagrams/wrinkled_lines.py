"""Lines of critical points of the wrinkled tube under gas, and under a liquid, with relaxed energy.

The limit pressure is followed over the thickness at the lower end, the radius of the disks and the
pre-stretch. The membrane is wrinkled at both disks, at one, or at none, and the fronts are unknowns of the
lines. A line ends where a zone opens or closes; the next one begins there. Wide disks leave the membrane taut
at its limit pressure, and the line of first wrinkling meets that of limit points at one radius. At the lowest
pressures the membrane of disks of its own radius is wrinkled in the middle, up to a line that ends at the
thickness at which even the unloaded membrane is taut. The same for the highest level of a light liquid, which
fills the tube, and of a heavy one, whose free surface is one more unknown.
"""

from weakforms.cases import (
    At,
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
    diagram,
    reference,
    wrinkled_tube,
)

TUBE = {"body": "wrinkled_tube", "alpha": 0.01}
OF_TWO = TUBE | {"delta": 2.0}
OVER_M = diagram(**OF_TWO, Af=0.5, kind="fold", low=0.3).on(cells=96, levels=2)
TAUT = diagram(**OF_TWO, low=0.4, high=0.9, kind="fold,wrinkling").on(cells=96, levels=2)
OVER_AF = diagram(**OF_TWO, x="Af", Af=0.7, kind="fold", low=0.53).on(cells=96, levels=2)
OVER_DELTA = diagram(**TUBE, x="delta", delta=2.0, Af=0.5, kind="fold", low=1.5, high=3.2).on(
    cells=96, levels=2
)
LIQUID = OF_TWO | {"y": "zw", "Af": 0.5, "M": 0.5, "low": 0.45, "high": 0.55, "kind": "fold"}
FULL = diagram(**LIQUID, gamma=0.05).on(cells=96, levels=2)
PARTLY = diagram(**LIQUID, gamma=0.3).on(cells=96, levels=2)
SINGLE = wrinkled_tube(M=0.5, delta=2, Af=0.5, load="gas", c2=0.01, load_end=1.0).on(levels=2)
AT_TWO, UNLOADED = At("delta", 2.0, branch="fold"), At("p", 0.0, branch="wrinkling")


def the_other_problem(solutions: Solutions) -> Finding:
    """The line over the pre-stretch passes the limit point that the problem ``wrinkled_tube`` finds."""
    return decide.all_of(
        decide.agree(
            name,
            solutions.number(OVER_DELTA, AT_TWO, name),
            solutions.point(SINGLE, "limit_point", name, 0),
            1e-7,
        )
        for name in ("p", "V")
    )


def the_threshold(solutions: Solutions) -> Finding:
    """The line of first wrinkling ends without pressure, at the threshold of paper 4's table."""
    table = reference(4, "thresholds").columns
    rows = {"delta": 2.0, "c2": 0.01, "L": 8.0, "upper": 0.0}
    here = [all(table[n][k] == v for n, v in rows.items()) for k in range(len(table["M"]))]
    return decide.agree("M", solutions.number(TAUT, UNLOADED, "M"), float(table["M"][here][0]), 1e-8)


def wrinkled_or_not(solutions: Solutions) -> Finding:
    """Limit points between narrow disks are wrinkled, those between wide ones are not."""
    both = solutions.point(OVER_AF, "wrinkling_fold", "Af").value
    found = []
    for name, wide in (("fold", False), ("fold_2", True)):
        line = solutions.branch(OVER_AF, name).columns
        found.append(
            decide.same(
                f"wrinkled on {name}", set(line["wrinkled"][(line["Af"] > both) == wide]), {float(not wide)}
            )
        )
    return decide.all_of(found)


CASE = Case(
    title="Lines of limit pressures and of first wrinkling of the wrinkled tube",
    source="the tube of Patil, Nordmark & Eriksson (2015, 2016)",
    panels=(
        Panel(
            "a",
            x=Axis("M", 0.25, 1.05),
            y=Axis("p", 0.5, 1.1),
            title=r"limit pressures, $\delta = 2$",
            curves=(
                Curve(OVER_M, "narrow disks", "wrinkled_fold_M", branch="fold"),
                Curve(OVER_M, "the same, wrinkled at one", "wrinkled_fold_M_thin", branch="fold_2"),
                Curve(TAUT, "disks as wide as the tube", "wrinkled_fold_M_taut", branch="fold"),
            ),
        ),
        Panel(
            "b",
            x=Axis("M", 0.35, 0.8),
            y=Axis("p", 0, 0.006),
            title="above the line the membrane is taut",
            curves=(Curve(TAUT, "first wrinkling", "wrinkled_onset_M", branch="wrinkling"),),
        ),
        Panel(
            "c",
            x=Axis("Af", 0.5, 1.05),
            y=Axis("p", 0.7, 0.76),
            title=r"limit pressures, $\delta = 2$, $M = 0.5$",
            markers="wrinkling_fold",
            curves=(
                Curve(OVER_AF, "wrinkled", "wrinkled_fold_Af", branch="fold"),
                Curve(OVER_AF, "taut", "wrinkled_fold_Af_taut", branch="fold_2"),
            ),
        ),
        Panel(
            "d",
            x=Axis("delta", 1.4, 3.3),
            y=Axis("p", 0.5, 1),
            title="limit pressures, $M = 0.5$, $A_f = 0.5$",
            curves=(
                Curve(OVER_DELTA, "wrinkled at both disks", "wrinkled_fold_delta", branch="fold"),
                Curve(OVER_DELTA, "at the upper one", "wrinkled_fold_delta_far", branch="fold_2"),
            ),
        ),
        Panel(
            "e",
            x=Axis("M", 0.44, 0.56),
            y=Axis("zw", 5, 21),
            title=r"highest levels, $\delta = 2$, $A_f = 0.5$",
            curves=(
                Curve(FULL, r"$\gamma = 0.05$, full", "wrinkled_fold_M_full", branch="fold"),
                Curve(PARTLY, r"$\gamma = 0.3$, filled in part", "wrinkled_fold_M_partly", branch="fold"),
            ),
        ),
    ),
    checks=(
        Count("wrinkling_fold", {OVER_AF: 1}, "the limit point is about to wrinkle at one radius"),
        Points(
            "wrinkling_fold",
            "wrinkled_meetings",
            OVER_AF,
            (),
            {"Af": 1e-7, "p": 1e-7, "V": 1e-6},
            where={"M": 0.5},
        ),
        Claim(
            "other_problem",
            "the line passes the limit point of a single tube",
            ((OVER_DELTA, AT_TWO), (SINGLE, None)),
            the_other_problem,
        ),
        Claim(
            "threshold",
            "without pressure first wrinkling is at the threshold of paper 4's table",
            ((TAUT, UNLOADED),),
            the_threshold,
        ),
        Claim(
            "wrinkled_or_not",
            "limit points between narrow disks are wrinkled, those between wide ones are not",
            ((OVER_AF, None),),
            wrinkled_or_not,
        ),
    ),
    asked={"p": 1e-7, "zw": 1e-7, "V": 1e-6},
    slow=True,
)
