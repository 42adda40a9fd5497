"""Eigenvalues by both methods for the states of paper 5, and the loads where they change sign."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Column
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper4.methods.shooting_newton import Solution
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.hemisphere import states as hem
from reference_data.solvers.paper5.waves import cylinder as cyl
from reference_data.solvers.paper5.waves import shots as sht
from reference_data.solvers.paper5.waves.second_variation import Quadratic
from reference_data.solvers.paper5.waves.transfer import Parts, Transfer, halved

SPLITS = (1, 2)  # of the base state's elements, coarse and fine
ROUNDING = 5e-10  # of an eigenvalue, relative or absolute: differences between resolutions
SLOPE_STEP = 1e-4


@dataclass
class Spectrum:
    """One state: matrices on two resolutions, and parts for the canonical system on two.

    Attributes:
        forms: Matrices, coarse and fine.
        parts: For a wave number, coarse and fine.
    """

    forms: tuple[Quadratic, Quadratic]
    parts: Callable[[float], tuple[Parts, Parts]]

    def lowest(self, n: float, count: int = 3) -> tuple[Pair, Pair]:
        """Lowest eigenvalues by both methods."""
        a = [q.lowest(n, count)[0] for q in self.forms]
        b = [Transfer(p, n).lowest(count) for p in self.parts(n)]
        floors = [ROUNDING * np.maximum(1.0, np.abs(x[1])) for x in (a, b)]
        return Pair(a[0], a[1], floors[0]), Pair(b[0], b[1], floors[1])


def refined(parts: Parts, times: int) -> Parts:
    """Parts after repeated halving."""
    for _ in range(times):
        parts = halved(parts)
    return parts


@cache
def cylinder(membrane: Membrane, load: float) -> Spectrum:
    """The cylinder at a load."""
    solved = cas.solved(membrane, load)
    forms = tuple(cyl.quadratic(x, k) for x, k in zip(solved.tracked, SPLITS, strict=True))

    def parts(n: float) -> tuple[Parts, Parts]:
        times = int(np.searchsorted((30, 60, 120), n))
        return tuple(refined(sht.parts(x), times) for x in solved.shots)

    return Spectrum(forms, parts)


@dataclass
class Hemisphere:
    """The hemisphere at a level or at a gas pressure, by both methods."""

    load: float
    walk: hem.Walk

    @cached_property
    def tracked(self) -> list[State]:
        """States by collocation."""
        coarse = self.walk.at(self.load)
        return [coarse, hem.fine(coarse, "load", self.load)]

    @cached_property
    def shots(self) -> list[Solution]:
        """States by shooting."""
        return hem.shots(self.tracked[0], "load", self.load)

    @cached_property
    def spectrum(self) -> Spectrum:
        """Second variation of the state."""
        forms = tuple(cyl.quadratic(x, k) for x, k in zip(self.tracked, SPLITS, strict=True))

        def parts(n: float) -> tuple[Parts, Parts]:
            return tuple(sht.hemisphere_parts(x, n, k) for x, k in zip(self.shots, (1, 2), strict=True))

        return Spectrum(forms, parts)


@cache
def hemisphere(zw: float) -> Hemisphere:
    """The hemisphere at a level."""
    return Hemisphere(zw, hem.LEVELS)


@cache
def uneven_hemisphere(zw: float) -> Hemisphere:
    """The hemisphere of uneven thickness at a level."""
    return Hemisphere(zw, hem.UNEVEN_LEVELS)


@cache
def gas_hemisphere(p: float) -> Hemisphere:
    """The hemisphere at a gas pressure."""
    return Hemisphere(p, hem.PRESSURES)


@dataclass
class Crossing:
    """A load where the lowest eigenvalue of a wave number passes zero.

    Attributes:
        n: Wave number.
        direction: 1 if it becomes negative as the load rises, -1 if it becomes positive.
        pairs: The load by both methods.
        slope: Derivative of the eigenvalue by the load.
    """

    n: float
    direction: int
    pairs: tuple[Pair, Pair]
    slope: float


def crossing(spectrum: Callable[[float], Spectrum], n: float, low: float, high: float) -> Crossing:
    """Root on the fine matrices; the other three values follow from their eigenvalues and the slope there."""
    x = float(brentq(lambda x: spectrum(float(x)).forms[1].first(n), low, high, xtol=1e-13))
    ends = [spectrum(x + k * SLOPE_STEP).forms[1].first(n) for k in (-1, 1)]
    slope = (ends[1] - ends[0]) / (2 * SLOPE_STEP)
    a, b = spectrum(x).lowest(n, 1)
    floor = np.array([ROUNDING / abs(slope)])
    pairs = tuple(Pair(x - p.coarse / slope, x - p.fine / slope, floor) for p in (a, b))
    return Crossing(n, -int(np.sign(slope)), pairs, slope)


def turning(name: str, found: list[Crossing], control: str) -> list[Column]:
    """Columns of loads at which lowest eigenvalues change sign."""
    pairs = cas.stacked([tuple(Pair(p.coarse[0], p.fine[0], p.floor[0]) for p in x.pairs) for x in found])
    keys = text.SERIES.keys(n=[x.n for x in found], direction=[x.direction for x in found])
    return [*keys, cas.agreed(name, control, *pairs, text.COLUMNS[control])]


def spectra(name: str, rows: list[tuple[Pair, Pair]]) -> list[Column]:
    """Columns of the three lowest eigenvalues of some states."""
    out = []
    for k, column in enumerate(("Lambda_1", "Lambda_2", "Lambda_3")):
        pairs = [
            Pair(*(np.array([getattr(r[i], part)[k] for r in rows]) for part in ("coarse", "fine", "floor")))
            for i in (0, 1)
        ]
        out.append(cas.agreed(name, column, *pairs, text.COLUMNS[column]))
    return out
