"""Paper 1, figure 10: contact stress over the radius, alpha = 0.1, beta = 1; negative is compression.

(a) frictionless, (b) adhesive inflation, (c) adhesive deflation from p = 3.477. The printed axis of (c) is
wider than necessary for the locked patch with its vertical balance.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    PrintedInput,
    Solutions,
    circular,
    decide,
)

SLIP = circular(alpha=0.1, beta=1, contact="frictionless", p_end=6.5)
STICK = circular(alpha=0.1, beta=1, contact="adhesive", p_end=4.0)
DOWN = circular(alpha=0.1, beta=1, contact="adhesive", phase="deflation")
SAME_STATE = {4.83: "fig03a_p_4.83", 1.4: "fig05a_p_1.4", 3.2: "fig05a_p_3.2"}
PANELS = (
    ("a", "frictionless", SLIP, (2.79, 3.74, 4.83, 5.281, 5.963), (-8, 0)),
    ("b", "adhesive inflation", STICK, (2.591, 2.887, 3.059, 3.238, 3.726), (-6, 0)),
    ("c", "adhesive deflation", DOWN, (0.4, 1.0, 1.4, 2.8, 3.2), (-10, 15)),
)

HUNDREDTHS = tuple(k / 100 for k in range(45, 66))
"""Pole heights in contact, around the substrate at l = 0.5, that count as round numbers."""


def compressive_in_inflation(solutions: Solutions) -> Finding:
    """Sign of the contact stress on the patch, and its zero at the edge."""
    found = []
    for _, _, of, pressures, _ in PANELS[:2]:
        for p in pressures:
            at = At("p", p, profile=())
            inside = solutions.profile(of, at).columns["X"] < solutions.value(of, at, "X_contact")
            found.append(decide.negative(f"sigma, p = {p}", solutions.column(of, at, "sigma")[inside]))
            edge, pole = (solutions.number(of, at, name) for name in ("sigma_contact", "sigma_pole"))
            found.append(decide.zero("sigma at the edge", edge, 5e-10, abs(pole)))
    return decide.all_of(found)


CASE = Case(
    title="Contact stress",
    source="Patil, DasGupta & Eriksson (2015), figure 10",
    panels=tuple(
        Panel(
            letter,
            x=Axis("X", 0, 1),
            y=Axis("sigma", *limits),
            title=title,
            curves=tuple(
                Curve(
                    of, f"$p = {p:g}$", reference=SAME_STATE.get(p, f"fig10{letter}_p_{p:g}"), at=At("p", p)
                )
                for p in pressures
            ),
        )
        for letter, title, of, pressures, limits in PANELS
    ),
    checks=(
        Claim(
            "compressive_in_inflation",
            "in inflation the contact stress is compressive and vanishes at the edge",
            tuple((of, At("p", p, profile=())) for _, _, of, ps, _ in PANELS[:2] for p in ps),
            compressive_in_inflation,
        ),
        *(
            PrintedInput(
                f"pressure {p} of figure 10b",
                str(p),
                STICK,
                At("p", p),
                "t0",
                searched=HUNDREDTHS,
                within=3e-3,
                source="legend of figure 10b",
                decoded=False,
            )
            for p in PANELS[1][3]
        ),
    ),
    asked={"rho": 1e-7, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-5, "t2": 5e-6, "sigma": 1e-7},
)
