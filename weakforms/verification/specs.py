"""What is to be solved, as plain values: a problem, its parameters, its meshes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True)
class Spec:
    """A problem at some parameters (defaults left out) and, where they matter, numerics."""

    problem: str
    parameters: tuple[tuple[str, Any], ...] = ()
    numerics: tuple[tuple[str, Any], ...] = ()

    def on(self, **numerics: Any) -> Spec:
        """The same problem on other meshes, such as ``on(degree=2, cells=64)``."""
        return replace(self, numerics=_sorted(dict(self.numerics) | numerics))

    def at(self, **parameters: Any) -> Spec:
        """The same problem with some parameters changed."""
        return replace(self, parameters=_sorted(dict(self.parameters) | parameters))

    def __str__(self) -> str:
        given = ", ".join(f"{k}={v}" for k, v in (*self.parameters, *self.numerics))
        return f"{self.problem}({given})"


def _sorted(values: dict[str, Any]) -> tuple[tuple[str, Any], ...]:
    return tuple(sorted(values.items()))


def tube(**parameters: Any) -> Spec:
    """The pre-stretched cylindrical membrane of Paper 2."""
    return Spec("tube", _sorted(parameters))


def tube_fold(**parameters: Any) -> Spec:
    """The fold line of the freely inflated tube of Paper 2."""
    return Spec("tube_fold", _sorted(parameters))


def tube_scheme(**parameters: Any) -> Spec:
    """The constrained tube of Paper 2 by the paper's own schemes on a fixed mesh."""
    return Spec("tube_scheme", _sorted(parameters))


@dataclass(frozen=True)
class At:
    """A state wanted of a solution: a column at a value, or the ``value``-th special point of a kind."""

    name: str
    value: float
    crossing: int = 1
    profile: tuple[float, ...] | None = None

    def __str__(self) -> str:
        return f"{self.name} = {self.value:g}"
