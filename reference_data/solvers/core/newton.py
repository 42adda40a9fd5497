"""Roots by Newton's method: with a given correction of any state, or of a few numbers without derivatives.

Both methods of a table may use it, for it knows no equation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

Array = np.ndarray


def newton(
    x: Any,
    correct: Callable[[Any], tuple[Any, Callable[[Any], Any]]],
    what: str,
    longest: float = 0.4,
    close: float = 1e-7,
    most: int = 40,
    more: int = 1,
) -> Any:
    """The state at which corrections vanish.

    Args:
        x: First guess, of any kind.
        correct: The size of the correction at x (of each state, if x holds several), and a function from
            the share of the correction that is made to the next x.
        what: What is sought, for the message.
        longest: Longer steps are shortened to this.
        close: A step shorter than this is nearly the last one.
        most: Number of corrections.
        more: How many further short steps follow the first one; one leaves only rounding errors.

    Raises:
        RuntimeError: If the corrections do not become small, are not finite, or do not exist.
    """
    short = 0
    for _ in range(most):
        try:
            size, advance = correct(x)
        except np.linalg.LinAlgError:
            break
        if not np.all(np.isfinite(size)):
            break
        x = advance(np.minimum(1.0, longest / np.maximum(size, 1e-300)))
        short = short + 1 if np.max(size) < close else 0
        if short > more:
            return x
    raise RuntimeError(f"{what}: Newton's method does not converge")


@dataclass
class Secants:
    """Roots of a few functions whose derivatives are differences, kept by Broyden's updates.

    Attributes:
        jacobian: The matrix, for the next root.
        offset: Step of the differences, relative to the unknowns.
    """

    jacobian: Array | None = None
    offset: float = 1e-7

    def _differenced(self, f: Callable[[Array], Array], z: Array, r: Array) -> Array:
        columns = []
        for i in range(len(z)):
            step = self.offset * max(abs(z[i]), 1e-3)
            moved = z.copy()
            moved[i] += step
            columns.append((f(moved) - r) / step)
        return np.array(columns).T

    def solve(
        self,
        f: Callable[[Array], Array],
        z: Sequence[float],
        what: str = "shooting",
        limit: float = 0.2,
        stalled: float = 1e-10,
    ) -> Array:
        """Root of f near z; steps longer than ``limit`` (relative) are shortened.

        Below ``stalled`` steps that no longer decrease are rounding.

        Raises:
            RuntimeError: If the iteration does not converge.
        """
        z = np.asarray(z, dtype=float)
        r, last, fresh = f(z), np.inf, False
        for _ in range(40):
            if self.jacobian is None:
                self.jacobian, fresh = self._differenced(f, z, r), True
            step = -np.linalg.solve(self.jacobian, r)
            size = float(np.max(np.abs(step) / np.maximum(np.abs(z), 1e-3)))
            if size < 1e-13 or (size < stalled and size > 0.2 * last):
                return z + step
            if not fresh and size > min(1e-3, 0.2 * last):
                self.jacobian = None
                continue
            step *= min(1.0, limit / size)
            z = z + step
            r, before, last, fresh = f(z), r, size, False
            if size > 1e-3:
                self.jacobian = None
            else:  # Broyden: the smallest change that explains the last step
                miss = r - before - self.jacobian @ step
                self.jacobian = self.jacobian + np.outer(miss, step) / (step @ step)
        raise RuntimeError(f"{what}: no root near {z}")


def secant(f: Callable[[float], float], x0: float, x1: float, longest: float = np.inf) -> tuple[float, float]:
    """Root of a function of one number, and its slope there, from two guesses.

    Args:
        f: The function.
        x0: One guess.
        x1: The other.
        longest: Longer steps are shortened to this.

    Raises:
        RuntimeError: If the iteration does not converge.
    """
    f0, f1, done = f(x0), f(x1), False
    slope = (f1 - f0) / (x1 - x0)
    for _ in range(40):
        if done or f1 == f0:
            return x1, slope
        if abs(x1 - x0) > 1e-7:  # closer, the quotient is mostly rounding
            slope = (f1 - f0) / (x1 - x0)
        step = float(np.clip(-f1 / slope, -longest, longest))
        done = abs(step) < 1e-9 * max(1.0, abs(x1))
        x0, f0, x1 = x1, f1, x1 + step
        f1 = f(x1)
    raise RuntimeError("the secant iteration does not converge")


def settled(step: Callable[[Array], Array], z: Array, tolerance: float, depth: int = 6) -> Array:
    """Fixed point of ``step`` by Anderson's mixing of the last few iterates.

    It stops at changes below ``tolerance``, or below 1e-11 if they do not decrease further (rounding).

    Raises:
        RuntimeError: If it does not converge to rounding errors.
    """
    results: list[Array] = []
    misses: list[Array] = []
    best, stale = np.inf, 0
    for _ in range(80):
        new = step(z)
        miss = new - z
        size = float(np.max(np.abs(miss)))
        stale = 0 if size < 0.5 * best else stale + 1
        best = min(best, size)
        if size < tolerance or (best < 1e-11 and stale >= 3):
            return new
        results, misses = [*results, new][-depth:], [*misses, miss][-depth:]
        z = new
        if len(misses) > 1:
            span = np.array([m - miss for m in misses[:-1]]).T
            weight = np.linalg.lstsq(span, -miss, rcond=1e-12)[0]
            z = new + np.array([r - new for r in results[:-1]]).T @ weight
    raise RuntimeError(f"history not settled, last change {size:.1e}")
