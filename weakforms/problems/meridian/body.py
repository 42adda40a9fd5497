"""Membranes of revolution: reference surface, thickness, supports."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

Values = Mapping[str, Any]
"""Parameters by name: numbers, or expressions of a form."""

EndPosition = tuple[float | None, float | None]
"""What the two unknowns are at an end; ``None`` where one is free."""


@dataclass(frozen=True)
class Body:
    """A membrane of revolution and its supports; all functions accept numbers and expressions.

    The unknowns ``(u, w)`` are measured from a shape: the deformed radius is ``R (hoop + u)`` and the height
    ``z0 + w``, over a coordinate ``S`` along the meridian. Nothing is divided by ``R``, which is 0 at a pole.
    """

    name: str
    parameters: tuple[str, ...]
    """Names of the parameters that its functions use."""
    length: Callable[[Values], Any]
    """``S`` at the last end."""
    radius: Callable[[Any, Values], Any]
    """``R(S)``, by which the first unknown is multiplied."""
    thickness: Callable[[Any, Values], Any]
    """Reference volume per ``R dS``: the thickness, if ``S`` is the reference length and ``R`` the reference
    radius."""
    shape: Callable[[Any, Values], tuple[Any, Any]] = lambda _s, _q: (0.0, 0.0)
    """``(hoop, z0)``."""
    held: tuple[EndPosition, EndPosition] = ((0.0, 0.0), (0.0, 0.0))
    """The unknowns at the first and at the last end; at a pole the first one is free."""
    scales: Callable[[Values], tuple[Any, Any]] = lambda _q: (1.0, 1.0)
    """Factors of the stretches ``|dx/dS|`` and ``r/R``, if ``S`` or ``R`` belongs to a stretched surface."""
    upwards: float = 1.0
    """Sign of ``dz/dS`` where the membrane encloses a volume."""
    easy: tuple[tuple[str, float], ...] = ()
    """Parameters at which the shape is near an unloaded state, the start of the steps to other parameters."""
    pole: bool = False
    """Whether the first end lies on the axis."""
