"""Paper 5: the unstable ranges that a finite element code found on the tube, in three dimensions.

Convention, nowhere tuned: nodes uniform in (S, Theta) on the cylinder, flat triangles that are their own
reference metric, all diagonals one way, thickness and strain at the centroid; the liquid by the vertical flux
of its potential, edge midpoints. The equilibrium is the ring-periodic one; that it is one of the whole
surface its residual shows. Stability by the inertia of the whole tangent.
"""

import numpy as np

from weakforms import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Printed,
    Solutions,
    Surface,
    reference,
    surface,
)

COARSE, FINE = (
    surface(rule=1, load_start=4, load_end=8).on(scan=40, shown=8),
    surface(rule=1, load_start=3.5, load_end=10.5).on(scan=70, shown=10),
)
"""Walks on meshes of 48 and of 96 columns, in steps of 0.1."""

M48, M96 = COARSE.at(meridional=120, circumferential=48), FINE.at(meridional=80, circumferential=96)
H48, H96 = COARSE.at(meridional=60, circumferential=48), FINE.at(meridional=40, circumferential=96)
MESHES = {"120 x 48": M48, "80 x 96": M96, "60 x 48": H48, "40 x 96": H96}

STEEP = surface(meridional=120, circumferential=48, load_start=6.6, load_end=7).on(
    scan=2, shown=2, eigenvalues=0
)
OTHERS = {
    "one point": STEEP.at(rule=2),
    "three inner points": STEEP.at(rule=3),
    "printed potential": STEEP.at(rule=1, potential="horizontal"),
}
PICTURE = surface(meridional=60, circumferential=35, load_start=5.5, load_end=6.5).on(scan=2, shown=1)
"""A mesh coarse enough for every line of it to be drawn."""

SHOWN = At("zw", 6.5)
AXES = (Axis("x", -0.9, 0.9), Axis("y", -0.9, 0.9), Axis("z", 0, 8))


def changes(solutions: Solutions, spec: object) -> np.ndarray:
    """Levels at which stability changes, with the eigenvalues on both sides."""
    points = solutions.points(spec, "stability_change")
    return np.array([[p.values[k] for k in ("zw", "Lambda_1", "Lambda_1_stable")] for p in points])


def whole(solutions: Solutions) -> Finding:
    """Residual of the whole surface at ring-periodic equilibria, and how many levels were solved."""
    residual = np.concatenate([solutions.branch(s).columns["residual"] for s in MESHES.values()])
    good = bool(np.max(residual) < 1e-9 and not any(solutions.result(s).failures for s in MESHES.values()))
    return good, f"{len(residual)} levels shown, largest residual of the whole surface {residual.max():.1e}"


def signs(solutions: Solutions) -> Finding:
    """The lowest eigenvalue by SLEPc is negative where the inertia counts negative ones, and only there."""
    good, unstable, total = True, 0, 0
    for spec in MESHES.values():
        columns = solutions.branch(spec).columns
        first, third = columns["Lambda_1"], columns["Lambda_3"]
        good &= bool(np.all((first < 0) == (columns["n_negative"] > 0)))
        good &= bool(np.all((third < 0) == (columns["n_negative"] > 2)) and np.all(first <= third))
        unstable, total = unstable + int(np.sum(first < 0)), total + len(first)
    return good and 0 < unstable < total, f"{unstable} of {total} states are unstable by both"


def hoop(solutions: Solutions) -> Finding:
    """Half the cells along moves the lower ends little; twice as many around moves them by more than 1."""
    lower = {name: changes(solutions, spec)[0, 0] for name, spec in MESHES.items()}
    upper = {name: changes(solutions, spec)[-1, 0] for name, spec in MESHES.items()}
    along = [abs(lower[a] - lower[b]) for a, b in (("120 x 48", "60 x 48"), ("80 x 96", "40 x 96"))]
    around = lower["120 x 48"] - lower["80 x 96"]
    good = max(along) < 0.01 and around > 1 and abs(upper["120 x 48"] - upper["60 x 48"]) < 0.01
    good &= upper["80 x 96"] - upper["120 x 48"] > 2
    rows = "; ".join(f"{name}: {lower[name]:.5f} to {upper[name]:.5f}" for name in MESHES)
    return bool(good), rows


