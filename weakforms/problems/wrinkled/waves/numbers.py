"""Wave numbers around an axis, as a parameter of problems."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field

MOST_WAVES = 400
"""Largest wave number that can be requested; larger ones were not tested on the default meshes."""


def _waves(value: object) -> object:
    """Wave numbers without repetition, from a list, one number, or text such as ``20,50``."""
    given = value.split(",") if isinstance(value, str) else value
    wanted = f"whole numbers from 0 to {MOST_WAVES} are wanted, such as 20,50"
    found = []
    for item in given if isinstance(given, list | tuple) else [given]:
        try:
            number = float(item)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            raise ValueError(wanted) from None
        if isinstance(item, bool) or number not in range(MOST_WAVES + 1):
            raise ValueError(wanted)
        found.append(int(number))
    return tuple(dict.fromkeys(found))


WaveNumbers = Annotated[tuple[Annotated[int, Field(ge=0, le=MOST_WAVES)], ...], BeforeValidator(_waves)]
"""Parameter ``n``: wave numbers around the axis for which stability is computed."""
