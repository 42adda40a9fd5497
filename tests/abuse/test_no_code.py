"""Input is data: no part of it is run as code, and nothing is sent over a network."""

import json
import os
import socket
from pathlib import Path

import pytest
from abuse_tools import CASE, COMPARE, CURVE, call, canned, orderly, start, verify

from weakforms.verification.cases.discovery import Expression

pytestmark = pytest.mark.usefixtures("nothing_is_solved")

MARK = "was-run"


def payloads(mark: Path) -> list[str]:
    """Texts that create a file if anything evaluates them."""
    python = f"open({str(mark)!r}, 'w')"
    return [
        f"__import__('os').system('touch {mark}')",
        python,
        f"({python}, 1)[1]",
        f"$(touch {mark})",
        f"`touch {mark}`",
        f"; touch {mark} #",
        f"| touch {mark}",
        f"=cmd|'touch {mark}'!A0",
        "{{ cycler.__init__.__globals__.os.popen('touch " + str(mark) + "') }}",
        "{0.__class__.__init__.__globals__}",
        f"!!python/object/apply:os.system ['touch {mark}']",
        f"cos\nsystem\n(S'touch {mark}'\ntR.",
        f"\\immediate\\write18{{touch {mark}}}",
    ]


@pytest.fixture
def mark(tmp_path, monkeypatch):
    """A file that must not appear, in a separate working folder."""
    monkeypatch.chdir(tmp_path)
    yield tmp_path / MARK
    assert not (tmp_path / MARK).exists(), "something was evaluated"


@pytest.mark.parametrize("number", range(13))
def test_values_are_not_evaluated(mark, number):
    text = payloads(mark)[number]
    for option in ("--set", "--at", "--mesh"):
        for name in ("alpha", text):
            orderly(call("solve", "tube", option, f"{name}={text}"), 2)
    for problem in ("circular", "hemisphere", "wrinkled_tube", "wrinkled_sheet"):
        orderly(call("solve", problem, "--set", f"thickness={text}"), 2)
    for words in (
        ("verify", f"-k={text}"),
        ("show", "--", text),
        ("check", "--", text),
        ("solve", "--", text),
    ):
        orderly(call(*words), 2)
    for data in (
        {"parameters": {"alpha": text}},
        {"at": {text: 1}},
        {"numerics": {"cells": text}},
        {text: {}},
    ):
        Path("s.json").write_text(json.dumps(data))
        orderly(call("solve", "tube", "--spec", "s.json"), 2)
    Path("c.csv").write_text(f'u_max,p\n0.1,0.2\n0.2,"{text}"\n')
    orderly(call(*COMPARE, "c.csv"), 2)
    orderly(call(*COMPARE, "c.csv", "--map", f"p={text}", "--constant", f"R_f={text}"), 2)
    Path("r").mkdir()
    for i, request in enumerate(
        ({"problem": text}, {"case": text, "curve": text}, {"case": CASE, "curve": text})
    ):
        Path("r", f"{i}.json").write_text(
            json.dumps(request | ({"name": CURVE} if "case" in request else {}))
        )
    assert call("batch", "r").status == 2
    Path("x.json").write_text(
        json.dumps(canned().to_json() | {"problem": text, "parameters": {"geometry": text}})
    )
    orderly(call("shape", "x.json", f"{number}.vtu"), 0)
    orderly(call("solve", "surface", "--set", f"geometry={text}"), 2)


def test_expressions_are_words():
    assert Expression("a and not (b or __import__)").matches("a c")
    assert not Expression("open").matches("closed")


HOSTILE_FILES = {
    "weakforms.py": "raise SystemExit(99)",
    "numpy.py": "raise SystemExit(99)",
    "sitecustomize.py": "open('was-run', 'w')",
    "conftest.py": "open('was-run', 'w')",
    ".petscrc": "-log_view\n-dll_append ./evil.so\n-info",
    "petscrc": "-log_view",
    "dolfinx_jit_options.json": '{"cffi_extra_compile_args": ["-fplugin=./evil.so"], "cffi_verbose": true}',
    "ffcx_options.json": '{"scalar_type": "float32", "epsilon": 0.5}',
    "matplotlibrc": "backend: module://evil",
    "evil.py": "open('was-run', 'w')",
    "pyproject.toml": "[",
    ".env": "PATH=/nowhere",
}


