"""Estimates of two kinds: numbers that are exact up to rounding by two ways, and numbers on two grids."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reference_data.solvers.core.tables import TWO_GRIDS, Array, Column, Estimate, agreed

HAND, CONTOUR = 2e-13, 2e-11
"""Uncertainties, relative to one plus the value, of numbers from derivatives by hand and by contours: about
ten times the rounding that changes of nodes and radius show."""


def on_two_grids(coarse: Array, fine: Array, left: float) -> Estimate:
    """Finer values; one uncertainty: TWO_GRIDS times the column's largest difference, and what is left."""
    coarse, fine = np.asarray(coarse, dtype=float), np.asarray(fine, dtype=float)
    own = TWO_GRIDS * np.abs(fine - coarse).max() + left * max(1.0, np.abs(fine).max())
    return Estimate(fine, np.full(fine.shape, own))


def rounded(values: Sequence[float], level: float) -> Estimate:
    """Numbers with an uncertainty relative to one plus their magnitude."""
    array = np.array(values, dtype=float)
    return Estimate(array, level * (1 + np.abs(array)))


def both(
    table: str,
    name: str,
    about: tuple[str, str],
    hand: Sequence[float],
    contour: Sequence[float],
    levels: tuple[float, float] = (HAND, CONTOUR),
) -> Column:
    """A column of numbers from derivatives by hand, after a check that those by contours agree."""
    first, second = rounded(hand, levels[0]), rounded(contour, levels[1])
    return agreed(table, name, second, first, about, other="contour integrals", written="by hand")
