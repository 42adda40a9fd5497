"""Truncated Taylor series in one variable, for exact directional derivatives.

A jet holds the coefficients c_0 .. c_n of f(s) = sum c_k s^k, each an array; arithmetic on
jets is arithmetic on series cut off after s^n. Evaluating a residual on the jet of a curve
Y(s) therefore yields D F[Y1], D2 F[Y1, Y1]/2, ... without any differencing.
"""

from __future__ import annotations

from typing import Any

import numpy as np


class Jet:
    """Series with coefficients ``c[0], c[1], ...`` (arrays of one common shape)."""

    __array_ufunc__ = None  # makes ndarray <op> Jet fall back to the methods below

    def __init__(self, c: list[Any]) -> None:
        self.c = c

    def _other(self, other: Any) -> list[Any]:
        if isinstance(other, Jet):
            return other.c
        return [other] + [0.0] * (len(self.c) - 1)

    def __add__(self, other: Any) -> Jet:
        return Jet([a + b for a, b in zip(self.c, self._other(other), strict=True)])

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet([-a for a in self.c])

    def __sub__(self, other: Any) -> Jet:
        return self + (-other)

    def __rsub__(self, other: Any) -> Jet:
        return (-self) + other

    def __mul__(self, other: Any) -> Jet:
        b = self._other(other)
        return Jet([sum(self.c[j] * b[k - j] for j in range(k + 1)) for k in range(len(b))])

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Jet:
        b = self._other(other)
        q: list[Any] = []
        for k, a in enumerate(self.c):
            q.append((a - sum(q[j] * b[k - j] for j in range(k))) / b[0])
        return Jet(q)

    def __rtruediv__(self, other: Any) -> Jet:
        return Jet(self._other(other)) / self


def sin_cos(x: Any) -> tuple[Any, Any]:
    """Sine and cosine of an array or a jet, from s' = c x' and c' = -s x'."""
    if not isinstance(x, Jet):
        return np.sin(x), np.cos(x)
    s, c = [np.sin(x.c[0])], [np.cos(x.c[0])]
    for k in range(1, len(x.c)):
        s.append(sum(j * x.c[j] * c[k - j] for j in range(1, k + 1)) / k)
        c.append(-sum(j * x.c[j] * s[k - j] for j in range(1, k + 1)) / k)
    return Jet(s), Jet(c)
