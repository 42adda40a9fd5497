"""Files written beside the pages: report.json, junit.xml, shapes; damaged files, and a full disk."""

import json
import math
import os
from pathlib import Path
from types import SimpleNamespace
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from canned_run import failing_case, passing_case, sample, surface

from weakforms.errors import EnvironmentLackError, InputError
from weakforms.verification.audit.faults.outcome import SHIPPED, Seeded, load_faults
from weakforms.verification.report import pdf
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.junit import clean, junit_xml
from weakforms.verification.report.pages import render
from weakforms.verification.report.report import load_run, write_report
from weakforms.verification.report.vtu import vtu


def test_report_json_is_strict_and_comes_back(run, folder, tmp_path):
    text = (folder / "report.json").read_text(encoding="utf-8")
    data = json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert data["schema"] == "weakforms.report/1"
    again = load_run(folder)
    assert again.cases[0] == run.cases[0]
    assert again.cases[1] == run.cases[1]
    assert math.isnan(again.cases[2].convergence[0].errors[1])
    write_report(again, tmp_path)
    names = {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}
    assert {path.relative_to(tmp_path) for path in tmp_path.rglob("*") if path.is_file()} == names
    for name in names:
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes()


def test_the_overview_says_that_its_seeded_faults_are_those_of_the_release(run, folder):
    page = (folder / "index.html").read_text("utf-8")
    assert "in the last run before this release; they were not run for this report" in page
    assert (
        "last run before this release" not in render(run, Beside(Seeded(load_faults(SHIPPED))))["index.html"]
    )


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
    with pytest.raises(InputError, match="cannot read"):
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
    assert sum(int(suite.get("tests")) for suite in root) == 9
    cases = {(item.get("classname"), item.get("name")): item for item in root.iter("testcase")}
    failure = cases["paper2.fig02", "bad:p"].find("failure")
    assert "12 rows out of bound" in failure.text
    assert "error 1.3004e-09" in failure.get("message")
    assert cases["paper2.fig03", "count"].find("failure") is None
    versions = {p.get("name"): p.get("value") for p in root[0].iter("property")}
    assert versions["dolfinx"] == "0.9.0"


def test_pages_of_an_earlier_report_go_and_other_files_stay(tmp_path):
    (tmp_path / "mine.html").write_text("<p>mine</p>")
    write_report(sample(passing_case()), tmp_path)
    assert {"paper2.html", "shapes", "figures"} < set(os.listdir(tmp_path))
    write_report(sample(), tmp_path)
    left = {
        "audit.html",
        "coverage.html",
        "faults.html",
        "scaling.html",
        "thesis.html",
        "index.html",
        "junit.xml",
        "mine.html",
        "report.json",
        "shapes",
        "figures",
    }
    assert set(os.listdir(tmp_path)) == left
    assert os.listdir(tmp_path / "shapes") == os.listdir(tmp_path / "figures") == []


def test_a_page_that_cannot_be_drawn_leaves_the_numbers(tmp_path, monkeypatch):
    monkeypatch.setattr("weakforms.verification.report.report.render_with_files", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        write_report(sample(passing_case()), tmp_path)
    assert load_run(tmp_path).cases[0] == passing_case()


def test_shapes_are_what_other_programs_read(tmp_path):
    meshio = pytest.importorskip("meshio")
    shape = surface()
    (tmp_path / "shape.vtu").write_text(vtu(shape), encoding="utf-8")
    mesh = meshio.read(tmp_path / "shape.vtu")
    x = np.asarray(shape.position[0])
    assert mesh.points.shape == (x.size, 3)
    assert mesh.cells_dict["quad"].shape == ((x.shape[0] - 1) * (x.shape[1] - 1), 4)
    np.testing.assert_allclose(mesh.points[:, 0], x.ravel(), rtol=1e-11)
    np.testing.assert_allclose(mesh.point_data["lam1"], np.ravel(shape.fields["lam1"]), rtol=1e-11)
    a, b, c, _ = mesh.points[mesh.cells_dict["quad"][0]]
    assert np.cross(b - a, c - a) @ [*a[:2], 0.0] > 0, "normals point outwards"


def test_without_a_browser_there_is_no_pdf(tmp_path, monkeypatch):
    monkeypatch.setattr(pdf.shutil, "which", lambda name: None)
    with pytest.raises(EnvironmentLackError, match="apt install chromium"):
        pdf.write_pdf(sample(), tmp_path / "report.pdf")
    with pytest.raises(InputError, match=r"must end in \.pdf"):
        pdf.write_pdf(sample(), tmp_path / "report.txt")
    with pytest.raises(InputError, match="no such folder"):
        pdf.write_pdf(sample(), tmp_path / "nowhere" / "report.pdf")
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(("user", "without"), [(0, True), (1000, False)])
def test_only_root_prints_without_the_browsers_sandbox(tmp_path, monkeypatch, user, without):
    commands = []

    def printed(command, **_):
        commands.append(command)
        (place,) = [word for word in command if word.startswith("--print-to-pdf=")]
        Path(place.partition("=")[2]).write_bytes(b"%PDF")
        return SimpleNamespace(returncode=0, stderr="")

    monkeypatch.setattr(pdf, "browser", lambda: "browser")
    monkeypatch.setattr(pdf.os, "geteuid", lambda: user)
    monkeypatch.setattr(pdf.subprocess, "run", printed)
    assert pdf.write_pdf(sample(), tmp_path / "report.pdf").read_bytes() == b"%PDF"
    assert ("--no-sandbox" in commands[0]) is without
