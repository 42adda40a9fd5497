"""Adhesive contact and deflation of the tube of paper 2 with other rubbers: Ogden's and Gent's.

The spring of the bonded patch both pushes and pulls ("bilateral"). Branches are compared with the paper's
reference codes, which implement the laws separately.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

P_END = {"ogden": 1.3, "gent": 2.6}
"""Pressure at which inflation ends and deflation starts."""
STICK = {m: tube(model=m, contact="adhesive", p_end=p) for m, p in P_END.items()}
DOWN = {m: spec.at(phase="deflation", spring="bilateral") for m, spec in STICK.items()}
EMPTY = At("p", 0.0)


def held_open(solutions: Solutions) -> Finding:
    """Displacement of the mid-plane at p = 0, and at the end of inflation."""
    return decide.all_of(
        decide.less(
            f"{m}: u_max at p = 0 and at p_end",
            0,
            solutions.number(DOWN[m], EMPTY, "u_max"),
            solutions.number(STICK[m], At("p", p), "u_max"),
        )
        for m, p in P_END.items()
    )


CASE = Case(
    title="Adhesive contact of the tube with other laws",
    source="the problem of Patil, Nordmark & Eriksson (2014) with laws of the thesis's chapter 3",
    panels=tuple(
        Panel(
            phase,
            x=Axis("p", 0, 3),
            y=Axis("u_max", 0, 0.6),
            title=f"adhesive {phase}",
            markers="contact_onset",
            note="Not a figure of the paper.",
            curves=tuple(Curve(spec, m, reference=f"tube_{kind}_{m}") for m, spec in specs.items()),
        )
        for phase, kind, specs in (("inflation", "adhesive", STICK), ("deflation", "deflation", DOWN))
    ),
    checks=(
        Claim(
            "held_open",
            "also with these laws the bonded substrate holds the tube open at p = 0",
            tuple((DOWN[m], EMPTY) for m in P_END) + tuple((STICK[m], At("p", p)) for m, p in P_END.items()),
            held_open,
        ),
    ),
    asked={
        **dict.fromkeys(("u_max", "lam2_mid", "lam1_mid"), 5e-9),
        "t1_mid": 2e-8,
        **dict.fromkeys(("contact_length", "Z_front", "V", "spring_max"), 1e-6),
        **dict.fromkeys(("line_force", "line_force_membrane"), 5e-5),
        **dict.fromkeys(("traction_front", "traction_max"), 1e-3),
    },
    slow=True,
)
