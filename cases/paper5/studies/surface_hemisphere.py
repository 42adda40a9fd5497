"""Paper 5: the hemisphere as an unstructured surface in space, compared with its spectrum by wave number."""

import numpy as np

from weakforms.cases import At, Case, Claim, Finding, Solutions, decide, hemisphere, surface

SIZES = (0.1, 0.05, 0.025)
MESHES = [
    surface(geometry="hemisphere", size=size, load_start=-0.55, load_end=-0.7).on(
        scan=3, shown=3, eigenvalues=5
    )
    for size in SIZES
]
REVOLVED = hemisphere(n="0,1,2", low_end=-0.8)
LEVELS = (At("zw", -0.55), At("zw", -0.7))
"""Levels at which the hemisphere is taut except for the rim, and wrinkled on half of the meridian."""

SPECTRUM = {-0.55: (1, 1, 0, 2, 2), -0.7: (1, 1, 2, 2, 0)}
"""Wave numbers of the five lowest modes; those with n > 0 occur twice; n = 0 is without torsion."""


FALL = {
    -0.55: decide.Stated(
        8, "converge", "with the square of the size where the sheet is taut, 16 from first to last"
    ),
    -0.7: decide.Stated(
        2,
        "converge",
        "where it wrinkles, triangles change their state one by one, and errors decrease irregularly",
    ),
}
CLOSE = decide.Stated(
    0.005, "those of the axisymmetric theory", "on flat triangles of a fortieth of the radius"
)
NEAREST = decide.Stated(
    0.01, "the nearest surface of revolution", "on the coarsest mesh, a tenth of its size"
)
ASKED = 0.1
"""Accuracy asked of the spread over the meshes."""


def spectrum(solutions: Solutions) -> Finding:
    """The five lowest eigenvalues converge to the eigenvalues of the axisymmetric theory."""
    found = []
    for at in LEVELS:
        one = decide.stack(solutions.number(REVOLVED, at, f"Lambda_n{n}_1") for n in SPECTRUM[at.value])
        sizes = np.array([[solutions.value(s, at, f"Lambda_{i}") for i in range(1, 6)] for s in MESHES])
        error = np.abs(sizes / one.value - 1)
        # The uncertainty is the difference between the meshes.
        spread = decide.Number(sizes[2] / one.value, np.ptp(sizes, axis=0) / one.value / 2)
        found += [
            decide.agree(f"eigenvalues, {at}", spread, np.ones(5), ASKED),
            decide.at_most("largest error on the finest mesh", error[2], CLOSE),
            decide.at_least("decrease of the largest error", error[0].max() / error[2].max(), FALL[at.value]),
        ]
    return decide.all_of(found)


def state(solutions: Solutions) -> Finding:
    """Volume on the mesh, and distance of the equilibrium from the nearest surface of revolution."""
    found = []
    for at in LEVELS:
        one = 2 * np.pi * solutions.number(REVOLVED, at, "V")
        error = decide.stack(abs(solutions.value(s, at, "V") / one - 1) for s in MESHES)
        away = [solutions.value(s, at, "departure") for s in MESHES]
        found += [
            decide.order(f"volume, {at}", [1 / size for size in SIZES], error, 2),
            decide.less("departures", away[2], away[0]),
            decide.at_most("the first", away[0], NEAREST),
        ]
    return decide.all_of(found)


def stable(solutions: Solutions) -> Finding:
    """All states are stable, because these meshes do not resolve the unstable short waves."""
    counts = np.concatenate([solutions.branch(s).columns["n_negative"] for s in MESHES])
    return decide.every("states without a negative eigenvalue", counts == 0)


WANTS = tuple((s, at) for s in (*MESHES, REVOLVED) for at in LEVELS)
CASE = Case(
    title="The hemisphere on an unstructured surface mesh",
    source="Patil, Nordmark & Eriksson (2016), section 5",
    checks=(
        Claim(
            "spectrum",
            "the lowest eigenvalues of the whole surface agree with the axisymmetric theory for each wave "
            "number",
            WANTS,
            spectrum,
        ),
        Claim("state", "its equilibria converge to the axisymmetric ones", WANTS, state),
        Claim(
            "stable", "the equilibria are stable at these levels", tuple((s, None) for s in MESHES), stable
        ),
    ),
    slow=True,
)
