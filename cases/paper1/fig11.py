"""Paper 1, figures 11 and 12: energy release rate over the radius of the patch, and pull-off.

At a pressure below first contact G has a minimum: the pull-off point q. To the right of q the patch is stable
against peeling (dG/drho* > 0; solid), to the left it is not (dashed). Above first contact G rises from zero,
with zero slope, from the radius that adhesive inflation reaches at that pressure.
"""

import numpy as np
from scipy.interpolate import make_interp_spline

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    circular,
    decide,
    reference,
)

BASE = circular(contact="adhesive", phase="peeling")
SETS = {
    "fig11a": (BASE.at(alpha=0, beta=1, p_end=4.2), (1.2, 1.4, 1.6, 2.2, 2.4), 0.4),
    "fig11b": (BASE.at(alpha=0.1, beta=1, p_end=4.7), (1.2, 1.4, 1.6, 2.2, 2.4), 0.4),
    "fig12a": (BASE.at(alpha=0.1, beta=1, k=100, p_end=5.2), (1.4, 1.6, 1.8, 2.3, 2.7), 0.5),
    "fig12b": (BASE.at(alpha=0.1, beta=2, p_end=7.8), (2.4, 3.2, 3.8, 4.2, 5.6), 1.2),
}
"""Curve, pressures and height of the axis. Inflation ends at rho* = 0.6, the end of the axis, because G at a
pressure and radius does not depend on the end of inflation."""
HIGH = {"fig11a": (2.2, 2.4), "fig11b": (2.2, 2.4), "fig12a": (2.3, 2.7), "fig12b": (5.6,)}
START = reference(1, "release_start")
CURVES = {(name, p): spec.at(p=p) for name, (spec, pressures, _) in SETS.items() for p in pressures}
MR, NH, STIFF, STRETCHED = "fig11b", "fig11a", "fig12a", "fig12b"


def adhesive(spec: Spec) -> Spec:
    """The inflation at the start of a peeling curve."""
    kept = {name: value for name, value in spec.parameters if name not in ("phase", "p")}
    return circular(**kept)


ZERO_SLOPE = decide.Stated(
    0.2,
    "with zero slope",
    "over the first step; for a parabola it is a twentieth to a fifth of the mean slope",
)


def pull_off_moves(solutions: Solutions) -> Finding:
    """Radius and G of the pull-off points as the pressure rises."""
    found = []
    for name, (_, pressures, _) in SETS.items():
        low = [CURVES[name, p] for p in pressures if p not in HIGH[name]]
        for column in ("rho_contact", "G"):
            found.append(
                decide.falls(f"{name}, {column}", [solutions.point(s, "pull_off", column) for s in low])
            )
    return decide.all_of(found)


def both_ways(solutions: Solutions) -> Finding:
    """G in closed form against differences of potentials, along every curve."""
    return decide.all_of(
        decide.agree("G", solutions.along(spec, "G_difference"), solutions.along(spec, "G"), 1e-5)
        for spec in CURVES.values()
    )


def from_zero(solutions: Solutions) -> Finding:
    """Above first contact: G at the start of the curve, its increase, and its slope over the mean one."""
    found = []
    for name, pressures in HIGH.items():
        for p in pressures:
            g, branch = solutions.along(CURVES[name, p], "G")[::-1], solutions.branch(CURVES[name, p])
            rho = decide.Number(branch.columns["rho_contact"], branch.uncertainty["rho_contact"])[::-1]
            given = {"beta": 1, "k": 50} | dict(SETS[name][0].parameters) | {"p": p}
            row = np.all([START.columns[n] == given[n] for n in ("alpha", "beta", "k", "p")], axis=0)
            known = START.number("rho_contact")[row][0]
            reached = solutions.number(adhesive(SETS[name][0]), At("p", p), "rho_contact")
            slope = (g[1] - g[0]) / (rho[1] - rho[0]) / ((g[-1] - g[0]) / (rho[-1] - rho[0]))
            found += [
                decide.zero(f"{name}, p = {p:g}: G", g[0], 1e-5, g.largest()),
                decide.agree("rho* at the start", rho[0], known, 1e-6),
                decide.agree("rho* that inflation reaches", reached, known, 1e-6),
                decide.rises("G", g),
                decide.at_most("slope over mean slope", slope, ZERO_SLOPE),
            ]
    return decide.all_of(found)


def _common(solutions: Solutions, more: str, less: str, p: float) -> list[decide.Number]:
    """Two curves at equal pressure, over their common radii from q outwards."""
    curves = [CURVES[name, p] for name in (more, less)]
    radii = [solutions.branch(spec).columns["rho_contact"] for spec in curves]
    rho = np.linspace(max(r.min() for r in radii), min(r.max() for r in radii), 40)
    g = [solutions.along(spec, "G") for spec in curves]
    found = []
    for r, c in zip(radii, g, strict=True):
        # Between points of a trace a cubic spline has a smaller error than its distance from straight lines.
        curved = make_interp_spline(r[::-1], c.value[::-1])(rho)
        straight = np.interp(rho, r[::-1], c.value[::-1])
        found.append(decide.Number(curved, np.max(c.uncertainty) + np.abs(curved - straight)))
    return found


