r"""What explains the errors of a column: another parameter, a missing pre-stretch, a load of another kind.

A parameter :math:`q` explains the difference :math:`e` of curve and table if it is a multiple of the
sensitivity, :math:`e \approx \Delta q\; \partial c / \partial q`, over the whole abscissa. The sensitivity is
the difference of two solutions on the same mesh, in which the error of the mesh cancels.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any

import numpy as np

from weakforms import api
from weakforms.errors import WeakformsError
from weakforms.problems.registry import abouts
from weakforms.verification.crosscheck.rows import JudgedColumn
from weakforms.verification.crosscheck.targets import Target

SAMPLES = 9
"""Rows of the curve at which problems are solved to look for causes."""

STEP = 1e-3
"""Relative change of a parameter for its sensitivity."""

EXPLAINED = 0.1
"""Part of the errors that an explanation may leave over: what is left must be a tenth of them at most."""

LINEAR = 0.05
"""Relative change of a parameter beyond which a solution there takes the place of its sensitivity."""

FEW = 0.2
"""Part of the rows: if no more are out of bounds, a sentence names them and says nothing of the others."""

NEUTRAL = {"delta1": 1.0, "beta": 1.0}
"""Parameters with the value that means that there is no pre-stretch."""

NEAR_POWER = 0.02
"""Distance from a whole number within which an exponent counts as that number."""

ABOUT_POWER = 0.25
"""The same for a body that is stretched differently from place to place, so that no power is exact."""


def limits(judged: JudgedColumn) -> np.ndarray:
    """The errors beyond which rows differ from the table: their bounds; without a claim its uncertainty."""
    return judged.bound if judged.verdict.asked is not None else 2 * judged.known


def trend(judged: JudgedColumn, over: str) -> str:
    """The errors of a column in words: their ratio to the table, the rows out of bounds, or how errors grow.

    Args:
        judged: A column out of bounds, or one that differs from the table and claims nothing.
        over: Name of the abscissa.
    """
    order = np.argsort(judged.x)
    error, size = judged.error[order], np.abs(judged.error[order])
    beyond = np.flatnonzero(size > limits(judged)[order])
    if not len(beyond):
        return ""  # what is not finite has no size
    side = "above" if error[beyond].sum() > 0 else "below"
    if np.ptp(error) <= EXPLAINED * size.max():
        return f"every row lies {size.mean():.2g} of the table's value {side} it"
    both = np.unique(np.sign(error[beyond])).size > 1
    where = "on both sides of the table" if both else f"{side} the table"
    if len(beyond) <= FEW * len(error):
        first, last = judged.x[order][beyond[[0, -1]]]
        place = f"{over} = {first:g}" + (f" to {last:g}" if len(beyond) > 1 else "")
        verb = "are" if len(beyond) > 1 else "is"
        return f"{len(beyond)} of {len(error)} rows {verb} out of bounds, at {place}, {where}"
    start, end = (
        float(size[part].mean()) for part in (slice(0, len(size) // 3 + 1), slice(-len(size) // 3, None))
    )
    way = "grow" if end > 2 * start else "fall" if start > 2 * end else ""
    return f"the errors lie {where}" + (
        f" and {way} with {over}, from {size[0]:.1e} to {size[-1]:.1e}" if way else ""
    )


def causes(target: Target, failed: Sequence[JudgedColumn]) -> dict[str, tuple[str, ...]]:
    """Explanations of the errors of each column; none if nothing explains nine tenths of them.

    Those that explain most columns come first, then those that leave least over.

    Args:
        target: The table, with the parameters of its solution.
        failed: Columns to be explained, all with the same rows.

    Raises:
        EnvironmentLackError: If DOLFINx is missing.
    """
    api.require_environment()
    if not failed:
        return {}
    order = np.argsort(failed[0].x)
    picked = order[np.unique(np.linspace(0, len(order) - 1, SAMPLES).round().astype(int))]
    place = str(target.table.abscissa), failed[0].x[picked]
    base = _columns(target, {}, *place)
    left: dict[str, dict[str, float]] = {judged.verdict.column: {} for judged in failed}
    if base is None or not left.keys() <= base.keys():
        return {}
    moved = {
        name: _columns(target, {name: value * (1 + STEP) or STEP}, *place) for name, value in _numbers(target)
    }
    shifted = _columns(target, {}, place[0], place[1] * (1 - STEP))
    without = {
        name: _columns(target, {name: neutral}, *place)
        for name, neutral in NEUTRAL.items()
        if target.parameters.get(name, neutral) != neutral
    }
    for judged in failed:
        column = judged.verdict.column
        difference, expected = judged.difference[picked], judged.expected[picked]
        found = left[column]
        for name, value in _numbers(target):
            if (other := moved[name]) is not None:
                factor, rest = _fitted(difference, (other[column] - base[column]) / STEP)
                if rest <= EXPLAINED and value and abs(factor) > LINEAR:
                    factor = max(factor, -1.0)
                    there = _columns(target, {name: value * (1 + factor)}, *place)
                    if there is None:
                        continue
                    part, rest = _fitted(difference, there[column] - base[column])
                    factor *= part
                size = abs(100 * factor)
                way = f"{size:{'.2g' if size < 99.5 else '.0f'}} % too {'large' if factor > 0 else 'small'}"
                found[f"equals {name} {way}" if value else f"equals {name} = {factor:.3g}"] = rest
        for name, other in without.items():
            if other is not None:
                text = f"equals {name} = {NEUTRAL[name]:g}: is the pre-stretch missing?"
                found[text] = _rest(difference, other[column] - base[column])
        if shifted is not None:
            factor, rest = _fitted(difference, (shifted[column] - base[column]) / STEP)
            way = "large" if factor > 0 else "small"
            found[f"equals {place[0]} {abs(100 * factor):.2g} % too {way}: is it scaled otherwise?"] = rest
        found |= dict(islice(_powers(difference, expected, base), 1))
        left[column] = {text: rest for text, rest in found.items() if rest <= EXPLAINED}
    common = Counter(text for found in left.values() for text in found)
    return {
        column: tuple(sorted(found, key=lambda text: (-common[text], found[text])))
        for column, found in left.items()
    }


def _powers(
    difference: np.ndarray, expected: np.ndarray, base: Mapping[str, np.ndarray]
) -> Iterator[tuple[str, float]]:
    """Stretches with whose power the curve is multiplied.

    A pressure per undeformed area is the pressure times the stretched area, a nominal stress is the true one
    times a stretch.
    """
    ratio = (expected + difference) / np.where(expected, expected, np.nan)
    if not np.all(ratio > 0):
        return
    stretches = {name: values for name, values in base.items() if name.startswith("lam")}
    if "u_max" in base and "lam2_mid" not in base:
        stretches["(1 + u_max)"] = 1 + base["u_max"]
    for name, stretch in stretches.items():
        if np.any(stretch <= 0) or np.ptp(stretch) < 0.05:
            continue
        slope, constant = (float(value) for value in np.polyfit(np.log(stretch), np.log(ratio), 1))
        power = round(slope)
        if not power or abs(slope - power) > ABOUT_POWER:
            continue
        fits = [("is about", np.exp(constant) * stretch**slope)]
        if abs(slope - power) <= NEAR_POWER:
            fits.insert(0, ("equals", stretch**power))
        for how, factor in fits:
            rest = _rest(difference, expected * (factor - 1))
            if rest <= EXPLAINED:
                text = f"{how} the table times {name}^{power}: a dead load, or stress per undeformed area?"
                yield text, rest
                break


def _numbers(target: Target) -> Iterator[tuple[str, float]]:
    """The parameters of the solution that are numbers, and its law's constants; not ends of branches."""
    fields = api.require_environment().get(target.problem).parameters.model_fields
    for name, value in ({n: field.default for n, field in fields.items()} | target.parameters).items():
        if isinstance(value, int | float) and not isinstance(value, bool) and not name.endswith("_end"):
            yield name, float(value)


