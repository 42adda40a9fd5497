"""Lines at which waves around the free tube are neutral: which tubes bend, and which bend first.

Bending (n = 1) is followed over the length and over the pre-stretch, and two waves around (n = 2) over the
pre-stretch. Where bending and the limit point coincide, short tubes, which reach the limit point first, meet
long ones, which bend first.
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
    diagram,
)

OVER_LENGTH = diagram(x="lf", alpha=0.0, low=5.0, high=10.0, u_end=2.5, kind="fold,mirror,n1")
OVER_STRETCH = diagram(alpha=0.0, high=1.2, u_end=2.0, kind="n1")
TWO_WAVES = diagram(alpha=0.0, delta1=2.0, low=1.9, high=2.2, u_end=4.0, kind="n2").on(levels=2)
MEETING = diagram(x="lf", alpha=0.0, low=7.5, high=9.0, u_end=1.2, kind="fold,n1").on(levels=2)
ALPHAS = (0.0, 0.05, 0.1)
EXACT = {"lf": 1e-6, "p": 1e-6, "u_max": 1e-6}


def the_same_points(solutions: Solutions) -> Finding:
    """Points at which two conditions hold are the same on both of their lines."""
    return decide.all_of(
        decide.agree(
            f"{name} of {kind}", *(solutions.point(OVER_LENGTH, kind, name, k) for k in (0, 1)), 1e-6
        )
        for kind in ("fold_n1", "mirror_n1")
        for name in ("lf", "p", "u_max")
    )


def between(solutions: Solutions) -> Finding:
    """The length at which bending and the limit point coincide lies between 7.5 and 8.5."""
    found = [solutions.point(MEETING.at(alpha=alpha), "fold_n1", "lf") for alpha in ALPHAS]
    return decide.less("lf for alpha = 0, 0.05, 0.1", 7.5, *found, 8.5)


def who_is_first(solutions: Solutions) -> Finding:
    """At the limit point, tubes shorter than that length are stable to bending, and longer ones are not."""
    line = solutions.branch(OVER_LENGTH, "fold").columns
    both = solutions.point(OVER_LENGTH, "fold_n1", "lf").value
    counts = [set(line["n_negative_n1"][part].astype(int)) for part in (line["lf"] < both, line["lf"] > both)]
    return decide.same("negative eigenvalues of bending, below and above", counts, [{0}, {1}])


CASE = Case(
    title="Lines of bending and of two waves around the tube",
    source="the tube of Patil, Nordmark & Eriksson (2014)",
    panels=(
        Panel(
            "a",
            x=Axis("lf", 5, 10),
            y=Axis("p", 1.1, 1.8),
            title=r"neo-Hookean, $\delta_1 = 1$",
            markers=("fold_n1", "mirror_n1", "tip_n1", "wrinkling_n1"),
            curves=(
                Curve(OVER_LENGTH, "bending", "lines_n1_lf", branch="n1"),
                Curve(OVER_LENGTH, "limit points", branch="fold"),
                Curve(OVER_LENGTH, "mirror breaking", branch="mirror"),
            ),
        ),
        Panel(
            "b",
            x=Axis("delta1", 1, 1.05),
            y=Axis("p", 1.4, 1.7),
            title=r"neo-Hookean, $l_f = 6$",
            markers="tip_n1",
            curves=(Curve(OVER_STRETCH, "bending", "lines_n1_delta1", branch="n1"),),
        ),
        Panel(
            "c",
            x=Axis("delta1", 1.9, 2.2),
            y=Axis("p", 1.1, 1.4),
            title=r"neo-Hookean, $l_f = 6$",
            curves=(Curve(TWO_WAVES, "two waves around", "lines_n2_delta1", branch="n2"),),
        ),
    ),
    checks=(
        Count("tip_n1", {OVER_LENGTH: 1, OVER_STRETCH: 1}, "turns of the lines of bending"),
        Points("tip_n1", "lines_tip_n1_lf", OVER_LENGTH, (), EXACT),
        Points("tip_n1", "lines_tip_n1_delta1", OVER_STRETCH, (), {"delta1": 1e-6, "p": 1e-6, "u_max": 1e-6}),
        Points("mirror_n1", "lines_mirror_n1_lf", OVER_LENGTH, (), EXACT),
        Points("fold_n1", "lines_fold_n1_lf", MEETING, ("alpha",), EXACT),
        Claim("same_points", "both lines have the same points", ((OVER_LENGTH, None),), the_same_points),
        Claim(
            "between",
            "bending and the limit point coincide at a length between 7.5 and 8.5",
            tuple((MEETING.at(alpha=alpha), None) for alpha in ALPHAS),
            between,
        ),
        Claim(
            "who_is_first",
            "short tubes reach the limit point first, long ones bend first",
            ((OVER_LENGTH, None),),
            who_is_first,
        ),
    ),
    asked={"p": 1e-7, "lf": 1e-7, "delta1": 1e-7},
    slow=True,
)
