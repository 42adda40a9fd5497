"""Paper 2, figure 9: profiles at p = 3 against the substrate, (a) frictionless, (b) adhesive."""

import numpy as np

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


def bulges(solutions: Solutions) -> Finding:
    """Slope of the wall at the disk and radius at the middle, frictionless."""
    good, rows = True, []
    for alpha in (0, 0.1):
        slope, middle = {}, {}
        for d in (1, 2):
            columns = solutions.profile(SLIP[alpha, d], At("p", 3.0, profile=())).columns
            rise, run = (abs(columns[name][-1] - columns[name][-2]) for name in ("rho", "eta"))
            slope[d], middle[d] = np.degrees(np.arctan2(rise, run)), columns["rho"][0]
        good &= slope[1] > slope[2] + 20 and middle[2] > middle[1]
        rows.append(f"alpha = {alpha}: {slope[1]:.1f} and {slope[2]:.1f} degrees")
    return bool(good), "delta1 = 1 and 2: " + "; ".join(rows)


def plateau(solutions: Solutions) -> Finding:
    """w_2 = P_eff rho lam1 at the mid-plane, that is t2 = P_eff rho, on the unstretched tube's plateau."""
    rows = []
    for alpha in (0, 0.1):
        columns = solutions.profile(SLIP[alpha, 1], At("p", 3.0, profile=())).columns
        rho, t2 = columns["rho"][0], columns["t2"][0]
        effective = 3.0 - 20 * ((rho - 1.3) + (rho - 1.3) ** 2 / (2 * rho))
        rows.append(abs(t2 / (effective * rho) - 1))
    return max(rows) < 1e-4, "relative defect: " + ", ".join(f"{r:.1e}" for r in rows)


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
            "bulges",
            "pre-stretched profiles bulge in radius, unstretched ones flatten and bulge sideways",
            tuple((SLIP[s], At("p", 3.0, profile=())) for s in SETS),
            bulges,
        ),
        Claim(
            "plateau",
            "on the frictionless plateau of the unstretched tube w_2 = P_eff rho lam1 holds up to the small "
            "curvature term",
            tuple((SLIP[a, 1], At("p", 3.0, profile=())) for a in (0, 0.1)),
            plateau,
        ),
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