def rings_switch(solutions: Solutions) -> Finding:
    """The upper end of 96 columns is where rings of triangles become taut: eigenvalues jump there."""
    rows, good = [], True
    for name, spec in (("80 x 96", M96), ("40 x 96", H96)):
        zw, unstable, stable = changes(solutions, spec)[-1]
        good &= stable - unstable > 1e3 * 1e-6
        rows.append(f"{name}: at {zw:.5f} from {unstable:.3g} to {stable:.3g}")
    gaps = solutions.result(H96).quantities["gaps"].value
    for name, spec in MESHES.items():
        zw, unstable, stable = changes(solutions, spec)[0]
        good &= abs(stable - unstable) < 1e-4
        rows.append(f"{name}, lower end {zw:.5f}: from {stable:.1g} to {unstable:.1g}")
    return bool(good and gaps == 1), f"{'; '.join(rows)}; stable gaps on 40 x 96: {gaps:.0f}"


def waves(solutions: Solutions) -> Finding:
    """Waves of the critical mode on each mesh, against a quarter of its columns."""
    good, rows = True, []
    for name, spec in MESHES.items():
        columns = dict(spec.parameters)["circumferential"]
        n = solutions.points(spec, "stability_change")[0].values["n"]
        good &= 0.85 <= n / (columns / 4) <= 1.0
        rows.append(
            f"{name}: n = {n:.0f}, seen as {columns / (2 * np.pi) * np.sin(2 * np.pi * n / columns):.2f}"
        )
    return bool(good), "; ".join(rows)


def effective(solutions: Solutions) -> Finding:
    """Wave numbers at which the axisymmetric theory's waves have the mesh's ends of the unstable range."""
    table = reference(5, "stability_changes_fluid").columns
    good, rows = True, []
    for spec in (M48, M96):
        columns = dict(spec.parameters)["circumferential"]
        found = []
        for direction, place in ((1, 0), (-1, -1)):
            here = table["direction"] == direction
            zw, n = table["zw"][here], table["n"][here]
            order = np.argsort(zw)
            found.append(float(np.interp(changes(solutions, spec)[place, 0], zw[order], n[order])))
        most = columns / (2 * np.pi)
        good &= all(0.8 * most < n < most for n in found) and abs(found[1] / found[0] - 1) < 0.1
        rows.append(f"{columns} columns: {found[0]:.2f} and {found[1]:.2f}, N_C/(2 pi) = {most:.2f}")
    return bool(good), "; ".join(rows)


def sensitive(solutions: Solutions) -> Finding:
    """The upper end of 120 x 48 by other quadratures and by the printed potential."""
    own = changes(solutions, M48)[-1, 0]
    found = {name: changes(solutions, spec)[-1, 0] for name, spec in OTHERS.items()}
    most = max(abs(zw - own) for zw in found.values())
    rows = "; ".join(f"{name}: {zw:.5f}" for name, zw in found.items())
    return bool(0 < most < 0.01), f"edge midpoints and vertical flux: {own:.5f}; {rows}"


