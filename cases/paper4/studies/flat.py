"""Paper 4, section 5.1(a): a flat circular membrane of non-uniform thickness does not wrinkle.

The paper reports it without a figure. The thickness is linear over the radius, 0.5 or 1.5 times the mean at
the pole; the law is the paper's, and the pressure rises from the flat state to a dome as high as its radius.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular, decide

DISKS = {(M, beta): circular(alpha=0.01, beta=beta, M=M, t_end=1.0) for M in (0.5, 1.5) for beta in (1, 1.5)}


def taut(solutions: Solutions) -> Finding:
    """Smallest principal resultant along the branches, except for the first point."""
    return decide.all_of(
        decide.positive(f"M = {M}, beta = {beta}", solutions.along(spec, "t_min")[1:])
        for (M, beta), spec in DISKS.items()
    )


def stretches_most_where_thin(solutions: Solutions) -> Finding:
    """Stretch at the pole at equal height, from a thick pole to a thin one."""
    thick, thin = (solutions.number(DISKS[M, 1], HALF, "lam_pole") for M in (1.5, 0.5))
    return decide.less("lam_pole at t0 = 0.5, M = 1.5 and 0.5", thick, thin)


HALF = At("t0", 0.5)

CASE = Case(
    title="A flat circular membrane of non-uniform thickness",
    source="Patil, Nordmark & Eriksson (2015), section 5.1(a)",
    panels=(
        Panel(
            "flat",
            x=Axis("p", 0, 6),
            y=Axis("t0", 0, 1),
            note="Not a figure of the paper.",
            curves=tuple(Curve(spec, rf"$M = {M}$, $\beta = {beta}$") for (M, beta), spec in DISKS.items()),
        ),
    ),
    checks=(
        Claim(
            "taut",
            "a flat circular membrane of non-uniform thickness does not wrinkle",
            tuple((spec, None) for spec in DISKS.values()),
            taut,
        ),
        Claim(
            "stretches_most_where_thin",
            "the pole stretches more where it is thin",
            tuple((DISKS[M, 1], HALF) for M in (0.5, 1.5)),
            stretches_most_where_thin,
        ),
    ),
)
