"""The numbers to expect of a deck: a converged solution, and the error of its mesh and wall."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline

from weakforms import api
from weakforms.decks.bodies import Body, body_of, require_body
from weakforms.decks.meshes import cells_around
from weakforms.errors import ConvergenceError, InputError
from weakforms.results import Quantity, Result

STEPS = 10
"""Number of equal loads up to the one that is asked for."""

WALL, BULK = 0.002, 1e4
"""Thickness of a solid wall over the body's length, and its bulk modulus over ``C1``."""


@dataclass(frozen=True)
class Expected:
    """A solution, and the parts of the error to expect, relative to the load."""

    body: Body
    result: Result
    loads: np.ndarray
    values: np.ndarray
    """The column over which is judged, at each load."""
    uncertainty: np.ndarray
    errors: dict[str, float]

    @property
    def claim(self) -> float | None:
        """An accuracy to claim: twice the sum of the errors, rounded up; none if they are unknown."""
        if not self.errors:
            return None
        total = 2 * sum(self.errors.values())
        unit = 10.0 ** math.floor(math.log10(total))
        return math.ceil(total / unit * (1 - 1e-9)) * unit


def validated(problem: str, parameters: Mapping[str, Any], load: str, value: float) -> dict[str, Any]:
    """All parameters of a problem of which there is a deck, with the load checked.

    Raises:
        InputError: For bad input; nothing was solved.
        EnvironmentLackError: Without DOLFINx.
    """
    registry = api.require_environment()
    from weakforms.problems.problem import validated as checked

    chosen = registry.get(problem)
    values = checked(chosen.parameters, dict(parameters), problem).model_dump()
    require_body(problem, values)
    wanted = body_of(problem, values).load
    if load != wanted:
        raise InputError(f"deck {problem}: --at {load}: the load is {wanted}, as in --at {wanted}=...")
    if not (math.isfinite(value) and value > 0):
        raise InputError(f"deck {problem}: {load} = {value:g} must be above 0")
    return values


def solved(problem: str, parameters: Mapping[str, Any], load: str, value: float, progress: Any) -> Result:
    """The solution, with a state at each load.

    Raises:
        InputError: If the load is not reached from rest by raising it.
        ConvergenceError: If a state did not converge.
    """
    loads = np.linspace(0, value, STEPS + 1)[1:]
    result = api.prepare(problem, parameters, {}, [(load, float(p)) for p in loads])(progress)
    if result.failures:
        raise ConvergenceError(f"deck {problem}: {result.failures[0].what}: {result.failures[0].reason}")
    if len(result.states) < STEPS:
        raise InputError(
            f"deck {problem}: {load} = {value:g} is not reached by raising it from 0; choose a lower one"
        )
    over, last = body_of(problem, result.parameters).over, result.states[-1].quantities
    passed = [point for point in result.points("limit_point") if point.values[over] < last[over].value]
    if passed:
        raise InputError(
            f"deck {problem}: {load} = {value:g} lies beyond the limit point at {load} = "
            f"{passed[0].values[load]:.6g}; choose a lower one"
        )
    unstable = last.get("n_negative")
    if unstable is not None and unstable.value > 0:
        raise InputError(f"deck {problem}: the state at {load} = {value:g} is unstable under a held load")
    return result


def expected(result: Result, body: Body, cells: int, way: str) -> Expected:
    """What a deck's mesh is expected to give.

    The errors of a wrinkled tube are stated for a membrane of curved triangles under gas, with which they
    were measured. Those of its wall, and of one with a liquid, were not.

    Args:
        result: The solution.
        body: The body.
        cells: Number of cells along the meridian.
        way: ``section`` (a wall in the plane), ``wall`` (a wall in space), ``surface`` (a membrane of curved
            triangles) or ``facets`` (each of them as four flat ones).
    """
    quantities = [state.quantities for state in result.states]
    loads = np.array([q[body.load].value for q in quantities])
    over = [q[body.over] for q in quantities]
    if body.over == "V":
        return Expected(body, result, loads, *_columns(over), _of_volume(result, body, cells, way))
    degree, halves = (1, 2) if way == "facets" else (2, 1)
    errors = {"meridian": _meridian(result, body, halves * cells, degree)}
    angle = np.pi / 2 / cells_around(cells, body)
    if way == "facets":
        errors["circumference"] = around(angle / halves, degree)
    elif way != "section":
        errors["circumference"] = around(angle, 2)
        errors["edges"] = _edges(result, body, angle, quantities)
    if way in ("section", "wall"):
        errors["wall"] = WALL if body.clamps else WALL**2
        errors["compression"] = 2 * (1 + body.ratio) / BULK
    return Expected(body, result, loads, *_columns(over), errors)


