"""Paper 1, figure 7: stretches along the radius and the isotropic zone, frictionless, alpha = 0.1, beta = 1.

X_iso is the first X at which lam1 and lam2 differ by 1e-4. At small pressure the stretches change like
p^(2/3), hence X_iso like p^(-1/3). It decreases in free inflation and increases after first contact.
"""

import numpy as np

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Line,
    Panel,
    Solutions,
    circular,
    decide,
    reference,
)

SLIP = circular(alpha=0.1, beta=1, contact="frictionless", p_end=7.2)
FREE = circular(alpha=0.1, beta=1)
STATES = ((FREE, 1.64), (SLIP, 4.82), (SLIP, 5.95))
REST = reference(1, "fig07a_p_0")
"""The paper's first curve, p = 0: the unstretched disk, which has no stiffness against p and is a limit."""
SMALL = tuple(At("t0", t, profile=tuple(REST.columns["X"])) for t in (0.24, 0.12, 0.06))


LIKE = decide.Stated(0.02, "like p^(-1/3)", "the next term, of relative order p^(2/3), at p up to 0.2")
GROWS = decide.Stated(
    2,
    "grows after first contact",
    "no number is printed; figure 7b has it at about twice its least value at the end",
)
NEARLY_EQUAL = decide.Stated(
    0.05, "nearly equal", "no number is printed; a fifteenth of the height of figure 7a"
)


def power(solutions: Solutions) -> Finding:
    """Exponent of X_iso(p) as p falls; it tends to -1/3."""
    values = {
        p: solutions.number(circular(alpha=0.1, beta=1, l=1), At("p", p), "X_iso") for p in (0.05, 0.1, 0.2)
    }
    low, high = (
        abs((values[b].log() - values[a].log()) / np.log(b / a) + 1 / 3) for a, b in ((0.05, 0.1), (0.1, 0.2))
    )
    return decide.all_of(
        decide.less("exponent off -1/3", low, high), decide.at_most("the larger", high, LIKE)
    )


def rest(solutions: Solutions) -> Finding:
    """Largest difference of the stretches from those of the table, at heights that tend to zero."""
    return decide.all_of(
        decide.order(
            f"|{name} - 1| over 1/t0",
            [1 / at.value for at in SMALL],
            decide.stack(
                abs(solutions.samples(FREE, at, name) - REST.columns[name]).largest() for at in SMALL
            ),
            2,
        )
        for name in ("lam1", "lam2")
    )


def least_at_contact(solutions: Solutions) -> Finding:
    """X_iso along the branch: it falls before first contact and rises after it."""
    p, radius = (solutions.along(SLIP, name) for name in ("p", "X_iso"))
    before, after = decide.sides(p, solutions.point(SLIP, "contact_onset", "p"))
    known = before & (p.value > 0)
    return decide.all_of(
        decide.falls("X_iso before first contact", radius[known][1:]),
        decide.rises("X_iso after it", radius[after]),
        decide.at_least("growth", radius[-1] / radius.smallest(), GROWS),
    )


def nearly_equal(solutions: Solutions) -> Finding:
    """|lam1 - lam2| on the patch up to p = 7."""
    found = []
    for p in (4.82, 5.95, 7.0):
        at = At("p", p, profile=())
        inside = solutions.profile(SLIP, at).columns["X"] < solutions.value(SLIP, at, "X_contact")
        lam1, lam2 = (solutions.column(SLIP, at, name)[inside] for name in ("lam1", "lam2"))
        found.append(decide.at_most(f"|lam1 - lam2| at p = {p}", abs(lam1 - lam2), NEARLY_EQUAL))
    return decide.all_of(found)


CASE = Case(
    title="Stretches and the isotropic zone, frictionless",
    source="Patil, DasGupta & Eriksson (2015), figure 7",
    panels=(
        *(
            Panel(
                f"a, {column}",
                x=Axis("X", 0, 1),
                y=Axis(column, 0.8, 1.6),
                title="free and frictionless",
                lines=(Line("$p = 0$", (0.0, 1.0), (1.0, 1.0)),),
                curves=tuple(
                    Curve(of, f"$p = {p:g}$", reference=f"fig07a_p_{p:g}", at=At("p", p), y=column)
                    for of, p in STATES
                ),
            )
            for column in ("lam1", "lam2")
        ),
        Panel(
            "b",
            x=Axis("p", 0, 7),
            y=Axis("X_iso", 0, 0.35),
            title=r"radius of the zone with $|\lambda_1 - \lambda_2| < 10^{-4}$",
            markers="contact_onset",
            curves=(Curve(SLIP, r"$\alpha = 0.1$, $\beta = 1$", reference="fig07b_iso"),),
        ),
    ),
    checks=(
        Claim(
            "power",
            "X_iso falls like p^(-1/3) at small pressure",
            tuple((circular(alpha=0.1, beta=1, l=1), At("p", p)) for p in (0.05, 0.1, 0.2)),
            power,
        ),
        Claim(
            "rest",
            "without pressure both stretches are 1; they tend to it with the square of the height",
            tuple((FREE, at) for at in SMALL),
            rest,
        ),
        Claim(
            "least_at_contact",
            "X_iso is least at first contact and grows after it",
            ((SLIP, None),),
            least_at_contact,
        ),
        Claim(
            "nearly_equal",
            "in contact both stretches are nearly equal",
            tuple((SLIP, At("p", p, profile=())) for p in (4.82, 5.95, 7.0)),
            nearly_equal,
        ),
    ),
    asked={
        "rho": 1e-9,
        "eta": 2e-9,
        "lam1": 5e-7,
        "lam2": 1e-9,
        "t1": 2e-6,
        "t2": 5e-7,
        "sigma": 1e-8,
        "X_iso": 1e-4,
        "t0": 2e-9,
    },
)
