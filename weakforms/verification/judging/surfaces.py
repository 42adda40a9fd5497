"""Deformed surfaces in space: the states for their pictures, and the data to draw."""

from __future__ import annotations

import numpy as np

from weakforms.results import Field
from weakforms.verification.cases.panels import Surface
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.judging.outcome import SurfaceOutcome
from weakforms.verification.run.solutions import Solutions

TURNS = 49
"""Number of meridians of a surface of revolution."""


def surface_wants(surface: Surface) -> list[tuple[Spec, At | None]]:
    """The shown state with its fields."""
    return [(surface.of, shown_at(surface))]


def shown_at(surface: Surface) -> At:
    """The state with the problem's own sample points."""
    at = surface.at
    return At(at.name, at.value, at.crossing, at.profile or (), at.branch)


def draw_surface(surface: Surface, solutions: Solutions) -> SurfaceOutcome:
    """The data of a surface for the report."""
    field = solutions.profile(surface.of, shown_at(surface))
    x, y, z = position(field, surface.displaced)
    height = surface.axes[2]
    shown = z.min(axis=1) <= height.high + 1e-6 * (height.high - height.low)  # rows above it are left out
    return SurfaceOutcome(
        name=surface.name,
        title=surface.title,
        position=[part[shown].tolist() for part in (x, y, z)],
        ranges=[(axis.low, axis.high) for axis in surface.axes],
        labels=[axis.tex for axis in surface.axes],
        note=surface.note,
        fields={name: values[shown].tolist() for name, values in fields(field, x.shape).items()},
    )


def position(field: Field, displaced: float = 0.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``x, y, z`` as arrays over ``Z`` and ``Theta``.

    A field with ``x, y, z`` over ``Z, Theta`` is put on its grid, plus ``displaced`` times its mode. A
    meridian ``r, z`` over ``Z`` is rotated about the axis.
    """
    columns = field.columns
    if "Theta" not in columns:
        turns = np.linspace(0, 2 * np.pi, TURNS)
        r, z = columns["r"][:, None], columns["z"][:, None]
        return r * np.cos(turns), r * np.sin(turns), np.broadcast_to(z, (len(z), TURNS))
    mode = {name: _on_grid(field, f"u_{name}") if displaced else 0.0 for name in "xyz"}
    return tuple(_on_grid(field, name) + displaced * mode[name] for name in "xyz")


def fields(field: Field, shape: tuple[int, int]) -> dict[str, np.ndarray]:
    """Every other column over the same grid, with the ten digits that a picture can use."""
    rest = [name for name in field.columns if name not in ("x", "y", "z")]
    if "Theta" in field.columns:
        grids = {name: _on_grid(field, name) for name in rest}
    else:
        grids = {name: np.broadcast_to(field.columns[name][:, None], shape) for name in rest}
    return {name: np.vectorize(lambda v: float(f"{v:.10g}"))(grid) for name, grid in grids.items()}


def _on_grid(field: Field, name: str) -> np.ndarray:
    """A column over ``Z`` and ``Theta``."""
    columns = field.columns
    rows = len(np.unique(columns["Z"].round(12)))
    order = np.lexsort((columns["Theta"], columns["Z"].round(12)))
    return columns[name][order].reshape(rows, -1)
