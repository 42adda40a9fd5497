"""Net of the second method of bent states: Chebyshev elements times equidistant angles."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reference_data.solvers.core.collocation import differentiation, lobatto

Array = np.ndarray
EVEN, ODD = 0, 1  # parity about Theta = 0 and pi


@dataclass(frozen=True)
class Net:
    """Chebyshev elements times equidistant angles.

    Attributes:
        wet: Elements below the free surface.
        dry: Elements above it; 0 when over-filled.
        degree: Degree of their polynomials.
        modes: Highest wave number, M.
    """

    wet: int
    dry: int
    degree: int
    modes: int
    nodes: Array = field(init=False, compare=False)
    slopes: Array = field(init=False, compare=False)
    theta: Array = field(init=False, compare=False)
    around: Array = field(init=False, compare=False)
    turns: tuple[Array, Array] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        put = lambda name, x: object.__setattr__(self, name, x)  # noqa: E731
        put("nodes", lobatto(self.degree))
        put("slopes", differentiation(self.nodes))
        count = 2 * self.modes + 1
        k = np.arange(count)[:, None] - np.arange(count)
        full = np.divide((-1.0) ** k, 2 * np.sin(np.pi * k / count), where=k != 0, out=np.zeros(k.shape))
        half, mirror = full[: self.modes + 1, : self.modes + 1], full[: self.modes + 1, : self.modes : -1]
        both = np.zeros_like(half)
        both[:, 1:] = mirror
        put("theta", 2 * np.pi * np.arange(self.modes + 1) / count)
        put("around", np.where(np.arange(self.modes + 1) == 0, 1, 2) * 2 * np.pi / count)
        put("turns", (half + both, half - both))

    @property
    def count(self) -> int:
        """Number of elements."""
        return self.wet + self.dry

    @property
    def breaks(self) -> Array:
        """Ends of the elements in s."""
        parts = [np.linspace(0, 1, self.wet + 1), 1 + np.linspace(0, 1, self.dry + 1)[1:] if self.dry else []]
        return np.concatenate(parts)

    def element(self, e: int) -> tuple[Array, Array]:
        """Nodes s of an element and the matrix of d/ds."""
        width = self.breaks[e + 1] - self.breaks[e]
        return self.breaks[e] + width * self.nodes, self.slopes / width

    def kept(self, parities: tuple[int, ...]) -> Array:
        """Which of the (angles, 3) values are unknowns: odd functions vanish at Theta = 0."""
        out = np.ones((self.modes + 1, 3), dtype=bool)
        out[0] = np.array(parities) == EVEN
        return out.ravel()

    def weights(self) -> Array:
        """Weights of Clenshaw and Curtis on [0, 1] at the nodes."""
        powers = np.polynomial.chebyshev.chebvander(2 * self.nodes - 1, self.degree)
        k = np.arange(self.degree + 1)
        moments = np.where(k % 2 == 0, 1 / (1.0 - np.where(k % 2 == 0, k, 0) ** 2), 0)
        return np.linalg.solve(powers.T, moments)


def waves(values: Array, theta: Array, at: Array, parity: int, order: int = 0) -> Array:
    """Trigonometric interpolation, or its derivative, from angles ``theta`` (last axis) to ``at``."""
    m = np.arange(parity, len(theta))

    def table(angles: Array, of: int) -> Array:
        if of == 0:
            return np.sin(np.outer(m, angles)) if parity else np.cos(np.outer(m, angles))
        return (
            m[:, None] * np.cos(np.outer(m, angles)) if parity else -m[:, None] * np.sin(np.outer(m, angles))
        )

    coefficients = np.linalg.solve(
        table(theta[parity:], 0).T, np.moveaxis(values[..., parity:], -1, 0).reshape(len(m), -1)
    )
    out = table(at, order).T @ coefficients
    return np.moveaxis(out.reshape(len(at), *values.shape[:-1]), 0, -1)
