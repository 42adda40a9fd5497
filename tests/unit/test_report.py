"""The report holds every check, stands on its own, and survives hostile texts and damaged files."""

import io
import json
import math
import os
import re
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from rich.cells import cell_len
from rich.console import Console

from weakforms.errors import InputError
from weakforms.verification import summary
from weakforms.verification.figures import convergence_figure, panel_figure
from weakforms.verification.junit import clean, junit_xml
from weakforms.verification.outcome import (
    CaseOutcome,
    Convergence,
    CurveOutcome,
    Marker,
    PanelOutcome,
    Printed,
    RunOutcome,
    Verdict,
)
from weakforms.verification.report import load_run, render, write_report

HOSTILE = '<script>alert("x")</script> \'&amp; \x00\x1b[31m $\\foo{$ \ud800 ∂λ₁ 中 {{ 7*7 }} [red]'
VOID = {"meta", "link", "br", "wbr", "img", "input", "hr"}


def curve(name, delta1, factor=1.0):
    """An S-shaped branch with a reference at every third point; ``factor`` scales its errors."""
    u = np.linspace(0.0, 5.0, 60)
    p = (1 - np.exp(-3.2 * u)) * (1.95 + 0.03 * (u - 1.6) ** 3 - (1.163 - delta1) / 2 * (u - 1.6))
    rows = u[1::3]
    bound = np.full(len(rows), 4e-9)
    errors = bound * factor * np.abs(np.sin(5 * rows))
    errors[0] = 0.0
    return CurveOutcome(
        name,
        rf"$\delta_1 = {delta1}$",
        p.tolist(),
        u.tolist(),
        [False, *(np.diff(p) < 0).tolist()],
        name,
        "independent",
        p[1::3].tolist(),
        rows.tolist(),
        "u_max",
        rows.tolist(),
        errors.tolist(),
        bound.tolist(),
    )


def panel(curves, name="a"):
    markers = [
        Marker("limit_point", "$p = 1.95$", 1.95, 1.3),
        Marker("cusp_point", "cusp", 1.9, 2.0),
        Marker("unheard_of", "", 99.0, 2.0),
    ]
    axes = ("p", "u_max", "$p$", "$u_{max}$", (1.7, 2.05), (0.0, 5.0))
    return PanelOutcome(name, "Limit points", *axes, curves, markers, "A note.")


def verdict(check, passed=True, error=3.2e-10, bound=1.3e-9, **more: object):
    values = {"statement": "The curves agree.", "where": "u_max = 1.25", "asked": 1e-7}
    values |= {"uncertainty": 5e-10, "reference_uncertainty": 4e-10, "reference": check}
    return Verdict(check, "curve", passed, error=error, bound=bound, **values | more)


def passing_case():
    checks = [
        verdict("fig03a_delta1_1:p", reference="fig03a_delta1_1"),
        verdict("limit:p"),
        Verdict("count", "count", True, "Two limit points.", "found 2"),
    ]
    histories = [
        Convergence("limit pressure $p$", degree, [20, 40, 80], errors, order, order, "exact")
        for degree, errors, order in ((1, [1e-2, 2.5e-3, 6e-4], 2.0), (2, [1e-4, 6e-6, 0.0], 4.0))
    ]
    ledger = [
        Printed("cusp $\\delta_1$", "1.163", 1.16299342, 3e-8, "reproduced", "rounds", "fig. 3"),
        Printed("$\\delta_2$", "0.8164", 0.8164965809, None, "misprint"),
        Printed("n", "-", None, None, "not recoverable"),
    ]
    solutions = [
        {
            "problem": "tube",
            "parameters": {"alpha": 0.1, "delta1": d},
            "numerics": {"cells": [160, 320]},
            "provenance": {"versions": {"dolfinx": "0.9.0"}, "wall_s": d},
            "file": f"solutions/{d}.json",
        }
        for d in (1.0, 1.1)
    ]
    panels = [panel([curve("fig03a_delta1_1", 1.0), curve("fig03a_delta1_2", 1.2)])]
    panels.append(PanelOutcome("b", "", "x", "y", "$x$", "$y$", (0.0, 1.0), (0.0, 1.0)))
    return CaseOutcome(
        "paper2.fig03",
        "Limit points",
        "figure 3",
        "First.\n\nSecond.",
        "passed",
        checks,
        panels,
        ledger,
        histories,
        [],
        3.4,
        solutions,
    )


