"""Where a membrane of revolution is compressed along a branch: a remark of its result.

The ordinary energy lets a membrane bear compression, in which a real one wrinkles. The smallest principal
resultant is read at the nodes of each point of a trace; where it changes its sign, states with a resultant of
zero are solved for.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from ufl.core.expr import Expr

from weakforms.errors import ConvergenceError
from weakforms.problems.meridian.fields import Meridian
from weakforms.problems.meridian.model import MeridianModel
from weakforms.results.uncertain import uncertain
from weakforms.solvers.continuation.curve import SolutionCurve, Solved
from weakforms.solvers.continuation.pieces import PiecewiseFamily
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.points import special_point

UNRESOLVED = "may be compressed where the meshes do not resolve it (raise cells)"
"""What is said if the meshes do not agree on where the smallest resultant is zero."""

ONSET = "wrinkling_onset"
"""Kind of the special point at which the smallest principal resultant passes zero."""

ALONG, AROUND = "along the meridian", "around the axis"

NEGLIGIBLE = 1e-5
"""Compression, over the largest resultant of its state, that is not told of: it may be the mesh's error, as
in a dry tube, whose hoop resultant is zero."""

SLACK = 1e-9
"""The same without relation to others, for a membrane without pressure."""

NEAR = 0.2
"""Part of a block within which the place of the smallest resultant moves between two points of a trace. Far
from there it may be zero, as in a dry part, to the mesh's error."""

SLOPES = 1e-8
"""Round-off of a resultant and of its place: Newton's last step in a slope on the smallest cells."""

TAUT = "taut"
"""Kind of a state with a resultant of zero after which the membrane is taut; else the kind is the direction
of compression."""


class PrincipalResultants:
    """Principal resultants along the meridian, at the state that the system of a model is lent to.

    Args:
        model: The model.
        t1: The meridional resultant.
        t2: The resultant around the axis.
    """

    def __init__(self, model: MeridianModel, t1: Expr, t2: Expr) -> None:
        self.model, self._columns = model, {ALONG: t1, AROUND: t2}

    @cached_property
    def _fields(self) -> Meridian:
        return Meridian(self.model, self._columns)

    def at_nodes(self) -> tuple[float, float]:
        """The smallest resultant, and the largest magnitude, at the nodes of the cells."""
        return self._fields.at_nodes()

    def least(self, near: float | None = None) -> tuple[float, float, str]:
        """The smallest one anywhere or near a mesh coordinate, its mesh coordinate and its direction."""
        within = (-np.inf, np.inf) if near is None else (near - NEAR, near + NEAR)
        (value, x), name = min((self._fields.extreme_at(name, -1, within), name) for name in self._columns)
        return value, x, name

    def place(self, x: float, loads: Mapping[str, float]) -> float:
        """Magnitude of the material coordinate at a mesh coordinate."""
        return abs(float(self.model.material(np.array([x]), loads)[0]))


