"""Paper 2, table 1: orders of continuity at the contact front, measured.

On each side of the front a polynomial is fitted to the solution (elements of degree 6) over a window, and
its derivatives are compared at the front. The order counts derivatives up to the first with a jump. According
to the printed table u, w, lam2 are in C^i and lam1, t1, t2 in C^(i-1) with i = 2 (frictionless), 1 (adhesive
inflation), 0 (adhesive deflation): the first jump is in derivative i + 1, or i. In frictionless contact lam1,
t1 and t2 are smoother: w - lam1 w_1 is constant along the membrane, so that lam1 is a smooth function of
lam2.
"""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, continuity, reference, tube

FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2")
WINDOW = 0.2
STICK = tube(contact="adhesive", alpha=0.1, delta1=1).on(degree=6)
KINDS = {
    2: ("frictionless", tube(contact="frictionless", alpha=0.1, delta1=1).on(degree=6), 2.0, "fig06a"),
    3: ("adhesive inflation", STICK, 2.0, "fig06b"),
    4: ("adhesive deflation", STICK.at(phase="deflation", spring="bilateral"), 1.0, "fig06b"),
}


def front(kind: int) -> float:
    """Material position of the front at the state's pressure, or at p = 3 in deflation."""
    table = reference(2, f"{KINDS[kind][3]}_alpha_0.1_delta1_1")
    row = int(np.argmin(np.abs(table.columns["p"] - (3.0 if kind == 4 else KINDS[kind][2]))))
    return float(table.columns["Z_front"][row])


def state(kind: int) -> At:
    """The state with its profile on both sides of the front."""
    return At("p", KINDS[kind][2], profile=continuity.samples(front(kind), WINDOW))


def as_measured(kind: int, solutions: Solutions) -> Finding:
    """The measured orders agree with the reference, and every jump is clearly zero or clearly not zero."""
    table = reference(2, "table1_continuity")
    rows = table.columns["kind"] == kind
    expected = dict(zip(FIELDS, table.columns["first_jump"][rows].astype(int), strict=True))
    return continuity.first_jumps(solutions, KINDS[kind][1], state(kind), front(kind), WINDOW, expected)


STATEMENTS = {
    2: "frictionless: the third derivative of u and w is the first to jump, as printed; the same holds for "
    "lam1, t1 and t2, for which the table prints the second",
    3: "adhesive inflation: the second derivatives of u and w and the first of lam1, t1, t2 jump, as printed",
    4: "adhesive deflation: the first derivatives of u and w jump, and lam1, t1, t2 themselves, as printed",
}

DIFFERS = {
    2: "the table prints C1 for lam1, t1 and t2 in frictionless contact; w - lam1 w_1 is constant along the "
    "membrane, which makes them as smooth as lam2: C2"
}

CASE = Case(
    title="Orders of continuity at the contact front",
    source="Patil, Nordmark & Eriksson (2014), table 1",
    checks=tuple(
        Claim(
            KINDS[kind][0].replace(" ", "_"),
            statement,
            ((KINDS[kind][1], state(kind)),),
            lambda solutions, kind=kind: as_measured(kind, solutions),
            DIFFERS.get(kind, ""),
        )
        for kind, statement in STATEMENTS.items()
    ),
)
