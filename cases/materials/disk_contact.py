"""Adhesive contact, deflation and peeling of the circular membrane of paper 1 with other rubbers.

Ogden's and Gent's. States, curves and pull-off points are compared with the paper's reference codes, which
implement the laws separately.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    circular,
    decide,
)

P_END = {"ogden": 1.7, "gent": 3.2}
"""Pressure at which deflation starts."""
FARTHEST = {"ogden": 2.0, "gent": 3.6}
"""End of inflation, at a front beyond those of the tables."""
PEELING = {"ogden": 0.7, "gent": 1.4}
"""Pressures of peeling, below first contact."""
STICK = {m: circular(model=m, contact="adhesive", p_end=p) for m, p in FARTHEST.items()}
DOWN = {m: circular(model=m, contact="adhesive", phase="deflation", p_end=p) for m, p in P_END.items()}
PEEL = {m: STICK[m].at(phase="peeling", p=p) for m, p in PEELING.items()}


def stable_side(solutions: Solutions) -> Finding:
    """Negative eigenvalues, with the front as a degree of freedom, on both sides of the pull-off point."""
    found = []
    for model, spec in PEEL.items():
        counts = solutions.branch(spec).columns["n_negative"]
        left, right = decide.sides(
            solutions.along(spec, "rho_contact"), solutions.point(spec, "pull_off", "rho_contact")
        )
        found.append(decide.every(f"{model}: one left of it", counts[left] == 1))
        found.append(decide.every("none right of it", counts[right] == 0))
    return decide.all_of(found)


def both_ways(solutions: Solutions) -> Finding:
    """G in closed form against differences of potentials."""
    return decide.all_of(
        decide.agree(m, solutions.along(spec, "G_difference"), solutions.along(spec, "G"), 1e-5)
        for m, spec in PEEL.items()
    )


CASE = Case(
    title="Adhesive contact of the circular membrane with other laws",
    source="the problem of Patil, DasGupta & Eriksson (2015) with laws of the thesis's chapter 3",
    panels=tuple(
        Panel(kind, x=x, y=y, title=title, markers=marked, note="Not a figure of the paper.", curves=curves)
        for kind, x, y, title, marked, curves in (
            (
                "inflation",
                Axis("p", 0, 4),
                Axis("t0", 0, 0.8),
                "adhesive inflation",
                "contact_onset",
                tuple(Curve(spec, m, reference=f"disk_adhesive_{m}") for m, spec in STICK.items()),
            ),
            (
                "deflation",
                Axis("p", 0, 4),
                Axis("t0", 0, 0.8),
                "adhesive deflation",
                (),
                tuple(Curve(spec, m, reference=f"disk_deflation_{m}") for m, spec in DOWN.items()),
            ),
            (
                "peeling",
                Axis("rho_contact", 0, 0.6),
                Axis("G", 0, 0.4),
                "peeling at a pressure below first contact",
                "pull_off",
                tuple(Curve(spec, m, reference=f"disk_peeling_{m}") for m, spec in PEEL.items()),
            ),
        )
    ),
    checks=(
        Count("pull_off", dict.fromkeys(PEEL.values(), 1), "one pull-off point below first contact"),
        *(
            Points(
                "pull_off",
                reference=f"disk_pull_off_{m}",
                base=spec,
                parameters=("p",),
                asked={"rho_contact": 1e-6, "G": 1e-6},
            )
            for m, spec in PEEL.items()
        ),
        Claim(
            "stable_side",
            "also with these laws, patches larger than that of the pull-off point are stable against peeling",
            tuple((spec, None) for spec in PEEL.values()),
            stable_side,
        ),
        Claim(
            "both_ways",
            "the closed form of the energy release rate holds for every law",
            tuple((spec, None) for spec in PEEL.values()),
            both_ways,
        ),
    ),
    asked={
        **dict.fromkeys(("p", "X_contact", "sigma_contact"), 1e-7),
        **dict.fromkeys(("t0", "rho_contact", "lam1_contact", "lam1_contact_outer", "sigma_pole"), 2e-7),
        "V": 5e-7,
        "lam1_rim": 1e-5,
        "G": 1e-6,
    },
    slow=True,
)
