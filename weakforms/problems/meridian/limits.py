"""Stretches beyond which a law takes no more: full extension, no resistance, no tension."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from weakforms.errors import InputError
from weakforms.problems.homogeneous.material_point import LARGEST, NAMES, evaluated, stressed
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen

LEAST_RESISTANCE = 0.02
"""Lower limit of ``lam1 w,11 / w,1``; below it no mesh resolves the meridional stretch."""

MARGIN = 0.01
"""A law that is not defined at stretches larger by this fraction is at its limit."""


def limit_of(law: Chosen, places: Iterable[tuple[float, float]]) -> str:
    """Why a law takes hardly any more stretch at one of some pairs of stretches, as text; empty if it does.

    Args:
        law: The law; a Mooney-Rivlin membrane takes any stretch.
        places: Meridional and circumferential stretch.
    """
    if law.model == MOONEY_RIVLIN:
        return ""
    for l1, l2 in places:
        here, there = (evaluated(law, l1 * more, l2 * more) for more in (1.0, 1.0 + MARGIN))
        stretched = f"model = {law.model!r} at the stretches {l1:.4g} and {l2:.4g}"
        if not all(np.isfinite(values[name]) for values in (here, there) for name in NAMES):
            return f"{stretched} is beyond its end, or within {MARGIN:.0%} of it"
        if l1 > 1 and l1 * here["W11"] < LEAST_RESISTANCE * here["W1"]:
            return f"{stretched} hardly resists meridional stretch any more"
        if stressed(law, l1, l2) > LARGEST:
            return f"{stretched} has stresses of more than {LARGEST:g} times its stiffness at rest"
    return ""


def require_taut(problem: str, law: Chosen, stretch: float, name: str) -> None:
    """Refuse an equal pre-stretch in both directions beyond a law's limit, or at which it gives no tension.

    Raises:
        InputError: With a message that names the parameter.
    """
    why = limit_of(law, [(stretch, stretch)])
    if not why and stretch > 1 and evaluated(law, stretch, stretch)["W1"] <= 0:
        why = f"model = {law.model!r} gives no tension at this stretch in both directions"
    if why:
        raise InputError(f"{problem}: {name} = {stretch:g}: {why}; lower {name}")