def test_files_in_the_current_folder_are_not_obeyed(mark, tmp_path):
    """Configuration files that some library might read in a folder of another user's requests."""
    for name, text in HOSTILE_FILES.items():
        Path(name).write_text(text)
    words = ("solve", "tube", "--mesh", "cells=16", "--mesh", "levels=2", "--set", "u_end=0.3")
    found = start(*words, cwd=tmp_path, env={"XDG_CACHE_HOME": str(tmp_path / "cache")}).wait()
    assert (found.status, found.err) == (0, "")
    elsewhere = start(*words).wait()
    numbers = [json.loads(text.out)["branches"] for text in (found, elsewhere)]
    assert numbers[0] == numbers[1]


# -- the network ---------------------------------------------------------------------------------

NO_NETWORK = """
import socket
right = socket.socket.connect
def connect(self, address, *more):
    if self.family in (socket.AF_INET, socket.AF_INET6):
        open({mark!r}, "a").write(repr(address))
        raise OSError("no network")
    return right(self, address, *more)
socket.socket.connect = socket.socket.connect_ex = connect
socket.getaddrinfo = lambda *address, **more: connect(socket.socket(), address)
"""


@pytest.fixture
def watched(mark, tmp_path):
    """An environment in which every connection creates a file, in child processes too."""
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(NO_NETWORK.format(mark=str(mark)))
    path = os.pathsep.join([str(tmp_path / "site"), str(Path(__file__).resolve().parents[2])])
    return {"PYTHONPATH": path, "http_proxy": "http://192.0.2.1:9", "https_proxy": "http://192.0.2.1:9"}


def test_nothing_is_fetched_by_a_run_and_its_report(watched, tree, tmp_path):
    called = verify(tree, tmp_path / "out", "-j", "2", env=watched).wait()
    assert called.status == 0, called.err
    called = start("report", tmp_path / "out", env=watched).wait()
    assert called.status == 0, called.err


@pytest.mark.slow
def test_nothing_is_fetched_by_the_documentation(watched, tmp_path):
    called = start("docs", "--out", tmp_path / "docs", env=watched).wait(900)
    assert called.status == 0, called.err
    assert (tmp_path / "docs" / "index.html").exists()


def test_the_watch_sees_a_connection(tmp_path):
    code = NO_NETWORK.format(mark=str(tmp_path / MARK)).replace("right(self", "None and right(self")
    names = {}
    before = socket.socket.connect, socket.socket.connect_ex, socket.getaddrinfo
    try:
        exec(code, names)
        with socket.socket() as one, pytest.raises(OSError, match="no network"):
            one.connect(("192.0.2.1", 9))
    finally:
        socket.socket.connect, socket.socket.connect_ex, socket.getaddrinfo = before
    assert (tmp_path / MARK).read_text() == "('192.0.2.1', 9)"


SOURCES = ("weakforms", "cases", "reference_data")


@pytest.mark.parametrize("folder", SOURCES)
def test_no_source_evaluates_text_or_opens_connections(folder):
    """The source uses no ``eval``, ``exec``, ``pickle``, shell or socket."""
    import ast

    root = Path(__file__).resolve().parents[2] / folder
    barred = {"pickle", "marshal", "shelve", "socket", "urllib", "http", "ftplib", "requests", "yaml", "code"}
    for path in sorted(root.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Import | ast.ImportFrom):
                names = (
                    [node.module or ""] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
                )
                assert not {name.split(".")[0] for name in names} & barred, (path, names)
            if isinstance(node, ast.Call):
                called = ast.unparse(node.func)
                assert called not in ("eval", "exec", "os.system", "os.popen"), (path, node.lineno)
                assert not any(k.arg == "shell" for k in node.keywords), (path, node.lineno)
                if called in ("np.load", "numpy.load"):
                    assert not any(k.arg == "allow_pickle" for k in node.keywords), (path, node.lineno)


def test_environment_variables_that_make_no_sense(tmp_path):
    """Whatever the files contain, listing them only lists them."""
    odd = {"COLUMNS": "x", "LINES": "-1", "TERM": "\x1b[31m", "NO_COLOR": ""}
    odd |= {
        "PYTHONIOENCODING": "ascii",
        "LC_ALL": "C",
        "WEAKFORMS_IN_IMAGE": "maybe",
    }
    odd |= {
        "MPLBACKEND": "module://evil",
        "HOME": "/nonexistent",
        "XDG_CACHE_HOME": "",
        "TMPDIR": "/nonexistent",
    }
    for words in (("list",), ("show", "tube")):
        called = start(*words, env=odd, cwd=tmp_path).wait()
        assert (called.status, called.err) == (0, ""), called
        assert called.out
