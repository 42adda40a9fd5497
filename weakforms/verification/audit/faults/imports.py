"""Who may see a file, by what imports what: tests and cases, those about it first."""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from itertools import zip_longest
from pathlib import Path

from weakforms.verification.audit.faults.tables import SOLVERS
from weakforms.verification.cases.discovery import find_cases

UNSEEN = ("tests/mpi/", "tests/verification/audit/test_faults", "tests/cases/test_cases")
"""Tests that show nothing here: processes of their own, the machinery itself, the cases once more."""

CONTRACT = "tests/house/test_contract.py"
"""What holds all that is declared of a problem or of a law against a stored copy, in a second or two."""

DECLARING = ("weakforms/problems/", "weakforms/forms/materials/")
"""Folders of what it holds."""

NAMING = (*DECLARING, "tests/problems/")
"""Folders whose files say by their names which problem uses a file."""

ASKED = "tests/references/test_tables_asked.py"
"""What holds all that tables ask for (parameters, abscissae, texts) against the committed ones."""

RANKS = "tests/mpi"
"""Folder of the tests that start several ranks."""

LONG = "test_every_kind_ranks.py"
"""The file among them that takes minutes."""

SPEAKS_OF_RANKS = re.compile(r"comm\b|\branks?\b|bcast|gather|reduce\b|scatter|ghost|owne[rd]|size_local")
"""What a line contains if its change may show on several ranks only."""

EVERYWHERE = {
    *("branch", "model", "parameters", "problem", "problems", "registry"),
    *("test", "tests", "weakforms"),
}
"""Words of names that say nothing about what a file or a test is about."""

FEW = 8
"""Number of tests on ranks run for such a line: each takes half a minute, and problems share files."""

REGISTRY = "reference_data/solvers/registry.py"
REGISTERED = re.compile(r"reference_data/solvers/\w+/tables\w*\.py")
"""What finds the modules of tables, and their names: it imports them without naming them."""

PROBLEMS = "weakforms/problems/registry.py"
"""What imports every module beside it in the same way."""

WORD = re.compile(r"[A-Za-z_]{4,}")
"""Words of a line that may say which tests are about it."""


