"""The part of the plane in which lines are followed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

INSIDE = 1e-9
"""Relative distance within which a point lies on a side of the window."""

MARGIN = 0.05
"""Part of the window by which a line is followed beyond it where meshes differ in the points on it: on a
coarser mesh a point near a side may lie outside."""


@dataclass(frozen=True)
class Window:
    """The part of the plane in which lines are followed, and the largest displacement."""

    vary: str
    """The parameter over which lines are drawn, besides the load."""
    low: float
    high: float
    load_low: float
    load_high: float
    end: float
    """Largest value of the column ``depth`` of the membrane."""
    load: str = "p"

    def outside(
        self, columns: Mapping[str, float], depth: str, others: Sequence[tuple[str, float, int]] = ()
    ) -> list[tuple[str, float]]:
        """Sides beyond which a point lies: column and value.

        Args:
            columns: Of the point.
            depth: Column of the membrane's largest displacement.
            others: Column, value and outward direction of further sides.
        """
        sides = (
            (self.vary, self.low, -1),
            (self.vary, self.high, 1),
            (self.load, self.load_low, -1),
            (self.load, self.load_high, 1),
            (depth, self.end, 1),
            *others,
        )
        return [
            (name, side)
            for name, side, outward in sides
            if outward * (columns[name] - side) > INSIDE * max(1.0, abs(side))
        ]

    def wider(self) -> Window:
        """The window with its margin."""
        more = MARGIN * (self.high - self.low)
        sides = {"low": self.low - more, "high": self.high + more, "end": (1 + MARGIN) * self.end}
        loads = {
            "load_low": self.load_low - MARGIN * abs(self.load_low),
            "load_high": self.load_high + MARGIN * abs(self.load_high),
        }
        return replace(self, **sides, **loads)
