"""Stretches beyond which a law takes no more: full extension, no resistance, no tension."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import ufl
from ufl.core.expr import Expr

from weakforms.forms.wrinkling import Law
from weakforms.problems.homogeneous.material_point import LARGEST, NAMES, evaluated, stressed
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen, mooney_rivlin_of
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.sampling import Sampler

if TYPE_CHECKING:
    from weakforms.problems.meridian.model import MeridianModel

LEAST_RESISTANCE = 0.02
"""Lower limit of ``lam1 w,11 / w,1``; below it no mesh resolves the meridional stretch."""

GIVES_WAY = (
    "the law hardly resists meridional stretch any more, which grows without bound from there on; choose "
    "another law"
)
"""Why a branch of a law of bounded force ends, and what to change."""

MARGIN = 0.01
"""A law that is not defined at stretches larger by this fraction is at its limit."""


def relative_stiffness(law: Chosen) -> float:
    """Stiffness ``w,11`` at rest over that of a neo-Hookean law with ``C1 = 1``."""
    own, usual = (evaluated(one, 1.0, 1.0)["W11"] for one in (law, mooney_rivlin_of(0.0)))
    return own / usual


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


def resistance(law: Law, lam1: Expr, lam2: Expr) -> Expr:
    r"""``λ₁ w,₁₁ - LEAST_RESISTANCE w,₁``: negative if the law hardly resists more meridional stretch.

    In free inflation :math:`H = w - \lambda_1 w_{,1}` is constant, and its derivative with respect to the
    stretch is :math:`-\lambda_1 w_{,11}`. If this is nearly zero (for laws of linear growth, such as
    Varga's), the stretch of the mid-plane becomes unbounded at a finite displacement, and beyond it there is
    no solution of finite stretch.
    """
    l1 = ufl.variable(lam1)
    slope = ufl.diff(law(l1, lam2), l1)
    return l1 * ufl.diff(slope, l1) - LEAST_RESISTANCE * slope


SAMPLED = 61
"""Number of places of a meridian at which the stretches of a state are compared with the limit of its law."""


def stretches_along(model: MeridianModel) -> Callable[[State], list[tuple[float, float]]]:
    """Meridional and circumferential stretch at places of a model's meridian: a function of states."""

    @cache
    def sampler() -> Sampler:
        stretches = {name: model.expressions[name] for name in ("lam1", "lam2")}
        return Sampler(model.unknown, stretches, np.linspace(0.0, model.blocks, SAMPLED))

    def sampled(state: State) -> list[tuple[float, float]]:
        with model.system.at(state):
            found = sampler()()
        return list(zip(found["lam1"].tolist(), found["lam2"].tolist(), strict=True))

    return sampled


def limit_along(model: MeridianModel) -> Callable[[State], str]:
    """Why the law takes hardly any more stretch at some place of a state of a model: a function of states.

    Constants of the law may be loads.
    """
    places = stretches_along(model)

    def limit(state: State) -> str:
        given = model.material_law
        constants = tuple((name, state.loads.get(name, value)) for name, value in given.constants)
        return limit_of(replace(given, constants=constants), places(state))

    return limit


NEARLY = 0.1
"""A law that hardly resists stretches larger by this fraction is about to give way."""


def giving_way(model: MeridianModel, state: State) -> str:
    """Where the law of a membrane is about to give way in a state, as text; empty if it is not."""
    law = model.material_law
    if law is None:  # a Mooney-Rivlin membrane takes any stretch
        return ""
    for l1, l2 in stretches_along(model)(state):
        more = l1 * (1 + NEARLY)
        there = evaluated(law, more, l2)
        if more > 1 and more * there["W11"] < LEAST_RESISTANCE * there["W1"]:
            return (
                f"its stretches are {l1:.4g} and {l2:.4g} at one place, and at a meridional stretch larger "
                f"by {NEARLY:.0%} model = {law.model!r} hardly resists more of it"
            )
    return ""
