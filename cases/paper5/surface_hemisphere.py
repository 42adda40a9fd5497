"""Paper 5: the hemisphere as an unstructured surface in space against its spectrum by wave number."""

import numpy as np

from weakforms import At, Case, Claim, Finding, Solutions, hemisphere, surface

SIZES = (0.1, 0.05, 0.025)
MESHES = [
    surface(geometry="hemisphere", size=size, load_start=-0.55, load_end=-0.7).on(
        scan=3, shown=3, eigenvalues=5
    )
    for size in SIZES
]
REVOLVED = hemisphere(n="0,1,2", low_end=-0.8)
LEVELS = (At("zw", -0.55), At("zw", -0.7))
"""Taut all over but for the rim, and wrinkled on half of the meridian."""

SPECTRUM = {-0.55: (1, 1, 0, 2, 2), -0.7: (1, 1, 2, 2, 0)}
"""Waves of the five lowest modes, those of n > 0 twice; n = 0 without torsion."""


FALL = {-0.55: 8, -0.7: 2}
"""Least factor by which errors fall from the first mesh to the last, four times as fine: with the square of
the size where the sheet is taut; where it wrinkles, triangles change state singly and they fall unevenly."""


def spectrum(solutions: Solutions) -> Finding:
    """The five lowest eigenvalues converge to those of the axisymmetric theory, within their own spread."""
    good, rows = True, []
    for at in LEVELS:
        one = [solutions.value(REVOLVED, at, f"Lambda_n{n}_1") for n in SPECTRUM[at.value]]
        all_sizes = np.array([[solutions.value(s, at, f"Lambda_{i}") for i in range(1, 6)] for s in MESHES])
        error = np.abs(all_sizes / one - 1)
        spread = np.ptp(all_sizes, axis=0) / one
        worst = error.max(axis=1)
        good &= bool(np.all(error[2] <= spread) and worst[2] < 0.005 and worst[0] > FALL[at.value] * worst[2])
        largest = ", ".join(f"{e:.1e}" for e in error.max(axis=1))
        rows.append(f"{at}: largest relative errors {largest}")
    return good, "; ".join(rows)


def state(solutions: Solutions) -> Finding:
    """Volume by the mesh, and how far SNES goes from the nearest surface of revolution."""
    good, rows = True, []
    for at in LEVELS:
        one = 2 * np.pi * solutions.value(REVOLVED, at, "V")
        error = np.array([abs(solutions.value(s, at, "V") / one - 1) for s in MESHES])
        away = np.array([solutions.value(s, at, "departure") for s in MESHES])
        good &= bool(np.all(error[1:] < error[:-1] / 3) and away[2] < away[0] < 0.01)
        rows.append(
            f"{at}: relative errors of V {', '.join(f'{e:.1e}' for e in error)}; "
            f"departures {', '.join(f'{a:.1e}' for a in away)}"
        )
    return good, "; ".join(rows)


def stable(solutions: Solutions) -> Finding:
    """All states counted are stable: these meshes do not resolve the short waves that are not."""
    counts = np.concatenate([solutions.branch(s).columns["n_negative"] for s in MESHES])
    return bool(np.all(counts == 0)), f"negative eigenvalues: {counts.tolist()}"


WANTS = tuple((s, at) for s in (*MESHES, REVOLVED) for at in LEVELS)
CASE = Case(
    title="The hemisphere on an unstructured surface mesh",
    source="Patil, Nordmark & Eriksson (2016), section 5",
    checks=(
        Claim(
            "spectrum",
            "the lowest eigenvalues of the whole surface are those of the axisymmetric theory, wave by wave",
            WANTS,
            spectrum,
        ),
        Claim("state", "its equilibria tend to the axisymmetric ones", WANTS, state),
        Claim("stable", "they are stable at these levels", tuple((s, None) for s in MESHES), stable),
    ),
)
