"""Names and texts from users are shown as they are; they are never run and never leave a folder."""

import json
import os
import re
from dataclasses import asdict
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from abuse_tools import CASE, COMPARE, CURVE, call, canned, orderly, quickly
from hypothesis import given, settings
from hypothesis import strategies as st

from weakforms.results import Branch, Failure
from weakforms.verification.cases import references
from weakforms.verification.judging.outcome import (
    CaseOutcome,
    Convergence,
    CurveOutcome,
    Marker,
    PanelOutcome,
    Printed,
    RunOutcome,
    SurfaceOutcome,
    Verdict,
)

pytestmark = pytest.mark.usefixtures("nothing_is_solved")

TEXTS = (
    "<script>alert(1)</script>",
    "'\"><img src=x onerror=alert(1)>",
    "javascript:alert(1)",
    "\x1b]0;title\x07\x1b[31mred\x9b2J",
    "[red]x[/red] [/nothing] [link=http://x]y[/link] :bomb:",
    "=cmd|' /C calc'!A0",
    "../../../etc/passwd",
    "..",
    "/etc/passwd",
    "a\nb\r\nc",
    "{{ 7*7 }} {% import os %}",
    "$\\input{/etc/passwd}$ $\\write18{x}$ \\(x\\)",
    "\ud800 \u202egnp.exe \u2028",
    "a" * 5000,
    "",
    "CON",
    "%s %d {0} {x!r}",
    "]]> --> <!-- <![CDATA[",
    "\x85",
)
texts = st.one_of(st.sampled_from(TEXTS), st.text(max_size=12))


# -- stored reports ------------------------------------------------------------------------------


def run_of(text: str) -> dict:
    """A stored run with ``text`` in every place that holds a text."""
    numbers = [0.0, 0.5, 1.0]
    curve = CurveOutcome(text, text, numbers, numbers, [False] * 3, text, text, numbers, numbers, text)
    curve.residual_x, curve.residual, curve.residual_bound = numbers, [1e-9] * 3, [1e-8] * 3
    panel = PanelOutcome(text, text, text, text, text, text, (0.0, 1.0), (0.0, 1.0), [curve])
    panel.markers, panel.note, panel.drawn = [Marker(text, text, 0.5, 0.5)], text, text
    patch = [[0.0, 1.0], [0.0, 1.0]]
    surface = SurfaceOutcome(text, text, [patch] * 3, [(0.0, 1.0)] * 3, [text] * 3, text)
    surface.fields = {text: patch}
    case = CaseOutcome(
        text,
        text,
        text,
        text,
        "failed",
        [Verdict(text, text, False, text, text, 1e-3, 1e-9, 1e-7, where=text, reference=text, differs=text)],
        [panel],
        [Printed(text, text, 1.0, 0.1, text, text, text)],
        [Convergence(text, 1, [1, 2], [1e-2, 1e-3], 2.0, 2.0, text)],
        [text],
        1.0,
        [
            {
                "spec": text,
                "problem": text,
                "parameters": {text: text},
                "provenance": {text: text},
                "file": text,
            }
        ],
        [surface],
    )
    run = RunOutcome(text, text, text, 1.0, {text: text}, [case])
    return run.to_json()


