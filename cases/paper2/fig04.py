"""Paper 2, figure 4: principal stretches along the unstretched Mooney-Rivlin tube.

The paper marks the pressures in the picture only; here p = 0.5, 1, 1.5, 1.9 on the first branch, and the
first limit point.
"""

from itertools import pairwise

from weakforms import At, Axis, Case, Claim, Constant, Curve, Finding, Panel, Solutions, tube

TUBE = tube(alpha=0.1, delta1=1)
PRESSURES = (0.5, 1, 1.5, 1.9)
STATES = [(f"p_{p}", At("p", float(p)), rf"$p = {p}$") for p in PRESSURES] + [
    ("limit_1", At("limit_point", 1.0), "limit point")
]
FINE = tube(alpha=0.1, delta1=1).on(degree=5, cells=192)
"""The first integrals contain derivatives of the solution; degree 5 resolves them to 1e-8 at the disk."""
WHOLE = At("p", 1.5, profile=())


def boundary_stretches(solutions: Solutions) -> Finding:
    """At the disk lam2 = 1 exactly and lam1 > 1, at every pressure."""
    rows = []
    for p in PRESSURES:
        columns = solutions.profile(TUBE, At("p", float(p), profile=())).columns
        rows.append((columns["lam1"][-1], columns["lam2"][-1]))
    good = all(l1 > 1 and abs(l2 - 1) < 1e-12 for l1, l2 in rows)
    return good, "lam1 at the disk: " + ", ".join(f"{l1:.5f}" for l1, _ in rows)


def flat_middle(solutions: Solutions) -> Finding:
    """At low pressure the middle is flat; bulging there grows with pressure."""
    drops = []
    for p in PRESSURES:
        columns = solutions.profile(TUBE, At("p", float(p), profile=())).columns
        middle = columns["Z"] <= 1.0
        rho = columns["rho"][middle]
        drops.append((rho[0] - rho[-1]) / (rho[0] - 1))
    rises = all(a < b for a, b in pairwise(drops))
    return rises and drops[0] < 0.02, "relative drop of u over |Z| <= 1: " + ", ".join(
        f"{d:.2e}" for d in drops
    )


PROFILES = tuple((TUBE, At("p", float(p), profile=())) for p in PRESSURES)

CASE = Case(
    title="Principal stretches along the tube",
    source="Patil, Nordmark & Eriksson (2014), figure 4",
    panels=tuple(
        Panel(
            name,
            x=Axis("Z", 0, 6),
            y=Axis(column, 0.8, 2.2),
            title=r"$\alpha = 0.1$, $\delta_1 = 1$",
            mirrored=True,
            curves=tuple(
                Curve(TUBE, label, reference=f"fig04_{key}", at=at, y=column) for key, at, label in STATES
            ),
            note="" if name == "lam1" else "Both panels are one picture in the paper.",
        )
        for name, column in (("lam1", "lam1"), ("lam2", "lam2"))
    ),
    checks=(
        Claim(
            "boundary_stretches",
            "lam1 > 1 and lam2 = 1 at the fixed boundary, at every pressure",
            PROFILES,
            boundary_stretches,
        ),
        Claim(
            "flat_middle",
            "at low pressure the profile is flat in the middle; bulging at the centre grows with pressure",
            PROFILES,
            flat_middle,
        ),
        *(
            Constant(column, FINE, at, 1e-8, statement)
            for at in (At("p", 1.5, profile=()), At("u_max", 3.0, profile=()))
            for column, statement in (
                ("F_axial", "the axial resultant F is constant along the membrane"),
                ("H", "the first integral H = w - lam1 w_1 is constant along the membrane"),
            )
        ),
    ),
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-6, "lam2": 1e-6, "t1": 1e-6, "t2": 1e-6},
)
