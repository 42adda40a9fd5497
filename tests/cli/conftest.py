"""Fixtures that call the command line in this process, and that replace the solver."""

import io
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import pytest

from weakforms import terminal
from weakforms.cli import app
from weakforms.problems import registry
from weakforms.results import Branch, Result
from weakforms.terminal import guarded
from weakforms.verification.run import solving


@dataclass(frozen=True)
class Called:
    """Exit status, standard output and standard error of a command."""

    status: int
    out: str
    err: str

    @property
    def complaints(self) -> list[str]:
        """Lines on standard error other than progress lines."""
        return [line for line in self.err.splitlines() if line.startswith("weakforms: ")]


def call(*words: object) -> Called:
    """Call a command as the console script does, through ``guarded``."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        status = guarded(lambda: app([str(word) for word in words], standalone_mode=False))
    return Called(status, out.getvalue(), err.getvalue())


def pytest_make_parametrize_id(val: object) -> str | None:
    """Give short names to long and binary parameters."""
    return ascii(val)[:40] if isinstance(val, str | bytes) else None


@pytest.fixture(scope="session")
def weakforms():
    return call


@pytest.fixture(autouse=True)
def silent_solves(monkeypatch):
    """Switch signs of life off: on a busy machine a short solve may take long enough to print one."""
    monkeypatch.setattr(terminal, "PULSE", 3600.0)


@pytest.fixture
def solves(monkeypatch):
    """Count every solve and return a prepared result for it."""
    seen = []
    for problem in registry.problems().values():
        monkeypatch.setattr(type(problem), "solve", lambda self, *_, **__: seen.append(self.name) or canned())
    return seen


@pytest.fixture(scope="module")
def canned_solves() -> Iterator[None]:
    """Like ``solves``, for a whole module."""
    with pytest.MonkeyPatch.context() as patch:
        for problem in registry.problems().values():
            patch.setattr(type(problem), "solve", lambda *_, **__: canned())
        yield


def canned() -> Result:
    """The smallest result that follows the schema."""
    versions = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")
    return Result(
        problem="tube",
        parameters={},
        scales={},
        numerics={},
        provenance={**versions, "ranks": 1, "wall_s": 0.0},
        branches=[Branch("primary", "p", {"p": [0.0, 1.0]})],
    )


def listing(folder: Path) -> dict[Path, object]:
    """Every file with its content, except Python's caches."""
    paths = [p for p in sorted(folder.rglob("*")) if "__pycache__" not in p.parts]
    return {p: p.read_bytes() if p.is_file() else None for p in paths}


def changed(before: dict, after: dict) -> list[Path]:
    return [p for p in {**before, **after} if before.get(p, "none") != after.get(p, "none")]


@pytest.fixture
def refused(weakforms, solves, tmp_path, monkeypatch):
    """Call the program in a separate folder and assert that it only reported an error."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(solving, "solve_spec", lambda spec, _: solves.append(spec))

    def call(words: str | list[str], *said: str) -> None:
        before = listing(tmp_path)
        called = weakforms(*(words.split() if isinstance(words, str) else words))
        assert (called.status, called.out, solves) == (2, "", [])
        assert called.err.startswith("weakforms: ")
        assert called.err.count("\n") == 1
        assert len(called.err) < 700
        assert [word for word in said if word not in called.err] == []
        assert changed(before, listing(tmp_path)) == []

    return call
