"""States by both methods, starting from the unloaded membrane, and the columns on which they agree."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from reference_data.solvers.core import tables
from reference_data.solvers.core.tables import Column, DisagreementError, Levels
from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.collocation import State

CELLS = 400  # of the untracked search for the pattern
STEPS = (5, 10)  # Runge-Kutta steps per segment
SAMPLES = 160  # intervals between the rows of a profile
ROUNDING = 3e-13  # relative, remaining error of Newton's last step


@dataclass
class Pair(Levels):
    """Coarse and fine values of one method, and what Newton's last step leaves."""

    rounding: float = ROUNDING


@cache
def grids(membrane: Membrane) -> dict[float, fd.Grid]:
    """Finite-difference states computed so far, by load."""
    return {0.0: fd.unloaded(membrane, CELLS)}


def grid_at(membrane: Membrane, load: float) -> fd.Grid:
    """Finite-difference state at a load, in steps from the nearest one below."""
    known = grids(membrane)
    if load not in known:
        known[load] = fd.walk(known[max(x for x in known if x <= load)], load)
    return known[load]


@dataclass
class Solved:
    """One state by collocation on two rules and, if requested, by shooting with two steps."""

    membrane: Membrane
    load: float

    @cached_property
    def tracked(self) -> list[State]:
        """States by collocation."""
        guess, out = sta.from_grid(grid_at(self.membrane, self.load), sta.RULES[0]), []
        for rule in sta.RULES:
            guess = guess if guess.rule == rule else sta.moved_to(guess, rule)
            guess = sta.polished(guess, "load", self.load)
            out.append(guess)
        return out

    @cached_property
    def shots(self) -> list[sho.Solution]:
        """States by shooting."""
        starts = sho.from_grid(grid_at(self.membrane, self.load))
        first = sho.solve(self.membrane, starts, self.load, "load", self.load, STEPS[0])
        return [first, sho.refined(first, self.load, STEPS[1])]

    @cached_property
    def measured(self) -> tuple[list[msr.Measures], list[msr.Measures]]:
        """Measures of the collocation states and of the shots.

        Raises:
            DisagreementError: If the numbers of fronts differ.
        """
        a = [msr.measures(x) for x in self.tracked]
        b = [smsr.measures(x) for x in self.shots]
        counts = {len(x.fronts) for x in [*a, *b]}
        if len(counts) > 1:
            raise DisagreementError(
                f"{self.membrane} at {self.load:g}: fronts {a[1].fronts} against {b[1].fronts}"
            )
        return a, b

    def scalar(self, name: str) -> tuple[Pair, Pair]:
        """One of the measures' scalars by both methods."""
        a, b = self.measured
        floor = 0.0
        if name == "wrinkled_fraction":
            floor = float(np.sum(ROUNDING / a[1].slopes)) / self.membrane.L
        both = [Pair(*(np.array(x.scalars[name]) for x in m), floor) for m in (a, b)]
        return both[0], both[1]

    @property
    def fronts(self) -> tuple[Pair, Pair]:
        """Positions of the fronts by both methods; rounding is amplified where gw is flat."""
        a, b = self.measured
        floor = ROUNDING / a[1].slopes
        return Pair(a[0].fronts, a[1].fronts, floor), Pair(b[0].fronts, b[1].fronts, floor)

    @property
    def zones(self) -> str:
        """Pattern from the bottom up, in words."""
        if self.membrane.energy == "standard":
            m = self.measured[0][1]
            return " ".join("gw>1" if m.first == (i % 2 == 0) else "gw<1" for i in range(len(m.fronts) + 1))
        return words(self.tracked[1].pattern.signature)


def words(signature: tuple[bool, ...]) -> str:
    """The zones, taut or wrinkled, from the bottom up."""
    return " ".join("taut" if t else "wrinkled" for t in signature)


@cache
def solved(membrane: Membrane, load: float) -> Solved:
    """The state at a load."""
    return Solved(membrane, load)


def agreed(table: str, name: str, a: Pair, b: Pair, about: tuple[str, str]) -> Column:
    """Column of collocation values, after a check that shooting agrees."""
    return tables.agreed(table, name, b, a, about, other="shooting")


def stacked(pairs: list[tuple[Pair, Pair]]) -> tuple[Pair, Pair]:
    """Combine pairs of single numbers into columns by both methods."""
    out = []
    for i in (0, 1):
        parts = [p[i] for p in pairs]
        coarse, fine = (np.array([getattr(p, k) for p in parts], dtype=float) for k in ("coarse", "fine"))
        out.append(Pair(coarse, fine, np.array([p.floor for p in parts], dtype=float)))
    return out[0], out[1]


def profiles(state: Solved) -> tuple[Array, dict[str, tuple[Pair, Pair]]]:
    """Rows Z and the columns of a profile by both methods; no row lies on a front."""
    s = np.linspace(0, state.membrane.L, SAMPLES + 1)
    fronts = state.measured[0][1].fronts
    apart = np.abs(s[:, None] - fronts).min(axis=1, initial=1.0)
    keep = (apart > 1e-6) | (np.arange(len(s)) % SAMPLES == 0)
    a = [msr.profile(x, s[keep]) for x in state.tracked]
    every = [sho.SEGMENTS * n // SAMPLES for n in STEPS]
    b = [{k: v[keep] for k, v in smsr.profile(x, e).items()} for x, e in zip(state.shots, every, strict=True)]
    return s[keep], {k: (Pair(a[0][k], a[1][k]), Pair(b[0][k], b[1][k])) for k in a[0]}
