"""Paper 3, figure 3: fluid volume against fluid level, and the effect of the pre-stretch.

With the volume as control there is no limit point: it rises along the whole primary branch, which is stable
under volume control up to the bifurcation.
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
    Solutions,
    Spec,
    decide,
    fluid_tube,
    reference,
)

LENGTHS, STRETCHES = (8, 24), (1.5, 2, 3)
TUBES = {(length, d): fluid_tube(L=length, delta=d, gamma=0.116) for length in LENGTHS for d in STRETCHES}
BENT = {key: fluid_tube(L=key[0], delta=key[1], secondary=True) for key in TUBES}
BENT[24, 1.5] = BENT[24, 1.5].on(levels=2, secondary_levels=2, secondary_cells=12, secondary_end=0.94)
"""On a coarse mesh, because its dry part is slightly compressed: see case ``compressed``."""
STIFF, CROSSED, SOFT = At("zw", 4.0), At("zw", 7.5), At("zw", 8.1, crossing=2)
CROSSINGS = reference(3, "crossings")
ACCURACY = 1e-7
"""Relative accuracy of a level at which two curves cross."""
STEP = 1e-2
AROUND = tuple(At("zw", 6.0 + s * STEP) for s in (-1, 0, 1))


OF_SECOND_ORDER = decide.Stated(
    STEP**2, "dPi/dzw = -gamma V", "the square of the step; its factor is below one"
)


def volumes(solutions: Solutions, length: int, at: At) -> list[decide.Number]:
    """Volume at a level for the three pre-stretches."""
    return [solutions.number(TUBES[length, d], at, "V") for d in STRETCHES]


def stiffens_then_softens(solutions: Solutions) -> Finding:
    """V decreases with delta at zw = 4, increases at 7.5, and increases past the limit point."""
    return decide.all_of(
        way(f"V, L = {length}, {at}", volumes(solutions, length, at))
        for length in LENGTHS
        for at, way in ((STIFF, decide.falls), (CROSSED, decide.rises), (SOFT, decide.rises))
    )


def either_side(row: int) -> list[tuple[Spec, At]]:
    """The two curves that cross in a row of the table, just below and above the level of the crossing."""
    table = CROSSINGS.columns
    out = []
    for side in (-ACCURACY, ACCURACY):
        for which in ("a", "b"):
            tube = TUBES[int(table["L"][row]), float(table[f"delta_{which}"][row])]
            level = float(table["zw"][row]) * (1 + side)
            out.append((tube, At("zw", level, crossing=1 + int(table[f"post_{which}"][row]))))
    return out


def crossings(solutions: Solutions) -> Finding:
    """Whether the order of the volumes changes within the accuracy around each level of the table."""
    found = []
    for row in range(len(CROSSINGS)):
        low_a, low_b, high_a, high_b = (solutions.number(of, at, "V") for of, at in either_side(row))
        below, above = low_a - low_b, high_a - high_b
        way = np.sign(above.value)
        found.append(
            decide.less(
                f"zw = {CROSSINGS.columns['zw'][row]:.6f}: gap, zero, gap", way * below, 0, way * above
            )
        )
    return decide.all_of(found)


def work_conjugate(solutions: Solutions) -> Finding:
    """Central difference of the potential over the level, compared with the volume."""
    found = []
    for tube in TUBES.values():
        before, after = (solutions.number(tube, at, "Pi") for at in (AROUND[0], AROUND[2]))
        off = (after - before) / (2 * STEP) / (-0.116 * solutions.number(tube, AROUND[1], "V")) - 1
        found.append(decide.at_most("relative difference", abs(off), OF_SECOND_ORDER))
    return decide.all_of(found)


def stable_in_volume(solutions: Solutions) -> Finding:
    """Lowest eigenvalues of axisymmetric modes at fixed volume and of one wave, up to the bifurcation."""
    found = []
    for tube in TUBES.values():
        end = next(p for p in solutions.points(tube, "bifurcation_point") if p.values["n"] == 1)
        before, _ = decide.sides(solutions.along(tube, "V"), decide.of_point(end, "V"))
        found += [
            decide.positive(name, solutions.along(tube, name)[before]) for name in ("LambdaV_n0", "Lambda_n1")
        ]
    return decide.all_of(found)


EVERY = tuple(TUBES.values())

CASE = Case(
    title="Fluid volume against fluid level",
    source="Patil, Nordmark & Eriksson (2015), figure 3",
    panels=tuple(
        Panel(
            name,
            x=Axis("zw", 0, 10),
            y=Axis("V", 0, 250),
            title=rf"$L/A = {length}$",
            markers=("limit_point", "bifurcation_point"),
            note="The text does not give the printed axes; the ranges are chosen here.",
            curves=tuple(
                Curve(TUBES[length, d], rf"$\delta = {d}$", reference=f"primary_L_{length}_delta_{d}")
                for d in STRETCHES
            )
            + tuple(
                Curve(
                    BENT[length, d],
                    rf"$\delta = {d}$, secondary",
                    reference=f"secondary_L_{length}_delta_{d}",
                    branch="secondary",
                    asked={"V": 2e-2 if (length, d) == (24, 1.5) else 1e-5},
                )
                for d in STRETCHES
            ),
        )
        for name, length in (("a", 8), ("b", 24))
    ),
    checks=(
        Claim(
            "stiffens_then_softens",
            "with pre-stretch the volume at a level decreases at low levels (stiffening) and increases past "
            "the limit point (softening); the paper claims stiffening everywhere before the limit point, but "
            "the order is reversed well before it",
            tuple((tube, at) for tube in EVERY for at in (STIFF, CROSSED, SOFT)),
            stiffens_then_softens,
            differs="the text claims stiffening with pre-stretch everywhere before the limit point; the "
            "order of the volumes is reversed well before it, where the curves cross",
        ),
        Claim(
            "crossings",
            "the curves of two pre-stretches cross at the levels of the reference, to 1e-7 of the level: "
            "once well before the limit points, and again past them",
            tuple(wanted for row in range(len(CROSSINGS)) for wanted in either_side(row)),
            crossings,
        ),
        Claim(
            "work_conjugate",
            "level and volume are work-conjugate: dPi/dzw = -gamma V along the branch",
            tuple((tube, at) for tube in EVERY for at in AROUND),
            work_conjugate,
        ),
        Claim(
            "stable_in_volume",
            "under volume control the primary branch is stable up to the bifurcation, past the limit point "
            "of "
            "the level",
            tuple((tube, None) for tube in EVERY),
            stable_in_volume,
        ),
    ),
    asked={"zw": 5e-10},
)
