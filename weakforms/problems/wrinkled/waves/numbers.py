"""Wave numbers around an axis, as problems take them for a parameter."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field

MOST_WAVES = 400
"""Largest wave number one may ask for: shorter waves than the default meshes were tried with."""


def _waves(value: object) -> object:
    """Wave numbers from a list, one number, or text such as ``20,50``; each once."""
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
"""Parameter ``n``: numbers of waves around the axis whose stability is judged."""
