"""Polynomials through the neighbours of every point of a trace, which do not know of the point itself."""

from __future__ import annotations

import numpy as np

SIDE = 4
"""Neighbours on either side through which a polynomial goes; the error is that against one fewer a side."""

EVEN = 0.05
"""Smallest step of a column over its largest within a window over which a polynomial is believed."""


class Windows:
    """Polynomials through the neighbours of every point of a trace, over columns that rise or fall there.

    Args:
        columns: Of the trace.
        kinks: Points that no window may hold.
    """

    def __init__(self, columns: dict[str, np.ndarray], kinks: list[int]) -> None:
        self.columns = columns
        self.count = len(next(iter(columns.values()), ()))
        inner = np.arange(SIDE, self.count - SIDE)
        clear = np.array([all(abs(i - k) > SIDE for k in kinks) for i in inner], dtype=bool)
        self.inner = inner[clear]
        self.rows = self.inner[:, None] + np.arange(-SIDE, SIDE + 1)
        self.evenness = {name: self._evenness(values) for name, values in columns.items()}
        self._weights: dict[str, tuple[np.ndarray, np.ndarray]] = {}

    def errors(self, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """How far each point is off, how far two polynomials are apart there, and what they make of noise."""
        out = np.full((3, self.count), np.nan)
        if not len(self.inner):
            return tuple(out)
        others = [other for other in self.columns if other != name]
        best = np.argmax([self.evenness[other] for other in others], axis=0) if others else []
        values = self.columns[name][self.rows]
        for k, other in enumerate(others):
            here = np.flatnonzero((best == k) & (self.evenness[other] >= EVEN))
            if len(here):
                wide, narrow = (self._through(other)[w][here] for w in (0, 1))
                first, second = (np.sum(w * values[here], axis=1) for w in (wide, narrow))
                gain = np.sum(np.abs(wide), axis=1) + 1
                out[:, self.inner[here]] = np.abs(values[here, SIDE] - first), np.abs(first - second), gain
        return tuple(out)

    def _evenness(self, values: np.ndarray) -> np.ndarray:
        steps = np.diff(values[self.rows], axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            small, large = np.abs(steps).min(axis=1), np.abs(steps).max(axis=1)
            one_way = np.abs(np.sign(steps).sum(axis=1)) == 2 * SIDE
            return np.where(one_way & np.isfinite(small) & np.isfinite(large), small / large, -1.0)

    def _through(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Weights of the neighbours in the value at the point: with all of them, and one fewer a side."""
        if name not in self._weights:
            x = self.columns[name][self.rows]
            self._weights[name] = _lagrange(x, SIDE), _lagrange(x, SIDE - 1)
        return self._weights[name]


def _lagrange(x: np.ndarray, side: int) -> np.ndarray:
    """Weights of the neighbours in the polynomial through them at the middle point; zero for that point.

    Args:
        x: Places, one window a row.
        side: Neighbours a side that count.
    """
    middle = x.shape[1] // 2
    used = [k for k in range(x.shape[1]) if 0 < abs(k - middle) <= side]
    weights = np.zeros_like(x)
    with np.errstate(invalid="ignore", divide="ignore"):
        for k in used:
            others = [j for j in used if j != k]
            factors = (x[:, [middle]] - x[:, others]) / (x[:, [k]] - x[:, others])
            weights[:, k] = np.prod(factors, axis=1)
    return weights
