"""Paper 2, figure 4: principal stretches along the unstretched Mooney-Rivlin tube.

The paper marks the pressures in the picture only; here p = 0.5, 1, 1.5, 1.9 on the first branch, and the
first limit point.
"""

import numpy as np

from weakforms.cases import At, Axis, Case, Claim, Constant, Curve, Finding, Panel, Solutions, decide, tube

TUBE = tube(alpha=0.1, delta1=1)
PRESSURES = (0.5, 1, 1.5, 1.9)
STATES = [(f"p_{p}", At("p", float(p)), rf"$p = {p}$") for p in PRESSURES] + [
    ("limit_1", At("limit_point", 1.0), "limit point")
]
FINE = tube(alpha=0.1, delta1=1).on(degree=5, cells=192)
"""The first integrals contain derivatives of the solution; degree 5 resolves them to 1e-8 at the disk."""
WHOLE = At("p", 1.5, profile=())


def boundary_stretches(solutions: Solutions) -> Finding:
    """At the disk lam2 = 1 and lam1 > 1, at every pressure."""
    ends = {
        name: decide.stack(solutions.column(TUBE, At("p", float(p), profile=()), name)[-1] for p in PRESSURES)
        for name in ("lam1", "lam2")
    }
    return decide.all_of(
        decide.positive("lam1 - 1", ends["lam1"] - 1),
        decide.agree("lam2", ends["lam2"], np.ones(len(PRESSURES)), 1e-9),
    )


def flat_middle(solutions: Solutions) -> Finding:
    """At low pressure the middle is flat; bulging there grows with pressure."""
    drops = []
    for p in PRESSURES:
        at = At("p", float(p), profile=())
        rho = solutions.column(TUBE, at, "rho")[solutions.profile(TUBE, at).columns["Z"] <= 1.0]
        drops.append((rho[0] - rho[-1]) / (rho[0] - 1))
    return decide.all_of(
        decide.rises("relative drop of u over |Z| <= 1", drops),
        decide.at_most(f"at p = {PRESSURES[0]}", drops[0], FLAT),
    )


FLAT = decide.Stated(
    0.02, "flat in the middle", "no number is printed; a fiftieth of the displacement is a line's width"
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
            Constant(column, FINE, at, 1e-9, statement)
            for at in (At("p", 1.5, profile=()), At("u_max", 3.0, profile=()))
            for column, statement in (
                ("F_axial", "the axial resultant F is constant along the membrane"),
                ("H", "the first integral H = w - lam1 w_1 is constant along the membrane"),
            )
        ),
    ),
    asked={"rho": 1e-9, "eta": 1e-9, "lam1": 1e-6, "lam2": 1e-9, "t1": 1e-6, "t2": 1e-6},
)
