"""Paper 1: the curves behind figures 3 to 10, over the pressure or the edge of the patch.

First contact, frictionless and adhesive inflation, deflation; G = 0 during adhesive inflation.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    States,
    circular,
    decide,
)

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
SLIP = {
    s: circular(alpha=s[0], beta=s[1], contact="frictionless", p_end=8.0 if s[1] == 1 else 9.0) for s in SETS
}
ENDS = {(0, 1): 4.4, (0, 2): 5.9, (0.1, 1): 4.9, (0.1, 2): 9.0}
STICK = {s: circular(alpha=s[0], beta=s[1], contact="adhesive", p_end=ENDS[s]) for s in SETS}
FULL = {(0, 1): 3.477, (0, 2): 5.0, (0.1, 1): 3.477, (0.1, 2): 8.49}
"""Pressures from which the membranes deflate."""
DOWN = {
    s: circular(alpha=s[0], beta=s[1], contact="adhesive", phase="deflation", p_end=p)
    for s, p in FULL.items()
}
FLAT = At("kappa", 0.0)


def label(s: tuple[float, float]) -> str:
    """Legend entry."""
    return rf"$\alpha = {s[0]}$, $\beta = {s[1]}$"


def no_release(solutions: Solutions) -> Finding:
    """G along adhesive inflation, compared with the value 1 that peeling reaches."""
    return decide.all_of(decide.zero("G", solutions.along(spec, "G"), 1e-9) for spec in STICK.values())


def contact_later(solutions: Solutions) -> Finding:
    """Pressure of first contact."""
    p = {s: solutions.point(SLIP[s], "contact_onset", "p") for s in SETS}
    return decide.all_of(
        *(decide.less(f"alpha = {a}", p[a, 1], p[a, 2]) for a in (0, 0.1)),
        *(decide.less(f"beta = {b}", p[0, b], p[0.1, b]) for b in (1, 2)),
    )


def taut(solutions: Solutions) -> Finding:
    """Smallest principal resultant anywhere along the branches, except for the unstressed start."""
    return decide.all_of(
        decide.positive("smallest resultant", solutions.along(spec, "t_min")[1:])
        for spec in (*SLIP.values(), *STICK.values(), *DOWN.values())
    )


CASE = Case(
    title="Contact: curves over pressure and edge of the patch",
    source="Patil, DasGupta & Eriksson (2015), sections 5 and 6",
    panels=(
        Panel(
            "frictionless",
            x=Axis("p", 0, 9),
            y=Axis("t0", 0, 0.7),
            markers="contact_onset",
            curves=tuple(
                Curve(SLIP[s], label(s), reference=f"frictionless_alpha_{s[0]}_beta_{s[1]}") for s in SETS
            ),
        ),
        Panel(
            "adhesive",
            x=Axis("p", 0, 9),
            y=Axis("t0", 0, 0.7),
            markers="contact_onset",
            curves=tuple(
                Curve(STICK[s], label(s), reference=f"adhesive_alpha_{s[0]}_beta_{s[1]}") for s in SETS
            ),
        ),
        Panel(
            "deflation",
            x=Axis("p", 0, 9),
            y=Axis("t0", 0, 0.7),
            curves=tuple(
                Curve(DOWN[s], label(s), reference=f"deflation_alpha_{s[0]}_beta_{s[1]}") for s in DOWN
            ),
        ),
    ),
    checks=(
        Points(
            "contact_onset",
            reference="disk_contact_onset",
            base=circular(contact="frictionless", p_end=6.0),
            parameters=("alpha", "beta", "l"),
            asked={"p": 1e-9, "lam_pole": 5e-10},
        ),
        States(
            "curvature_change",
            circular(contact="adhesive", phase="deflation"),
            ("alpha", "beta", "p_end"),
            FLAT,
            {"p": 1e-6, "t0": 1e-6, "lam1_contact_outer": 2e-7},
        ),
        Claim(
            "no_release",
            "no energy is released while the patch grows: G = 0",
            tuple((s, None) for s in STICK.values()),
            no_release,
        ),
        Claim(
            "contact_later",
            "first contact needs more pressure with pre-stretch and with the Mooney-Rivlin term",
            tuple((s, None) for s in SLIP.values()),
            contact_later,
        ),
        Claim(
            "taut",
            "both resultants stay positive: nothing wrinkles",
            tuple((s, None) for s in (*SLIP.values(), *STICK.values(), *DOWN.values())),
            taut,
        ),
    ),
    asked={
        "p": 1e-6,
        "t0": 1e-6,
        "lam_pole": 1e-9,
        "rho_contact": 1e-6,
        "X_contact": 2e-8,
        "lam1_contact": 1e-5,
        "lam1_contact_outer": 1e-5,
        "sigma_pole": 1e-6,
        "V": 1e-6,
    },
    slow=True,
)
