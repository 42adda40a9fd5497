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
    modules = [import_module(name) for name in _modules() if name.endswith(".about")]
    found = [value for module in modules for value in vars(module).values() if isinstance(value, About)]
    return {about.name: about for about in found}


@cache
def problems() -> dict[str, Problem]:
    """Every problem by name: the classes with an attribute ``about`` of all modules. Needs dolfinx.

    Raises:
        TypeError: If nothing solves a problem of which something is said.
    """
    classes = [
        value
        for module in map(import_module, _modules())
        for value in vars(module).values()
        if isinstance(value, type) and "about" in vars(value) and value.__module__ == module.__name__
    ]
    by_name = {cls.about.name: cls for cls in classes}
    unsolved = [name for name in abouts() if name not in by_name]
    if unsolved:
        raise TypeError(f"no class has about = About({unsolved[0]!r}, ...)")
    return {name: by_name[name]() for name in abouts()}


def get(name: str) -> Problem:
    """The problem of that name.

    Raises:
        InputError: If there is none.
    """
    if re.fullmatch(r"\w+\.\w+", name):  # as cases are named
        raise InputError(f"unknown problem {name!r}; if it is a case: weakforms check {name}")
    if name not in abouts():
        raise InputError(f"unknown problem {name!r}{not_among(name, abouts(), 'the problems are')}")
    return problems()[name]


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
