"""Paper 1: orders of continuity at the edge of the patch, measured, alpha = 0.1, beta = 1.

In frictionless contact the paper states that lam1 is C1 and lam2 is C2. lam1 is smoother than stated: lam1'
depends only on the slope angle, whose derivative is continuous like the pressure. In adhesive inflation lam1
is C0 and lam2 C1; in adhesive deflation lam1 jumps and lam2 is C0.
"""

from weakforms.cases import At, Case, Claim, Finding, Solutions, circular, continuity, reference

WINDOW = 0.12
"""Width of the sampling window for third derivatives, which contain the error of samples divided by its
cube."""
STICK = circular(alpha=0.1, beta=1, contact="adhesive").on(degree=6)
SLIP = circular(alpha=0.1, beta=1, contact="frictionless", p_end=5.0).on(degree=6)
DOWN = STICK.at(phase="deflation")
STUCK = float(reference(1, "deflation_alpha_0.1_beta_1").columns["X_contact"][0])
KINDS = {
    "frictionless": (SLIP, At("X_contact", 0.4), 0.4, {"lam1": 3, "lam2": 3}),
    "adhesive_inflation": (STICK, At("X_contact", 0.34), 0.34, {"lam1": 1, "lam2": 2}),
    "adhesive_deflation": (DOWN, At("p", 2.0), STUCK, {"lam1": 0, "lam2": 1}),
}
"""Solution, state, edge, and the first derivative that jumps."""


def state(kind: str) -> At:
    """The state with samples on both sides of the edge."""
    _, at, edge, _ = KINDS[kind]
    return At(at.name, at.value, profile=continuity.samples(edge, WINDOW))


def as_stated(kind: str, solutions: Solutions) -> Finding:
    """First derivatives that jump."""
    spec, _, edge, expected = KINDS[kind]
    return continuity.first_jumps(solutions, spec, state(kind), edge, WINDOW, expected)


STATEMENTS = {
    "frictionless": "frictionless: lam2 is C2, as stated; lam1 is C2 too, but is stated to be C1",
    "adhesive_inflation": "adhesive inflation: lam1 is C0, lam2 is C1",
    "adhesive_deflation": "adhesive deflation: lam1 jumps, lam2 is C0",
}

CASE = Case(
    title="Orders of continuity at the edge of the patch",
    source="Patil, DasGupta & Eriksson (2015), section 5",
    checks=tuple(
        Claim(
            kind,
            statement,
            ((KINDS[kind][0], state(kind)),),
            lambda solutions, kind=kind: as_stated(kind, solutions),
        )
        for kind, statement in STATEMENTS.items()
    ),
)
