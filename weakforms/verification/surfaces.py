"""Deformed surfaces in space: what their pictures need solved, and what is drawn."""

from __future__ import annotations

import numpy as np

from weakforms.results import Field
from weakforms.verification.case import Surface
from weakforms.verification.outcome import SurfaceOutcome
from weakforms.verification.solutions import Solutions
from weakforms.verification.specs import At, Spec

TURNS = 49
"""Meridians of a surface of revolution."""


def surface_wants(surface: Surface) -> list[tuple[Spec, At | None]]:
    """The state shown, with its fields."""
    return [(surface.of, shown_at(surface))]


def shown_at(surface: Surface) -> At:
    """The state with the problem's own sample points."""
    at = surface.at
    return At(at.name, at.value, at.crossing, at.profile or (), at.branch)


def draw_surface(surface: Surface, solutions: Solutions) -> SurfaceOutcome:
    """What the report needs of a surface."""
    x, y, z = position(solutions.profile(surface.of, shown_at(surface)))
    return SurfaceOutcome(
        name=surface.name,
        title=surface.title,
        position=[x.tolist(), y.tolist(), z.tolist()],
        ranges=[(axis.low, axis.high) for axis in surface.axes],
        labels=[axis.tex for axis in surface.axes],
        note=surface.note,
    )


def position(field: Field) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``x, y, z`` as arrays over ``Z`` and ``Theta``.

    A field with ``x, y, z`` over ``Z, Theta`` is put on its grid; a meridian ``r, z`` over ``Z`` is revolved.
    """
    columns = field.columns
    if "Theta" not in columns:
        turns = np.linspace(0, 2 * np.pi, TURNS)
        r, z = columns["r"][:, None], columns["z"][:, None]
        return r * np.cos(turns), r * np.sin(turns), np.broadcast_to(z, (len(z), TURNS))
    rows = len(np.unique(columns["Z"].round(12)))
    order = np.lexsort((columns["Theta"], columns["Z"].round(12)))
    return tuple(columns[name][order].reshape(rows, -1) for name in ("x", "y", "z"))
