"""Zones of a wrinkled membrane along its meridian."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from weakforms.errors import ConvergenceError
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.model import TAUT, WRINKLED

PER_CELL = 9
"""Number of points of each cell at which zones are searched."""

NEAR_ENDS = 10.0 ** -np.arange(1.0, 11.0)
"""Distances from the ends, relative to the length, at which thin zones are searched in addition."""

NEGATIVE_RADIUS = 1e-9
"""Largest negative radius, relative to the length, that is round-off (at a pole)."""


@dataclass(frozen=True)
class Zones:
    """Taut and wrinkled zones of a state, and the point where the liquid's surface cuts the meridian."""

    first: float
    """State of the zone at the first end."""
    fronts: tuple[float, ...]
    """Material points where the state changes."""
    surface: float | None = None
    """Material point at the fluid level; ``None`` if the membrane is all wet or all dry."""
    wet: bool = False
    """Whether the membrane is all wet or, with a surface, wet up to it."""

    @property
    def kind(self) -> tuple:
        """The pattern of zones, which does not change while fronts move."""
        return self.first, len(self.fronts), self.surface is None, self.wet

    def states(self, s: np.ndarray) -> np.ndarray:
        """State at material points."""
        return np.where(np.searchsorted(self.fronts, s) % 2 == 0, self.first, -self.first)

    def left_out_of(self, others: Zones) -> tuple[float, ...]:
        """Fronts of another state that are not the nearest one to any front of this state."""
        left = list(others.fronts)
        for front in self.fronts:
            left.remove(min(left, key=lambda f, front=front: abs(f - front)))
        return tuple(left)

    def share(self, state: float, length: float) -> float:
        """Fraction of the length in a state."""
        widths = np.diff([0.0, *self.fronts, length])
        return float(widths[(0 if self.first == state else 1) :: 2].sum() / length)

    def without_thinnest(self, length: float) -> Zones:
        """The same zones without the thinnest one, which joins its neighbours."""
        edges = np.array([0.0, *self.fronts, length])
        k = int(np.argmin(np.diff(edges)))
        drop = {k - 1, k} if 0 < k < len(edges) - 2 else {0} if k == 0 else {k - 1}
        kept = tuple(f for i, f in enumerate(self.fronts) if i not in drop)
        return Zones(-self.first if k == 0 else self.first, kept, self.surface, self.wet)

    def thicker_than(self, share: float, length: float) -> Zones:
        """The same zones without those that are thinner than a fraction of the length, the thinnest first."""
        found = self
        while found.fronts and np.diff([0.0, *found.fronts, length]).min() < share * length:
            found = found.without_thinnest(length)
        return found


def zones(meridian: Meridian, loads: Mapping[str, float], flat: float, liquid: bool) -> Zones:
    """Zones of the state that a model holds.

    Args:
        meridian: Fields of the state.
        loads: Loads of the state.
        flat: Deviations of ``gw`` from 1 up to this count as taut.
        liquid: Whether there is a liquid.

    Raises:
        ConvergenceError: If the surface crosses the axis, which is not a physical equilibrium.
    """
    model = meridian.model
    breaks = model.breaks_of(loads)
    length = breaks[-1]
    t = (1 - np.cos(np.pi * (np.arange(PER_CELL) + 0.5) / PER_CELL)) / 2
    inner = ((np.arange(model.blocks * model.cells)[:, None] + t) / model.cells).ravel()
    s = np.concatenate(
        [model.material(inner, loads), length * NEAR_ENDS, length * (1 - NEAR_ENDS), [0.0, length]]
    )
    s = np.unique(s)
    found = meridian.sampled(s, loads)
    if found["r"].min() < -NEGATIVE_RADIUS * length:
        raise ConvergenceError("the equilibrium is turned inside out")
    excess = found["gw"] - 1.0
    sign = np.where(np.abs(excess) > flat, np.sign(excess), 0.0)
    known = np.flatnonzero(sign)
    if not len(known):
        first, fronts = TAUT, ()
    else:
        first = TAUT if sign[known[0]] > 0 else WRINKLED
        change = known[:-1][sign[known[:-1]] != sign[known[1:]]]
        after = known[1:][sign[known[:-1]] != sign[known[1:]]]
        fronts = tuple(_crossing(s, excess, i, j) for i, j in zip(change, after, strict=True))
    surface, wet = None, False
    if liquid:
        under = loads["zw"] - found["z"]
        wet = bool(under[0] > 0)
        across = np.flatnonzero(under[:-1] * under[1:] < 0)
        if len(across):
            surface = _crossing(s, under, int(across[0]), int(across[0]) + 1)
    return Zones(first, fronts, surface, wet)


def _crossing(s: np.ndarray, values: np.ndarray, i: int, j: int) -> float:
    share = values[i] / (values[i] - values[j])
    return float(s[i] + share * (s[j] - s[i]))
