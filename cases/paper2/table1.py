"""Paper 2, table 1: orders of continuity at the contact front, measured.

On each side of the front a polynomial is fitted to the solution (elements of degree 6) over a window, and
its derivatives are compared at the front: the first whose jump does not vanish is the order. The printed
table has u, w, lam2 in C^i and lam1, t1, t2 in C^(i-1) with i = 2 (frictionless), 1 (adhesive inflation), 0
(adhesive deflation): the first jump is in derivative i + 1, or i. In frictionless contact lam1, t1 and t2
are smoother than that: w - lam1 w_1 is constant along the membrane, which makes lam1 a smooth function of
lam2.
"""

import numpy as np

from weakforms import At, Case, Claim, Finding, Solutions, reference, tube

FIELDS = ("rho", "eta", "lam1", "lam2", "t1", "t2")
WINDOW, NODES, FIT = 0.2, 30, 9
OFFSETS = WINDOW * (1 - np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)) / 2
STICK = tube(contact="adhesive", alpha=0.1, delta1=1).on(degree=6)
KINDS = {
    2: ("frictionless", tube(contact="frictionless", alpha=0.1, delta1=1).on(degree=6), 2.0, "fig06a"),
    3: ("adhesive inflation", STICK, 2.0, "fig06b"),
    4: ("adhesive deflation", STICK.at(phase="deflation", spring="bilateral"), 1.0, "fig06b"),
}
VANISHES, JUMPS = 2e-3, 1e-2
"""Relative jumps below the one are none, above the other are one; in between nothing is measured."""


def front(kind: int) -> float:
    """Material position of the front: at the state's pressure, in deflation at p = 3."""
    table = reference(2, f"{KINDS[kind][3]}_alpha_0.1_delta1_1")
    row = int(np.argmin(np.abs(table.columns["p"] - (3.0 if kind == 4 else KINDS[kind][2]))))
    return float(table.columns["Z_front"][row])


def state(kind: int) -> At:
    """The state with its profile on both sides of the front."""
    z = front(kind)
    return At("p", KINDS[kind][2], profile=tuple(sorted([*(z - OFFSETS), *(z + OFFSETS)])))


def one_sided(z: np.ndarray, values: np.ndarray, side: int) -> list[tuple[float, float]]:
    """Value at the front and largest magnitude in the window of derivatives 0 to 3."""
    inside = (side * z > 0) & (side * z < WINDOW)
    fit = np.polynomial.Chebyshev.fit(z[inside], values[inside], FIT)
    grid = side * np.linspace(0, WINDOW / 2, 20)
    return [
        (float(d(0.0)), float(np.abs(d(grid)).max())) for d in (fit.deriv(m) if m else fit for m in range(4))
    ]


def measured(kind: int, solutions: Solutions) -> dict[str, tuple[int, list[float]]]:
    """First derivative that jumps, and the relative jumps, of every field."""
    at = state(kind)
    z = np.asarray(at.profile) - front(kind)
    out = {}
    for name in FIELDS:
        values, _ = solutions.sampled(KINDS[kind][1], at, name)
        sides = [one_sided(z, values, side) for side in (-1, 1)]
        jumps = [abs(a - b) / max(p, q) for (a, p), (b, q) in zip(*sides, strict=True)]
        first = next((m for m, jump in enumerate(jumps) if jump > JUMPS), 4)
        out[name] = (first, jumps)
    return out


def continuity(kind: int, solutions: Solutions) -> Finding:
    """The measured orders are the reference's, and no jump is in between."""
    table = reference(2, "table1_continuity")
    rows = table.columns["kind"] == kind
    expected = dict(zip(FIELDS, table.columns["first_jump"][rows].astype(int), strict=True))
    found = measured(kind, solutions)
    good = all(
        first == expected[name] and all(jump < VANISHES for jump in jumps[:first])
        for name, (first, jumps) in found.items()
    )
    return good, "; ".join(
        f"{name}: derivative {first} (jump {jumps[first] if first < 4 else 0:.2g}, below "
        f"{max(jumps[:first], default=0):.0e})"
        for name, (first, jumps) in found.items()
    )


STATEMENTS = {
    2: "frictionless: the third derivative of u and w is the first to jump, as printed; so is that of lam1, "
    "t1 and t2, where the table prints the second",
    3: "adhesive inflation: the second derivatives of u and w and the first of lam1, t1, t2 jump, as printed",
    4: "adhesive deflation: the first derivatives of u and w jump, and lam1, t1, t2 themselves, as printed",
}

CASE = Case(
    title="Orders of continuity at the contact front",
    source="Patil, Nordmark & Eriksson (2014), table 1",
    checks=tuple(
        Claim(
            KINDS[kind][0].replace(" ", "_"),
            statement,
            ((KINDS[kind][1], state(kind)),),
            lambda solutions, kind=kind: continuity(kind, solutions),
        )
        for kind, statement in STATEMENTS.items()
    ),
    quick=False,
)