def bloch(solutions: Solutions) -> Finding:
    """All ends against matrices reduced by wave number, of another code, each within the brackets' halves."""
    table = reference(5, "surface_ranges")
    columns, good, worst = table.columns, True, (0.0, 0.0)
    rows = [(spec, 1.0, ("lower", "upper")) for spec in MESHES.values()]
    rows += [(spec, rule, ("upper",)) for spec, rule in zip(OTHERS.values(), (2.0, 3.0, 4.0), strict=True)]
    for spec, rule, ends in rows:
        mesh = [dict(spec.parameters)[name] for name in ("meridional", "circumferential")]
        keys = np.column_stack([columns[name] for name in ("N_S", "N_C", "rule")])
        (row,) = np.flatnonzero((keys == [*mesh, rule]).all(axis=1))
        points = solutions.points(spec, "stability_change")
        for name, point in zip(("lower", "upper"), (points[0], points[-1]), strict=True):
            if name in ends:
                error = abs(point.values["zw"] - columns[name][row])
                bound = 2 * np.hypot(point.uncertainty["zw"], table.uncertainty[name])
                good &= bool(error <= bound <= 1e-4)
                worst = max(worst, (error, bound))
        if "lower" in ends:
            good &= points[0].values["n"] == columns["n_lower"][row]
    return bool(
        good
    ), f"{len(rows)} meshes and conventions; largest difference {worst[0]:.1e} <= {worst[1]:.1e}"


def printed(what: str, text: str, spec: object, index: int) -> Printed:
    """One printed end of a range."""
    return Printed(what, text, spec, "stability_change", "zw", "section 6, finite element ranges", index)


CASE = Case(
    title="The unstable ranges of the tube on flat triangles in space",
    source="Patil, Nordmark & Eriksson (2016), section 6",
    panels=(
        Panel(
            "lowest",
            x=Axis("zw", 3.5, 10.5),
            y=Axis("Lambda_1", -4, 1, r"$\Lambda_1$"),
            title="Lowest eigenvalue of the whole surface",
            note="Marked: where stability changes, by the eigenvalue on the unstable side.",
            curves=tuple(Curve(spec, name) for name, spec in MESHES.items()),
            markers="stability_change",
        ),
    ),
    surfaces=(
        Surface("state", PICTURE, SHOWN, AXES, title=r"60 x 35, $z_w = 6.5$: ring-periodic, its lower third"),
        Surface(
            "mode",
            PICTURE,
            SHOWN,
            AXES,
            title="The same with its lowest mode",
            note="The mode is unstable; its waves are about as short as the mesh resolves.",
            displaced=0.2,
        ),
    ),
    checks=(
        printed("lower end, 120 x 48", "5.14", M48, 0),
        printed("upper end, 120 x 48", "6.81", M48, 1),
        printed("lower end, 80 x 96", "4.03", M96, 0),
        printed("upper end, 80 x 96", "9.81", M96, 1),
        Claim(
            "whole",
            "ring-periodic equilibria are those of the whole",
            tuple((s, None) for s in MESHES.values()),
            whole,
        ),
        Claim("signs", "SLEPc and inertia say the same", tuple((s, None) for s in MESHES.values()), signs),
        Claim(
            "hoop",
            "the range depends on the mesh around the tube; its lower end, and for 48 columns its upper one, "
            "hardly on that along it",
            tuple((s, None) for s in MESHES.values()),
            hoop,
        ),
        Claim(
            "rings_switch",
            "lower ends are zeros of an eigenvalue; upper ones of 96 columns are jumps, and depend on rings",
            tuple((s, None) for s in MESHES.values()),
            rings_switch,
            differs="The paper calls the unstable range largely independent of the axial discretization. The "
            "upper end of 96 columns is not: it is where rings of triangles become taut one by one, and with "
            "half as many rings there is even a stable gap.",
        ),
        Claim(
            "waves",
            "the critical waves are about as short as triangles resolve, four columns a wave",
            tuple((s, None) for s in MESHES.values()),
            waves,
        ),
        Claim(
            "effective",
            "both ends of a range belong to nearly the same effective wave number, a little below N_C/(2 pi)",
            ((M48, None), (M96, None)),
            effective,
        ),
        Claim(
            "bloch",
            "the inertia of the whole tangent gives the ends that blocks by wave number give",
            tuple((s, None) for s in (*MESHES.values(), *OTHERS.values())),
            bloch,
        ),
        Claim(
            "sensitive",
            "the upper end of 120 x 48 moves by less than 0.01 with quadrature and potential of the load",
            tuple((s, None) for s in (M48, *OTHERS.values())),
            sensitive,
        ),
    ),
    slow=True,
)
