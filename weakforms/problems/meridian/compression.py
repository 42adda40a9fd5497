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
from weakforms.solvers.uncertainty.family import BranchFamily
from weakforms.solvers.uncertainty.points import special_point

ONSET = "wrinkling_onset"
"""Kind of the special point at which the smallest principal resultant passes zero."""

ALONG, AROUND = "along the meridian", "around the axis"

NEGLIGIBLE = 1e-5
"""Compression, over the largest resultant of its state, that is not told of: it may be the mesh's error, as
in a dry tube, whose hoop resultant is zero."""

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

    def least(self, loads: Mapping[str, float]) -> tuple[float, float, str]:
        """The smallest one anywhere, the magnitude of its material coordinate, and its direction."""
        (value, x), name = min((self._fields.extreme_at(name, -1), name) for name in self._columns)
        return value, abs(float(self.model.material(np.array([x]), loads)[0])), name


def compression(
    family: BranchFamily | PiecewiseFamily, place: str, order: float, end: tuple[str, float] | None = None
) -> str:
    """Between which states of a branch its membrane is compressed, as text; empty if it is taut.

    Args:
        family: The branch on all meshes.
        place: Name of the material coordinate.
        order: Order of resultants; their place has one less.
        end: A column and its value up to which the branch is asked for; its last step goes beyond.
    """
    pieces = [p.family for p in family.pieces] if isinstance(family, PiecewiseFamily) else [family]
    levels = list(zip(*(piece.levels for piece in pieces), strict=True))
    signs = np.concatenate([_signs(curve)[0] for curve in levels[-1]])
    if not (signs < 0).any():
        return ""
    column, last = end or (place, np.inf)
    try:
        found = [[s for s in _zeros(level, place) if s.values[column] <= last] for level in levels]
    except ConvergenceError as error:
        return f"on a part of the branch, whose ends are not found ({error})"
    kinds = [s.kind for s in found[-1]]
    if any([s.kind for s in level] != kinds for level in found):
        return "on a part of the branch that depends on the mesh; raise cells"
    across, along = pieces[0].across
    shown = along, across, place
    text = "from its first state on" if signs[signs != 0][0] < 0 else ""
    for same in zip(*found, strict=True):
        at = special_point(same, shown, order, "primary", across, {place: order - 1})
        spread = at.uncertainty | {place: at.uncertainty[place] + SLOPES}
        number = {name: f"{name} = {uncertain(at.values[name], spread[name])}" for name in shown}
        if at.kind == TAUT:
            text = f"{text.removesuffix(' on')} to {number[along]}"
        else:
            where = f"{at.kind} from {number[along]} ({number[across]}, at {number[place]}) on"
            text = f"{text}, and {where}" if text else where
    return text


def _signs(curve: SolutionCurve) -> tuple[np.ndarray, np.ndarray]:
    """Sign of the smallest resultant at each point of a trace, 0 where it is not known, and its value."""
    tension, rows = curve.system.formulation.tension, []
    for point in curve.points:
        with curve.system.at(point.state):
            rows.append(tension.at_nodes())
    least, largest = np.array(rows).T
    return (least > 0).astype(int) - (least < -NEGLIGIBLE * largest), least


def _zeros(curves: Sequence[SolutionCurve], place: str) -> list[Solved]:
    """The states of consecutive curves at which the smallest resultant is zero, with its place."""
    found, before = [], 0
    for curve in curves:
        sign, least = _signs(curve)
        known = np.flatnonzero(sign)
        if len(known) and before * sign[known[0]] < 0:  # between the last point of one and this one
            found.append(_placed(curve, curve.solved(curve.points[0].state), place, sign[known[0]]))
        for i, j in pairwise(known):
            if sign[i] * sign[j] < 0:
                k = i + int(np.flatnonzero(np.diff(least[i : j + 1] > 0))[-1])
                zero = curve.zero(k, lambda solved, curve=curve: _least(curve, solved)[0], ONSET)
                found.append(_placed(curve, zero, place, sign[j]))
        before = sign[known[-1]] if len(known) else before
    return found


def _placed(curve: SolutionCurve, solved: Solved, place: str, after: int) -> Solved:
    """A state with the place of its smallest resultant, and with what follows as its kind."""
    _, at, direction = _least(curve, solved)
    kind = TAUT if after > 0 else direction
    return replace(solved, values=solved.values | {place: at}, kind=kind)


def _least(curve: SolutionCurve, solved: Solved) -> tuple[float, float, str]:
    with curve.system.at(solved.state):
        return curve.system.formulation.tension.least(solved.state.loads)
