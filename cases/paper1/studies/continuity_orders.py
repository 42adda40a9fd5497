"""Paper 1: orders of continuity at the edge of the patch, measured, alpha = 0.1, beta = 1.

In frictionless contact the paper states that lam1 is C1 and lam2 is C2. lam1 is smoother than stated: lam1'
depends only on the slope angle, whose derivative is continuous like the pressure. In adhesive inflation lam1
is C0 and lam2 C1; in adhesive deflation lam1 jumps and lam2 is C0. The reference has the same orders, also of
rho, eta and the resultants.
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
    2: ("frictionless", SLIP, At("X_contact", 0.4), 0.4),
    3: ("adhesive_inflation", STICK, At("X_contact", 0.34), 0.34),
    4: ("adhesive_deflation", DOWN, At("p", 2.0), STUCK),
}
"""Name, solution, state and edge, by the number of the kind in the table."""
FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2")
STATEMENTS = {
    2: "frictionless: lam2 is C2, as stated; lam1 is C2 too, but is stated to be C1",
    3: "adhesive inflation: lam1 is C0, lam2 is C1",
    4: "adhesive deflation: lam1 jumps, lam2 is C0",
}
DIFFERS = {
    2: "the text says that lam1 is C1 at the edge in frictionless contact; its second derivative is "
    "continuous too"
}


def state(kind: int) -> At:
    """The state with samples on both sides of the edge."""
    _, _, at, edge = KINDS[kind]
    return At(at.name, at.value, profile=continuity.samples(edge, WINDOW))


def as_in_the_table(kind: int, solutions: Solutions) -> Finding:
    """First derivatives that jump, compared with the reference."""
    table, (_, spec, _, edge) = reference(1, "continuity_orders"), KINDS[kind]
    rows = table.columns["kind"] == kind
    expected = dict(zip(FIELDS, table.columns["first_jump"][rows].astype(int), strict=True))
    return continuity.first_jumps(solutions, spec, state(kind), edge, WINDOW, expected)


CASE = Case(
    title="Orders of continuity at the edge of the patch",
    source="Patil, DasGupta & Eriksson (2015), section 5",
    checks=tuple(
        Claim(
            KINDS[kind][0],
            statement,
            ((KINDS[kind][1], state(kind)),),
            lambda solutions, kind=kind: as_in_the_table(kind, solutions),
            DIFFERS.get(kind, ""),
        )
        for kind, statement in STATEMENTS.items()
    ),
    slow=True,
)
