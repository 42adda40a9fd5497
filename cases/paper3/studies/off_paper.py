"""Paper 3 far from its parameters: L 8 to 24, delta 1.1 to 7, gamma 0.05 to 0.25.

The paper remarks that for larger and for very small pre-stretch the bifurcation comes before the limit point.
"""

from weakforms.cases import Axis, Case, Claim, Curve, Finding, Panel, Solutions, Spec, decide, fluid_tube

SETS = ((8, 5, 0.116), (8, 7, 0.116), (24, 1.1, 0.116), (16, 2.5, 0.05), (12, 1.3, 0.25), (24, 7, 0.25))
TUBES = {s: fluid_tube(L=s[0], delta=s[1], gamma=s[2]) for s in SETS}
HIGH, LOW, HIGHEST = TUBES[8, 5, 0.116], TUBES[24, 1.1, 0.116], TUBES[8, 7, 0.116]
USUAL = fluid_tube(L=8, delta=3, gamma=0.116)


def volumes(solutions: Solutions, tube: Spec) -> dict[str, decide.Number]:
    """Volumes at the limit point and at the first bifurcation of each wave number."""
    found = {"limit": solutions.point(tube, "limit_point", "V")}
    for point in solutions.points(tube, "bifurcation_point"):
        found.setdefault(f"n = {point.values['n']:g}", decide.of_point(point, "V"))
    return found


def bifurcation_first(solutions: Solutions) -> Finding:
    """Order of the critical points."""
    found = [volumes(solutions, tube) for tube in (HIGH, LOW)]
    return decide.all_of(decide.less("V at bifurcation and limit", v["n = 1"], v["limit"]) for v in found)


def two_waves_first(solutions: Solutions) -> Finding:
    """At delta = 7 the bifurcation with two waves comes before that with one."""
    found = volumes(solutions, HIGHEST)
    return decide.less("V at n = 2, n = 1 and limit", found["n = 2"], found["n = 1"], found["limit"])


def rises_again(solutions: Solutions) -> Finding:
    """The limit level is not monotone in the pre-stretch."""
    return decide.less(
        "limit level at delta = 3 and 5",
        *(solutions.point(tube, "limit_point", "zw") for tube in (USUAL, HIGH)),
    )


CASE = Case(
    title="Off the paper's parameters",
    source="the problem of Patil, Nordmark & Eriksson (2015), figure 2, at other data",
    panels=(
        Panel(
            "off",
            x=Axis("zw", 0, 16),
            y=Axis("V", 0, 300),
            markers=("limit_point", "bifurcation_point"),
            note="Not a figure of the paper.",
            curves=tuple(
                Curve(
                    TUBES[s],
                    rf"$L = {s[0]}$, $\delta = {s[1]}$, $\gamma = {s[2]}$",
                    reference=f"primary_L_{s[0]}_delta_{s[1]}_gamma_{s[2]}",
                )
                for s in SETS
            ),
        ),
    ),
    checks=(
        Claim(
            "bifurcation_first",
            "for large (L/A = 8, delta = 5) and for very small pre-stretch (L/A = 24, delta = 1.1) the "
            "bifurcation comes before the limit point",
            ((HIGH, None), (LOW, None)),
            bifurcation_first,
        ),
        Claim(
            "two_waves_first",
            "at delta = 7 (L/A = 8) a bifurcation with two waves comes before that with one",
            ((HIGHEST, None),),
            two_waves_first,
        ),
        Claim(
            "rises_again",
            "the limit level decreases with the pre-stretch up to delta = 3 but is higher again at delta = 5",
            ((USUAL, None), (HIGH, None)),
            rises_again,
        ),
    ),
    asked={"zw": 1e-9, "r_mid": 5e-9, "Pi": 1e-9},
    slow=True,
)
