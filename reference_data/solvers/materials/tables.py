"""Tables of the material laws: energy, stresses and tangent, full and relaxed, at some stretches."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from reference_data.solvers.core.contour import derivative, six
from reference_data.solvers.core.laws import BUILDERS, CONSTANTS, law
from reference_data.solvers.core.tables import Series, Table
from reference_data.solvers.core.two_estimates import both
from reference_data.solvers.registry import Builder

NAMES = ("W", "W1", "W2", "W11", "W12", "W22")
EVERYWHERE = (
    (1.0, 1.0),
    (1.2, 1.1),
    (1.5, 1.5),
    (2.0, 1.2),
    (1.2, 2.0),
    (1.5, 0.9),
    (3.0, 2.5),
    (1.4, 0.6),
    (0.6, 1.5),
    (0.8, 0.9),
)
FAR = ((4.0, 0.3), (0.2, 2.5), (3.5, 1.0))
COMPRESSIBLE = ("saint_venant_kirchhoff", "harmonic")
SLACK, ALONG_1, ALONG_2, TAUT = 0, 1, 2, 3
METHOD = (
    "(a) derivatives worked out by hand; (b) from the energy alone, by contour integrals around the point. "
    "The relaxed energy is the full one where neither stretch is below the width that uniaxial tension along "
    "the other leaves, else the energy of that uniaxial tension, or zero."
)


SERIES = Series(
    "materials",
    "Patil (2016), chapter 3",
    {
        "l1": ("1", "principal stretch 1"),
        "l2": ("1", "principal stretch 2"),
        "state": ("1", "0 slack, 1 or 2 tension along 1 or 2, 3 taut"),
    },
    METHOD,
    "48 nodes on a circle of radius 0.08 times the stretch (b)",
    "rounding",
)


def state(material: Any, l1: float, l2: float) -> int:
    """State of a sheet that may wrinkle."""

    def wide(x: float, y: float) -> bool:
        with np.errstate(invalid="ignore"):
            return not y <= material.width(x)[0]  # a law without a positive width never wrinkles

    if wide(l1, l2) and wide(l2, l1):
        return TAUT
    return ALONG_1 if l1 > 1 else ALONG_2 if l2 > 1 else SLACK


def by_hand(material: Any, l1: float, l2: float) -> tuple[list[float], list[float]]:
    """Full and relaxed numbers from derivatives by hand."""
    full = [
        material.energy(l1, l2),
        material.slope(l1, l2),
        material.slope(l2, l1),
        material.curvature(l1, l2),
        material.mixed(l1, l2),
        material.curvature(l2, l1),
    ]
    found = state(material, l1, l2)
    if found in (TAUT, SLACK):
        return full, full if found == TAUT else [0.0] * 6
    along = l1 if found == ALONG_1 else l2
    across, rate = material.width(along)
    # d/dl w(l, b(l)) = w_1 + w_2 b' with w_2 = 0, and once more
    bent = material.curvature(along, across) + material.mixed(along, across) * rate
    values = material.energy(along, across), material.slope(along, across), bent
    return full, _placed(found, values)


def by_contour(material: Any, l1: float, l2: float) -> tuple[list[float], list[float]]:
    """The same numbers from the energy alone."""
    full = list(six(material.energy, l1, l2))
    found = state(material, l1, l2)
    if found in (TAUT, SLACK):
        return full, full if found == TAUT else [0.0] * 6

    def wrinkled(x: Any) -> Any:
        return material.energy(x, material.width(x)[0])

    along = l1 if found == ALONG_1 else l2
    return full, _placed(found, tuple(derivative(wrinkled, along, k) for k in (0, 1, 2)))


def _placed(found: int, values: tuple[float, float, float]) -> list[float]:
    w, first, second = values
    if found == ALONG_1:
        return [w, first, 0.0, second, 0.0, 0.0]
    return [w, 0.0, first, 0.0, 0.0, second]


def table(name: str, model: str) -> Table:
    """The table of one law with the constants of the tables."""
    material = law(model)
    points = EVERYWHERE + (() if model in COMPRESSIBLE else FAR)
    hand = [by_hand(material, *p) for p in points]
    contour = [by_contour(material, *p) for p in points]
    stress = "over the stress S of the constants"
    columns = SERIES.keys(l1=[p[0] for p in points], l2=[p[1] for p in points])
    for kind, suffix in enumerate(("", "_relaxed")):
        for i, base in enumerate(NAMES):
            about = (stress, f"{base} of the {'relaxed' if suffix else 'full'} energy; digits: derivatives")
            a, b = ([row[kind][i] for row in rows] for rows in (hand, contour))
            columns.append(both(name, base + suffix, about, a, b))
    columns += SERIES.keys(state=[state(material, *p) for p in points])
    title = f"Material law {model}: energy and its derivatives"
    return SERIES.table(name, title, "", {"model": model, **CONSTANTS[model]}, columns)


TABLES: dict[str, Builder] = {f"law_{m}": partial(table, f"law_{m}", m) for m in BUILDERS}
