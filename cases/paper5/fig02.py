"""Paper 5, figure 2 and section 2.3: a flat wrinkled patch under pressure is unstable at any wave number.

The perturbation does not change the direction of tension, so that the strain energy is constant, while the
pressure's potential decreases as printed in equation 33. The figure is drawn with a = 1, e = 0.08, c = 0.1
and n = 10: a curve with steep flanks.
"""

import numpy as np

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, decide, wrinkled_patch

DRAWN = wrinkled_patch(a=1.0, c=0.1, n=10.0, e_end=0.08)
FLAT, BENT = At("e", 0.0, profile=()), At("e", 0.08, profile=())
SMALL = At("e", 0.03)
PATCHES = {
    (n, length): wrinkled_patch(n=n, Lx=length) for n, length in ((5.0, 1.0), (10.0, 1.0), (10.0, 2.5))
}
A, B, C = 0.3, 2.0, 0.1
"""Stretches and height of these patches (the defaults)."""


def bracket(n: float, length: float) -> tuple[float, float]:
    """Factors of e and e^2 in the printed potential."""
    linear = (A / n + C) * np.sin(n * length)
    return linear, n * length / 2 + np.sin(2 * n * length) / 4


def printed(solutions: Solutions) -> Finding:
    """Potential and its two derivatives against equation 33."""
    found = []
    for (n, length), spec in PATCHES.items():
        linear, square = bracket(n, length)
        for at, e in ((At("e", 0.0), 0.0), (SMALL, SMALL.value)):
            exact = {
                "W": -B * (A * length * C + e * linear + e**2 * square),
                "W_e": -B * (linear + 2 * e * square),
                "W_ee": -2 * B * square,
            }
            found += [
                decide.agree(name, solutions.number(spec, at, name), value, 1e-8, max(1.0, abs(value)))
                for name, value in exact.items()
            ]
    return decide.all_of(found)


def strain_unchanged(solutions: Solutions) -> Finding:
    """Strain energy at e = 0.03 and at 0, its derivatives, the shear of the metric."""
    found = []
    for spec in PATCHES.values():
        flat, bent = (solutions.state(spec, at).quantities for at in (At("e", 0.0), SMALL))
        found.append(decide.exact("U", bent["U"].value / flat["U"].value, 1.0))
        found.append(decide.exact("shear", bent["shear"].value, 0.0))
        found += [decide.exact(k, q[k].value, 0.0) for q in (flat, bent) for k in ("U_e", "U_ee")]
    return decide.all_of(found)


def grows_with_n(solutions: Solutions) -> Finding:
    """Second derivative of the whole potential in e, over the length."""
    found = {key: solutions.number(spec, At("e", 0.0), "W_ee") / key[1] for key, spec in PATCHES.items()}
    return decide.all_of(
        decide.negative("second variation over the length", decide.stack(found.values())),
        decide.less("n = 10 and n = 5", found[10.0, 1.0], found[5.0, 1.0]),
    )


STEEP = decide.Stated(0.25, "steep flanks", "no number is printed; less than a fourth of the flat line's")


def overhangs(solutions: Solutions) -> Finding:
    """Smallest slope of x along the drawn curve, and height of the flat line."""
    x = solutions.profile(DRAWN, BENT).columns["X"]
    z, flat = (solutions.profile(DRAWN, at).columns["z"] for at in (BENT, FLAT))
    slope = 1 + BENT.value * 10 * np.cos(10 * x)
    return decide.all_of(
        # Between sample points, the error of a sine's maximum is of the square of their distance.
        decide.agree(
            "swing",
            decide.Number(np.ptp(z), 2 * BENT.value * (10 * np.diff(x).max()) ** 2 / 8),
            2 * BENT.value,
            0.1,
        ),
        decide.exact("flat line", flat, np.full(len(flat), flat[0])),
        decide.at_most("least x'", slope.min(), STEEP),
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
            "the second variation is negative and decreases with n",
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
