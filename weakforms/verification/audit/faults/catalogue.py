"""The catalogue of seeded faults: small TOML files, one an area, read and held against the tree."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any

from weakforms.errors import InputError
from weakforms.problems.registry import abouts
from weakforms.verification.cases.discovery import Expression, among
from weakforms.verification.cases.references import ROOT

FOLDER = Path(__file__).resolve().parent

REASONS = "equivalent.toml"
"""File of random mutants that were looked at by hand; no part of the catalogue."""

AREAS = (
    "weak form",
    "load",
    "boundary condition",
    "contact rule",
    "relaxed energy",
    "mass matrix",
    "second variation",
    "continuation",
    "solver",
    "uncertainty",
    "judging",
    "reference table",
    "reference solver",
    "reading and writing",
    "units",
    "comparison of runs",
    "figures",
)
"""What a fault is a fault of."""

TOPICS = ("contact", "adhesion", "peeling", "secondary", "waves", "materials", "solvers", "verification")
SUBJECTS = (*abouts(), *TOPICS)
"""Problems, or parts of the suite, that a fault sits in."""


@dataclass(frozen=True)
class Expectation:
    """Where a fault is looked for first: a case, part of one, or a test.

    Written ``paper2.fig03``, ``paper2.fig03::limit_points`` (only the curves and checks of the case with a
    verdict whose name contains that), ``tests/unit/test_x.py::test_y``, or ``table NAME`` (the
    reference table computed again).
    """

    text: str

    @property
    def is_test(self) -> bool:
        """Whether it is a test, not a case."""
        return self.text.startswith("tests/")

    @property
    def table(self) -> str:
        """Name of the reference table; empty if it is none."""
        return self.text.removeprefix("table ") if self.text.startswith("table ") else ""

    @property
    def case(self) -> str:
        """Id of the case."""
        return self.text.partition("::")[0]

    @property
    def part(self) -> str:
        """What names of its verdicts must contain; empty for all of it."""
        return self.text.partition("::")[2]


@dataclass(frozen=True)
class Fault:
    """One change of the source."""

    name: str
    area: str
    subject: str
    description: str
    """In the field's terms."""
    file: str
    """Relative to the tree."""
    find: str
    """Text that occurs in it exactly once ..."""
    replace: str
    """... and what stands there instead."""
    expected: tuple[Expectation, ...]
    """What notices it first, for speed only: what survives meets the whole quick profile."""
    reason: str = ""
    """Why nothing can notice it: for a change proven to be none. Empty for a real fault."""

    @property
    def words(self) -> str:
        """Text that a selection matches against."""
        return f"{self.name} {self.area} {self.subject} {self.file}".lower()

    def applied(self, text: str) -> str:
        """The file's text with the fault in it.

        Raises:
            InputError: When what is to be replaced does not stand there exactly once.
        """
        count = text.count(self.find)
        if count != 1:
            raise InputError(
                f"fault {self.name}: {self.find.splitlines()[0][:60]!r} occurs {count} times in {self.file}, "
                "not once: the catalogue is to follow the source"
            )
        return text.replace(self.find, self.replace)


@cache
def catalogue(folder: Path = FOLDER) -> tuple[Fault, ...]:
    """All faults, in the order of their files' names.

    Raises:
        InputError: When an entry is not sound.
    """
    found: list[Fault] = []
    for path in sorted(path for path in folder.glob("*.toml") if path.name != REASONS):
        try:
            entries = tomllib.loads(path.read_text("utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(f"fault catalogue {path.name}: {error}") from error
        found += [_fault(path.name, name, entry) for name, entry in entries.items()]
    names = [fault.name for fault in found]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"fault catalogue: {twice!r} is there twice")
    return tuple(found)


def _fault(where: str, name: str, entry: Any) -> Fault:
    def wrong(what: str) -> InputError:
        return InputError(f"fault catalogue {where}: {name}: {what}")

    if not isinstance(entry, dict):
        raise wrong("a table is wanted")
    known = {field.name for field in fields(Fault)} - {"name"}
    needed = known - {"reason"}
    if not needed <= set(entry) <= known:
        raise wrong(f"entries {', '.join(sorted(entry))}; wanted are {', '.join(sorted(needed))}")
    expected = entry["expected"]
    texts = {key: value for key, value in entry.items() if key != "expected"}
    if not all(isinstance(value, str) for value in texts.values()) or not isinstance(expected, list):
        raise wrong("texts are wanted, and a list of them for expected")
    for key, allowed in (("area", AREAS), ("subject", SUBJECTS)):
        if texts[key] not in allowed:
            raise wrong(f"{key} = {texts[key]!r}; allowed are {', '.join(allowed)}")
    if not expected or not texts["find"] or texts["find"] == texts["replace"]:
        raise wrong("nothing is expected, or nothing is replaced")
    return Fault(name=name, expected=tuple(map(Expectation, expected)), **texts)


def select(only: Iterable[str] = (), expression: str | None = None) -> list[Fault]:
    """Faults by their names, or by an expression over name, area, subject and file.

    Raises:
        InputError: For an unknown name, a malformed expression, or when nothing is left.
    """
    faults = list(catalogue())
    known = {fault.name: fault for fault in faults}
    wanted = list(dict.fromkeys(only))
    for name in wanted:
        if name not in known:
            raise InputError(f"unknown fault {name!r}; {among(name, known).replace('list', 'faults --list')}")
    if wanted:
        faults = [known[name] for name in wanted]
    if expression is not None:
        chosen = Expression(expression)
        faults = [fault for fault in faults if chosen.matches(fault.words)]
    if not faults:
        raise InputError(f"no fault matches -k {expression!r}; see: weakforms faults --list")
    return faults


def require_sound(faults: Iterable[Fault], root: Path = ROOT) -> None:
    """Refuse faults that do not fit the tree, before anything runs.

    Raises:
        InputError: When a file or a text is not there, or a case is unknown.
    """
    from weakforms.verification.cases.discovery import get_case

    for fault in faults:
        path = root / fault.file
        if not path.is_file():
            raise InputError(f"fault {fault.name}: there is no {fault.file}")
        fault.applied(path.read_text("utf-8"))
        for wanted in fault.expected:
            if not wanted.is_test:
                get_case(wanted.case)
            elif not (root / wanted.case).is_file():
                raise InputError(f"fault {fault.name}: there is no {wanted.case}")