def failing_case():
    checks = [
        verdict("good:p"),
        verdict("bad:p", passed=False, error=1.3004e-9, bound=1.3e-9, detail="12 rows out of bound"),
        verdict("nan:p", passed=False, error=None, detail="not a number"),
    ]
    panels = [panel([curve("bad", 1.1, factor=3.0)])]
    return CaseOutcome("paper2.fig02", "Free", "figure 2", "", "failed", checks, panels)


def hostile_case():
    text = HOSTILE
    bad = replace(curve("x", 1.0), name=text, label=text, reference_kind=text)
    bad.residual_abscissa = text
    picture = replace(panel([bad]), name=text, title=text, x_label=text, note=text)
    picture.markers = [Marker(text, text, 1.9, 2.0)]
    check = Verdict(text, text, False, text, text, 1e-3, 1e-9, 1e-7, None, None, text, text)
    histories = [Convergence(text, 1, [10, 20], [1e-3, math.nan], None, 2.0, text)]
    ledger = [Printed(text, text, 1.0, 0.1, text, text, text)]
    return CaseOutcome(
        text,
        text,
        text,
        text,
        "error",
        [check, check],
        [picture],
        ledger,
        histories,
        [text],
        1.0,
        [{text: text, "parameters": {text: [text, 1.5]}}],
    )


def sample(*cases: CaseOutcome):
    environment = {"dolfinx": "0.9.0", "machine": "x86_64", "git": "1f2e3d4"}
    return RunOutcome("full", "paper2", "2026-08-11T09:41:07Z", 12.7, environment, list(cases))


@pytest.fixture(scope="module")
def run():
    return sample(passing_case(), failing_case(), hostile_case())


