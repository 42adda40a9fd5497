"""The bodies of which decks are written, as what a mesher needs: meridian, thickness, supports, load.

Lengths are those of the problem, forces are such that ``C1 h = 1``; pressures are then the problem's own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from weakforms.errors import InputError, not_among

TAUT = {"tube": ("delta1", 1.05), "circular": ("beta", 1.05)}
"""Smallest pre-stretch of which there is a deck. With none, CalculiX did not converge at the first load."""


@dataclass(frozen=True)
class Clamp:
    """An edge that is held: its radius is multiplied, and it is moved along the axis."""

    end: Literal[0, 1]
    """First or last end of the meridian."""
    radius: float
    """Radius over that of the mesh."""
    height: float
    """Place on the axis."""


@dataclass(frozen=True)
class Body:
    """A membrane of revolution about the ``z`` axis. The meridian's left side is the outside."""

    problem: str
    load: str
    """Name of the load, and column that is judged."""
    over: str
    """Column over which a curve is judged."""
    meridian: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    """Radius and height of the mid-surface at rest over ``s`` in ``[0, 1]``."""
    thickness: Callable[[np.ndarray], np.ndarray]
    """Thickness over its mean."""
    clamps: tuple[Clamp, ...]
    pole: bool
    """Whether the meridian begins on the axis."""
    mirror: bool
    """Whether the body is symmetric about the plane ``z = 0``, in which its meridian ends."""
    size: float
    """Length of the meridian at rest."""
    ratio: float
    """``C2/C1``."""
    gamma: float = 0.0
    """Weight of the fluid; 0 is gas."""
    relaxed: bool = False
    """Whether wrinkled parts bear no compression."""


def _even(s: np.ndarray) -> np.ndarray:
    return np.ones_like(s)


def _tube(values: Mapping[str, Any], _critical: float) -> Body:
    radius, half = math.sqrt(values["delta1"]), values["lf"] / 2
    rest = half / values["delta1"]
    return Body(
        "tube",
        "p",
        "u_max",
        lambda s: (np.full_like(s, radius), rest * (1 - s)),
        _even,
        (Clamp(0, 1 / radius, half),),
        False,
        True,
        rest,
        values["alpha"],
    )


def _disk(values: Mapping[str, Any], _critical: float) -> Body:
    beta = values["beta"]
    return Body(
        "circular",
        "p",
        "t0",
        lambda s: (s / beta, np.zeros_like(s)),
        lambda s: values["M"] + 2 * (1 - values["M"]) * s,
        (Clamp(1, beta, 0.0),),
        True,
        False,
        1 / beta,
        values["alpha"],
    )


def _sphere(values: Mapping[str, Any], _critical: float) -> Body:
    return Body(
        "sphere",
        "P",
        "lam",
        lambda s: (np.sin(np.pi / 2 * s), np.cos(np.pi / 2 * s)),
        _even,
        (),
        True,
        True,
        np.pi / 2,
        values["alpha"],
    )


def _wrinkled(values: Mapping[str, Any], critical: float) -> Body:
    length, ratio = values["L"], values["M"]
    radius = critical if values["Af"] == "critical" else float(values["Af"])
    liquid = values["load"] == "fluid"
    return Body(
        "wrinkled_tube",
        "zw" if liquid else "p",
        "V",
        lambda s: (np.ones_like(s), length * (1 - s)),
        lambda s: ratio + 2 * (1 - ratio) * (1 - s),
        (Clamp(0, radius, values["delta"] * length), Clamp(1, radius, 0.0)),
        False,
        False,
        length,
        values["c2"],
        gamma=float(values["gamma"] or 0.0) if liquid else 0.0,
        relaxed=values["energy"] != "standard",
    )


BODIES: dict[str, Callable[[Mapping[str, Any], float], Body]] = {
    "tube": _tube,
    "circular": _disk,
    "sphere": _sphere,
    "wrinkled_tube": _wrinkled,
}
"""The problems of which decks are written."""

LAWS = {"mooney_rivlin", "neo_hookean"}
"""Laws that all codes have."""

ONLY = {
    "tube": {"contact": "none", "phase": "inflation", "extent": "half", "energy": "standard"},
    "circular": {"contact": "none", "phase": "inflation", "thickness": None},
    "sphere": {"vary": ""},
    "wrinkled_tube": {"thickness": None},
}
"""Parameters without which a deck would be of another body."""


def require_body(problem: str, values: Mapping[str, Any]) -> None:
    """Refuse problems and parameters of which there is no deck.

    Raises:
        InputError: With a message that says what is allowed.
    """
    if problem not in BODIES:
        raise InputError(f"there is no deck of {problem!r}{not_among(problem, BODIES, 'decks are of')}")
    if values["model"] not in LAWS:
        raise InputError(f"deck {problem}: model = {values['model']!r}; allowed: {', '.join(sorted(LAWS))}")
    if problem in TAUT:
        name, least = TAUT[problem]
        if values[name] < least:
            raise InputError(
                f"deck {problem}: {name} = {values[name]:g}: the membrane at rest has too little tension "
                f"to start from; allowed: {name} of {least} or more"
            )
    for name, wanted in ONLY[problem].items():
        if values[name] != wanted:
            raise InputError(f"deck {problem}: {name} = {values[name]!r}; allowed: {wanted!r}")


def body_of(problem: str, values: Mapping[str, Any], critical: float = 1.0) -> Body:
    """The body of a problem.

    Args:
        problem: Name of the problem.
        values: All its parameters and the constants of its law.
        critical: The critical radius, if the disks of a wrinkled tube have it.
    """
    if values["model"] == "neo_hookean":
        values = {**values, "alpha": 0.0, "c2": 0.0}
    return BODIES[problem](values, critical)
