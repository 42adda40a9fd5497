"""What both methods for waves are given of a membrane at rest."""

from __future__ import annotations

from typing import Any, NamedTuple


class Ring(NamedTuple):
    """Radius at rest, and the constant of the law, in place of a tube's."""

    r0: Any
    alpha: float
