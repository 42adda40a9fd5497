"""Paper 2, figure 9: profiles at p = 3 against the substrate, (a) frictionless, (b) adhesive."""

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, tube

SETS = ((0, 1), (0, 2), (0.1, 1), (0.1, 2))
SLIP = {s: tube(contact="frictionless", alpha=s[0], delta1=s[1]) for s in SETS}
STICK = {s: tube(contact="adhesive", alpha=s[0], delta1=s[1]) for s in SETS}
END = At("p", 3.0)


def overhang(solutions: Solutions) -> Finding:
    """How far eta exceeds its value at the disk, frictionless, delta1 = 1."""
    rows = {}
    for alpha in (0, 0.1):
        at = At("p", 3.0, profile=FINE)
        eta = solutions.profile(SLIP[alpha, 1], at).columns["eta"]
        rows[alpha] = eta.max() - 3.0
    return 0 < rows[0] < 1e-3 and rows[0.1] <= 1e-12, ", ".join(
        f"alpha = {a}: {v:.2e}" for a, v in rows.items()
    )


FINE = tuple(2.9 + 0.1 * i / 40 for i in range(41))

CASE = Case(
    title="Constrained profiles",
    source="Patil, Nordmark & Eriksson (2014), figure 9",
    panels=tuple(
        Panel(
            letter,
            x=Axis("eta", 0, 6),
            y=Axis("rho", 1, 2),
            title=title,
            mirrored=True,
            curves=tuple(
                Curve(
                    curves[s],
                    rf"$\alpha = {s[0]}$, $\delta_1 = {s[1]}$",
                    reference=f"fig09{letter}_alpha_{s[0]}_delta1_{s[1]}",
                    at=END,
                )
                for s in SETS
            ),
        )
        for letter, title, curves in (("a", "frictionless, p = 3", SLIP), ("b", "adhesive, p = 3", STICK))
    ),
    checks=(
        Claim(
            "overhang",
            "the unstretched neo-Hookean wall just begins to overhang the disk at p = 3 (eta exceeds its end "
            "value by less than 1e-3); the Mooney-Rivlin one does not",
            tuple((SLIP[a, 1], At("p", 3.0, profile=FINE)) for a in (0, 0.1)),
            overhang,
        ),
    ),
    asked={"rho": 1e-6, "eta": 1e-6, "lam1": 1e-5, "lam2": 1e-6, "t1": 1e-4, "t2": 1e-4},
)
