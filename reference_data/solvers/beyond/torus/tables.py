"""Tables of the inflated torus: states over the volume, the limit point, and the meridian of one state."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.polynomial import Chebyshev

from reference_data.solvers.beyond.torus.fourier import Series as Fourier
from reference_data.solvers.beyond.torus.shooting import Shooting
from reference_data.solvers.core.tables import Levels, Series, Table, agreed, rule
from reference_data.solvers.registry import Builder

TOLERANCES, WAVES = (1e-9, 1e-11), (28, 40)
"""Coarse and fine resolution of shooting and of the Fourier series."""

ROUNDING = 1e-12
"""Rounding of both methods, relative to numbers above one."""

VOLUMES = np.array([1.05, 1.1, 1.2, 1.35, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0])
"""Volumes of the tables over that of the stress-free torus."""

WAY = np.linspace(1.05, 4.0, 60)
"""Volumes on the way to a state, over that of the stress-free torus."""

NEAR, NODES = 0.15, 12
"""A limit point is searched within this fraction of its volume, by a polynomial through so many states."""

SERIES = Series(
    paper="beyond",
    source="a benchmark of codes for membranes: the toroidal membrane",
    columns={
        "order": ("1", "number of the point along the branch"),
        "V": ("1/a^3", "enclosed volume"),
        "p": ("a/(C1 h)", "pressure"),
        "r_out": ("1/a", "radius of the outer equator"),
        "r_in": ("1/a", "radius of the inner equator"),
        "z_top": ("1/a", "largest height"),
        "U": ("1/(C1 h a^2)", "strain energy"),
        "virial": ("1/(C1 h a^2)", "int (lam1 W_1 + lam2 W_2) dA"),
        "t": ("1", "angle of the cross-section without stress, from the outer equator"),
        "r": ("1/a", "distance from the axis"),
        "z": ("1/a", "height"),
        "lam1": ("1", "meridional stretch"),
        "lam2": ("1", "circumferential stretch"),
    },
    method="Two codes without common equations: (a) shooting with the balance of forces along the meridian "
    "between both equators; (b) stationary energy of trigonometric polynomials by the invariants "
    "of the metric. " + rule("Fourier"),
    grid=f"(a) tolerances {TOLERANCES[0]} and {TOLERANCES[1]}; (b) waves up to {WAVES[0]} and {WAVES[1]}",
    tolerance="steps of Newton's method and of Broyden's method down to rounding",
)

Row = dict[str, float]


@dataclass(frozen=True)
class Torus:
    """One torus of the tables.

    Attributes:
        b: Ratio of the radii.
        alpha: C2/C1.
        first: Pressure, outer radius and meridional stretch there at the first of :data:`VOLUMES`, roughly.
    """

    b: float
    alpha: float
    first: tuple[float, float, float]

    @property
    def facts(self) -> dict[str, object]:
        """Parameters of the problem."""
        return {"b": self.b, "alpha": self.alpha}

    @property
    def volume(self) -> float:
        """Volume without stress."""
        return 2 * np.pi**2 * self.b**2

    def _way(self, volumes: np.ndarray) -> np.ndarray:
        """The given volumes after those on the way to the first."""
        before = self.volume * WAY
        return np.append(before[before < volumes[0] * (1 - 1e-9)], volumes)

    def fourier(self, volumes: np.ndarray, waves: int) -> list[tuple[Row, np.ndarray]]:
        """States by Fourier series, each from the one before, and their unknowns."""
        code, out = Fourier(self.b, self.alpha, waves), []
        x = code.start(1.0)
        for volume in self._way(volumes):
            row, x = code.state(float(volume), x)
            out.append((row, x))
        return out[-len(volumes) :]

    def shot(self, volumes: np.ndarray, tolerance: float) -> list[tuple[Row, np.ndarray]]:
        """States by shooting, and their ``(p, r, l_1)`` at the outer equator, extrapolated on the way."""
        code, way = Shooting(self.b, self.alpha, tolerance), self._way(volumes)
        out: list[tuple[Row, np.ndarray]] = []
        for k, volume in enumerate(way):
            guess = np.array(self.first) if k == 0 else out[-1][1]
            if k > 1:
                guess = guess + (volume - way[k - 1]) / (way[k - 1] - way[k - 2]) * (guess - out[-2][1])
            out.append(code.state(float(volume), guess))
        return out[-len(volumes) :]


def both(of: Torus, volumes: np.ndarray) -> tuple[list[list[Row]], list[list[Row]]]:
    """Rows by both methods, each at both resolutions."""
    a = [[row for row, _ in of.shot(volumes, tolerance)] for tolerance in TOLERANCES]
    b = [[row for row, _ in of.fourier(volumes, waves)] for waves in WAVES]
    return a, b


def _levels(pair: list[list[Row]], name: str) -> Levels:
    coarse, fine = ([row[name] for row in rows] for rows in pair)
    return Levels(coarse, fine, rounding=ROUNDING)


def _agreed(table: str, names: tuple[str, ...], a: list[list[Row]], b: list[list[Row]]) -> list:
    return [
        agreed(table, name, _levels(a, name), _levels(b, name), SERIES.columns[name], "shooting", "Fourier")
        for name in names
    ]


def curve(name: str, title: str, of: Torus) -> Table:
    """States over the volume."""
    volumes = np.round(VOLUMES * of.volume, 6)
    a, b = both(of, volumes)
    columns = SERIES.keys(V=volumes)
    columns += _agreed(name, ("p", "r_out", "r_in", "z_top", "U", "virial"), a, b)
    return SERIES.table(name, title, "", of.facts, columns)


def limit(name: str, title: str, of: Torus, near: float) -> Table:
    """The limit point, where the pressure is largest, near a volume over that without stress."""
    middle, half = near * of.volume, NEAR * near * of.volume
    volumes = middle + half * np.cos(np.pi * np.arange(NODES, -1, -1) / NODES)
    a, b = ([[_largest(volumes, rows)] for rows in found] for found in both(of, volumes))
    columns = SERIES.keys(order=np.ones(1))
    columns += _agreed(name, ("V", "p", "r_out", "U"), a, b)
    return SERIES.table(name, title, "", of.facts, columns)


def _largest(volumes: np.ndarray, rows: list[Row]) -> Row:
    """Numbers where the polynomial of the pressure is largest."""
    fits = {n: Chebyshev.fit(volumes, [row[n] for row in rows], NODES) for n in ("p", "r_out", "U")}
    roots = fits["p"].deriv().roots()
    (at,) = (x.real for x in roots if abs(x.imag) < 1e-9 and volumes[0] < x.real < volumes[-1])
    return {"V": float(at)} | {n: float(fit(at)) for n, fit in fits.items()}


def meridian(name: str, title: str, of: Torus, share: float) -> Table:
    """The meridian of one state, at a volume over that without stress."""
    volume, t = np.round(share * of.volume, 6), np.linspace(0.0, np.pi, 13)
    a = [Shooting(of.b, of.alpha, x).meridian(of.shot(np.array([volume]), x)[-1][1], t) for x in TOLERANCES]
    b = [Fourier(of.b, of.alpha, n).meridian(of.fourier(np.array([volume]), n)[-1][1], t) for n in WAVES]
    columns = SERIES.keys(t=t)
    columns += [
        agreed(name, n, _columns(a, n), _columns(b, n), SERIES.columns[n], "shooting", "Fourier")
        for n in ("r", "z", "lam1", "lam2")
    ]
    return SERIES.table(name, title, "", of.facts | {"V": float(volume)}, columns)


def _columns(pair: list[dict[str, np.ndarray]], name: str) -> Levels:
    return Levels(pair[0][name], pair[1][name], rounding=ROUNDING)


USUAL, SLENDER = Torus(0.4, 0.0, (0.46, 1.406, 1.0187)), Torus(0.2, 0.1, (1.0217, 1.20441, 1.02069))

TABLES: dict[str, Builder] = {
    name: partial(make, name, *given)
    for name, make, *given in (
        ("torus", curve, "Neo-Hookean torus", USUAL),
        ("torus_slender", curve, "Slender torus", SLENDER),
        ("torus_limit", limit, "Neo-Hookean torus: limit point", USUAL, 2.9),
        ("torus_slender_limit", limit, "Slender torus: limit point", SLENDER, 3.5),
        ("torus_meridian", meridian, "Neo-Hookean torus: meridian", USUAL, 2.0),
    )
}
