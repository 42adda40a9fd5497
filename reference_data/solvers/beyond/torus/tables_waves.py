"""Tables of the inflated torus: where it is neutral to waves around its axis, and its lowest eigenvalues."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.beyond.torus import tables as states
from reference_data.solvers.beyond.torus.family import EVEN, Family, families
from reference_data.solvers.beyond.torus.fourier import Series as Fourier
from reference_data.solvers.beyond.torus.shooting import Shooting
from reference_data.solvers.beyond.torus.tables import SLENDER, TOLERANCES, USUAL, WAVES, Row, Torus
from reference_data.solvers.beyond.torus.waves_energy import Waves
from reference_data.solvers.beyond.torus.waves_shooting import Jacobi
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.tables import DisagreementError, Levels, Table, agreed, rule
from reference_data.solvers.registry import Builder

BASES = Basis(4, 9, 1.0), Basis(6, 11, 1.0)
"""Coarse and fine polynomials of the waves."""

ROUNDING = 1e-10
"""Rounding of eigenvalues and of their roots by both methods, relative to numbers above one."""

MOST = 3
"""Largest wave number of the tables."""

FIRST, STEP = 1.05, 0.05
"""First volume that is searched over that without stress, and the distance of two."""

SHARES = np.array([1.2, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0])
"""Volumes of the eigenvalues over that without stress."""

REACH = 1e-3
"""Distance in which (a) searches an eigenvalue of (b)."""

STIFF, STIFFER = Torus(0.4, 0.1, (0.5063, 1.406, 1.0187)), Torus(0.4, 0.2, (0.55234, 1.40594, 1.01868))
ENDS = {USUAL: 4.2, SLENDER: 5.2, STIFF: 5.2, STIFFER: 7.2}
"""Tori, and the volumes up to which they are searched over those without stress."""

SERIES = replace(
    states.SERIES,
    columns=states.SERIES.columns
    | {
        "b": ("1/a", "radius of the cross-section"),
        "alpha": ("C2/C1", "constant of the law"),
        "v_end": ("1", "largest volume that was searched over that of the stress-free torus"),
        "n": ("1", "wave number around the axis"),
        "parity": ("1", "of the wave about the equatorial plane: 1 even, -1 odd"),
        "direction": ("1", "1 if an eigenvalue becomes negative with growing volume, -1 if positive"),
    }
    | {
        f"Lambda_n{n}_1": ("a^2/(C1 h)", f"lowest eigenvalue at given pressure, {n} waves around")
        for n in range(MOST + 1)
    },
    method="Two codes without common equations, for states and for waves: (a) shooting with the balance of "
    "forces in space, linearised for the waves; neutral where a determinant at the inner equator is "
    "zero; (b) stationary energy of trigonometric polynomials by the invariants of the metric, and its "
    "second variation by polynomials on elements; neutral where an eigenvalue is zero. Both search the "
    "same volumes and must find points between the same neighbours. A component of the displacement is "
    "held at the outer equator where the torus could else move as a rigid body. " + rule("energy"),
    grid=f"(a) tolerances {TOLERANCES[0]} and {TOLERANCES[1]}; (b) waves up to {WAVES[0]} and {WAVES[1]}, "
    f"{BASES[0].elements} elements of degree {BASES[0].degree} and {BASES[1].elements} of degree "
    f"{BASES[1].degree}",
    tolerance="roots to 1e-13 of the volume; Newton's and Broyden's method down to rounding",
)


@dataclass(frozen=True)
class Point:
    """A state at which a family is neutral, coarse and fine by both methods."""

    torus: Torus
    family: Family
    order: int
    direction: int
    by_shooting: list[Row]
    by_energy: list[Row]


def waves(of: Torus, level: int) -> Waves:
    """The code of the energy at a resolution."""
    return Waves(Fourier(of.b, of.alpha, WAVES[level]), BASES[level])


def jacobi(of: Torus, family: Family, level: int) -> Jacobi:
    """The code of shooting at a resolution."""
    return Jacobi(Shooting(of.b, of.alpha, TOLERANCES[level]), family)


@cache
def search(of: Torus) -> tuple[np.ndarray, list[np.ndarray], list[np.ndarray]]:
    """Volumes, and states there by shooting and by the series."""
    shares = np.arange(FIRST, ENDS[of] + STEP / 2, STEP)
    volumes = of.volume * np.append(shares[shares < ENDS[of] - STEP / 2], ENDS[of])
    return (
        volumes,
        [found for _, found in of.shot(volumes, TOLERANCES[0])],
        [x for _, x in of.fourier(volumes, WAVES[0])],
    )


def neutral(of: Torus, family: Family) -> list[Point]:
    """States of a torus at which a family is neutral.

    Raises:
        DisagreementError: If the methods find them between different neighbours.
    """
    volumes, shot, series = search(of)
    code, own = waves(of, 0), jacobi(of, family, 0)
    counts = np.array([int(np.sum(code.eigenvalues(x, family, 4) < 0)) for x in series])
    values = np.array([own.path(found)[1] for found in shot])
    changes = np.flatnonzero(np.diff(counts)).tolist()
    if changes != np.flatnonzero(values[:-1] * values[1:] < 0).tolist():
        raise DisagreementError(f"{of}, {family}: the methods find points between different neighbours")
    out = []
    for order, i in enumerate(changes, 1):
        index, size = int(min(counts[i : i + 2])), float(np.abs(values[i : i + 2]).max())
        share = values[i] / (values[i] - values[i + 1])
        guess = shot[i] + share * (shot[i + 1] - shot[i])
        a = [jacobi(of, family, level).neutral(guess, size)[0] for level in (0, 1)]
        ends = float(volumes[i]), float(volumes[i + 1])
        b = [_root(waves(of, level), of, family, index, ends) for level in (0, 1)]
        out.append(Point(of, family, order, int(np.sign(counts[i + 1] - counts[i])), a, b))
    return out


def _root(code: Waves, of: Torus, family: Family, index: int, ends: tuple[float, float]) -> Row:
    """The state between two volumes at which an eigenvalue by its number is zero."""
    at = [of.fourier(np.array([ends[0]]), code.series.n)[0][1]]

    def value(volume: float) -> float:
        at[0] = code.series.state(volume, at[0])[1]
        return float(code.eigenvalues(at[0], family, index + 1)[index])

    volume = brentq(value, *ends, xtol=1e-13, rtol=1e-14)
    return {"V": volume} | code.series.state(volume, at[0])[0]


def points(name: str) -> Table:
    """States at which waves are neutral; the even ones of n = 0 are so at limit points."""
    sought = [family for family in families(MOST) if family != Family(0, EVEN)]
    found = [point for of in ENDS for family in sought for point in neutral(of, family)]
    keys = {
        "b": [q.torus.b for q in found],
        "alpha": [q.torus.alpha for q in found],
        "v_end": [ENDS[q.torus] for q in found],
        "n": [q.family.n for q in found],
        "parity": [q.family.parity for q in found],
        "order": [q.order for q in found],
    }
    columns = SERIES.keys(**keys, direction=[q.direction for q in found])
    for column in ("V", "p", "r_out"):
        a, b = (
            Levels(*([row[level][column] for row in rows] for level in (0, 1)), rounding=ROUNDING)
            for rows in ([q.by_shooting for q in found], [q.by_energy for q in found])
        )
        columns.append(agreed(name, column, a, b, SERIES.columns[column], "shooting", "energy"))
    without = "; ".join(
        f"({of.b:g}, {of.alpha:g}, {ENDS[of]:g})" for of in ENDS if of not in {q.torus for q in found}
    )
    notes = f"Searched: n = 0 odd, n = 1 to {MOST} even and odd. None for (b, alpha, v_end) = {without}."
    title = "Tori that are neutral to waves around the axis"
    return SERIES.table(name, title, "", {}, columns, notes=notes, extra={"keys": list(keys)})


def eigenvalues(name: str, title: str, of: Torus) -> Table:
    """The lowest eigenvalue of each wave number, over the volume."""
    volumes = np.round(SHARES * of.volume, 6)
    columns = SERIES.keys(V=volumes)
    series = [[x for _, x in of.fourier(volumes, WAVES[level])] for level in (0, 1)]
    shot = [[found for _, found in of.shot(volumes, TOLERANCES[level])] for level in (0, 1)]
    for n in range(MOST + 1):
        both = [family for family in families(MOST) if family.n == n]
        by_energy = [
            [min((float(waves(of, k).eigenvalues(x, f, 1)[0]), f.parity) for f in both) for x in series[k]]
            for k in (0, 1)
        ]
        by_shooting = [
            [
                jacobi(of, Family(n, parity), k).eigenvalue(found, near, REACH)
                for found, (near, parity) in zip(shot[k], by_energy[k], strict=True)
            ]
            for k in (0, 1)
        ]
        a, b = (
            Levels(*rows, rounding=ROUNDING)
            for rows in (by_shooting, [[value for value, _ in rows] for rows in by_energy])
        )
        column = f"Lambda_n{n}_1"
        columns.append(agreed(name, column, a, b, SERIES.columns[column], "shooting", "energy"))
    return SERIES.table(name, title, "", of.facts, columns)


TABLES: dict[str, Builder] = {
    "torus_waves": partial(points, "torus_waves"),
    "torus_eigenvalues": partial(eigenvalues, "torus_eigenvalues", "Neo-Hookean torus: eigenvalues", USUAL),
    "torus_slender_eigenvalues": partial(
        eigenvalues, "torus_slender_eigenvalues", "Slender torus: eigenvalues", SLENDER
    ),
}
