"""Finds case files by their folder, and selects cases by paper or by an expression over their names."""

from __future__ import annotations

import importlib.util
import re
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from pathlib import Path

from weakforms.errors import InputError
from weakforms.problems.registry import abouts
from weakforms.verification.cases.case import Case
from weakforms.verification.cases.references import ROOT, folder_of, part

GROUPS = ("materials", "closed_form", "beyond")
"""Folders of cases and reference tables that do not belong to a paper."""


@dataclass(frozen=True)
class FoundCase:
    """A case with its id: ``cases/paper2/fig03.py`` is ``paper2.fig03``."""

    id: str
    paper: int | str
    """Number of the paper, or name of the group if the case does not belong to a paper."""
    path: Path
    case: Case
    description: str

    @property
    def group(self) -> str:
        """Folder of the case, such as ``paper2`` or ``materials``."""
        return folder_of(self.paper)

    @property
    def words(self) -> str:
        """Text that a selection searches."""
        return " ".join([self.id, *self.case.tags]).lower()


@cache
def find_cases(root: Path = ROOT) -> tuple[FoundCase, ...]:
    """All cases in the order of papers and names, then those that do not belong to a paper.

    Raises:
        InputError: If a case file does not define ``CASE``.
    """
    return tuple(_load(path, paper) for path, paper in _files(root))


def case_ids(root: Path = ROOT) -> list[str]:
    """Ids of all cases, without reading their files."""
    return [_id(path, paper) for path, paper in _files(root)]


def _files(root: Path) -> list[tuple[Path, int | str]]:
    """The file of each case with its paper or group, in the order of the cases."""
    of_papers = [
        (path, paper)
        for paper in range(1, 6)
        for path in (part("cases", root) / f"paper{paper}").rglob("*.py")
        if not path.stem.startswith("_")
    ]
    of_groups = [
        (path, group)
        for group in GROUPS
        for path in sorted((part("cases", root) / group).rglob("*.py"), key=lambda path: path.stem)
        if not path.stem.startswith("_")
    ]
    return sorted(of_papers, key=lambda item: (item[1], _id(*item))) + of_groups


def _id(path: Path, paper: int | str) -> str:
    return f"{folder_of(paper)}.{path.stem}"


def _load(path: Path, paper: int | str) -> FoundCase:
    name = f"weakforms_cases.{folder_of(paper)}.{path.stem}"
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        raise InputError(f"case file {path}: {type(error).__name__}: {error}") from error
    case = getattr(module, "CASE", None)
    if not isinstance(case, Case):
        raise InputError(f"case file {path} defines no CASE")
    return FoundCase(_id(path, paper), paper, path, case, (module.__doc__ or "").strip())


def get_case(name: str) -> FoundCase:
    """The case of that id.

    Raises:
        InputError: If there is none; the message names similar ids.
    """
    known = {found.id: found for found in find_cases()}
    if name in abouts():
        raise InputError(f"unknown case {name!r}; it is a problem: weakforms solve {name}")
    if name not in known:
        raise InputError(f"unknown case {name!r}; {among(name, known)}")
    return known[name]


def among(name: str, known: Iterable[str]) -> str:
    """The names closest to a wrong one, in one short line; ``fig3`` means ``fig03`` first of all."""
    close = get_close_matches(name, list(known), n=5, cutoff=0.5)
    close.sort(key=lambda word: _without_zeros(word) != _without_zeros(name))
    return f"close to it: {', '.join(close)}; all: weakforms list" if close else "see: weakforms list"


def _without_zeros(name: str) -> str:
    """A name whose numbers have no leading zeros."""
    return re.sub(r"(?<!\d)0+(?=\d)", "", name)


def select(paper: int | None = None, expression: str | None = None) -> list[FoundCase]:
    """Cases of a paper whose names satisfy an expression of words, ``and``, ``or``, ``not``, brackets.

    Raises:
        InputError: If the expression is malformed or nothing is left.
    """
    cases = [c for c in find_cases() if paper is None or c.paper == paper]
    if expression is not None:
        chosen = Expression(expression)
        cases = [c for c in cases if chosen.matches(c.words)]
    if not cases:
        wanted = " ".join(
            ([f"--paper {paper}"] if paper is not None else [])
            + ([f"-k {expression!r}"] if expression is not None else [])
        )
        raise InputError(f"no case matches {wanted}; see: weakforms list")
    return cases


class Expression:
    """``a and not (b or c)`` over words found in a text; parsed here, never evaluated as code."""

    LONGEST = 200
    """Largest number of words and brackets of an expression, which limits its nesting."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._tokens = re.findall(r"[()]|[^\s()]+", text.lower())
        self._at = 0
        if len(self._tokens) > self.LONGEST:
            raise InputError(
                f"the expression {text[:40]!r}... has {len(self._tokens)} words and brackets; "
                f"allowed are {self.LONGEST}"
            )
        self._tree = self._or()
        if self._at != len(self._tokens):
            raise self._error()

    def _error(self) -> InputError:
        place = self._tokens[self._at] if self._at < len(self._tokens) else "its end"
        return InputError(f"cannot read the expression {self._text[:80]!r} at {place!r}")

    def _next(self) -> str | None:
        return self._tokens[self._at] if self._at < len(self._tokens) else None

    def _or(self) -> tuple:
        parts = [self._and()]
        while self._next() == "or":
            self._at += 1
            parts.append(self._and())
        return ("or", parts)

    def _and(self) -> tuple:
        parts = [self._not()]
        while self._next() == "and":
            self._at += 1
            parts.append(self._not())
        return ("and", parts)

    def _not(self) -> tuple:
        negated = False
        while self._next() == "not":
            self._at += 1
            negated = not negated
        token = self._next()
        if token is None or token in (")", "and", "or"):
            raise self._error()
        self._at += 1
        if token == "(":
            inner = self._or()
            if self._next() != ")":
                raise self._error()
            self._at += 1
        else:
            inner = ("word", token)
        return ("not", inner) if negated else inner

    def matches(self, text: str) -> bool:
        """Whether the expression is true for a text."""
        return _holds(self._tree, text)


def _holds(node: tuple, text: str) -> bool:
    kind, inner = node
    if kind == "word":
        return inner in text
    if kind == "not":
        return not _holds(inner, text)
    results = (_holds(part, text) for part in inner)
    return any(results) if kind == "or" else all(results)
