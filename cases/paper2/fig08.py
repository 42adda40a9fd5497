"""Paper 2, figure 8: stress resultants along the tube, alpha = 0.1.

(a) adhesive inflation, delta1 = 1; (b) adhesive inflation of the pre-stretched tube, delta1 = 2; (c) adhesive
deflation, delta1 = 1. The paper's caption says "deflated" for all three.
"""

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, reference, tube

STICK = {d: tube(contact="adhesive", alpha=0.1, delta1=d) for d in (1, 2)}
BONDED = STICK[1].at(phase="deflation", spring="bilateral")
UP, DOWN = (1.6, 2, 2.5, 3), (3, 2, 1, 0)
PANELS = (
    ("a", "adhesive inflation, $\\delta_1 = 1$", STICK[1], "fig07b", UP, {"t1": (0, 2), "t2": (0, 4)}),
    ("b", "adhesive inflation, $\\delta_1 = 2$", STICK[2], "fig08b", UP, {"t1": (3, 7), "t2": (0, 4)}),
    ("c", "adhesive deflation, $\\delta_1 = 1$", BONDED, "fig07c", DOWN, {"t1": (0, 2), "t2": (0, 4)}),
)


def mid_plane_stress(solutions: Solutions) -> Finding:
    """t1 at the mid-plane over p = 1.6..3: rises for delta1 = 1, falls for delta1 = 2."""
    t1 = {d: solutions.numbers(STICK[d], [At("p", float(p)) for p in UP], "t1_mid") for d in (1, 2)}
    return decide.all_of(decide.rises("delta1 = 1", t1[1]), decide.falls("delta1 = 2", t1[2]))


def never_compressed(solutions: Solutions) -> Finding:
    """Smallest hoop resultant down to p = 0 with a bilateral spring."""
    return decide.positive("smallest t2", solutions.along(BONDED, "t2_min"))


def falls_in_deflation(solutions: Solutions) -> Finding:
    """Both resultants at points inside and outside the patch as the pressure falls."""
    rows = [At("p", float(p), profile=POINTS) for p in DOWN]
    return decide.all_of(
        decide.falls(
            f"{name} at Z = {z:g}",
            decide.stack(solutions.samples(BONDED, at, name)[POINTS.index(z)] for at in rows),
        )
        for name in ("t1", "t2")
        for z in POINTS
        if z not in BESIDE
    )


def jumps_grow(solutions: Solutions) -> Finding:
    """Jumps of lam1 and t1 at the edge of the patch as the pressure falls from 2.5."""
    rows = [At("p", float(p), profile=POINTS) for p in (2, 1, 0)]
    found = []
    for name in ("lam1", "t1"):
        inside, outside = (
            decide.stack(solutions.samples(BONDED, at, name)[POINTS.index(z)] for at in rows) for z in BESIDE
        )
        found.append(decide.rises(f"jump of {name}", inside - outside))
    return decide.all_of(found)


EDGE = float(reference(2, "fig06b_alpha_0.1_delta1_1").columns["Z_front"][-1])
"""Edge of the patch at p = 3, from which the tube deflates."""
BESIDE = (EDGE - 1e-4, EDGE + 1e-4)
POINTS = (0.0, 1.0, 2.0, *BESIDE, 2.8, 3.0)

CASE = Case(
    title="Stress resultants along the constrained tube",
    source="Patil, Nordmark & Eriksson (2014), figure 8",
    panels=tuple(
        Panel(
            f"{letter}, {column}",
            x=Axis("Z", 0, 6),
            y=Axis(column, *limits[column]),
            title=title,
            mirrored=True,
            curves=tuple(
                Curve(of, rf"$p = {p}$", reference=f"{table}_p_{p}", at=At("p", float(p)), y=column)
                for p in pressures
            ),
        )
        for letter, title, of, table, pressures, limits in PANELS
        for column in ("t1", "t2")
    ),
    checks=(
        Claim(
            "mid_plane_stress",
            "t1 at the mid-plane rises with p for delta1 = 1 and falls for delta1 = 2 in adhesive inflation "
            "(the text speaks of the stretch; it is the stress)",
            tuple((STICK[d], At("p", float(p))) for d in (1, 2) for p in UP),
            mid_plane_stress,
        ),
        Claim(
            "falls_in_deflation",
            "both resultants fall in deflation, inside and outside the patch",
            tuple((BONDED, At("p", float(p), profile=POINTS)) for p in DOWN),
            falls_in_deflation,
        ),
        Claim(
            "jumps_grow",
            "the jumps of lam1 and t1 at the edge of the patch grow as the pressure falls",
            tuple((BONDED, At("p", float(p), profile=POINTS)) for p in (2, 1, 0)),
            jumps_grow,
        ),
        Claim(
            "never_compressed",
            "with a bilateral spring no compressive stress appears down to p = 0",
            ((BONDED, None), (BONDED, At("p", 0.0))),
            never_compressed,
        ),
    ),
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-5, "t2": 2e-6},
)
