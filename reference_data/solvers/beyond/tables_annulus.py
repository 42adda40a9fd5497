"""Tables of the turned annulus: states over the angle, and the onset of wrinkling of a stretched one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from reference_data.solvers.beyond.annulus.shooting import Ring, Shooting
from reference_data.solvers.beyond.annulus.spectral import Pieces
from reference_data.solvers.core.tables import Levels, Series, Table, agreed, rule, steps
from reference_data.solvers.registry import Builder

TOLERANCES, DEGREES = (1e-9, 1e-11), (22, 30)
"""Coarse and fine resolution of shooting and of the spectral method."""

ROUNDING = 1e-12
"""Rounding of both methods, relative to numbers above one."""

SERIES = Series(
    paper="beyond",
    source="Reissner (1938); set-up of a published finite element model (COMSOL)",
    columns={
        "order": ("1", "number of the point along the branch"),
        "psi": ("1", "angle of the inner edge in radians"),
        "M": ("1/(C1 h R_o^2)", "torque"),
        "U": ("1/(C1 h R_o^2)", "strain energy"),
        "R_front": ("1/R_o", "reference radius of the front, wrinkled inside of it and taut outside"),
    },
    method="Two codes without common equations: (a) shooting from the inner edge with principal stretches "
    "and the force's direction, the front being an event; (b) stationary energy of polynomials on each "
    "piece, the front being an unknown. " + rule("spectral"),
    grid=f"(a) tolerances {TOLERANCES[0]} and {TOLERANCES[1]}; (b) degrees {DEGREES[0]} and {DEGREES[1]}",
    tolerance="steps of Newton's method and of Broyden's method down to rounding",
)


@dataclass(frozen=True)
class Turned:
    """One annulus of the tables.

    Attributes:
        ring: Geometry and law.
        wrinkled: Its pieces, from the inner edge outwards.
        first: Force and moment per radian at the inner edge at the first angle, roughly.
    """

    ring: Ring
    wrinkled: tuple[bool, ...]
    first: tuple[float, float]

    @property
    def facts(self) -> dict[str, object]:
        """Parameters of the problem."""
        return {"a": self.ring.a, "s": self.ring.s, "alpha": self.ring.alpha}

    def pieces(self, degree: int) -> Pieces:
        """The spectral method's annulus."""
        return Pieces(self.ring.a, self.ring.s, self.ring.alpha, self.wrinkled, degree)


def shot(of: Turned, angles: np.ndarray, tolerance: float) -> list[dict[str, float]]:
    """States by shooting, each from the one before."""
    code, guess, out = Shooting(of.ring, tolerance), of.first, []
    for psi in angles:
        out.append(code.state(float(psi), guess, of.wrinkled[0]))
        guess = out[-1]["pull"], out[-1]["moment"]
    return out


def spectral(of: Turned, angles: np.ndarray, degree: int) -> list[dict[str, float]]:
    """The same states by polynomials."""
    code = of.pieces(degree)
    z, last, out = code.start(float(angles[0])), angles[0], []
    for psi in angles:
        z, last = code.solve(float(psi), code.turned(z, psi / last)), psi
        out.append(code.columns(z, float(psi)))
    return out


def _levels(pair: list[list[dict[str, float]]], name: str) -> Levels:
    coarse, fine = ([row[name] for row in rows] for rows in pair)
    return Levels(coarse, fine, rounding=ROUNDING)


def curve(name: str, title: str, of: Turned, angles: np.ndarray) -> Table:
    """States over the angle."""
    a = [shot(of, angles, tolerance) for tolerance in TOLERANCES]
    b = [spectral(of, angles, degree) for degree in DEGREES]
    names = ("M", "U", "R_front")[: 2 + (len(of.wrinkled) > 1)]
    columns = SERIES.keys(psi=angles)
    columns += [
        agreed(name, n, _levels(a, n), _levels(b, n), SERIES.columns[n], "shooting", "spectral")
        for n in names
    ]
    return SERIES.table(name, title, "", of.facts, columns)


def onset(name: str, title: str, of: Turned) -> Table:
    """The first wrinkle of a pre-stretched annulus."""
    a = [[Shooting(of.ring, tolerance).onset(of.first)] for tolerance in TOLERANCES]
    b = []
    for degree in DEGREES:
        code = of.pieces(degree)
        z, psi = code.onset(0.1, code.start(0.1))
        b.append([{"psi": psi} | code.columns(z, psi)])
    columns = SERIES.keys(order=np.ones(1))
    columns += [
        agreed(name, n, _levels(a, n), _levels(b, n), SERIES.columns[n], "shooting", "spectral")
        for n in ("psi", "M", "U")
    ]
    return SERIES.table(name, title, "", of.facts, columns)


WIDE = Turned(Ring(0.4, 1.0, 0.0), (True, False), (0.0245, 0.0254))
NARROW = Turned(Ring(0.8, 1.0, 0.1), (True,), (0.38, 0.29))
STRETCHED = Turned(Ring(0.4, 1.05, 0.1), (True, False), (0.28, 0.136))
STRETCHED_TAUT = Turned(Ring(0.4, 1.05, 0.1), (False,), (0.3, 0.108))

TABLES: dict[str, Builder] = {
    name: partial(make, name, *given)
    for name, make, *given in (
        ("annulus_wide", curve, "Neo-Hookean annulus with a taut ring", WIDE, steps(0.05, 0.5, 0.05)),
        ("annulus_narrow", curve, "Annulus that wrinkles everywhere", NARROW, steps(0.05, 0.3, 0.05)),
        ("annulus_stretched", curve, "Stretched annulus past its onset", STRETCHED, steps(0.15, 0.5, 0.05)),
        ("annulus_onset", onset, "Stretched annulus: first wrinkle", STRETCHED_TAUT),
    )
}
