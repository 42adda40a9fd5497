"""Functions of the tables of material laws and closed forms: two estimates that must agree."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reference_data.solvers.core.tables import Array, Column, agreed

HAND, CONTOUR = 2e-13, 2e-11
"""Uncertainties, relative to one plus the value, of numbers from derivatives by hand and by contours: about
ten times the rounding that changes of nodes and radius show."""


@dataclass
class Rounded:
    """Numbers that are exact up to rounding."""

    value: Array
    uncertainty: Array


def rounded(values: Sequence[float], level: float) -> Rounded:
    """Numbers with an uncertainty relative to one plus their magnitude."""
    array = np.array(values, dtype=float)
    return Rounded(array, level * (1 + np.abs(array)))


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
    column = agreed(table, name, second, first, about, other="contour integrals")
    column.extra["uncertainty_by_hand"] = column.extra.pop("uncertainty_collocation")
    return column