class Page(HTMLParser):
    """Elements, attributes and links that a browser finds in a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.found: list[tuple[str, dict]] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):  # noqa: D102
        self.found.append((tag, dict(attrs)))

    handle_startendtag = handle_starttag


def harmless(page: str) -> None:
    """Assert that a page has no active element, no link out of the report and no control character."""
    for tag, attributes in Page(page).found:
        assert tag not in ("script", "img", "iframe", "object", "embed", "base", "form"), tag
        for name, value in attributes.items():
            assert not name.startswith("on"), (tag, name)
            if name in ("href", "src", "action", "xlink:href"):
                assert re.match(
                    r"(#|data:,$|https://fenicsproject\.org|[\w./-]*\.(html|json|xml|vtu|svg|csv|pdf)(#|$)|$)",
                    value,
                ), value
    assert not re.search("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f]", page)


@pytest.mark.parametrize("text", TEXTS)
def test_reports_escape_what_is_known_to_be_hostile(tmp_path, text):
    escapes(tmp_path, text)


@settings(quickly, max_examples=max(len(TEXTS), quickly.max_examples) // 4)
@given(texts)
def test_reports_escape_what_they_show(tmp_path_factory, text):
    escapes(tmp_path_factory.mktemp("run"), text)


def escapes(folder: Path, text: str) -> None:
    """A report of a run that says the text everywhere is written, and harmless."""
    (folder / "report.json").write_text(json.dumps(run_of(text)))
    new = folder / "new"
    called = orderly(call("report", folder, "--out", new), 0)
    for path in new.rglob("*"):
        assert path.resolve().is_relative_to(new)
        if path.suffix == ".html":
            harmless(path.read_text("utf-8"))
        elif path.suffix in (".xml", ".vtu"):
            ElementTree.parse(path)
    assert {path.name for path in folder.iterdir()} == {"report.json", "new"}
    assert not re.search("[\x00-\x09\x0b-\x1f\x7f-\x9f]", called.out)


leaves = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=3), st.just([]), st.just({})
)


@quickly
@given(st.lists(st.integers(0, 30), min_size=1, max_size=9), leaves)
def test_damaged_reports_with_pictures(tmp_path_factory, path, new):
    folder = tmp_path_factory.mktemp("run")
    data = run_of("fig")
    place = data
    for step in path[:-1]:
        keys = list(place) if isinstance(place, dict) else range(len(place))
        inner = place[keys[step % len(keys)]] if len(keys) else None
        if not isinstance(inner, dict | list) or not inner:
            break
        place = inner
    keys = list(place) if isinstance(place, dict) else range(len(place))
    place[keys[path[-1] % len(keys)]] = new
    (folder / "report.json").write_text(json.dumps(data))
    called = orderly(call("report", folder, "--out", folder / "new"), 0, 2)
    assert (folder / "new").exists() == (called.status == 0)


# -- names of files ------------------------------------------------------------------------------

NAMES = (
    "[red]a[b]",
    "\x1b[31mred",
    "a\nb",
    "=cmd|x",
    "<b>",
    "--out",
    "-h",
    "ü",
    "a b",
    "%s",
    "{x}",
    "'\"`$(id)",
)


@pytest.mark.parametrize("name", NAMES)
def test_files_of_such_names(tmp_path, name, solves):
    folder = tmp_path / name
    (folder / "r").mkdir(parents=True)
    (folder / f"{name}.json").write_text(json.dumps({"problem": "tube"}))
    (folder / f"{name}x.json").write_text("{")
    called = call("batch", folder, "--out", tmp_path / "answers")
    assert called.status == 2
    assert called.out.count("\n") == 2
    assert "\x1b" not in called.out
    assert called.err == ""
    assert sorted(p.name for p in (tmp_path / "answers").iterdir()) == sorted(
        [f"{name}.json", f"{name}x.json"]
    )

    (folder / f"{name}.csv").write_text("u_max,p\n")
    orderly(call(*COMPARE, "--", folder / f"{name}.csv"), 2)
    orderly(call("solve", "tube", "--out", folder / f"{name}.out"), 0)
    orderly(call("shape", folder / f"{name}.out", folder / f"{name}.vtu"), 0)
    (folder / "report.json").write_text(json.dumps({**run_of("x"), "cases": []}))
    orderly(call("report", folder, "--out", folder / "r"), 0)
    for words in (
        ("solve", "--", name),
        ("show", "--", name),
        ("verify", f"-k={name}"),
        ("check", "--", name),
    ):
        orderly(call(*words), 2)


def test_undecodable_names(tmp_path):
    folder = os.fsencode(tmp_path) + b"/\xff\xfe"
    os.mkdir(folder)
    for name in (b"\xff.json", b"\xfex.csv"):
        with open(folder + b"/" + name, "wb") as stream:
            stream.write(b"{")
    place = Path(os.fsdecode(folder))
    called = call("batch", place)
    assert (called.status, called.err) == (2, "")
    orderly(call(*COMPARE, place / os.fsdecode(b"\xfex.csv")), 2)
    orderly(call("solve", "tube", "--out", place / os.fsdecode(b"\xff\xff")), 0)


# -- ways out of a folder ------------------------------------------------------------------------


@pytest.fixture
def requests(tmp_path):
    """A folder of hostile requests, beside a secret and one of our own files."""
    folder = tmp_path / "requests"
    folder.mkdir()
    (tmp_path / "secret.csv").write_text("u_max,p\n1,SECRET\n")
    (tmp_path / "mine").write_text("mine")
    return folder


@pytest.mark.parametrize(
    "curve",
    [
        "../secret.csv",
        "link.csv",
        "folder/../../secret.csv",
        "a\0b",
        "loop.csv",
        "pipe.csv",
        ".",
        "",
        "/dev/zero",
        "/etc/passwd",
        "x" * 5000,
        "\ud800",
        "C:\\secret.csv",
        "file:///etc/passwd",
        "http://localhost/x.csv",
        "|id",
    ],
)
def test_curves_of_a_batch_stay_inside(requests, curve):
    (requests / "folder").mkdir()
    (requests / "link.csv").symlink_to("../secret.csv")
    (requests / "loop.csv").symlink_to("loop.csv")
    os.mkfifo(requests / "pipe.csv")
    (requests / "q.json").write_text(json.dumps({"case": CASE, "curve": curve, "name": CURVE}))
    called = call("batch", requests)
    assert (called.status, called.err) == (2, "")
    answer = json.loads((requests / "results" / "q.json").read_text())
    assert answer["exit_status"] == 2
    assert "SECRET" not in called.out + answer["message"]
    assert "root:" not in called.out + answer["message"]


def test_answers_of_a_batch_stay_inside(requests, tmp_path):
    (requests / "q.json").write_text("{}")
    (requests / "results").mkdir()
    (requests / "results" / "q.json").symlink_to(tmp_path / "mine")
    (requests / "loop.json").symlink_to("loop.json")
    assert call("batch", requests).status == 2
    assert (tmp_path / "mine").read_text() == "mine"
    assert not (requests / "results" / "q.json").is_symlink()

    (requests / "results" / "q.json").unlink()
    (requests / "results").rmdir()
    (requests / "results").symlink_to(tmp_path)
    called = orderly(call("batch", requests), 2)
    assert "is a link" in called.err
    assert not (tmp_path / "q.json").exists()


@quickly
@given(texts)
def test_results_that_say_anything(tmp_path, text):
    """Names in a result never become file names, and its texts stay valid in CSV and XML."""
    result = canned()
    result.failures = [Failure(text, text)]
    result.branches = [Branch(text, text, result.branches[0].columns)]
    data = result.to_json() | {"scales": {text: text}, "parameters": {text: text}}
    data["states"][0]["fields"][0]["columns"][text or "x"] = [1.0, 2.0, 3.0]
    folder = tmp_path / "in"
    folder.mkdir(exist_ok=True)
    (folder / "r.json").write_text(json.dumps(data))
    for suffix in ("vtu", "xdmf"):
        if call("shape", folder / "r.json", folder / f"s.{suffix}").status == 0:
            ElementTree.parse(folder / f"s.{suffix}")
    orderly(call(*COMPARE, folder / "r.json"), 0, 1, 2, 5)
    assert {path.name for path in tmp_path.iterdir()} == {"in"}


@pytest.mark.parametrize("text", TEXTS)
def test_verdicts_on_curves_of_such_names(tmp_path, text):
    columns = references.load(2, CURVE).columns
    theirs = {text + "u": columns["u_max"].tolist(), text + "p": columns["p"].tolist()}
    (tmp_path / "c.json").write_text(json.dumps(theirs))
    names = ("--map", f"u_max={text}u", "--map", f"p={text}p") if text else ("--map", "u_max=u")
    words = (*names, "--out", tmp_path / "out")
    if text != text.lstrip():  # white space around a name of --map is none of it
        assert "the curve has no column 'u'" in orderly(call(*COMPARE, tmp_path / "c.json", *words), 2).err
        return
    orderly(call(*COMPARE, tmp_path / "c.json", *words), 0)
    harmless((tmp_path / "out" / "index.html").read_text())
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"index.html", "p.svg", "verdicts.json"}


def test_what_is_stored_is_one_thing():
    """The stored run above has its text in every place that holds one."""
    data = json.dumps(run_of("@@"))
    places = {name for kind in (Verdict, CaseOutcome, Printed, PanelOutcome) for name in kind.__annotations__}
    assert data.count("@@") > 40
    assert {"check", "statement", "differs", "evidence", "note"} <= places
    assert asdict(Marker("a", "b", 1, 2))["label"] == "b"
