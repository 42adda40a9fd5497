"""Lines of critical points of the free tube in planes of two parameters.

Limit points, points at which the mirror symmetry breaks, and first wrinkling are followed over the ratio
C2/C1 of the law and over the pre-stretch. Where two conditions hold at once, the point is solved for: the
cusp of limit points, the tips of mirror breaking, and the point that is both.
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

OVER_ALPHA = diagram(x="alpha", alpha=0.0, high=0.2, u_end=4.9, kind="fold,mirror")
OVER_STRETCH = diagram(alpha=0.0, high=1.6, u_end=4.9, kind="mirror,wrinkling")


def the_same_coincidence(solutions: Solutions) -> Finding:
    """The line of limit points and that of mirror breaking meet at one point, found on either of them."""
    return decide.all_of(
        decide.agree(name, *(solutions.point(OVER_ALPHA, "fold_mirror", name, k) for k in (0, 1)), 1e-6)
        for name in ("alpha", "p", "u_max")
    )


CASE = Case(
    title="Lines of limit points, mirror breaking and wrinkling of the tube",
    source="the tube of Patil, Nordmark & Eriksson (2014)",
    panels=(
        Panel(
            "a",
            x=Axis("alpha", 0, 0.2),
            y=Axis("p", 0.8, 2.6),
            title=r"$\delta_1 = 1,\; l_f = 6$",
            markers="cusp_point",
            curves=(
                Curve(OVER_ALPHA, "limit points", "lines_fold_alpha", branch="fold"),
                Curve(OVER_ALPHA, "mirror breaking", "lines_mirror_alpha", branch="mirror"),
            ),
        ),
        Panel(
            "b",
            x=Axis("delta1", 1, 1.4),
            y=Axis("p", 0.7, 1.6),
            title=r"neo-Hookean, $l_f = 6$",
            markers="tip_mirror",
            curves=(
                Curve(OVER_STRETCH, "mirror breaking", "lines_mirror_delta1", branch="mirror"),
                Curve(OVER_STRETCH, "wrinkling at the disk", "lines_wrinkling_disk", branch="wrinkling"),
                Curve(OVER_STRETCH, "wrinkling inside", "lines_wrinkling_front", branch="wrinkling"),
            ),
        ),
    ),
    checks=(
        Count("cusp_point", {OVER_ALPHA: 1}, "the limit points merge in one cusp"),
        Count("tip_mirror", {OVER_ALPHA: 2, OVER_STRETCH: 1}, "turns of the lines of mirror breaking"),
        *(
            Points(
                kind,
                reference=table,
                base=OVER_ALPHA,
                parameters=(),
                asked={"alpha": 1e-6, "p": 1e-6, "u_max": 1e-6},
            )
            for kind, table in (
                ("cusp_point", "lines_cusp_alpha"),
                ("tip_mirror", "lines_tips_alpha"),
                ("fold_mirror", "lines_fold_mirror_alpha"),
            )
        ),
        Claim(
            "same_coincidence",
            "both lines have the same point of coincidence",
            ((OVER_ALPHA, None),),
            the_same_coincidence,
        ),
    ),
    asked={"p": 1e-7, "alpha": 1e-7, "delta1": 1e-7},
    slow=True,
)