def grows(solutions: Solutions) -> Finding:
    """G of Mooney-Rivlin over neo-Hookean and of k = 100 over k = 50, at equal p and rho*."""
    pairs = [(MR, NH, p) for p in (1.2, 1.4, 1.6)] + [(STIFF, MR, p) for p in (1.4, 1.6)]
    found = []
    for a, b, p in pairs:
        more, less = _common(solutions, a, b, p)
        found.append(decide.positive(f"{a} over {b} at {p:g}, less 1", more / less - 1))
    return decide.all_of(found)


def at_high_pressure(solutions: Solutions) -> Finding:
    """Above first contact: G of Mooney-Rivlin less that of neo-Hookean, at equal p and rho*."""
    found = []
    for p in HIGH[MR]:
        more, less = _common(solutions, MR, NH, p)
        found.append(decide.positive(f"p = {p}", more - less))
    return decide.all_of(found)


def pre_stretch(solutions: Solutions) -> Finding:
    """Pre-stretched over not: G at equal p and rho*; q at a pressure that is nearer to first contact."""
    onset = reference(1, "disk_contact_onset")
    here = {b: (onset.columns["alpha"] == 0.1) & (onset.columns["beta"] == b) for b in (1, 2)}
    at_touch = [onset.number("p")[here[b] & (onset.columns["l"] == 0.5)][0] for b in (1, 2)]
    more, less = _common(solutions, STRETCHED, MR, 2.4)
    two, one = (CURVES[STRETCHED, 4.2], CURVES[MR, 1.6])
    return decide.all_of(
        decide.positive("G of beta = 2 minus that of beta = 1, p = 2.4", more - less),
        decide.less("p over that of first contact", 1.6 / at_touch[0], 4.2 / at_touch[1], 1),
        *(
            decide.less(f"{name} of q", *(solutions.point(spec, "pull_off", name) for spec in (one, two)))
            for name in ("rho_contact", "G")
        ),
    )


def stable_side(solutions: Solutions) -> Finding:
    """Negative eigenvalues, with the front as a degree of freedom, on both sides of q."""
    found = []
    for (name, p), spec in CURVES.items():
        counts = solutions.branch(spec).columns["n_negative"]
        if p in HIGH[name]:
            found.append(decide.every(f"{name}, p = {p:g}: none", counts[:-1] == 0))
            continue
        left, right = decide.sides(
            solutions.along(spec, "rho_contact"), solutions.point(spec, "pull_off", "rho_contact")
        )
        found.append(decide.every(f"{name}, p = {p:g}: one left of q", counts[left] == 1))
        found.append(decide.every("none right of it", counts[right] == 0))
    return decide.all_of(found)


ALL = tuple((spec, None) for spec in CURVES.values())

CASE = Case(
    title="Energy release rate and pull-off",
    source="Patil, DasGupta & Eriksson (2015), figures 11 and 12",
    panels=tuple(
        Panel(
            name,
            x=Axis("rho_contact", 0, 0.6),
            y=Axis("G", 0, high),
            title=", ".join(f"{k} = {v:g}" for k, v in spec.parameters if k in ("alpha", "beta", "k")),
            markers="pull_off",
            curves=tuple(
                Curve(CURVES[name, p], f"$p = {p:g}$", reference=f"{name}_p_{p:g}") for p in pressures
            ),
        )
        for name, (spec, pressures, high) in SETS.items()
    ),
    checks=(
        Count(
            "pull_off",
            {spec: 0 if p in HIGH[name] else 1 for (name, p), spec in CURVES.items()},
            "one pull-off point below the pressure of first contact, none above",
        ),
        *(
            Points(
                "pull_off",
                reference="pull_off",
                base=spec,
                parameters=("p",),
                asked={"rho_contact": 1e-4, "G": 1e-5},
                where={"alpha": values["alpha"], "beta": values["beta"], "k": values.get("k", 50)},
            )
            for spec, values in ((s, dict(s.parameters)) for s, _, _ in SETS.values())
        ),
        Claim("pull_off_moves", "as p falls, q moves outwards and G_q grows", ALL, pull_off_moves),
        Claim("both_ways", "G in closed form equals the difference of potentials", ALL, both_ways),
        Claim(
            "from_zero",
            "above first contact G rises from zero, with zero slope, at the radius that inflation reaches",
            ALL + tuple((adhesive(SETS[n][0]), At("p", p)) for n, ps in HIGH.items() for p in ps),
            from_zero,
        ),
        Claim(
            "grows",
            "at equal pressure and radius G is larger for the Mooney-Rivlin membrane and the stiffer "
            "substrate",
            ALL,
            grows,
        ),
        Claim(
            "at_high_pressure",
            "above first contact too G is larger for the Mooney-Rivlin membrane, which holds less area",
            ALL,
            at_high_pressure,
        ),
        Claim(
            "pre_stretch",
            "pre-stretch raises G and moves the pull-off point outwards",
            ALL,
            pre_stretch,
        ),
        Claim(
            "stable_side",
            "the branch to the right of q is stable against peeling, the left one is not",
            ALL,
            stable_side,
        ),
    ),
    asked={"G": 1e-5, "X_contact": 1e-6},
)