def _columns(over: list[Quantity]) -> tuple[np.ndarray, np.ndarray]:
    """Values and uncertainties."""
    return np.array([q.value for q in over]), np.array([q.uncertainty or 0.0 for q in over])


RIPPLES = 4e-4
"""Relative volume that a wrinkled tube of curved triangles lacks, besides that between parabolas and circles,
over the square of a cell's length along the meridian. Measured with NGSolve: 1.0e-4, 3.0e-5 and about 1e-5
at most on one tube of 16, 24 and 48 cells (lengths 1/2, 1/3 and 1/6), and 6.4e-5 on another one of 16."""


def _of_volume(result: Result, body: Body, cells: int, way: str) -> dict[str, float]:
    """Errors of the load of a wrinkled tube, which is judged over its volume, where they are largest.

    A volume that is too small by ``e`` is one at which the load is wrong by ``e d ln(load)/d ln(V)``.
    """
    if way != "surface" or body.gamma:
        return {}
    angle = np.pi / 2 / cells_around(cells, body)
    steep = float(np.max(steepness(result, body)))
    length, area = circle(angle, 2)
    return {
        "circumference": abs(length / area - 1) + steep * abs(area - 1),
        "ripples": steep * RIPPLES * (body.size / cells) ** 2,
    }


def steepness(result: Result, body: Body) -> np.ndarray:
    """``d ln(load)/d ln(over)`` at each state, by a spline through the branch."""
    branch = result.branch()
    over, first = np.unique(branch[body.over], return_index=True)
    slope = make_interp_spline(over, np.asarray(branch[body.load])[first], k=3).derivative()
    at = np.array([[float(s.quantities[n].value) for n in (body.over, body.load)] for s in result.states])
    return slope(at[:, 0]) * at[:, 0] / at[:, 1]


def _meridian(result: Result, body: Body, cells: int, degree: int) -> float:
    """Error of the load at the last state on elements of a degree along the meridian, by a solution on them.

    The meridian of a sphere is a circle, whose error is known.
    """
    if body.problem == "sphere":
        return around(np.pi / 2 / cells, degree)
    given = {k: v for k, v in result.parameters.items() if v is not None}
    numerics: dict[str, Any] = {"degree": degree, "cells": cells, "levels": 2}
    last = result.states[-1].quantities
    value = float(last[body.over].value)
    coarse = api.prepare(body.problem, given, numerics, [(body.over, value)])(None)
    if not coarse.states:
        raise ConvergenceError(f"deck {body.problem}: no state on {cells} cells of degree {degree}")
    return abs(float(coarse.states[0].quantities[body.load].value) / float(last[body.load].value) - 1)


EDGES = 1 / 500
"""Movement of a membrane of parabolic cells off its smooth place, over the fourth power of a cell's angle. It
was measured on spheres of 108 triangles, whose radius is 1.0e-5 too large at every pressure."""


def _edges(result: Result, body: Body, angle: float, quantities: list[dict[str, Any]]) -> float:
    """Error of the first load by the edges between cells, at which a membrane finds a place of its own."""
    first = float(quantities[0][body.over].value)
    moved = abs(first - float(result.branch()[body.over][0]))
    return EDGES * angle**4 / moved


def around(angle: float, degree: int) -> float:
    """Relative error of a load on a circle of straight or parabolic edges that each span an angle.

    The load is proportional to the length of the circle, from which the energy comes, over the area inside.
    """
    length, area = circle(angle, degree)
    return abs(length / area - 1)


def circle(angle: float, degree: int) -> tuple[float, float]:
    """Length of straight or parabolic edges that each span an angle, and area inside, over a circle's."""
    chord, rise = 2 * math.sin(angle / 2), 1 - math.cos(angle / 2)
    area = math.sin(angle) / 2
    length = chord
    if degree == 2:
        area += 2 / 3 * chord * rise
        slope = 4 * rise / chord
        length = chord / 2 * (math.hypot(1, slope) + math.asinh(slope) / slope)
    return length / angle, area / (angle / 2)
