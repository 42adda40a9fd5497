"""Where a branch begins, and its curvatures there, from states of small amplitude."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from reference_data.solvers.core.collocation import Array

PARTS = {"p": "p", "V": "volume", "u_max": "u_max"}
"""Columns that are even in the amplitude, and the attributes of states that they are."""

CURVED = {"p": "p_2", "V": "V_2"}
"""Columns of the curvatures."""

SMALLEST = 0.06
"""Square of the smallest amplitude, over that of the largest one."""

LARGER = 1.5
"""Factor of the amplitudes of a second fit; its difference from the first is a part of the uncertainty."""

States = Callable[[str, Array], Sequence[Sequence[Sequence[Any]]]]
"""States of a branch with given amplitudes, by method and resolution."""


def fit(amplitudes: Array, values: Array) -> tuple[float, float]:
    """Value and curvature at zero of an even polynomial through all values."""
    largest = amplitudes.max()
    found = np.polynomial.polynomial.polyfit((amplitudes / largest) ** 2, values, len(values) - 1)
    return float(found[0]), float(found[1] / largest**2)


def beginnings(
    largest: Mapping[str, float], states: States, nodes: int
) -> dict[str, tuple[list[list[Array]], float]]:
    """Columns of the points at which branches begin.

    Args:
        largest: Largest amplitude from which each branch is extrapolated.
        states: Of two methods, each coarse and fine.
        nodes: Number of amplitudes, and of coefficients in the amplitude's square.

    Returns:
        For each column its values by method and resolution, over the branches, and the largest difference of
        both fits.
    """
    found: dict[str, list[Array]] = {}
    for name, most in largest.items():
        fits: list[dict[str, Array]] = []
        for share in (1.0, LARGER):
            amplitudes = most * share * np.sqrt(np.linspace(SMALLEST, 1, nodes))
            rows: dict[str, list[list[float]]] = {}
            for levels in states(name, amplitudes):
                for key, attribute in PARTS.items():
                    both = [fit(amplitudes, np.array([getattr(s, attribute) for s in at])) for at in levels]
                    rows.setdefault(key, []).append([value for value, _ in both])
                    if key in CURVED:
                        rows.setdefault(CURVED[key], []).append([second for _, second in both])
            fits.append({key: np.array(row) for key, row in rows.items()})
        for key in fits[0]:
            found.setdefault(key, []).append(np.array([row[key] for row in fits]))
    order = (*PARTS, *CURVED.values())
    out = {}
    for key in order:
        values = np.array(found[key])  # branch, fit, method, resolution
        spread = float(np.abs(values[:, 1] - values[:, 0]).max())
        out[key] = [[values[:, 0, m, level] for level in (0, 1)] for m in (0, 1)], spread
    return out
