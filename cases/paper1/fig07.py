"""Paper 1, figure 7: stretches along the radius and the isotropic zone, frictionless, alpha = 0.1, beta = 1.

X_iso is the first X at which lam1 and lam2 differ by 1e-4. The stretches go with p^(2/3) at small pressure,
hence X_iso with p^(-1/3); it falls in free inflation and rises again once contact has formed.
"""

import numpy as np

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular

SLIP = circular(alpha=0.1, beta=1, contact="frictionless", p_end=7.2)
FREE = circular(alpha=0.1, beta=1)
STATES = ((FREE, 1.64), (SLIP, 4.82), (SLIP, 5.95))
"""The paper's first curve, p = 0, is lam1 = lam2 = 1."""


def power(solutions: Solutions) -> Finding:
    """Exponent of X_iso(p) as p falls."""
    values = {
        p: solutions.value(circular(alpha=0.1, beta=1, l=1), At("p", p), "X_iso") for p in (0.05, 0.1, 0.2)
    }
    found = [np.log(values[b] / values[a]) / np.log(b / a) for a, b in ((0.05, 0.1), (0.1, 0.2))]
    return abs(found[0] + 1 / 3) < abs(found[1] + 1 / 3) < 0.02, "observed " + ", ".join(
        f"{e:.4f}" for e in found
    )


def least_at_contact(solutions: Solutions) -> Finding:
    """Where X_iso(p) is least, along the branch."""
    columns = solutions.branch(SLIP).columns
    (onset,) = solutions.points(SLIP, "contact_onset")
    i = int(np.argmin(columns["X_iso"]))
    p = columns["p"]
    good = (
        p[max(i - 1, 0)] <= onset.values["p"] <= p[min(i + 2, len(p) - 1)]
        and columns["X_iso"][-1] > 2 * columns["X_iso"][i]
    )
    return bool(
        good
    ), f"least X_iso = {columns['X_iso'][i]:.4f} at p = {p[i]:.3f}; first contact at {onset.values['p']:.3f}"


def nearly_equal(solutions: Solutions) -> Finding:
    """Largest |lam1 - lam2| on the patch up to p = 7."""
    worst = 0.0
    for p in (4.82, 5.95, 7.0):
        at = At("p", p, profile=())
        columns = solutions.profile(SLIP, at).columns
        inside = columns["X"] < solutions.value(SLIP, at, "X_contact")
        worst = max(worst, float(np.abs(columns["lam1"] - columns["lam2"])[inside].max()))
    return worst < 0.05, f"largest difference on the patch, p = 4.82, 5.95 and 7: {worst:.3f}"


CASE = Case(
    title="Stretches and the isotropic zone, frictionless",
    source="Patil, DasGupta & Eriksson (2015), figure 7",
    panels=(
        *(
            Panel(
                f"a, {column}",
                x=Axis("X", 0, 1),
                y=Axis(column, 0.8, 1.6),
                title="free and frictionless",
                curves=tuple(
                    Curve(of, f"$p = {p:g}$", reference=f"fig07a_p_{p:g}", at=At("p", p), y=column)
                    for of, p in STATES
                ),
            )
            for column in ("lam1", "lam2")
        ),
        Panel(
            "b",
            x=Axis("p", 0, 7),
            y=Axis("X_iso", 0, 0.35),
            title="radius of the zone with |lam1 - lam2| < 1e-4",
            markers="contact_onset",
            curves=(Curve(SLIP, r"$\alpha = 0.1$, $\beta = 1$", reference="fig07b_iso"),),
        ),
    ),
    checks=(
        Claim(
            "power",
            "X_iso falls like p^(-1/3) at small pressure",
            tuple((circular(alpha=0.1, beta=1, l=1), At("p", p)) for p in (0.05, 0.1, 0.2)),
            power,
        ),
        Claim(
            "least_at_contact",
            "X_iso is least at first contact and grows after it",
            ((SLIP, None),),
            least_at_contact,
        ),
        Claim(
            "nearly_equal",
            "in contact both stretches are nearly equal",
            tuple((SLIP, At("p", p, profile=())) for p in (4.82, 5.95, 7.0)),
            nearly_equal,
        ),
    ),
    asked={
        "rho": 1e-6,
        "eta": 1e-6,
        "lam1": 1e-5,
        "lam2": 1e-6,
        "t1": 1e-4,
        "t2": 1e-4,
        "sigma": 1e-4,
        "X_iso": 1e-4,
        "t0": 1e-6,
    },
)