def _columns(
    target: Target, changed: Mapping[str, float], over: str, x: np.ndarray
) -> dict[str, np.ndarray] | None:
    """The columns of a solution on a coarse mesh at values of one of them; ``None`` without such states."""
    about = abouts()[target.problem]
    branch = target.curves[0].branch if target.curves else "primary"
    from weakforms.problems.problem import StateRequest

    states = [StateRequest(over, float(value), 1, branch, profile=()) for value in x]
    parameters: dict[str, Any] = {**target.parameters, **changed}
    with suppress(WeakformsError):
        numerics = dict(about.example.numerics)
        result = api.solve_requests(target.problem, parameters, numerics, states, branch_uncertainty=False)
        if len(result.states) == len(x):
            names = result.states[0].quantities
            return {n: np.array([float(s.quantities[n].value) for s in result.states]) for n in names}
    return None


def _fitted(difference: np.ndarray, slope: np.ndarray) -> tuple[float, float]:
    """The multiple of a sensitivity that is closest to the differences, and the part that is left over."""
    size = float(slope @ slope)
    factor = float(difference @ slope) / size if size else 0.0
    return factor, _rest(difference, factor * slope)


def _rest(difference: np.ndarray, explained: np.ndarray) -> float:
    return float(np.linalg.norm(difference - explained) / np.linalg.norm(difference))
