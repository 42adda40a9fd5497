"""Random sets of parameters from the whole ranges of a problem."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from weakforms.errors import InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems.material_choice import MOONEY_RIVLIN, MaterialChoice
from weakforms.problems.problem import Problem, Requests, validated

WIDE, DECADES = 10.0, 3
"""A range whose ends differ by more than this factor is drawn logarithmically. If it starts at zero, it is
drawn over this number of decades below its upper end; zero itself, if allowed, is one draw in ten."""

FREE = 1e6
"""A constant of a law with a wider range is relative to an arbitrary stress. It is drawn within a factor of
ten of its default."""

MANY = 4
"""If there are more choices than this, such as the laws, every second draw uses the default."""

ATTEMPTS = 400
"""Largest number of draws for one admissible set."""


def sets(problem: Problem, seed: int, count: int) -> tuple[list[dict[str, Any]], dict[str, int]]:
    """The first ``count`` admissible sets of a seed; a larger ``count`` starts with the same sets.

    Returns:
        The sets, and the number of refused draws for each message (contradictory parameters).

    Raises:
        InputError: If nearly no set is admissible.
    """
    found: list[dict[str, Any]] = []
    refused: dict[str, int] = {}
    draws = drawn(problem, seed)
    for _ in range(ATTEMPTS * count):
        if len(found) == count:
            return found, refused
        given = next(draws)
        try:
            problem.check(validated(problem.parameters, given, problem.name), Requests())
        except InputError as error:
            refused[str(error)] = refused.get(str(error), 0) + 1
        else:
            found.append(given)
    raise InputError(f"audit: {problem.name} admits fewer than one in {ATTEMPTS} of the sets drawn")


def drawn(problem: Problem, seed: int) -> Iterator[dict[str, Any]]:
    """An endless sequence of sets: each parameter is in its range, and combinations are not checked."""
    rng = np.random.default_rng([seed, zlib.crc32(problem.name.encode())])
    described = problem.parameters.model_json_schema()["properties"]
    held = problem.about.audit_held
    while True:
        values = {name: _value(entry, rng) for name, entry in described.items() if name not in held}
        given = {name: value for name, value in values.items() if value is not None}
        if issubclass(problem.parameters, MaterialChoice):
            given = _with_law(given, problem.parameters.ratio, rng)
        yield {**given, **held}


def _with_law(given: dict[str, Any], ratio: str, rng: np.random.Generator) -> dict[str, Any]:
    """The set with random constants of the law, except C2/C1 if this is a parameter of the problem."""
    law = MATERIALS[given["model"]]
    if law.name == MOONEY_RIVLIN and ratio:
        return given
    rest = {name: value for name, value in given.items() if name != ratio}
    return rest | {name: _constant(c, rng) for name, c in law.constants.items()}


def _constant(constant: Any, rng: np.random.Generator) -> float:
    factor = 10.0 ** rng.uniform(-1, 1)
    if constant.high - constant.low > FREE:
        return _rounded(min(max(constant.default * factor, constant.low), constant.high))
    return _number(constant.low, constant.high, not constant.open_low, rng)


def _value(entry: Mapping[str, Any], rng: np.random.Generator) -> Any:
    """A value for one property of a JSON schema, or none if the schema has too little information."""
    if "anyOf" in entry:
        return _value(entry["anyOf"][rng.integers(len(entry["anyOf"]))], rng)
    if entry.get("type") == "array":
        found = [_value(entry.get("items", {}), rng) for _ in range(rng.integers(3))]
        return ",".join(map(str, found)) if found and None not in found else None
    choices = [False, True] if entry.get("type") == "boolean" else entry.get("enum") or entry.get("examples")
    if choices or "const" in entry:
        choices = choices or [entry["const"]]
        default = len(choices) > MANY and rng.random() < 0.5
        return entry["default"] if default else choices[rng.integers(len(choices))]
    return _within(entry, rng)


def _within(entry: Mapping[str, Any], rng: np.random.Generator) -> float | None:
    """A number in a range with two ends, or none if it has fewer."""
    low = entry.get("minimum", entry.get("exclusiveMinimum"))
    high = entry.get("maximum", entry.get("exclusiveMaximum"))
    if entry.get("type") not in ("number", "integer") or low is None or high is None:
        return None
    number = _number(low, high, "minimum" in entry, rng)
    return round(number) if entry["type"] == "integer" else number


def _number(low: float, high: float, with_low: bool, rng: np.random.Generator) -> float:
    share = rng.random()
    if low == 0 and high > WIDE:
        if with_low and share < 0.1:
            return 0.0
        low = high / 10**DECADES
    if low > 0 and high > WIDE * low:
        return _rounded(low * (high / low) ** share)
    return _rounded(low + share * (high - low))


def _rounded(value: float) -> float:
    """The number with four digits, as on a command line."""
    return float(f"{value:.4g}")
