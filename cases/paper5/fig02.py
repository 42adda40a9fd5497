"""Paper 5, figure 2 and section 2.3: a flat wrinkled patch under pressure is unstable at any wave number.

The perturbation leaves the direction of tension as it is, so that the strain energy stays the same, while the
pressure's potential falls as printed in equation 33. The figure is drawn with a = 1, e = 0.08, c = 0.1 and
n = 10: a curve with steep flanks.
"""

import numpy as np

from weakforms import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, wrinkled_patch

DRAWN = wrinkled_patch(a=1.0, c=0.1, n=10.0, e_end=0.08)
FLAT, BENT = At("e", 0.0, profile=()), At("e", 0.08, profile=())
SMALL = At("e", 0.03)
PATCHES = {
    (n, length): wrinkled_patch(n=n, Lx=length) for n, length in ((5.0, 1.0), (10.0, 1.0), (10.0, 2.5))
}
A, B, C = 0.3, 2.0, 0.1
"""Stretches and height of these patches (the defaults)."""


def bracket(n: float, length: float) -> tuple[float, float]:
    """What multiplies e and e^2 in the printed potential."""
    linear = (A / n + C) * np.sin(n * length)
    return linear, n * length / 2 + np.sin(2 * n * length) / 4


def printed(solutions: Solutions) -> Finding:
    """Potential and its two derivatives against equation 33."""
    worst, bound = 0.0, 0.0
    for (n, length), spec in PATCHES.items():
        linear, square = bracket(n, length)
        for at, e in ((At("e", 0.0), 0.0), (SMALL, SMALL.value)):
            exact = {
                "W": -B * (A * length * C + e * linear + e**2 * square),
                "W_e": -B * (linear + 2 * e * square),
                "W_ee": -2 * B * square,
            }
            for name, value in exact.items():
                found = solutions.quantity(spec, at, name)
                worst = max(worst, abs(found.value - value) / max(1.0, abs(value)))
                bound = max(bound, 2 * found.uncertainty / max(1.0, abs(value)))
    return worst <= bound <= 1e-8, f"largest difference {worst:.0e} <= {bound:.0e}"


def strain_unchanged(solutions: Solutions) -> Finding:
    """Strain energy at e = 0.03 and at 0, its derivatives, the shear of the metric."""
    worst = 0.0
    for spec in PATCHES.values():
        flat, bent = (solutions.state(spec, at).quantities for at in (At("e", 0.0), SMALL))
        worst = max(worst, abs(bent["U"].value / flat["U"].value - 1), bent["shear"].value)
        worst = max(worst, *(abs(q[k].value) for q in (flat, bent) for k in ("U_e", "U_ee")))
    return worst < 1e-12, f"{worst:.0e}"


def grows_with_n(solutions: Solutions) -> Finding:
    """Second derivative of the whole potential in e, over the length."""
    found = {key: solutions.value(spec, At("e", 0.0), "W_ee") / key[1] for key, spec in PATCHES.items()}
    return bool(all(v < 0 for v in found.values()) and found[10.0, 1.0] < found[5.0, 1.0]), ", ".join(
        f"n = {n:g}, Lx = {length:g}: {v:.4f}" for (n, length), v in found.items()
    )


def overhangs(solutions: Solutions) -> Finding:
    """Where x falls along the drawn curve; height of the flat line."""
    columns = solutions.profile(DRAWN, BENT).columns
    flat = solutions.profile(DRAWN, FLAT).columns
    slope = 1 + BENT.value * 10 * np.cos(10 * columns["X"])
    swing = np.ptp(columns["z"])
    return bool(abs(swing - 0.16) < 2e-3 and np.ptp(flat["z"]) == 0 and slope.min() < 0.25), (
        f"x' between {slope.min():.2f} and {slope.max():.2f}: steep flanks; swing {swing:.4f}"
    )


CASE = Case(
    title="A flat wrinkled patch under pressure",
    source="Patil, Nordmark & Eriksson (2016), figure 2 and equation 33",
    panels=(
        Panel(
            "a",
            x=Axis("x", 0, 1),
            y=Axis("z", 0, 0.2),
            title="$a = 1$, $e = 0.08$, $c = 0.1$, $n = 10$",
            curves=(Curve(DRAWN, "flat", at=FLAT), Curve(DRAWN, "perturbed", at=BENT)),
            note="An illustration: with a = 1 no tension along Y leaves the patch wrinkled.",
        ),
    ),
    checks=(
        Claim(
            "printed",
            "the pressure's potential is equation 33, with its derivatives",
            tuple((spec, at) for spec in PATCHES.values() for at in (At("e", 0.0), SMALL)),
            printed,
        ),
        Claim(
            "strain_unchanged",
            "the relaxed energy does not change: the stretch along Y is b for any e",
            tuple((spec, at) for spec in PATCHES.values() for at in (At("e", 0.0), SMALL)),
            strain_unchanged,
        ),
        Claim(
            "grows_with_n",
            "the second variation is negative and falls with n",
            tuple((spec, At("e", 0.0)) for spec in PATCHES.values()),
            grows_with_n,
        ),
        Claim(
            "overhangs",
            "the perturbed curve has steep flanks about the flat line",
            ((DRAWN, FLAT), (DRAWN, BENT)),
            overhangs,
        ),
    ),
    quick=True,
)
