"""Detection of forgotten units: a column that is a constant multiple of the table's."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import product

import numpy as np

from weakforms.scaling import symbols
from weakforms.verification.crosscheck.rows import FAILED, FLOOR, JudgedColumn

CONSTANT_SPREAD = 1e-2
"""Largest relative spread over all rows of a ratio that counts as constant."""

MATCH = 1e-2
"""Relative distance within which a ratio counts as a product of powers of constants."""

SLIP = 0.1
"""Largest distance of a ratio from 1 that counts as a slip in the constants of the scaling."""

POWERS = range(-3, 4)
"""Powers of the constants in such a product."""

NUMBERS = {"": 1.0, "2": 2.0, "pi": math.pi, "2 pi": 2 * math.pi}
"""Additional factors of such a product; their inverses count too."""


def forgotten(
    judged: JudgedColumn, problem: str, constants: Mapping[str, object], parameters: Mapping[str, object]
) -> str:
    """The meaning of a constant ratio of curve and table; empty if there is none, or if nothing is wrong.

    Args:
        judged: A column that was judged.
        problem: Problem whose scaling the table has.
        constants: The caller's constants; the column may be multiplied by products of their powers, ...
        parameters: ... or by a power of one of the table's parameters.
    """
    size = np.abs(judged.expected)
    if (judged.verdict.asked is not None and judged.verdict.status != FAILED) or not size.any():
        return ""
    told = size > FLOOR * size.max()  # near a zero the ratio has no meaning
    values = judged.expected + judged.error * np.maximum(size, judged.verdict.scale_floor)
    ratios = values[told] / judged.expected[told]
    ratio = float(np.median(ratios))
    if len(ratios) < 3 or ratio == 0 or not np.all(np.abs(ratios / ratio - 1) <= CONSTANT_SPREAD):
        return ""
    spread = float(np.max(np.abs(ratios / ratio - 1)))
    if abs(ratio - 1) <= 10 * spread:  # scatter about the table, not a multiple of it
        return ""
    said = f"yours / ours = {ratio:.6g} in every row"
    if abs(ratio + 1) <= MATCH:
        return f"{said}: the other sign?"
    within = min(MATCH, 3 * max(spread, 1e-6))
    guesses = [_product(abs(ratio), _numbers(constants), within) or _power(abs(ratio), parameters, within)]
    near_one = abs(math.log(abs(ratio))) < math.log(2)  # a mistake, not a unit
    unit = "" if constants or near_one else symbols(problem, judged.verdict.column)
    guesses += [f"{unit} (see --constant)"] if unit else []
    if abs(abs(ratio) - 1) <= SLIP and not any(guesses) and symbols(problem, judged.verdict.column):
        way = f"{100 * abs(abs(ratio) - 1):.2g} % too {'large' if abs(ratio) > 1 else 'small'}"
        guesses = [f"is {symbols(problem, judged.verdict.column)} {way}"]
    return ": ".join([said, *filter(None, [" or ".join(filter(None, guesses))])]) + "?" * any(guesses)


def _power(ratio: float, parameters: Mapping[str, object], within: float) -> str:
    """The ratio as a power of one of the table's parameters; empty if it is not one."""
    for name, value in _numbers(parameters).items():
        for power in filter(None, POWERS):
            if abs(math.log(ratio) - power * math.log(value)) <= within:
                return _written({name: power}, "", 1)
    return ""


def _product(ratio: float, constants: Mapping[str, float], within: float) -> str:
    """The ratio as the simplest product of powers of constants, 2 and pi; empty if it is not one."""
    found = []
    for powers in product(POWERS, repeat=len(constants)):
        logarithms = [p * math.log(value) for p, value in zip(powers, constants.values(), strict=True)]
        for label, number in NUMBERS.items():
            for sign in (1, -1) if label else (1,):
                if abs(math.log(ratio) - sum(logarithms) - sign * math.log(number)) <= within:
                    factors = dict(zip(constants, powers, strict=True))
                    cost = sum(map(abs, powers)) + 2 * bool(label)
                    found.append((cost, _written(factors, label, sign)))
    return min(found)[1] if found else ""


def _written(factors: Mapping[str, int], number: str, sign: int) -> str:
    """The product as text, such as ``2 pi C1 h_o/R_f^2``."""

    def part(which: int) -> list[str]:
        words = [number] if number and sign == which else []
        for name, power in factors.items():
            if power * which > 0:
                words.append(name if abs(power) == 1 else f"{name}^{abs(power)}")
        return words

    above, below = part(1), part(-1)
    text = " ".join(above) or "1"
    if not below:
        return text
    return f"{text}/{below[0]}" if len(below) == 1 else f"{text}/({' '.join(below)})"


def _numbers(given: Mapping[str, object]) -> dict[str, float]:
    """The entries that are positive numbers other than 1."""
    out = {}
    for name, value in given.items():
        try:
            number = float(str(value))
        except ValueError:
            continue
        if 0 < number < math.inf and number != 1:
            out[name] = number
    return out


def abscissa_hint(problem: str, abscissa: str, constants: Mapping[str, object]) -> str:
    """A hint for a curve that lies mostly outside of its table."""
    unit = "" if constants else symbols(problem, abscissa)
    return f"is {abscissa} in units of {unit} (see --constant)?" if unit else ""
