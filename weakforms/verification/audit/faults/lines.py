"""Which lines of the source a case or a test runs, recorded once, and who sees a line.

``weakforms faults --measure`` runs every test file and every case in a process of its own, which notes the
lines that each test function runs (``sys.monitoring``: no slower than without) and how long it takes. Where
nothing was measured, the imports say who may see a file: the nearest first.
"""

from __future__ import annotations

import ast
import hashlib
import sys
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from types import CodeType
from typing import Any

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.results.io import dumps, load_json, write_atomically
from weakforms.verification.audit.faults import tables
from weakforms.verification.audit.faults.children import Children
from weakforms.verification.audit.faults.imports import UNSEEN, Imports
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.cases.references import ROOT

FOLDERS = ("weakforms", "reference_data")
"""Where the lines are that are noted."""

UNKNOWN = 10.0
"""Seconds that a case or a test is taken to need before it was measured."""

LONGEST = 3600.0
"""Seconds after which the measurement of one file is ended."""

Lines = dict[str, list[int]]
"""Numbers of the lines run, by file relative to the tree."""


def require_monitoring() -> None:
    """Make sure that lines can be noted here.

    Raises:
        EnvironmentLackError: When this Python is too old for it.
    """
    if sys.version_info < (3, 12):
        raise EnvironmentLackError("--measure needs Python 3.12 or later: ./run brings its own")


class Monitor:
    """Notes the lines that are run, from one :meth:`taken` to the next."""

    def __init__(self, root: Path) -> None:
        self._seen: dict[str, set[int]] = defaultdict(set)
        self._roots = tuple(f"{root / folder}/" for folder in FOLDERS)
        self._cut = len(f"{root}/")
        monitoring = sys.monitoring
        monitoring.use_tool_id(monitoring.COVERAGE_ID, "weakforms faults")
        monitoring.register_callback(monitoring.COVERAGE_ID, monitoring.events.LINE, self._line)
        monitoring.set_events(monitoring.COVERAGE_ID, monitoring.events.LINE)

    def _line(self, code: CodeType, line: int) -> Any:
        if code.co_filename.startswith(self._roots):
            self._seen[code.co_filename[self._cut :]].add(line)
        return sys.monitoring.DISABLE  # until the next one is asked for: each line is noted once

    def taken(self) -> Lines:
        """The lines run since the last call."""
        seen, self._seen = self._seen, defaultdict(set)
        sys.monitoring.restart_events()
        return {name: sorted(lines) for name, lines in sorted(seen.items())}


@dataclass(frozen=True)
class Measured:
    """What one test file or one case was seen to run."""

    unit: str
    passed: bool
    seconds: dict[str, float]
    """By case or test function."""
    lines: dict[str, Lines]
    """By case or test function; under the empty name what importing and shared fixtures run."""
    digests: dict[str, str]
    """Of the files as they were, its own among them."""

    def current(self, root: Path) -> bool:
        """Whether the file of the tests or of the case is still the one that was measured."""
        return self.digests.get(_file(self.unit), "") == digest(root / _file(self.unit))

    def sees(self, text: str, file: str, line: int, root: Path) -> bool:
        """Whether a test function ran a line, or one :func:`using` it; of a changed file, any line."""
        lines = self.lines.get(text, {}).get(file)
        if lines is None:
            return False
        return not using(root / file, line).isdisjoint(lines) or self.digests.get(file) != digest(root / file)


@cache
def digest(path: Path) -> str:
    """Digest of a file; empty where there is none."""
    return hashlib.sha256(path.read_bytes()).hexdigest()[:12] if path.is_file() else ""


@cache
def using(path: Path, line: int) -> frozenset[int]:
    """Lines that a test runs if a line matters to it.

    In a function this is the line itself. A line outside of functions runs only when its file is imported,
    which the first test does for all others; in its place stand the lines of functions that name what its
    statement defines, or else all lines of functions.
    """
    try:
        tree = ast.parse(path.read_text("utf-8"))
    except OSError:
        return frozenset({line})
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.Lambda)]
    bodies = [_span(node.body if isinstance(node, ast.FunctionDef) else [node.body]) for node in functions]
    if any(line in body for body in bodies):
        return frozenset({line})
    headed = [body for node, body in zip(functions, bodies, strict=True) if line in _span([node])]
    inside = frozenset(k for body in headed or bodies for k in body)
    defined = {
        name.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Assign | ast.AnnAssign) and line in _span([node])
        for target in (node.targets if isinstance(node, ast.Assign) else [node.target])
        for name in ast.walk(target)
        if isinstance(name, ast.Name)
    }
    named = {
        node.lineno for node in ast.walk(tree) if getattr(node, "id", getattr(node, "attr", 0)) in defined
    }
    return inside & named or inside or frozenset({line})


def _span(nodes: list[ast.AST]) -> range:
    return range(nodes[0].lineno, nodes[-1].end_lineno + 1)


