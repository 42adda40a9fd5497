"""Finds the problems in the folders beside it; what is said of them needs no dolfinx, the problems do."""

from __future__ import annotations

import re
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from weakforms.errors import InputError, not_among
from weakforms.problems.about import About

if TYPE_CHECKING:
    from weakforms.problems.problem import Problem


@cache
def abouts() -> dict[str, About]:
    """What is said of every problem, by name: the values of type ``About`` of all modules ``about``."""
    return {name: about for name, (about, _) in _placed().items()}


@cache
def _placed() -> dict[str, tuple[About, str]]:
    """What is said of every problem, and the package of the module that says it."""
    modules = [import_module(name) for name in _modules() if name.endswith(".about")]
    found = ((value, module) for module in modules for value in vars(module).values())
    return {value.name: (value, module.__package__) for value, module in found if isinstance(value, About)}


def problems() -> dict[str, Problem]:
    """Every problem by name. Needs dolfinx.

    Raises:
        TypeError: If nothing solves a problem of which something is said.
    """
    return {name: _solver(name) for name in abouts()}


@cache
def _solver(name: str) -> Problem:
    """The problem of that name; only modules in the folder in which something is said of it are imported.

    Raises:
        TypeError: If no class there has it as its attribute ``about``.
    """
    about, package = _placed()[name]
    for module in (import_module(each) for each in _modules() if each.startswith(f"{package}.")):
        for value in vars(module).values():
            if isinstance(value, type) and vars(value).get("about") is about:
                return value()
    raise TypeError(f"no class has about = About({name!r}, ...)")


def get(name: str) -> Problem:
    """The problem of that name.

    Raises:
        InputError: If there is none.
    """
    if re.fullmatch(r"\w+\.\w+", name):  # as cases are named
        raise InputError(f"unknown problem {name!r}; if it is a case: weakforms check {name}")
    if name not in abouts():
        raise InputError(f"unknown problem {name!r}{not_among(name, abouts(), 'the problems are')}")
    return _solver(name)


def symbol(name: str) -> str:
    """The label of a number in figures: TeX between dollars, or empty if no problem declares a symbol."""
    return _symbols().get(name, "")


@cache
def _symbols() -> dict[str, str]:
    declared = (column for about in abouts().values() for column in (*about.columns, *about.numbers))
    return {column.name: f"${column.symbol}$" for column in declared if column.symbol}


def _modules() -> list[str]:
    """Names of all modules in the folders of problems."""
    here = Path(__file__).parent
    found = sorted(path.relative_to(here).with_suffix("") for path in here.glob("*/**/*.py"))
    return [".".join(["weakforms.problems", *path.parts]) for path in found if path.name != "__init__"]
