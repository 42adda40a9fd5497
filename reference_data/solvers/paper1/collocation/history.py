r"""Adhesive contact with a locked patch by collocation (method b).

The slopes rho_c' = g(x) and F' = x H(x) that the passing front froze in are Chebyshev series on
[0, reach]. At as many fronts s_j the outer problems [s_j, 1/beta] are solved together. The series must equal
the slopes just outside of the front. This fixed point is found by repeated substitution with Anderson's
mixing. All other quantities of the patch follow by integrals,

.. math::
   \rho_c = s \int_0^1 g(su)\,du, \quad F = s^2 \int_0^1 u H(su)\,du, \quad
   I = \int_0^s \tfrac12 \rho_c^2 F' dx, \quad J = \int_0^s (F(s) - F)^2 \rho_c \rho_c' dx .

Conditions of the outer zone: rho(s) = rho_c(s), the balance of the patch

.. math:: p \rho_*^2/2 - k [ (e_* - l) \rho_*^2/2 + I ] - s\, W_1 \sin\theta = 0

and the rim; in inflation also eta(s) = l, p being unknown; in deflation p is given.
Source: Patil, DasGupta & Eriksson (2015), sections 3.2 and 3.3.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import lagrange
from reference_data.solvers.core.newton import settled
from reference_data.solvers.paper1.collocation.equations import (
    Array,
    Batch,
    Sliding,
    evaluate,
    newton,
    spread,
)
from reference_data.solvers.paper1.collocation.states import (
    Resolution,
    at_rim,
    joined,
    strain_energy,
    volume,
)
from reference_data.solvers.paper1.membrane import Disk, Patch

STAGES = (0.4, 0.7, 1.0)  # fraction of the reach, so that the free state is not a guess far out
_GAUSS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(24)
POINTS, WEIGHTS = (_GAUSS + 1) / 2, _GAUSS_WEIGHTS / 2


@dataclass(frozen=True)
class History:
    """Frozen slopes g = rho_c' and H = F'/x at Chebyshev points of [0, reach]."""

    disk: Disk
    reach: float
    g: Array
    h: Array

    @cached_property
    def fronts(self) -> Array:
        """Positions of the front: Chebyshev points."""
        n = len(self.g)
        return self.reach * (1 - np.cos(np.pi * (np.arange(n) + 0.5) / n)) / 2

    def series(self, values: Array, x: Array) -> Array:
        """A series given by its values at the fronts, at any x."""
        flat = np.ravel(x)
        return (lagrange(self.fronts, flat) @ values).reshape(np.shape(x))

    def stretched(self, reach: float) -> History:
        """A guess for a longer history: constant where it is unknown."""
        new = replace(self, reach=reach)
        known = np.minimum(new.fronts, self.reach)
        return replace(new, g=self.series(self.g, known), h=self.series(self.h, known))

    def radius(self, x: Array) -> Array:
        """rho_c/x."""
        return self.series(self.g, x[..., None] * POINTS) @ WEIGHTS

    def depth(self, x: Array) -> Array:
        """F/x^2."""
        return self.series(self.h, x[..., None] * POINTS) @ (WEIGHTS * POINTS)

    def patch(self, x: Array) -> Patch:
        """Patches with their edges at x (every number an array)."""
        x = np.asarray(x, dtype=float)
        inside = x[..., None] * POINTS
        radius, depth = self.radius(inside), self.depth(inside)
        slope, dip = self.series(self.g, inside), self.series(self.h, inside)
        moment = x**4 * ((radius**2 * dip * POINTS**3) @ WEIGHTS) / 2
        total = self.depth(x)
        left = total[..., None] - depth * POINTS**2
        second = x**6 * ((left**2 * radius * slope * POINTS) @ WEIGHTS)
        l1 = np.sqrt(slope**2 + (inside * dip) ** 2)
        energy = x**2 * ((mat.energy(l1, radius, self.disk.alpha) * POINTS) @ WEIGHTS)
        rho, edge = x * self.radius(x), x * self.series(self.h, x)
        return Patch(x, rho, x * x * total, moment, second, energy, self.series(self.g, x), edge)


def outer(disk: Disk, mesh: Any, patch: Patch, batch: Batch, p: Any = None) -> Batch:
    """The outer problems of patches: inflation, or deflation at the pressures p."""
    length = disk.length

    def conditions(left: Any, right: Any, scalars: Any) -> list[Any]:
        rho, eta, l1, th = left[0]
        pull = patch.x * mat.slope(l1, rho / patch.x, disk.alpha) * np.sin(th)
        springs = disk.k * ((eta - disk.l) * patch.rho**2 / 2 + patch.moment)
        # divided by x*^2, so that small patches have the same weight as large ones
        balance = (scalars[0] * patch.rho**2 / 2 - springs - pull) / patch.x**2
        last = eta - disk.l if p is None else scalars[0] - p
        return [rho - patch.rho, balance, *at_rim(right[0]), last]

    return replace(batch, ends=lambda _: [(patch.x, length)], conditions=conditions)


def cut(batch: Batch, picks: Any, disk: Disk, how: Resolution, fronts: Array) -> Batch:
    """Guess for outer zones: states ``picks`` of a batch (its last zone), cut at the fronts."""
    d, parts = len(batch.zones) - 1, []
    for i, front in zip(np.broadcast_to(picks, fronts.shape), fronts, strict=True):
        x = spread(front, disk.length, how.outer.x)[0]
        y = evaluate(batch, d, i, x.ravel()).reshape(1, *x.shape, 4)
        parts.append(Batch((Sliding(disk, how.outer),), (y,), batch.scalars[i : i + 1], None, None))
    return joined(parts)


def between(states: Batch, fronts: Array, wanted: Array) -> Batch:
    """Guess for the states at given fronts, interpolated between those at all fronts."""
    rows = lagrange(fronts, wanted)
    y = tuple(np.einsum("ws,s...->w...", rows, part) for part in states.y)
    return replace(states, y=y, scalars=rows @ states.scalars)


@dataclass
class Adhesive:
    """Adhesive inflation: the history and the states at its fronts."""

    disk: Disk
    how: Resolution
    onset: Batch
    reach: float
    history: History = field(init=False)
    states: Batch = field(init=False)

    @property
    def pole(self) -> tuple[float, float]:
        """Stretch of the pole at first contact, which stays, and slope of its angle."""
        lam = float(self.onset.y[0][0, 0, 0, 2])
        return lam, float(self.onset.p[0]) * lam**2 / (2 * mat.slope(lam, lam, self.disk.alpha))

    def problem(self, fronts: Array, guess: Batch) -> Batch:
        """The problems whose patches end at some fronts."""
        return outer(self.disk, self.how.outer, self.history.patch(fronts), guess)

    def at(self, fronts: Array) -> Batch:
        """States with their fronts at the given places."""
        fronts = np.atleast_1d(np.asarray(fronts, dtype=float))
        return newton(self.problem(fronts, between(self.states, self.history.fronts, fronts)))

    def settle(self, g: Array, h: Array | None = None, tolerance: float = 1e-14) -> None:
        """Make slopes (g, H), or g alone, those that the states outside their fronts have."""

        def substituted(z: Array) -> Array:
            new = z.reshape(-1, len(g))
            self.history = replace(self.history, g=new[0], h=new[-1] if h is not None else self.history.h)
            fronts = self.history.fronts
            self.states = newton(self.problem(fronts, self.states))
            _, _, l1, th = self.states.y[-1][:, 0, 0].T
            found = [l1 * np.cos(th), l1 * np.sin(th) / fronts]
            return np.concatenate(found[: len(new)])

        substituted(settled(substituted, g if h is None else np.concatenate([g, h]), tolerance))


@dataclass
class Inflation(Adhesive):
    """The patch is locked in both directions."""

    def __post_init__(self) -> None:
        (lam, c), flat = self.pole, np.ones(self.how.terms)
        self.history = History(self.disk, STAGES[0] * self.reach, lam * flat, lam * c * flat)
        self.states = cut(self.onset, 0, self.disk, self.how, self.history.fronts)
        for part in STAGES:
            old, self.history = self.history.fronts, self.history.stretched(part * self.reach)
            before = np.searchsorted(old, self.history.fronts, side="right") - 1
            if part > STAGES[0]:
                self.states = cut(self.states, before, self.disk, self.how, self.history.fronts)
            self.settle(self.history.g, self.history.h, 1e-14 if part == 1 else 1e-3)


def deflated(disk: Disk, how: Resolution, patch: Patch, start: Batch, p: Any) -> Batch:
    """States of given patches at given pressures, from neighbouring states."""
    return newton(outer(disk, how.outer, patch, start, np.asarray(p, dtype=float)))


def potential(batch: Batch, patch: Patch) -> Array:
    """Pi/(2 pi) of membrane, gas and springs."""
    disk, height = batch.zones[0].disk, batch.y[0][:, 0, 0, 1]
    gas = batch.p * (patch.moment + volume(batch, 0))
    return patch.energy + strain_energy(batch, 0) - gas + patch.spring(disk, height)
