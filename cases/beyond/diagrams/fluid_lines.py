"""Lines of critical points of the tube that a liquid fills, in the plane of its pre-stretch and its level.

Limit points and bifurcations with one, two and three waves around the axis are followed over full tubes. The
more the tube is stretched, the more waves has the mode that is critical first. Little stretched tubes have
become partially filled again where they bend: on that line, the free surface is one more unknown.
"""

from math import pi

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
    reference,
)

TUBE = {"body": "fluid_tube", "alpha": 0.0}
FULL = diagram(**TUBE, low=3.2, high=9.0, kind="fold,n1,n2,n3").on(cells=32, levels=2)
PARTLY = diagram(**TUBE, delta=2.4, low=1.76, high=3.04, kind="n1").on(cells=64, levels=2)
LONG = diagram(**TUBE, L=24.0, delta=1.2, low=1.1, high=1.2, kind="fold,n1", V_end=12.0).on(
    cells=128, levels=2
)
MEETINGS = {"fold_n1": (0, 1), "fold_n2": (0, 2), "fold_n3": (0, 3)}
MEETINGS |= {"n1_n2": (1, 2), "n1_n3": (1, 3), "n2_n3": (2, 3)}
TABLE = reference(3, "coincidence")


def the_other_problem(solutions: Solutions) -> Finding:
    """The points are those that paper 3 has for two lengths; the volume is over ``2 pi`` here."""
    return decide.all_of(
        decide.agree(
            f"L = {length:g}: {name}",
            decide.number(solutions.point(spec, "fold_n1", name)) * scale,
            float(TABLE.columns[name][TABLE.columns["L"] == length][0]),
            1e-6,
        )
        for length, spec in ((8, FULL), (24, LONG))
        for name, scale in (("delta", 1.0), ("zw", 1.0), ("V", 2 * pi))
    )


def the_same_points(solutions: Solutions) -> Finding:
    """Points at which two conditions hold are the same on both of their lines."""
    return decide.all_of(
        decide.agree(f"{name} of {kind}", *(solutions.point(FULL, kind, name, k) for k in (0, 1)), 1e-6)
        for kind in MEETINGS
        for name in ("delta", "zw", "V")
    )


def more_waves(solutions: Solutions) -> Finding:
    """The first critical mode has 0, 1, 2, 3 waves in turn."""
    turns = ("fold_n1", "n1_n2", "n2_n3")
    return decide.less("delta", *(solutions.point(FULL, kind, "delta") for kind in turns))


def who_is_first(solutions: Solutions) -> Finding:
    """At the limit point, tubes stretched less than that are stable to one wave, others are not."""
    line = solutions.branch(FULL, "fold").columns
    both = solutions.point(FULL, "fold_n1", "delta").value
    sides = (line["delta"] < both, line["delta"] > both)
    counts = [set(line["n_negative_n1"][side].astype(int)) for side in sides]
    return decide.same("negative eigenvalues of one wave, below and above", counts, [{0}, {1}])


CASE = Case(
    title="Lines of limit points and of waves around the tube that a liquid fills",
    source="the tube of Patil, Nordmark & Eriksson (2015)",
    panels=(
        Panel(
            "a",
            x=Axis("delta", 3, 9),
            y=Axis("zw", 8, 12),
            title=r"full, $L = 8$, $\gamma = 0.116$",
            markers=tuple(MEETINGS),
            curves=(
                Curve(FULL, "limit points", "fluid_fold_delta", branch="fold"),
                Curve(FULL, "one wave", "fluid_n1_delta", branch="n1"),
                Curve(FULL, "two waves", "fluid_n2_delta", branch="n2"),
                Curve(FULL, "three waves", branch="n3"),
            ),
        ),
        Panel(
            "b",
            x=Axis("delta", 1.7, 3.1),
            y=Axis("zw", 7.8, 8),
            title=r"partially filled, $L = 8$",
            curves=(Curve(PARTLY, "one wave", "fluid_n1_partly", branch="n1"),),
        ),
    ),
    checks=(
        Count("fold_n1", {FULL: 2, LONG: 2}, "limit points and bending meet once, on either line"),
        *(
            Points(
                kind,
                "fluid_meetings",
                FULL,
                (),
                {"delta": 1e-6, "zw": 1e-6, "V": 1e-6, "Pi": 1e-6},
                where={"n": float(n), "other": float(other)},
            )
            for kind, (n, other) in MEETINGS.items()
        ),
        Claim(
            "other_problem",
            "limit point and bending coincide where they do in paper 3's table",
            ((FULL, None), (LONG, None)),
            the_other_problem,
        ),
        Claim("same_points", "both lines have the same points", ((FULL, None),), the_same_points),
        Claim(
            "more_waves",
            "with the pre-stretch the first critical mode has 0, 1, 2 and 3 waves in turn",
            ((FULL, None),),
            more_waves,
        ),
        Claim(
            "who_is_first",
            "at the limit point, only tubes with a large pre-stretch are unstable to one wave",
            ((FULL, None),),
            who_is_first,
        ),
    ),
    asked=dict.fromkeys(("zw", "V", "Pi", "delta"), 1e-7),
    slow=True,
)
