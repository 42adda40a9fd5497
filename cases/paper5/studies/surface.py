"""Paper 5: the unstable ranges that a finite element code found on the tube, in three dimensions.

The conventions are not tuned: nodes are uniform in (S, Theta) on the cylinder; the flat triangles define the
reference metric; all diagonals have one direction; thickness and strain are those at the centroid; the load
of the liquid is the vertical flux of its potential at edge midpoints. The equilibrium is ring-periodic, and
its residual shows that it is an equilibrium of the whole surface. The inertia of the whole tangent decides on
stability.
"""

import numpy as np

from weakforms.cases import (
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
    decide,
    reference,
    surface,
)

COARSE, FINE = (
    surface(rule=1, load_start=4, load_end=8).on(scan=40, shown=8),
    surface(rule=1, load_start=3.5, load_end=10.5).on(scan=70, shown=10),
)
"""Branches on meshes of 48 and of 96 columns, in steps of 0.1."""

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
"""A mesh coarse enough to draw all its lines."""

SOLVED = 1e-6
"""Absolute accuracy of eigenvalues of the whole surface by SLEPc."""
IN_BALANCE = decide.Stated(
    1e-9, "of the whole", "below it the Newton step of the whole tangent changes no printed digit"
)
HARDLY = decide.Stated(0.01, "hardly", "the claim on the upper end's own number; a tenth of the load step")
DEPENDS = decide.Stated(1.0, "depends", "no number is printed; ten load steps")
JUMP = decide.Stated(1e3 * SOLVED, "jumps", "a thousand times the accuracy of eigenvalues")
ZERO = decide.Stated(
    1e-4, "zeros of an eigenvalue", "a hundred times the accuracy of eigenvalues: the bracket's ends"
)
ABOUT = decide.Stated(
    0.85, "four columns a wave", "no number is printed; less than five columns for each wave"
)
A_LITTLE = decide.Stated(0.2, "a little below", "no number is printed; four fifths and more")
NEARLY = decide.Stated(0.1, "nearly the same", "no number is printed; at most half of the difference")
SHOWN = At("zw", 6.5)
AXES = (Axis("x", -0.9, 0.9), Axis("y", -0.9, 0.9), Axis("z", 0, 8))


def changes(solutions: Solutions, spec: object, place: int, name: str = "zw") -> decide.Number:
    """Level at which stability changes, or the eigenvalue on one side of it."""
    point = solutions.points(spec, "stability_change")[place]
    return decide.of_point(point, name) if name == "zw" else decide.Number(point.values[name], SOLVED)


def whole(solutions: Solutions) -> Finding:
    """Residual of the whole surface at ring-periodic equilibria, and number of solved levels."""
    residual = np.concatenate([solutions.branch(s).columns["residual"] for s in MESHES.values()])
    return decide.all_of(
        decide.at_most("residual of the whole surface", residual, IN_BALANCE),
        decide.every(
            "branches without a failure", [not solutions.result(s).failures for s in MESHES.values()]
        ),
    )


def signs(solutions: Solutions) -> Finding:
    """The lowest eigenvalue by SLEPc is negative exactly where the inertia counts negative ones."""
    found = []
    for name, spec in MESHES.items():
        counts = solutions.branch(spec).columns["n_negative"]
        first, third = (decide.Number(solutions.branch(spec).columns[f"Lambda_{k}"], SOLVED) for k in (1, 3))
        for eigenvalue, least in ((first, 0), (third, 2)):
            below, above = decide.sides(eigenvalue, 0)
            found.append(
                decide.same(
                    f"{name}: negative by both", (counts > least)[below].tolist(), [True] * int(below.sum())
                )
            )
            found.append(decide.every("positive by both", (counts <= least)[above]))
        found.append(decide.every("in order", first.value <= third.value))
    return decide.all_of(found)


def hoop(solutions: Solutions) -> Finding:
    """Half the cells along change the lower ends little; twice as many around by more than 1."""
    lower, upper = (
        {name: changes(solutions, spec, place) for name, spec in MESHES.items()} for place in (0, -1)
    )
    along = [
        lower["120 x 48"] - lower["60 x 48"],
        lower["80 x 96"] - lower["40 x 96"],
        upper["120 x 48"] - upper["60 x 48"],
    ]
    return decide.all_of(
        decide.at_most("moved by the mesh along", abs(decide.stack(along)), HARDLY),
        decide.at_least("lower end moved by that around", lower["120 x 48"] - lower["80 x 96"], DEPENDS),
        decide.at_least("upper end", upper["80 x 96"] - upper["120 x 48"], DEPENDS),
    )


def rings_switch(solutions: Solutions) -> Finding:
    """At the upper end with 96 columns, rings of triangles become taut, and eigenvalues jump."""
    sides = ("Lambda_1_stable", "Lambda_1")
    found = []
    for name, spec in (("80 x 96", M96), ("40 x 96", H96)):
        stable, unstable = (changes(solutions, spec, -1, side) for side in sides)
        found.append(decide.at_least(f"{name}, upper end: jump", stable - unstable, JUMP))
    for name, spec in MESHES.items():
        stable, unstable = (changes(solutions, spec, 0, side) for side in sides)
        found.append(decide.at_most(f"{name}, lower end: jump", abs(stable - unstable), ZERO))
    found.append(decide.same("stable gaps on 40 x 96", solutions.result(H96).quantities["gaps"].value, 1))
    return decide.all_of(found)