def units(root: Path = ROOT) -> list[str]:
    """Test files and cases that can be measured, cases last: they take longest."""
    tests = sorted(path.relative_to(root).as_posix() for path in (root / "tests").rglob("test_*.py"))
    cases = sorted(found.id for found in find_cases())
    return [*(name for name in tests if not name.startswith(UNSEEN)), *cases]


def measure(
    wanted: list[str], out: Path, resume: bool, report: Callable[[float, float, str], None], jobs: int = 1
) -> int:
    """Run units and note their lines below ``out``; the number of those that do not pass.

    Args:
        wanted: Test files and cases.
        out: Output folder.
        resume: Take over what was measured there, if the file is still the same.
        report: Told about the progress.
        jobs: Units side by side.
    """
    children = Children()
    known = {found.unit: found for found in measured(out)} if resume else {}

    def one(unit: str) -> Measured:
        found = known.get(unit)
        if found is None or not found.current(ROOT):
            found = _measured(unit, children, out)
        return found

    failing = 0
    with ThreadPoolExecutor(jobs) as pool:
        try:
            running = [pool.submit(one, unit) for unit in wanted]
            for k, ended in enumerate(as_completed(running), 1):
                found = ended.result()
                failing += not found.passed
                report(k, len(wanted), found.unit)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            children.end()
            raise
    return failing


def _measured(unit: str, children: Children, out: Path) -> Measured:
    folder = _store(out)
    folder.mkdir(parents=True, exist_ok=True)
    answers, failure = children.run(ROOT, [unit], LONGEST, lines=folder)
    lines = answers[0].lines if answers else {}
    files = {_file(unit), *(name for seen in lines.values() for name in seen)}
    passed = bool(answers) and answers[0].status == "passed" and not failure
    times = answers[0].times if answers else {}
    found = Measured(unit, passed, times, lines, {name: digest(ROOT / name) for name in sorted(files)})
    write_atomically(folder / f"{unit.replace('/', '-')}.json", dumps(vars(found)))
    return found


def _store(out: Path) -> Path:
    return out / "faults" / "lines"


def _file(unit: str) -> str:
    return unit if unit.startswith("tests/") else f"cases/{unit.replace('.', '/')}.py"


def measured(out: Path) -> list[Measured]:
    """What was measured into a folder; what cannot be read counts as not measured."""
    found = []
    for path in sorted(_store(out).glob("*.json")):
        try:
            found.append(Measured(**load_json(path, "measured lines")))
        except (InputError, TypeError):
            continue
    return found


class Watchers:
    """Finds who sees a line, in the order in which they are to be run.

    First come the stored contract of the problems or what tables ask for, and tests on ranks if the line
    speaks of ranks. Measured tests that run the line follow, then those that run its file, tables computed
    again, other tests of the same files, and at last those that import the file.

    A test that finds a solution in a fixture or a cache does not run the lines that made it, so the other
    tests of a file that runs the line follow. A line that was run before lines were noted (in a file that
    every process imports) was run by none of them: imports say who may see it, measured or not.

    Args:
        out: Folder with what was measured.
        root: The tree.
    """

    def __init__(self, out: Path, root: Path = ROOT) -> None:
        self._root, self._measured = root, measured(out)

    @cached_property
    def _near(self) -> Imports:
        return Imports(self._root)

    def of(self, file: str, line: int) -> list[tuple[str, float]]:
        """Cases and test functions with the seconds they take, in the order in which they are to be run."""
        direct: dict[str, float] = {}
        beside: dict[str, float] = {}
        near: set[str] = set()
        for found in self._measured:
            seeing = {text for text in found.seconds if found.sees(text, file, line, self._root)}
            direct |= {text: found.seconds[text] for text in seeing}
            if seeing or found.sees("", file, line, self._root):
                beside |= {text: seconds for text, seconds in found.seconds.items() if text not in seeing}
                near |= {text for text in beside if file in found.lines.get(text, {})}
        measured = {found.unit for found in self._measured if found.current(self._root)}
        known = measured if direct or beside else set()
        guessed = [(text, UNKNOWN) for text in self._near.watching(file, line, known)]
        again = [(text, UNKNOWN) for text in tables.watching(file, line, self._near.reach(file))]
        first = [(text, UNKNOWN) for text in self._near.first(file, line)]
        close = {text: beside[text] for text in near if text in beside}  # cheaper than most tables
        measured_ones = [*_fastest(direct, near), *_fastest(close, near), *again, *_fastest(beside, near)]
        found: dict[str, float] = {}
        for text, seconds in [*first, *measured_ones, *guessed]:
            found.setdefault(text, seconds)
        return list(found.items())


def _fastest(seconds: dict[str, float], near: set[str]) -> list[tuple[str, float]]:
    """The fastest first, before them those that run other lines of the file."""
    return sorted(seconds.items(), key=lambda item: (item[0] not in near, item[1], item[0]))
