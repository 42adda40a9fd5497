"""Paper 1, figures 11 and 12: energy release rate over the radius of the patch, and pull-off.

At a pressure below first contact G has a minimum: the pull-off point q. To its right the patch is stable
against peeling (dG/drho* > 0; solid), to its left it is not (dashed). Above first contact G rises from zero,
with zero slope, at the radius that adhesive inflation reaches at that pressure.
"""

import numpy as np

from weakforms import At, Axis, Case, Claim, Count, Curve, Finding, Panel, Points, Solutions, Spec, circular

BASE = circular(contact="adhesive", phase="peeling")
SETS = {
    "fig11a": (BASE.at(alpha=0, beta=1, p_end=4.2), (1.2, 1.4, 1.6, 2.2, 2.4), 0.4),
    "fig11b": (BASE.at(alpha=0.1, beta=1, p_end=4.7), (1.2, 1.4, 1.6, 2.2, 2.4), 0.4),
    "fig12a": (BASE.at(alpha=0.1, beta=1, k=100, p_end=5.2), (1.4, 1.6, 1.8, 2.3, 2.7), 0.5),
    "fig12b": (BASE.at(alpha=0.1, beta=2, p_end=7.8), (2.4, 3.2, 3.8, 4.2, 5.6), 1.2),
}
"""Curve, pressures and height of the axis. Inflation ends where rho* = 0.6, the end of the axis: G at a
pressure and radius does not depend on how far inflation went."""
HIGH = {"fig11a": (2.2, 2.4), "fig11b": (2.2, 2.4), "fig12a": (2.3, 2.7), "fig12b": (5.6,)}
CURVES = {(name, p): spec.at(p=p) for name, (spec, pressures, _) in SETS.items() for p in pressures}
MR, NH, STIFF, STRETCHED = "fig11b", "fig11a", "fig12a", "fig12b"


def adhesive(spec: Spec) -> Spec:
    """The inflation that a peeling curve begins with."""
    kept = {name: value for name, value in spec.parameters if name not in ("phase", "p")}
    return circular(**kept)


def pull_off_moves(solutions: Solutions) -> Finding:
    """Radius and G of the pull-off points as the pressure falls."""
    good, rows = True, []
    for name, (_, pressures, _) in SETS.items():
        points = [solutions.points(CURVES[name, p], "pull_off") for p in pressures if p not in HIGH[name]]
        rho, g = np.array([[q[0].values["rho_contact"], q[0].values["G"]] for q in points]).T
        good &= bool(np.all(np.diff(rho) < 0) and np.all(np.diff(g) < 0))
        rows.append(f"{name}: rho {rho[0]:.4f} to {rho[-1]:.4f}, G {g[0]:.4f} to {g[-1]:.4f}")
    return good, "; ".join(rows)


def both_ways(solutions: Solutions) -> Finding:
    """G in closed form against differences of potentials, along every curve."""
    worst = 0.0
    for spec in CURVES.values():
        columns = solutions.branch(spec).columns
        scale = np.abs(columns["G"]).max()
        worst = max(worst, float(np.abs(columns["G"] - columns["G_difference"]).max() / scale))
    return worst < 1e-5, f"largest difference over the largest G of the curve: {worst:.1e}"


def from_zero(solutions: Solutions) -> Finding:
    """Above first contact: G and its slope where the curve begins, and that it rises."""
    good, rows = True, []
    for name, pressures in HIGH.items():
        for p in pressures:
            columns = solutions.branch(CURVES[name, p]).columns
            g, rho = columns["G"][::-1], columns["rho_contact"][::-1]
            reached = solutions.value(adhesive(SETS[name][0]), At("p", p), "rho_contact")
            slope = (g[1] - g[0]) / (rho[1] - rho[0]) / (g[-1] / (rho[-1] - rho[0]))
            good &= abs(g[0]) < 1e-9 and bool(np.all(np.diff(g) > 0)) and abs(rho[0] - reached) < 1e-8
            good &= slope < 0.2
            rows.append(f"{name}, p = {p:g}: G = {g[0]:.1e} at rho* = {rho[0]:.5f}")
    return bool(good), "; ".join(rows)


def _above(solutions: Solutions, more: str, less: str, p: float) -> tuple[bool, float]:
    """Whether one curve lies above another at equal pressure, over their common radii from q outwards."""
    a, b = (solutions.branch(CURVES[name, p]).columns for name in (more, less))
    radii = [c["rho_contact"] for c in (a, b)]
    low, high = max(r.min() for r in radii), min(r.max() for r in radii)
    rho = np.linspace(low, high, 40)
    ga, gb = (np.interp(rho, c["rho_contact"][::-1], c["G"][::-1]) for c in (a, b))
    return bool(np.all(ga > gb)), float((ga / gb).min())


def grows(solutions: Solutions) -> Finding:
    """G of Mooney-Rivlin over neo-Hookean and of k = 100 over k = 50, at equal p and rho*."""
    pairs = [(MR, NH, p) for p in (1.2, 1.4, 1.6)] + [(STIFF, MR, p) for p in (1.4, 1.6)]
    found = [_above(solutions, *pair) for pair in pairs]
    return all(ok for ok, _ in found), "smallest ratio: " + ", ".join(
        f"{a}/{b} at {p:g}: {r:.3f}" for (a, b, p), (_, r) in zip(pairs, found, strict=True)
    )


def stable_side(solutions: Solutions) -> Finding:
    """Negative eigenvalues, the front among the freedoms, to both sides of q."""
    good = True
    for (name, p), spec in CURVES.items():
        columns = solutions.branch(spec).columns
        counts, rho = columns["n_negative"], columns["rho_contact"]
        if p in HIGH[name]:
            good &= bool(np.all(counts[:-1] == 0))
            continue
        (q,) = solutions.points(spec, "pull_off")
        good &= bool(np.all(counts == (rho < q.values["rho_contact"])))
    return good, f"{len(CURVES)} curves: none to the right of q, one to its left"


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
            "stable_side",
            "the branch right of q is stable against peeling, the left one not",
            ALL,
            stable_side,
        ),
    ),
    asked={"G": 1e-5, "X_contact": 1e-6},
)