def waves(solutions: Solutions) -> Finding:
    """Waves of the critical mode on each mesh, compared with a quarter of its columns."""
    counts = [solutions.points(spec, "stability_change")[0].values["n"] for spec in MESHES.values()]
    quarters = [dict(spec.parameters)["circumferential"] / 4 for spec in MESHES.values()]
    share = np.array(counts) / np.array(quarters)
    return decide.all_of(
        decide.at_least("waves over a quarter of the columns", share, ABOUT),
        decide.every("not more", share <= 1),
    )


def effective(solutions: Solutions) -> Finding:
    """Wave numbers for which the axisymmetric theory has the same ends of the unstable range as the mesh."""
    table, found = reference(5, "stability_changes_fluid").columns, []
    for spec in (M48, M96):
        columns = dict(spec.parameters)["circumferential"]
        seen = []
        for direction, place in ((1, 0), (-1, -1)):
            here = table["direction"] == direction
            zw, n = table["zw"][here], table["n"][here]
            order = np.argsort(zw)
            seen.append(float(np.interp(changes(solutions, spec, place).value, zw[order], n[order])))
        missing = 1 - np.array(seen) / (columns / (2 * np.pi))
        found += [
            decide.positive(f"{columns} columns: missing from N_C/(2 pi)", missing),
            decide.at_most("missing", missing, A_LITTLE),
            decide.at_most("apart", abs(seen[1] / seen[0] - 1), NEARLY),
        ]
    return decide.all_of(found)


def sensitive(solutions: Solutions) -> Finding:
    """The upper end for 120 x 48 with other quadratures and with the printed potential."""
    moved = [abs(changes(solutions, spec, -1) - changes(solutions, M48, -1)) for spec in OTHERS.values()]
    return decide.all_of(
        decide.at_most("change of the upper end", decide.stack(moved), HARDLY),
        decide.positive("largest change", decide.stack(moved).largest()),
    )


def bloch(solutions: Solutions) -> Finding:
    """All ends compared with the results of another code, which reduces the matrices by wave number."""
    table, found = reference(5, "surface_ranges"), []
    rows = [(spec, 1.0, ("lower", "upper")) for spec in MESHES.values()]
    rows += [(spec, rule, ("upper",)) for spec, rule in zip(OTHERS.values(), (2.0, 3.0, 4.0), strict=True)]
    for spec, rule, ends in rows:
        mesh = [dict(spec.parameters)[name] for name in ("meridional", "circumferential")]
        keys = np.column_stack([table.columns[name] for name in ("N_S", "N_C", "rule")])
        (row,) = np.flatnonzero((keys == [*mesh, rule]).all(axis=1))
        for name, place in (("lower", 0), ("upper", -1)):
            if name in ends:
                found.append(
                    decide.agree(
                        f"{name} end", changes(solutions, spec, place), table.number(name)[row], 1e-4, 1.0
                    )
                )
        if "lower" in ends:
            waves_here = solutions.points(spec, "stability_change")[0].values["n"]
            found.append(decide.same("waves", waves_here, table.columns["n_lower"][row]))
    return decide.all_of(found)


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
            note="Marked: changes of stability, with the eigenvalue on the unstable side.",
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
            note="The mode is unstable; its waves are about the shortest that the mesh resolves.",
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
            "ring-periodic equilibria are equilibria of the whole surface",
            tuple((s, None) for s in MESHES.values()),
            whole,
        ),
        Claim("signs", "SLEPc and inertia agree", tuple((s, None) for s in MESHES.values()), signs),
        Claim(
            "hoop",
            "the range depends on the mesh around the tube; its lower end, and for 48 columns its upper end, "
            "depend little on the mesh along it",
            tuple((s, None) for s in MESHES.values()),
            hoop,
        ),
        Claim(
            "rings_switch",
            "lower ends are zeros of an eigenvalue; upper ends for 96 columns are jumps, and depend on rings",
            tuple((s, None) for s in MESHES.values()),
            rings_switch,
            differs="The paper calls the unstable range largely independent of the axial discretization. The "
            "upper end for 96 columns is not: there rings of triangles become taut one by one, and with half "
            "as many rings there is even a stable gap.",
        ),
        Claim(
            "waves",
            "the critical waves are about the shortest that the triangles resolve, four columns for each "
            "wave",
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
            "the inertia of the whole tangent gives the same ends as blocks by wave number",
            tuple((s, None) for s in (*MESHES.values(), *OTHERS.values())),
            bloch,
        ),
        Claim(
            "sensitive",
            "the upper end for 120 x 48 changes by less than 0.01 with quadrature and potential of the load",
            tuple((s, None) for s in (M48, *OTHERS.values())),
            sensitive,
        ),
    ),
    slow=True,
)
