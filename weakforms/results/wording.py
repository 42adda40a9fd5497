"""Results as text that people read: what the terminal and a notebook say alike."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from weakforms.results.model import Branch, State
from weakforms.results.result import Result
from weakforms.results.uncertain import uncertain

LABELS = ("n", "direction", "state")
"""Columns of a special point that say what it is, such as the number of waves that appear there."""


def short(result: Result) -> str:
    """One line about a result."""
    branches = ", ".join(f"{b.name} ({counted(len(b), 'point', 'points')})" for b in result.branches)
    counts: dict[str, int] = {}
    for point in result.special_points:
        counts[point.kind] = counts.get(point.kind, 0) + 1
    parts = [f"branch {branches}" if branches else ""]
    parts += [f"{count} {kind}" for kind, count in counts.items()]
    parts += [counted(len(result.states), "state", "states")] * bool(result.states)
    parts += [counted(len(result.quantities), "quantity", "quantities")] * bool(result.quantities)
    parts += [f"{len(result.failures)} FAILED" if result.failures else ""]
    return f"<Result {result.problem}: {'; '.join(filter(None, parts)) or 'empty'}>"


def counted(count: int, one: str, several: str) -> str:
    """``1 state``, ``2 states``."""
    return f"{count} {one if count == 1 else several}"


def parameters_line(result: Result) -> str:
    """All parameters with their values."""
    shown = {
        name: ",".join(map(str, value)) if isinstance(value, list | tuple) else value
        for name, value in result.parameters.items()
    }
    return ", ".join(f"{name} = {value}" for name, value in shown.items() if value not in (None, ""))


def extent(branch: Branch) -> str:
    """How many points a branch has, between which values of its control, and where and why it ends."""
    points = counted(len(branch), "point", "points")
    if branch.control in branch.columns and len(branch):
        values = branch.columns[branch.control]
        points += f", {branch.control} from {min(values):.6g} to {max(values):.6g}"
    return f"{points}; ends at {branch.ended}" if branch.ended else points


def point_rows(result: Result) -> list[tuple[str, dict[str, str]]]:
    """Each special point, numbered within its kind, and its columns with uncertainties, the control first."""
    seen: Counter[tuple[str, str]] = Counter()
    out = []
    for point in result.special_points:
        seen[point.kind, point.branch] += 1
        place = f"{point.kind} {seen[point.kind, point.branch]}{_on(point.branch, result)}"
        first = (point.control, *LABELS)
        names = sorted(point.values, key=lambda name: first.index(name) if name in first else len(first))
        out.append((place, {n: uncertain(point.values[n], point.uncertainty.get(n)) for n in names}))
    return out


def which_crossing(state: State) -> str:
    """``, crossing 1 of 3`` for a value that the branch takes several times; empty if it takes it once."""
    if max(state.crossing, state.crossings or 1) == 1:
        return ""
    return f", crossing {state.crossing}" + (f" of {state.crossings}" if state.crossings else "")


def state_rows(result: Result, whole: bool = False) -> list[tuple[str, dict[str, str]]]:
    """Each state, as ``p = 1.95, crossing 1 of 3``, and its other numbers with uncertainties.

    Args:
        result: Any result.
        whole: Whether the numbers begin with those at which a state was asked for.
    """
    out = []
    for state in result.states:
        place = ", ".join(f"{name} = {value:.12g}" for name, value in state.at.items())
        place += which_crossing(state)
        numbers = {name: f"{value:.12g}" for name, value in state.at.items() if whole}
        numbers |= {name: f"{q}" for name, q in state.quantities.items() if name not in state.at}
        out.append((place + _on(state.branch, result), numbers))
    return out


def _on(branch: str, result: Result) -> str:
    """The branch, if a result has several."""
    return f" on {branch}" if len(result.branches) > 1 else ""


def not_crossed(name: str, value: float, crossing: int, count: int, values: Sequence[float]) -> str:
    """Why there is no such crossing of a value, which a branch takes ``count`` times.

    Args:
        name: Column.
        value: Its value that was asked for.
        crossing: The crossing that was asked for, from 1.
        count: Number of crossings, less than that.
        values: The column along the branch.
    """
    taken = f"{name} = {value:g} is not taken on this branch"
    if count:
        times = "once" if count == 1 else f"{count} times"
        taken = f"{name} = {value:g} is taken {times} on this branch, so there is no crossing {crossing}"
    return f"{taken}; {name} ranges over [{min(values):.6g}, {max(values):.6g}]"


def notes(result: Result, every: str = "--crossing all") -> list[str]:
    """Warnings, what is not there, what did not converge, and values that a branch takes more than once.

    Args:
        result: Any result.
        every: What asks for all crossings of a value.
    """
    out = [f"warning: {text}" for text in result.warnings]
    told = set()
    for state in result.states:
        ((name, value),) = state.at.items() if len(state.at) == 1 else (("", 0.0),)
        shown = sum(s.at == state.at and s.branch == state.branch for s in result.states)
        if (state.crossings or 1) > shown and (name, value) not in told:
            told.add((name, value))
            out.append(
                f"note: {name} = {value:g} is crossed {state.crossings} times on the {state.branch} branch; "
                f"this is crossing {state.crossing} ({every} gives all)"
            )
    out += [f"not there: {item.what}: {item.reason}" for item in result.absent]
    return [*out, *(f"not converged: {item.what}: {item.reason}" for item in result.failures)]
