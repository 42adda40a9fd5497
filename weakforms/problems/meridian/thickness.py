"""A thickness given as text, such as ``1 + 0.2*cos(pi*X)``: read safely, checked, used in a form.

The text is parsed as a Python expression, of which only numbers, a few names, ``+ - * / **`` and smooth
functions of one argument are allowed. Nothing of it is executed as Python.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, Any

import numpy as np
import ufl
from pydantic import BeforeValidator

from weakforms.errors import InputError

FUNCTIONS: dict[str, tuple[Callable, Callable]] = {
    name: (getattr(np, name), getattr(ufl, "ln" if name == "log" else name))
    for name in ("cos", "exp", "log", "sin", "sqrt", "tan", "tanh")
}
"""Allowed functions, of numbers and of expressions of a form; all are smooth, so that orders are kept."""

OPERATORS: dict[type, Callable] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.UAdd: operator.pos,
    ast.USub: operator.neg,
}

LONGEST = 200
"""Largest number of characters."""

PLACES = 2001
"""Number of places along a meridian at which the thickness is looked at."""

LEAST, MOST = 0.01, 100.0
"""Range of the thickness over ``h``: beyond it no mesh resolves the stretches, or units are wrong."""


@dataclass(frozen=True)
class Thickness:
    """A thickness over ``h`` as a function of the coordinate along the meridian, or of several ones."""

    text: str
    coordinate: str
    """Name of the coordinate."""
    others: tuple[str, ...] = ()
    """Names of further coordinates, and of parameters of the body, that may occur."""

    def __post_init__(self) -> None:
        """Refuse a text with anything that is not allowed.

        Raises:
            ValueError: With the place and what is allowed.
        """
        if len(self.text) > LONGEST:
            raise ValueError(f"has {len(self.text)} characters; allowed: up to {LONGEST}")
        self._check(_parsed(self.text))

    def _check(self, node: ast.expr) -> None:
        known = (self.coordinate, *self.others, "pi")
        match node:
            case ast.Constant(value=value) if type(value) in (int, float):
                return
            case ast.Name(id=name) if name in known:
                return
            case ast.Name(id=name):
                kind = "name" if name not in FUNCTIONS else "name (a function needs brackets)"
                raise ValueError(f"unknown {kind} {name!r} {_place(node)}; {self._allowed()}")
            case ast.BinOp(left=left, op=op, right=right) if type(op) in OPERATORS:
                self._check(left)
                self._check(right)
            case ast.UnaryOp(op=op, operand=operand) if type(op) in OPERATORS:
                self._check(operand)
            case ast.Call(func=ast.Name(id=name), args=[argument], keywords=[]) if name in FUNCTIONS:
                self._check(argument)
            case ast.Call(func=ast.Name(id=name)) if name not in FUNCTIONS:
                raise ValueError(f"unknown function {name!r} {_place(node)}; {self._allowed()}")
            case _:
                part = (ast.get_source_segment(self.text, node) or self.text)[:40]
                raise ValueError(f"{part!r} {_place(node)} is not allowed; {self._allowed()}")

    def _allowed(self) -> str:
        names = ", ".join((self.coordinate, *self.others, "pi"))
        return f"allowed: numbers, {names}, + - * / **, and {', '.join(FUNCTIONS)} of one argument"

    def __call__(self, s: Any, values: Mapping[str, Any]) -> Any:
        """The expression of a form at a coordinate; ``values`` has the other names."""
        names = {self.coordinate: s, "pi": math.pi} | {name: values[name] for name in self.others}
        return _evaluated(_parsed(self.text), names, 1)

    def at(self, s: np.ndarray, **others: np.ndarray | float) -> np.ndarray:
        """Its values at places of the body, refused where one is no thickness.

        Args:
            s: The coordinate.
            **others: Values of the other names, at these places or everywhere.

        Raises:
            ValueError: If a number of the expression is not finite, or the thickness is out of range.
        """
        places = {self.coordinate: s} | {name: np.full_like(s, value) for name, value in others.items()}
        given = places | {"pi": np.full_like(s, math.pi)}
        with np.errstate(all="ignore"):
            found = np.broadcast_to(_evaluated(_parsed(self.text), given, 0, self._finite(places)), s.shape)
        k = int(np.argmin(found) if found.min() < LEAST else np.argmax(found))
        if not LEAST <= found[k] <= MOST:
            where = self._where(places, k)
            raise ValueError(f"is {found[k]:.4g} {where}; allowed: from {LEAST:g} to {MOST:g} everywhere")
        return found

    def _where(self, places: Mapping[str, np.ndarray], k: int) -> str:
        """A place in a message: the coordinate, and the others that differ from place to place."""
        named = {name: x[k] for name, x in places.items() if name == self.coordinate or np.ptp(x) > 0}
        return "at " + ", ".join(f"{name} = {value:.4g}" for name, value in named.items())

    def _finite(self, places: Mapping[str, np.ndarray]) -> Callable[[Any, ast.expr], None]:
        """A check of every number that occurs."""

        def check(value: Any, node: ast.expr) -> None:
            shape = places[self.coordinate].shape
            wrong = np.flatnonzero(~np.isfinite(np.broadcast_to(value, shape)))
            if len(wrong):
                part = ast.get_source_segment(self.text, node)
                where = self._where(places, wrong[0])
                raise ValueError(f"{part!r} {_place(node)} is not finite {where}")

        return check


def text_over(coordinate: str, *others: str) -> Any:
    """Type of a parameter that is the text of a thickness, or ``None``."""

    def text(given: object) -> str | None:
        if given is None:
            return None
        if isinstance(given, bool) or not isinstance(given, str | int | float):
            raise ValueError(f"must be a text such as '1 + 0.2*cos(pi*{coordinate})'")
        return Thickness(str(given), coordinate, others).text

    return Annotated[str | None, BeforeValidator(text)]


def require_thickness(
    problem: str,
    given: Thickness | None,
    places: float | np.ndarray,
    replaced: bool = False,
    **others: np.ndarray | float,
) -> None:
    """Refuse a thickness that is not positive and finite along a whole meridian, or at many places.

    Args:
        problem: Name of the problem, for the message.
        given: The thickness, if it is given as text.
        places: The coordinate at the last end of a meridian, or at each place.
        replaced: Whether the parameter ``M``, which it replaces, is given too.
        **others: Values of the other names in it.

    Raises:
        InputError: With the place and the allowed range.
    """
    if given is None:
        return
    try:
        given.at(places if np.ndim(places) else np.linspace(0.0, places, PLACES), **others)
    except ValueError as error:
        raise InputError(f"{problem}: thickness = {given.text!r}: {error}") from None
    if replaced:
        raise InputError(f"{problem}: thickness = {given.text!r} replaces M; leave out one of them")


@lru_cache(maxsize=64)
def _parsed(text: str) -> ast.expr:
    try:
        return ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        at = f" at character {error.offset}" if error.offset else ""
        raise ValueError(f"is no expression ({error.msg}{at})") from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise ValueError(f"is no expression ({error})") from None


def _place(node: ast.expr) -> str:
    return f"at character {node.col_offset + 1}"


def _evaluated(
    node: ast.expr,
    names: Mapping[str, Any],
    kind: int,
    seen: Callable[[Any, ast.expr], None] = lambda _value, _node: None,
) -> Any:
    """The value of a checked expression: an array (``kind`` 0) or an expression of a form (1)."""
    match node:
        case ast.Constant(value=value):
            out = np.float64(value) if kind == 0 else float(value)
        case ast.Name(id=name):
            out = names[name]
        case ast.UnaryOp(op=op, operand=operand):
            out = OPERATORS[type(op)](_evaluated(operand, names, kind, seen))
        case ast.BinOp(left=left, op=op, right=right):
            parts = (_evaluated(part, names, kind, seen) for part in (left, right))
            out = OPERATORS[type(op)](*parts)
        case ast.Call(func=ast.Name(id=name), args=[argument]):
            out = FUNCTIONS[name][kind](_evaluated(argument, names, kind, seen))
        case _:
            raise ValueError(f"{ast.dump(node)} has not been checked")
    seen(out, node)
    return out