class Imports:
    """Who may see a file, by what imports what: the way there is short where a test is about it."""

    def __init__(self, root: Path) -> None:
        self._root = root
        folders = ("weakforms", "reference_data", "cases", "tests")
        paths = [path for folder in folders for path in sorted((root / folder).rglob("*.py"))]
        self._files = {path.relative_to(root).as_posix(): path for path in paths}
        self._used_by: dict[str, set[str]] = defaultdict(set)
        for name, path in self._files.items():
            for module in _imported(path, name):
                self._used_by[module].add(name)
            if REGISTERED.fullmatch(name):
                self._used_by[name].add(REGISTRY)
            if name.startswith("weakforms/problems/") and name != PROBLEMS:
                self._used_by[name].add(PROBLEMS)

    def watching(self, file: str, line: int, known: set[str]) -> Iterator[str]:
        """Test functions and cases that reach a file by imports, those about it first, then the nearest.

        Args:
            file: Relative to the tree.
            line: Its words and those of the next one (an argument that is left out stands there), if few
                files use them, say which tests and cases are about it.
            known: Units that were measured: they are not guessed at.
        """
        reach = self.reach(file)
        texts = {name: self._files[name].read_text("utf-8") for name in reach}
        source = (self._root / file).read_text("utf-8").split("\n") if (self._root / file).exists() else []
        words = set(WORD.findall(" ".join(source[line - 1 : line + 1])))
        users = {word: {name for name, text in texts.items() if word in text} for word in words}

        def order(name: str) -> tuple[int, float, int]:
            shared = sum(1 / len(found) for found in users.values() if name in found)
            return self._rank(name, texts[name], file), -shared, reach[name]

        near = sorted(reach, key=lambda name: (order(name), name))
        tests = [functions(self._root / name, name) for name in near if _is_test(name, known)]
        cases = [[_case(name)] for name in near if name.startswith("cases/")]
        cases = [case for case in cases if case[0] not in known and _quick(case[0])]
        for pair in zip_longest(tests, cases, fillvalue=[]):
            for found in pair:
                yield from found

    def first(self, file: str, line: int) -> list[str]:
        """Test functions to run before others: of contract or tables, of the file itself, on several ranks.

        Tests of the file itself import it and are named as it is. Tests on ranks are chosen by the words, of
        four letters or more, that their functions share with the name of the file, or of what uses it; a word
        that few of them use counts more, and those of :data:`EVERYWHERE` do not count.
        """
        path = self._root / file
        found = []
        for name, folders in ((CONTRACT, DECLARING), (ASKED, SOLVERS)):
            if file.startswith(folders) and (self._root / name).exists():
                found += functions(self._root / name, name)
        for name in sorted(self._used_by[file]):
            if Path(name).name == f"test_{path.name}" and _is_test(name, set()):
                found += functions(self._root / name, name)
        text = path.read_text("utf-8").split("\n")[line - 1] if path.exists() else ""
        if not (file.startswith("weakforms/") and SPEAKS_OF_RANKS.search(text)):
            return found
        names = [file, *(name for name in self._used_by[file] if name.startswith(NAMING))]
        words = set(re.findall("[a-z]{4,}", " ".join(names))) - EVERYWHERE
        said = {
            name: words & set(re.findall("[a-z]{4,}", text))
            for path in sorted((self._root / RANKS).glob("test_*.py"))
            if path.name != LONG
            for name, text in _bodies(path, f"{RANKS}/{path.name}").items()
        }
        often = Counter(word for shared in said.values() for word in shared)
        tests = sorted((-sum(1 / often[word] for word in shared), name) for name, shared in said.items())
        return [*found, *(name for _, name in tests[:FEW])]

    def _rank(self, name: str, text: str, file: str) -> int:
        """First those named as the file is, or as it begins; cases by what they say."""
        words = Path(file).stem.split("_")
        beginnings = ["_".join(words[:k]) for k in range(len(words), 0, -1)]
        place = name if name.startswith("tests/") else text
        return next((k for k, word in enumerate(beginnings) if word in place), len(words))

    def reach(self, file: str) -> dict[str, int]:
        """Files that import it, with the length of the shortest way."""
        far, edge = {file: 0}, [file]
        for name in edge:  # grows as it goes
            for user in sorted(self._used_by[name] - far.keys()):
                far[user] = far[name] + 1
                edge.append(user)
        return far


def _imported(path: Path, name: str) -> Iterable[str]:
    """Files that a file imports, as far as its text says."""
    package = name.split("/")[:-1]
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            start = ".".join([*base, *([node.module] if node.module else [])])
            modules = [start, *(f"{start}.{alias.name}" for alias in node.names)]
        else:
            continue
        for module in modules:
            yield module.replace(".", "/") + ".py"
            yield module.replace(".", "/") + "/__init__.py"


def functions(path: Path, name: str) -> list[str]:
    """Test functions of a file but the slow ones, as pytest names them."""
    tree = ast.parse(path.read_text("utf-8"))
    if any("mark.slow" in ast.unparse(node) for node in tree.body if isinstance(node, ast.Assign)):
        return []
    tests = [n for n in tree.body if isinstance(n, ast.FunctionDef) and n.name.startswith("test_")]
    kept = [n for n in tests if not any("mark.slow" in ast.unparse(d) for d in n.decorator_list)]
    return [f"{name}::{node.name}" for node in kept]


def _bodies(path: Path, name: str) -> dict[str, str]:
    """Test functions of a file as pytest names them, with their text and the name of the file."""
    tree = ast.parse(path.read_text("utf-8"))
    wanted = functions(path, name)
    texts = {
        f"{name}::{node.name}": ast.unparse(node) for node in tree.body if isinstance(node, ast.FunctionDef)
    }
    return {test: f"{name} {texts[test]}" for test in wanted}


def _case(name: str) -> str:
    return ".".join(Path(name).with_suffix("").parts[1:])


def _is_test(name: str, known: set[str]) -> bool:
    return name.startswith("tests/") and name not in known and not name.startswith(UNSEEN)


def _quick(case: str) -> bool:
    return any(found.id == case and found.case.quick for found in find_cases())
