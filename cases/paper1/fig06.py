"""Paper 1, figure 6: frictionless against adhesive contact at equal pressure, with and without pre-stretch.

(a) neo-Hookean at p = 4 (above the limit pressures of free inflation, which is possible with the substrate),
(b) Mooney-Rivlin at p = 6.
"""

import numpy as np
from scipy.interpolate import CubicSpline

from weakforms.cases import At, Axis, Case, Claim, Curve, Finding, Panel, Solutions, circular, decide

PANELS = (("a", 0, 4.0, "neo-Hookean"), ("b", 0.1, 6.0, "Mooney-Rivlin"))
LAWS = ("frictionless", "adhesive")
PAIRS = {
    (alpha, beta, law): circular(alpha=alpha, beta=beta, contact=law, p_end=p + 0.5)
    for _, alpha, p, _ in PANELS
    for beta in (1, 2)
    for law in LAWS
}
FREE = {beta: circular(alpha=0, beta=beta, t_end=3.1).on(cells=192) for beta in (1, 2)}
AT = {alpha: At("p", p) for _, alpha, p, _ in PANELS}


def stick_indents_more(solutions: Solutions) -> Finding:
    """Pole height, peak stress, mean gradient of the stress and contact radius of both laws."""
    found = []
    for alpha, at in AT.items():
        for beta in (1, 2):
            slip, stick = (
                {
                    name: solutions.number(PAIRS[alpha, beta, law], at, name)
                    for name in ("t0", "sigma_pole", "X_contact", "rho_contact")
                }
                for law in LAWS
            )
            gradient = [abs(v["sigma_pole"]) / v["X_contact"] for v in (slip, stick)]
            found += [
                decide.less("t0", slip["t0"], stick["t0"]),
                decide.less("sigma_pole", stick["sigma_pole"], slip["sigma_pole"], 0),
                decide.less("mean gradient", *gradient),
                decide.less("rho_contact", stick["rho_contact"], slip["rho_contact"]),
            ]
    return decide.all_of(found)


INSIDE, SAME_POINT = 0.95, 1e-9
"""Part of the larger patch's radius from which a profile is fitted, and distance of points that are one."""


def apart(solutions: Solutions, alpha: float, beta: int) -> decide.Number:
    """Largest distance of the frictionless profile from the adhesive one, outside both patches."""
    at = At("p", AT[alpha].value, profile=())
    specs = [PAIRS[alpha, beta, law] for law in LAWS]
    edge = max(solutions.value(spec, at, "rho_contact") for spec in specs)
    slip, stick = (solutions.profile(spec, at).columns for spec in specs)
    outside = slip["rho"] > edge
    points = np.column_stack([slip[name][outside] for name in ("rho", "eta")])
    # From a little inside on, which is beyond the smaller patch; some points are sampled twice.
    free = (stick["rho"] > INSIDE * edge) & (np.diff(stick["X"], append=2) > SAME_POINT)
    x, curve = stick["X"][free], np.column_stack([stick[name][free] for name in ("rho", "eta")])
    found = []
    for step in (1, 2):  # splines through all points of the other profile, and through every other one
        knots = x[::-step][::-1]
        dense = CubicSpline(knots, curve[::-step][::-1])(np.linspace(knots[0], knots[-1], 2000))
        found.append(np.linalg.norm(points[:, None] - dense, axis=2).min(axis=1).max())
    return decide.Number(found[0], abs(found[0] - found[1]))


def similar_outside(solutions: Solutions) -> Finding:
    """Distance of the profiles outside the patches; without pre-stretch beside that of the indentations."""
    away = {key: apart(solutions, *key) for key in ((alpha, beta) for alpha in AT for beta in (1, 2))}
    deeper = [solutions.number(PAIRS[0.1, 1, law], AT[0.1], "t0") for law in LAWS]
    return decide.all_of(
        *(decide.at_most(f"alpha = {alpha}, beta = 2", away[alpha, 2], SIMILAR) for alpha in AT),
        *(decide.at_least(f"alpha = {alpha}, beta = 1", away[alpha, 1], APART) for alpha in AT),
        decide.less("alpha = 0.1, beta = 1: indentations and profiles", deeper[1] - deeper[0], away[0.1, 1]),
    )


def above_the_limits(solutions: Solutions) -> Finding:
    """The pressure of (a), and the limit pressures of free inflation for both pre-stretches."""
    return decide.all_of(
        decide.less("limit pressure", solutions.point(FREE[beta], "limit_point", "p"), AT[0].value)
        for beta in (1, 2)
    )


APART = decide.Stated(0.015, "apart", "no number is printed; one and a half times a line of figure 6")
SIMILAR = decide.Stated(0.01, "very similar", "no number is printed; a line of figure 6 is as wide")
BEYOND = decide.Stated(1.01, "bulges beyond its clamp", "no number is printed; a line of figure 6 is as wide")


def bulges(solutions: Solutions) -> Finding:
    """Largest radius at p = 6, frictionless, Mooney-Rivlin, compared with the clamp's radius."""
    at = At("p", 6.0, profile=())
    reach = {b: solutions.column(PAIRS[0.1, b, LAWS[0]], at, "rho") for b in (1, 2)}
    return decide.all_of(
        decide.at_least("beta = 1", reach[1].largest(), BEYOND),
        decide.less("beta = 2, without the clamp", reach[2][:-1].largest(), 1),
    )


WANTS = tuple((spec, AT[key[0]]) for key, spec in PAIRS.items())

CASE = Case(
    title="Frictionless against adhesive contact",
    source="Patil, DasGupta & Eriksson (2015), figure 6",
    panels=tuple(
        Panel(
            letter,
            x=Axis("rho", 0, 1.2),
            y=Axis("eta", 0, 1.0),
            level=0.5,
            title=f"{material}, p = {p:g}",
            curves=tuple(
                Curve(
                    PAIRS[alpha, beta, law],
                    rf"{law}, $\beta = {beta}$",
                    reference=f"fig06{letter}_{law}_beta_{beta}",
                    at=At("p", p),
                )
                for beta in (1, 2)
                for law in LAWS
            ),
        )
        for letter, alpha, p, material in PANELS
    ),
    checks=(
        Claim(
            "stick_indents_more",
            "at equal pressure adhesive contact has the deeper indentation, the larger peak stress and mean "
            "gradient of the stress, and the smaller patch",
            WANTS,
            stick_indents_more,
        ),
        Claim(
            "similar_outside",
            "outside the patch the profiles of both laws are very similar with pre-stretch",
            tuple((spec, At("p", AT[key[0]].value, profile=())) for key, spec in PAIRS.items()),
            similar_outside,
            differs="the text says that the profiles are very similar outside the patch and differ in it; "
            "without pre-stretch they are as far apart outside as the indentations differ, or farther",
        ),
        Claim(
            "above_the_limits",
            "p = 4 is above the limit pressures of free inflation for both pre-stretches",
            (*((spec, None) for spec in FREE.values()), *WANTS),
            above_the_limits,
        ),
        Claim(
            "bulges",
            "without pre-stretch the membrane bulges beyond its clamp at a pressure at which the "
            "stretched one "
            "does not",
            tuple((PAIRS[0.1, b, LAWS[0]], At("p", 6.0, profile=())) for b in (1, 2)),
            bulges,
        ),
    ),
    asked={"rho": 1e-7, "eta": 1e-6, "lam1": 1e-6, "lam2": 1e-6, "t1": 5e-6, "t2": 1e-6, "sigma": 1e-7},
)
