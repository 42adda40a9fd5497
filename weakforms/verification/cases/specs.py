"""Specifications of solutions as plain values: a problem, its parameters, its meshes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from weakforms.problems.about import About
from weakforms.problems.registry import abouts


@dataclass(frozen=True)
class Spec:
    """A problem at some parameters (without defaults), with numerics if needed."""

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


def maker(about: About) -> Callable[..., Spec]:
    """The function of a problem's name that cases import: parameters by name give a specification."""

    def make(**parameters: Any) -> Spec:
        return Spec(about.name, _sorted(parameters))

    make.__name__ = make.__qualname__ = about.name
    make.__doc__ = f"{about.title}."
    return make


MAKERS: dict[str, Callable[..., Spec]] = {name: maker(about) for name, about in abouts().items()}
"""For every problem its function, which the package exports under the problem's name."""


@dataclass(frozen=True)
class At:
    """A requested state of a solution: a column at a value, or the ``value``-th special point of a kind."""

    name: str
    value: float
    crossing: int = 1
    profile: tuple[float, ...] | None = None
    branch: str = "primary"
    theta: float | None = None
    """The meridian of a profile over a surface; ``None`` for the whole surface."""
    field: str = ""
    """Name of the field; the profile by default."""

    def __str__(self) -> str:
        return f"{self.name} = {self.value:g}"