@pytest.fixture(scope="module")
def folder(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "deep" / "out"
    assert write_report(run, folder) == folder / "index.html"
    return folder


@pytest.fixture(scope="module")
def page(folder):
    return (folder / "index.html").read_text(encoding="utf-8")


class Reader(HTMLParser):
    """Collects tags, attributes and text; complains about elements closed out of order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags, self.attributes, self.open, self.words = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):  # noqa: D102
        self.tags.append(tag)
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):  # noqa: D102
        self.tags.append(tag)
        self.attributes += [(tag, name, value) for name, value in attrs]

    def handle_endtag(self, tag):  # noqa: D102
        assert self.open.pop() == tag

    def handle_data(self, data):  # noqa: D102
        self.words.append(data)


@pytest.fixture(scope="module")
def reader(page):
    return Reader(page)


def test_page_is_well_formed_and_nothing_half_written_remains(reader, folder):
    assert reader.open == []
    assert sorted(os.listdir(folder)) == ["index.html", "junit.xml", "report.json"]


def test_page_loads_nothing(reader, page):
    assert not {"script", "iframe", "object", "embed", "img", "base"} & set(reader.tags)
    for _tag, name, value in reader.attributes:
        if name in ("src", "href", "xlink:href", "srcset", "action", "poster"):
            assert value.startswith(("#", "data:,")), (name, value)
        assert not name.startswith("on")
    addresses = set(re.findall(r"https?://[^\s\"'<]+", page))
    assert addresses <= {"http://www.w3.org/2000/svg"}
    assert "@import" not in page
    assert set(re.findall(r"url\(([^)]*)\)", page)) <= {
        f"#{value}" for _, name, value in reader.attributes if name == "id"
    }


def test_ids_are_unique_and_links_arrive(reader):
    ids = [value for _, name, value in reader.attributes if name == "id"]
    assert len(ids) == len(set(ids))
    assert "paper2.fig03" in ids
    assert "paper2.fig02:bad:p" in ids
    targets = {value[1:] for _, name, value in reader.attributes if name == "href" and value[0] == "#"}
    assert targets <= set(ids)
    for _, name, value in reader.attributes:
        if name in ("aria-labelledby", "aria-describedby"):
            assert set(value.split()) <= set(ids)
    assert not any(re.search(r"\s", value) for value in ids)


def test_every_check_figure_and_status_appears(run, page, reader):
    for case in run.cases[:2]:
        for item in case.verdicts:
            assert f"<code>{item.check}</code>" in page
            assert item.statement in page
    text = " ".join(" ".join(reader.words).split())
    assert "1 case could not be solved; 4 of 8 checks failed" in text
    assert "12 rows out of bound" in text
    assert "not recoverable" in text
    assert reader.tags.count("svg") == 4 + 2
    assert reader.tags.count("figure") == 4 + 2
    assert len([1 for _, n, v in reader.attributes if (n, v) == ("role", "img")]) == 6
    assert text.index("bad:p") < text.index("good:p")


def test_headings_come_in_order(reader):
    levels = [int(tag[1]) for tag in reader.tags if re.fullmatch(r"h[1-6]", tag)]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))
    assert ("html", "lang", "en") in reader.attributes


def test_hostile_texts_are_escaped(page, reader):
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "{{ 7*7 }}" in " ".join(reader.words)
    assert "\x00" not in page
    assert "\x1b" not in page


def test_close_numbers_are_told_apart(page):
    assert "1.3004e-09" in page
    assert "&gt;1.000" in page


def test_report_json_is_strict_and_comes_back(run, folder, tmp_path):
    text = (folder / "report.json").read_text(encoding="utf-8")
    data = json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert data["schema"] == "weakforms.report/1"
    again = load_run(folder)
    assert again.cases[0] == run.cases[0]
    assert again.cases[1] == run.cases[1]
    assert math.isnan(again.cases[2].convergence[0].errors[1])
    write_report(again, tmp_path)
    for name in ("index.html", "report.json", "junit.xml"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes()


def test_numpy_numbers_and_infinities_are_written(tmp_path):
    case = passing_case()
    case.verdicts[0].error = np.float64(math.inf)
    case.verdicts[0].passed = np.bool_(False)
    case.panels[0].curves[0].y[3] = math.nan
    case.solutions = [{"numerics": {"cells": np.arange(2), "tolerance": np.float64(1e-9)}}]
    write_report(sample(case), tmp_path)
    again = load_run(tmp_path).cases[0]
    assert again.verdicts[0].error is None
    assert again.verdicts[0].passed is False
    assert math.isnan(again.panels[0].curves[0].y[3])
    assert again.solutions[0]["numerics"]["cells"] == [0, 1]


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: text[: len(text) // 2],
        lambda text: "",
        lambda text: "[]",
        lambda text: "not json",
        lambda text: text.replace("weakforms.report/1", "weakforms.report/9"),
        lambda text: text.replace('"cases"', '"cages"'),
        lambda text: text.replace('"bound": 1.3e-09', '"bound": "wide"'),
        lambda text: text.replace('"verdicts": [', '"verdicts": ["x",', 1),
        lambda text: "[" * 100000,
    ],
)
def test_damaged_report_is_one_clear_line(damage, folder, tmp_path):
    text = (folder / "report.json").read_text(encoding="utf-8")
    (tmp_path / "report.json").write_text(damage(text), encoding="utf-8")
    with pytest.raises(InputError, match=r"report\.json: .") as caught:
        load_run(tmp_path)
    assert "\n" not in str(caught.value)


def test_missing_report_and_unwritable_folder(tmp_path):
    with pytest.raises(InputError, match="cannot be read"):
        load_run(tmp_path / "nowhere")
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="cannot write"):
        write_report(sample(), tmp_path / "file" / "out")


def test_failed_write_leaves_the_old_report(folder, tmp_path, monkeypatch):
    write_report(sample(), tmp_path)
    before = {name: (tmp_path / name).read_bytes() for name in os.listdir(tmp_path)}
    monkeypatch.setattr(os, "fsync", lambda _: (_ for _ in ()).throw(OSError(28, "No space left")))
    with pytest.raises(InputError, match="No space left"):
        write_report(sample(failing_case()), tmp_path)
    assert {name: (tmp_path / name).read_bytes() for name in os.listdir(tmp_path)} == before


def test_junit_parses_and_counts(run):
    root = ET.fromstring(junit_xml(run).encode())
    assert [suite.get("name") for suite in root] == [clean(case.id) for case in run.cases]
    assert (root.get("tests"), root.get("failures"), root.get("errors")) == ("9", "4", "1")
    cases = {(item.get("classname"), item.get("name")): item for item in root.iter("testcase")}
    failure = cases["paper2.fig02", "bad:p"].find("failure")
    assert "12 rows out of bound" in failure.text
    assert "error 1.3004e-09" in failure.get("message")
    assert cases["paper2.fig03", "count"].find("failure") is None
    versions = {p.get("name"): p.get("value") for p in root[0].iter("property")}
    assert versions["dolfinx"] == "0.9.0"


def test_figures_are_valid_deterministic_and_themed(run):
    picture = run.cases[0].panels[0]
    first = panel_figure(picture, "f1", run.cases[0].verdicts)
    assert first == panel_figure(picture, "f1", run.cases[0].verdicts)
    root = ET.fromstring(first)
    assert root.find("{*}title").text == "Limit points"
    assert "u_max from 0 to 5" in root.find("{*}desc").text
    assert "var(--f-c0,#0b62a4)" in first
    assert all(item.get("id", "f1--").startswith("f1--") for item in root.iter())
    assert "matplotlib" not in first
    assert "stroke-dasharray" in first
    ET.fromstring(convergence_figure(run.cases[0].convergence, "f2"))
    ET.fromstring(convergence_figure([], "f3"))


def test_odd_panels_are_drawn():
    one = CurveOutcome("one", "one point", [1.8], [2.0], residual_x=[1.0], residual=[0.0])
    odd = replace(panel([one, curve("two", 1.1)]), x_range=(0.0, 0.0), y_range=(math.nan, 1.0))
    odd.markers = [Marker("front", "lost", math.nan, 1.0)]
    ET.fromstring(panel_figure(odd, "odd"))
    many = panel([replace(curve(f"c{i}", 1.0 + i / 30), reference_x=[]) for i in range(20)])
    ET.fromstring(panel_figure(many, "many"))


@pytest.mark.parametrize(
    ("cases", "words"),
    [
        ([], "No case was run"),
        ([CaseOutcome("paper9.empty", "T", "S", "", "passed")], "No check was made"),
        ([CaseOutcome("odd", "T", "S", "", "error")], "no reason was recorded"),
    ],
)
def test_empty_runs_say_so(cases, words):
    reader = Reader(render(sample(*cases)))
    assert words in " ".join(" ".join(reader.words).split())
    ET.fromstring(junit_xml(sample(*cases)).encode())


def test_many_checks_are_folded():
    checks = [verdict(f"bulk_{i}:p") for i in range(600)] + [verdict("broken:p", passed=False)]
    case = CaseOutcome("paper2.bulk", "Many", "", "", "failed", checks)
    page = render(sample(case))
    assert "600 checks that hold" in page
    assert all(f"<code>bulk_{i}:p</code>" in page for i in range(600))
    section = page.index('id="paper2.bulk"')
    assert page.index("broken:p", section) < page.index("<details", section)


@pytest.mark.parametrize("width", [40, 60, 140])
def test_terminal_summary(run, width, monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")
    stream = io.StringIO()
    summary.print_summary(run, Console(file=stream, width=width, force_terminal=True))
    assert not re.search("\x1b\\[[0-9;]*3[0-9]", stream.getvalue())
    text = re.sub("\x1b\\[[0-9;]*m", "", stream.getvalue())
    assert "\x1b" not in text
    assert max(map(cell_len, text.splitlines())) <= width
    words = " ".join(text.split())
    assert "paper2.fig02:bad:p" in words
    assert "ERROR: 1 case could not be solved; 4 of 8 checks failed in 3 cases" in words
    assert "1 reproduced, 1 misprint, 1 not recoverable" in words


def test_headlines():
    assert summary.headline(sample(passing_case())) == "all 3 checks hold"
    lying = replace(passing_case(), verdicts=[verdict("x", passed=False)])
    assert summary.run_status(sample(lying)) == "failed"
    assert summary.headline(sample()) == "no case was run"
    assert summary.run_status(sample()) == "empty"


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.16299342, 3e-8, "1.16299342 ± 3e-08"),
        (1.16299342, 1.4e-5, "1.162993 ± 1e-05"),
        (1234.5, 20.0, "1230 ± 2e+01"),
        (0.5, None, "0.5"),
        (None, None, "–"),
        (math.nan, 1.0, "–"),
        (2.0, 1e-30, "2 ± 1e-30"),
    ],
)
def test_values_have_the_digits_their_uncertainty_justifies(value, uncertainty, text):
    assert summary.with_uncertainty(value, uncertainty) == text


def test_tex_becomes_html_without_a_way_out():
    assert summary.plain_tex(r"$\delta_1 = 1$") == "δ1 = 1"
    assert summary.html_tex(r"$u_{max}$ & <b>") == "<i>u</i><sub>max</sub> &amp; &lt;b&gt;"
    assert "<script" not in summary.html_tex(r"$\lt script\gt$ $\ltscript$ $&lt;$")
    assert [summary.scientific(v) for v in (3.21e-10, 0.0, None)] == ["3.2e-10", "0", "–"]
    assert [summary.duration(s) for s in (0.431, 12, 185, 7800)] == [
        "0.43 s",
        "12.0 s",
        "3 min 05 s",
        "2 h 10 min",
    ]
