"""A branch that consists of consecutive parts, such as free inflation and contact."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from weakforms.errors import InputError
from weakforms.results import Absence, Branch, Failure, Quantity, SpecialPoint, State
from weakforms.solvers.uncertainty.family import LOCATED, BranchFamily

Part = TypeVar("Part")


@dataclass(frozen=True)
class Piece:
    """A part of a branch on all meshes, with columns that are constant on it (no patch before contact)."""

    family: BranchFamily
    fixed: Mapping[str, float]


class PiecewiseFamily:
    """Consecutive parts combined into one branch: columns joined, special points and crossings in order.

    Args:
        pieces: In the order in which the branch runs through them.
        joints: Special points at which a piece ends and the next begins, one a joint; ``None`` for a joint
            at which a branch is smooth enough not to be marked.
        absent: What was asked for and is not there, such as contact.
    """

    def __init__(
        self,
        pieces: Sequence[Piece],
        joints: Callable[[], Sequence[SpecialPoint | None]] = tuple,
        absent: Sequence[Absence] = (),
    ) -> None:
        self.pieces, self.joints, self.missing = list(pieces), joints, list(absent)
        self.name, self.progress = self.pieces[0].family.name, BranchFamily.progress

    @property
    def absent(self) -> list[Absence]:
        """What was asked for and is not there, of the whole and of all pieces."""
        return [*self.missing, *(item for piece in self.pieces for item in piece.family.absent)]

    @property
    def failures(self) -> list[Failure]:
        """Failures of all parts."""
        return [failure for piece in self.pieces for failure in piece.family.failures]

    @property
    def warnings(self) -> list[str]:
        """Warnings of all parts."""
        return [text for piece in self.pieces for text in piece.family.warnings]

    @property
    def quadrature_degree(self) -> int:
        """The highest degree of all parts."""
        return max(piece.family.quadrature_degree for piece in self.pieces)

    def branch(self, with_uncertainty: bool = True) -> Branch:
        """All parts as one branch; a column that some part does not have is left out."""
        parts = []
        for piece in self.pieces:
            piece.family.progress = self.progress
            part = piece.family.branch(with_uncertainty)
            columns, spread = dict(part.columns), dict(part.uncertainty)
            for name, value in piece.fixed.items():
                columns[name] = np.full(len(part), value)
                if with_uncertainty:
                    spread[name] = np.zeros(len(part))
            parts.append(Branch(part.name, part.control, columns, spread))
        names = [n for n in parts[-1].columns if all(n in part.columns for part in parts)]
        known = [n for n in names if all(n in part.uncertainty for part in parts)]
        return Branch(
            self.name,
            parts[-1].control,
            {n: np.concatenate([part.columns[n] for part in parts]) for n in names},
            {n: np.concatenate([part.uncertainty[n] for part in parts]) for n in known},
        )

    def special_points(self) -> list[SpecialPoint]:
        """Special points of all parts and joints, in order."""
        joints = list(self.joints())
        points: list[SpecialPoint] = []
        for i, piece in enumerate(self.pieces):
            points.extend(_point_with_fixed(p, piece.fixed) for p in piece.family.special_points())
            points.extend(joint for joint in joints[i : i + 1] if joint is not None)
        return points

    def state(self, name: str, value: float, crossing: int = 1, profile: np.ndarray | None = None) -> State:
        """As :meth:`BranchFamily.state`, over all parts.

        Raises:
            InputError: If no part has such a state.
        """
        special, ranges = name in LOCATED, []

        def count(piece: Piece) -> int:
            family = piece.family
            if special:
                return sum(point.kind == name for point in family.special_points())
            if name in piece.fixed:
                return 0
            column = family.fine.over_points(name)
            ranges.extend([column.min(), column.max()])
            return len(family.fine.crossings(name, value))

        found = nth(self.pieces, count, value if special else crossing)
        if found is not None:
            piece, here = found
            wanted = (here, 1) if special else (value, here)
            return _with_fixed(piece.family.state(name, *wanted, profile), piece.fixed, crossing)
        where = f"; {name} ranges over [{min(ranges):.6g}, {max(ranges):.6g}]" if ranges else ""
        raise InputError(f"{name} = {value:g} is not taken {crossing} times on this branch{where}")


def nth(parts: Iterable[Part], count: Callable[[Part], int], wanted: float) -> tuple[Part, float] | None:
    """The part of a branch with the ``wanted``-th of what is counted, and which one it is there.

    Parts after it are not counted.
    """
    left = wanted
    for part in parts:
        here = count(part)
        if left <= here:
            return part, left
        left -= here
    return None


def _with_fixed(state: State, fixed: Mapping[str, float], crossing: int) -> State:
    """A part's state, with the columns that are constant on it; a column without a value is left out."""
    quantities = {name: value for name, value in state.quantities.items() if name not in fixed}
    quantities |= {name: Quantity(value, 0.0) for name, value in fixed.items() if not np.isnan(value)}
    return State(state.at, state.branch, quantities, state.fields, crossing)


def _point_with_fixed(point: SpecialPoint, fixed: Mapping[str, float]) -> SpecialPoint:
    """A part's special point, without the columns that are constant on it."""
    values, spread, orders = (
        {name: value for name, value in of.items() if name not in fixed}
        for of in (point.values, point.uncertainty, point.orders)
    )
    return replace(point, values=values, uncertainty=spread, orders=orders)