def compression(
    family: BranchFamily | PiecewiseFamily,
    place: str,
    order: float,
    end: tuple[str, float, int] | None = None,
) -> str:
    """Between which states of a branch its membrane is compressed, as text; empty if it is taut.

    Args:
        family: The branch on all meshes.
        place: Name of the material coordinate.
        order: Order of resultants; their place has one less.
        end: A column, its value up to which the branch is asked for, and 1 if it rises towards it or -1 if
            it falls; the last step of the branch goes beyond.
    """
    pieces = [p.family for p in family.pieces] if isinstance(family, PiecewiseFamily) else [family]
    levels = list(zip(*(piece.levels for piece in pieces), strict=True))
    errors = _errors([level[0] for level in levels])
    signs = np.concatenate([_signs(curve, errors[-1]) for curve in levels[-1]])
    if not (signs < 0).any():
        return ""
    column, last, way = end or (place, np.inf, 1)
    try:
        zeros = [_zeros(level, place, error) for level, error in zip(levels, errors, strict=True)]
    except ConvergenceError:
        return UNRESOLVED
    found = [[s for s in level if way * s.values[column] <= way * last - SLACK] for level in zeros]
    kinds = [s.kind for s in found[-1]]
    begins = signs[signs != 0][0] < 0
    if any([s.kind for s in level] != kinds for level in found) or (begins and not signs[0]):
        return UNRESOLVED
    across, along = pieces[0].across
    shown = along, across, place
    text = "is compressed from its first state on" if begins else ""
    for same in zip(*found, strict=True):
        at = special_point(same, shown, order, "primary", across, {place: order - 1})
        uncertainty = at.uncertainty | {place: at.uncertainty[place] + SLOPES}
        number = {name: f"{name} = {uncertain(at.values[name], uncertainty[name])}" for name in shown}
        if at.kind == TAUT:
            text = f"{text.removesuffix(' on')} to {number[along]}"
        else:
            where = f"is compressed {at.kind} from {number[along]} ({number[across]}, at {number[place]}) on"
            text = f"{text}, and {where}" if text else where
    return text


def _errors(curves: Sequence[SolutionCurve]) -> list[float]:
    """Twice the change of the smallest resultant of the first state from mesh to mesh: its error."""
    first = [_at_nodes(curve, curve.points[0].state)[0] for curve in curves]
    away = [abs(least - first[-1]) for least in first[:-1]]
    return [2 * error for error in (*away, away[-1])]


def _signs(curve: SolutionCurve, error: float) -> np.ndarray:
    """Sign of the smallest resultant at each point of a trace, 0 where it is not known."""
    least, largest = np.array([_at_nodes(curve, point.state) for point in curve.points]).T
    return (least > 0).astype(int) - (least < -np.maximum(NEGLIGIBLE * largest, max(SLACK, error)))


def _at_nodes(curve: SolutionCurve, state: State) -> tuple[float, float]:
    with curve.system.at(state):
        return curve.system.formulation.tension.at_nodes()


def _zeros(curves: Sequence[SolutionCurve], place: str, error: float) -> list[Solved]:
    """The states of consecutive curves at which the smallest resultant is zero, with its place."""
    found, before = [], 0
    for curve in curves:
        sign = _signs(curve, error)
        known = np.flatnonzero(sign)
        if len(known) and before * sign[known[0]] < 0:  # between the last point of one and this one
            found.append(_placed(curve, curve.solved(curve.points[0].state), place, None, sign[known[0]]))
        for i, j in pairwise(known.tolist()):
            if sign[i] * sign[j] < 0:
                found.append(_zero(curve, i, j, place, sign[j]))
        before = sign[known[-1]] if len(known) else before
    return found


def _zero(curve: SolutionCurve, i: int, j: int, place: str, after: int) -> Solved:
    """The state between two points of a trace, one taut and one compressed, at which a resultant is zero."""
    compressed = curve.points[i if after > 0 else j].state
    _, near, _ = _least(curve, compressed)
    at = [_least(curve, point.state, near)[0] for point in curve.points[i : j + 1]]
    changes = np.flatnonzero(np.diff(np.array(at) > 0))
    k = i + int(changes[0 if after > 0 else -1]) if len(changes) else i
    zero = curve.zero(k, lambda solved: _least(curve, solved.state, near)[0], ONSET)
    return _placed(curve, zero, place, near, after)


def _placed(curve: SolutionCurve, solved: Solved, place: str, near: float | None, after: int) -> Solved:
    """A state with the place of its smallest resultant, and with what follows as its kind."""
    _, x, direction = _least(curve, solved.state, near)
    at = curve.system.formulation.tension.place(x, solved.state.loads)
    return replace(solved, values=solved.values | {place: at}, kind=TAUT if after > 0 else direction)


def _least(curve: SolutionCurve, state: State, near: float | None = None) -> tuple[float, float, str]:
    with curve.system.at(state):
        return curve.system.formulation.tension.least(near)
