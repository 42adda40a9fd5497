"""Paper 1, figures 8 and 9: stretches in adhesive inflation and deflation, alpha = 0.1, beta = 1.

At the edge of a growing patch lam1 has a kink and lam2 a jump of its second derivative; in deflation lam1
jumps and lam2 has a kink. The tables do not contain points close to the edge.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular, decide

STICK = circular(alpha=0.1, beta=1, contact="adhesive")
DOWN = STICK.at(phase="deflation")
PANELS = (
    ("fig08", "adhesive inflation", STICK, (0.95, 2.83, 3.26, 3.47), (1.0, 1.6), (1.0, 1.3)),
    ("fig09", "adhesive deflation", DOWN, (0.6, 1.4, 2.4, 3.2), (0.6, 1.8), (1.0, 1.3)),
)
FREE = circular(alpha=0.1, beta=1)
SAME_STATE = {0.6: "fig05a_p_0.6", 1.4: "fig05a_p_1.4", 2.4: "fig05a_p_2.4", 3.2: "fig05a_p_3.2"}


SIDES = ("lam1_contact", "lam1_contact_outer")


def no_jump(solutions: Solutions) -> Finding:
    """lam1 on both sides of the edge of a growing patch."""
    return decide.all_of(
        decide.agree(f"lam1 at p = {p}", *(solutions.number(STICK, At("p", p), n) for n in SIDES), 1e-7)
        for p in (2.83, 3.26, 3.47)
    )


def jump(solutions: Solutions) -> Finding:
    """lam1 on both sides of the edge in deflation."""
    return decide.all_of(
        decide.less(
            f"lam1 outside and inside, p = {p}", *(solutions.number(DOWN, At("p", p), n) for n in SIDES[::-1])
        )
        for p in (0.6, 1.4, 2.4, 3.2)
    )


def taut(solutions: Solutions) -> Finding:
    """Smallest principal resultant anywhere in the printed states."""
    least = decide.stack(
        solutions.number(of, At("p", p), "t_min") for _, _, of, ps, _, _ in PANELS for p in ps
    )
    return decide.positive("smallest resultant", least)


CASE = Case(
    title="Stretches in adhesive inflation and deflation",
    source="Patil, DasGupta & Eriksson (2015), figures 8 and 9",
    panels=tuple(
        Panel(
            f"{figure}, {column}",
            x=Axis("X", 0, 1),
            y=Axis(column, *limits),
            title=title,
            curves=tuple(
                Curve(
                    FREE if p == 0.95 else of,
                    f"$p = {p:g}$",
                    reference=SAME_STATE[p] if of is DOWN else f"{figure}_p_{p:g}",
                    at=At("p", p),
                    y=column,
                )
                for p in pressures
            ),
        )
        for figure, title, of, pressures, *both in PANELS
        for column, limits in zip(("lam1", "lam2"), both, strict=True)
    ),
    checks=(
        Claim(
            "no_jump",
            "lam1 is continuous at the edge of a growing patch",
            tuple((STICK, At("p", p)) for p in (2.83, 3.26, 3.47)),
            no_jump,
        ),
        Claim(
            "jump",
            "lam1 jumps at the edge in deflation, to a smaller value outside",
            tuple((DOWN, At("p", p)) for p in (0.6, 1.4, 2.4, 3.2)),
            jump,
        ),
        Claim(
            "taut",
            "both resultants are positive everywhere: nothing wrinkles",
            tuple((of, At("p", p)) for _, _, of, ps, _, _ in PANELS for p in ps),
            taut,
        ),
    ),
    asked={"rho": 1e-7, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-5, "t2": 5e-6, "sigma": 1e-7},
)
