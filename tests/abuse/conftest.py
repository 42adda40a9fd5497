"""Fixtures that replace the solver, for tests in which nothing may be solved."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from abuse_tools import CASES, COUNT, canned

from weakforms.problems import registry


@pytest.fixture
def solves(monkeypatch) -> list[str]:
    """Count every solve and return a prepared result for it."""
    seen = []
    for problem in registry.problems().values():
        monkeypatch.setattr(type(problem), "solve", lambda self, *_, **__: seen.append(self.name) or canned())
    return seen


@pytest.fixture(scope="module")
def nothing_is_solved() -> Iterator[None]:
    """Like ``solves``, for a whole module."""
    with pytest.MonkeyPatch.context() as patch:
        for problem in registry.problems().values():
            patch.setattr(type(problem), "solve", lambda *_, **__: canned())
        yield


@pytest.fixture(scope="session")
def tree(tmp_path_factory) -> Path:
    """Two cases that are solved in a second or two."""
    folder = tmp_path_factory.mktemp("tree")
    (folder / "cases" / "paper2").mkdir(parents=True)
    for name, first in (("one", 0), ("two", COUNT // 2)):
        text = CASES.format(first=first, last=first + COUNT // 2)
        (folder / "cases" / "paper2" / f"{name}.py").write_text(text)
    return folder
