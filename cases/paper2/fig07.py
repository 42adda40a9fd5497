"""Paper 2, figure 7: principal stretches along the constrained tube, alpha = 0.1, delta1 = 1.

(a) frictionless, (b) adhesive inflation, (c) adhesive deflation with a bilateral spring. The tables do not
contain points within 0.02 of the front, where the stretches have kinks or jumps.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, tube

SLIP = tube(contact="frictionless", alpha=0.1, delta1=1)
STICK = tube(contact="adhesive", alpha=0.1, delta1=1)
BONDED = STICK.at(phase="deflation", spring="bilateral")
UP, DOWN = (1.6, 2, 2.5, 3), (3, 2, 1, 0)
PANELS = (
    ("a", "frictionless", SLIP, UP),
    ("b", "adhesive inflation", STICK, UP),
    ("c", "adhesive deflation", BONDED, DOWN),
)


def frozen(solutions: Solutions) -> Finding:
    """lam1 at the mid-plane after first touch, in adhesive inflation and deflation."""
    up, down = (
        solutions.numbers(spec, [At("p", float(p)) for p in pressures], "lam1_mid")
        for spec, pressures in ((STICK, UP), (BONDED, DOWN))
    )
    return decide.constant("lam1_mid", decide.join([up, down]), 1e-9)


HIGH = decide.Stated(1.2, "high", "no number is printed; four fifths of the rise to the substrate at 1.3")


def where_largest(solutions: Solutions) -> Finding:
    """lam1 is largest at the disk and lam2 high in the centre, for both contact laws."""
    found = []
    for spec, p in ((spec, p) for spec in (SLIP, STICK) for p in UP):
        lam1, lam2 = (
            solutions.column(spec, At("p", float(p), profile=()), name) for name in ("lam1", "lam2")
        )
        found.append(decide.positive(f"p = {p}: lam1 at the end minus lam1 elsewhere", lam1[-1] - lam1[:-1]))
        found.append(decide.at_least("lam2, centre over end", lam2[0] / lam2[-1], HIGH))
    return decide.all_of(found)


CASE = Case(
    title="Stretches along the constrained tube",
    source="Patil, Nordmark & Eriksson (2014), figure 7",
    panels=tuple(
        Panel(
            f"{letter}, {column}",
            x=Axis("Z", 0, 6),
            y=Axis(column, 0.9, 1.5),
            title=title,
            mirrored=True,
            curves=tuple(
                Curve(of, rf"$p = {p}$", reference=f"fig07{letter}_p_{p}", at=At("p", float(p)), y=column)
                for p in pressures
            ),
        )
        for letter, title, of, pressures in PANELS
        for column in ("lam1", "lam2")
    ),
    checks=(
        Claim(
            "frozen",
            "lam1 at the mid-plane keeps its value at first touch in adhesive inflation and deflation",
            tuple((STICK, At("p", float(p))) for p in UP) + tuple((BONDED, At("p", float(p))) for p in DOWN),
            frozen,
        ),
        Claim(
            "where_largest",
            "lam1 is largest at the ends, lam2 high in the centre",
            tuple((spec, At("p", float(p), profile=())) for spec in (SLIP, STICK) for p in UP),
            where_largest,
        ),
    ),
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-5, "t2": 2e-6},
)
