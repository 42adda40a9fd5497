"""Paper 2, figure 11: contact length over pressure, (a) frictionless, (b) adhesive inflation."""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
LAWS = (("a", "frictionless", "fig06a"), ("b", "adhesive", "fig06b"))
TUBES = {(law, s): tube(contact=law, alpha=s[0], delta1=s[1]) for _, law, _ in LAWS for s in SETS}


EARLY_LATE = (1.6, 2.0, 2.6, 3.0)


STAGNATES = decide.Stated(
    2, "stagnates", "no number is printed; the late growth is less than half the early one"
)


def grows_then_stagnates(solutions: Solutions) -> Finding:
    """Growth of the patch from p = 1.6 to 2 over that from 2.6 to 3; for delta1 = 2 it is shorter."""
    found = []
    for law in ("frictionless", "adhesive"):
        for alpha in (0, 0.1):
            length = solutions.numbers(
                TUBES[law, (alpha, 1)], [At("p", p) for p in EARLY_LATE], "contact_length"
            )
            shorter = solutions.number(TUBES[law, (alpha, 2)], At("p", 3.0), "contact_length")
            ratio = (length[1] - length[0]) / (length[3] - length[2])
            found.append(decide.at_least(f"{law}, alpha = {alpha}: early over late growth", ratio, STAGNATES))
            found.append(decide.less("at p = 3", shorter, length[3], 6))
    return decide.all_of(found)


CASE = Case(
    title="Contact length",
    source="Patil, Nordmark & Eriksson (2014), figure 11",
    panels=tuple(
        Panel(
            letter,
            x=Axis("p", 0, 3),
            y=Axis("contact_length", 1, 8, label=r"$\eta^*$"),
            title=law,
            curves=tuple(
                Curve(
                    TUBES[law, s],
                    rf"$\alpha = {s[0]}$, $\delta_1 = {s[1]}$",
                    reference=f"{table}_alpha_{s[0]}_delta1_{s[1]}",
                )
                for s in SETS
            ),
        )
        for letter, law, table in LAWS
    ),
    checks=(
        Claim(
            "grows_then_stagnates",
            "the contact length of the unstretched tube grows fast first and then stagnates; at p = 3 that "
            "of the pre-stretched tube is smaller (near first contact it is larger); all stay below l_f",
            tuple(
                (TUBES[law, (a, 1)], At("p", p)) for _, law, _ in LAWS for a in (0, 0.1) for p in EARLY_LATE
            )
            + tuple((TUBES[law, (a, 2)], At("p", 3.0)) for _, law, _ in LAWS for a in (0, 0.1)),
            grows_then_stagnates,
        ),
    ),
    asked={"contact_length": 1e-6, "Z_front": 1e-6},
)
