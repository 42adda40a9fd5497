"""What lines are followed of: a membrane in the form that the search for critical points needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from weakforms.solvers.continuation.branch import EquilibriumBranch
from weakforms.solvers.continuation.continuation import CurvePoint
from weakforms.solvers.continuation.curve import SolutionCurve
from weakforms.solvers.equilibrium.newton import Constraint
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modes import SecondVariation

PLACE = "S_least"
"""Where the least resultant is; a number of states on a line of wrinkling."""


@dataclass(frozen=True)
class Part:
    """What holds in one part of a primary branch, and on the lines through it."""

    fronts: Mapping[str, Constraint] = field(default_factory=dict)
    """Further loads that are unknown, such as the place of a free surface, with their equations."""
    bounds: tuple[tuple[str, float, int], ...] = ()
    """Column, value and outward direction of each end of the part."""
    why: str = ""
    """What happens there."""
    allowed: Callable[[State], bool] = lambda _state: True
    """Whether a state belongs to it or is just beyond an end; a step to another one is repeated shorter."""


class Followed(Protocol):
    """A membrane all of whose parameters are loads."""

    depth: str
    """Column of the largest displacement, which grows along the primary branch."""

    @property
    def system(self) -> System:
        """The equilibrium equations; their monitors have ``t_min``, the least principal resultant."""

    @property
    def least(self) -> Constraint:
        """The condition that the least principal resultant is zero."""

    @property
    def limit(self) -> Callable[[State], str]:
        """Why the law takes no more than a state."""

    def gives_way(self, point: CurvePoint) -> str:
        """Why the law takes no more stretch beyond a point; empty if it does."""

    def operators(self, kind: str) -> dict[int, Callable[[], SecondVariation]]:
        """Second variations whose null vectors break a symmetry, by parity; none for other kinds."""

    def at_onset(self) -> dict[str, float]:
        """What is said of the place of first wrinkling at the lent state."""

    def part(self, state: State) -> Part:
        """The part of the primary branch that a state belongs to."""

    def primary(self, end: float, step: float) -> SolutionCurve | Sequence[SolutionCurve]:
        """The primary branch at the loads of the initial state, up to ``depth = end``; its parts, if any."""


def ended_by_law(branch: EquilibriumBranch, model: Followed) -> EquilibriumBranch:
    """A primary branch with its end, if that is the law's."""
    branch.end_at_limit(model.limit)
    last = branch.points[-1]
    why = branch.ended or model.gives_way(last)
    if why:
        branch.ended = f"free inflation was followed up to {model.depth} = {last.monitors[model.depth]:.6g}, "
        branch.ended += f"p = {last.state.loads['p']:.6g}: {why}"
    return branch
