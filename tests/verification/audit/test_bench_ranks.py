"""Times of large surfaces on several ranks: the file, the ratios, and the page of the report."""

import pytest

from weakforms.errors import InputError
from weakforms.verification.audit.bench_ranks import NAME, Scaled, append, load
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render, render_whole


def table(ranks, times, title="Tube <t>"):
    """Meshes with doubled unknowns and given seconds of the states; the other stages take half as long."""
    rows = [
        {"mesh": f"{n}", "unknowns": 50_000 * 2**n, "states_s": t, "inertia_s": t / 2, "lowest_s": t / 2}
        for n, t in enumerate(times)
    ]
    return {
        "ranks": ranks,
        "title": title,
        "machine": {"processor": "P"},
        "rows": [row | {"peak_mib": 10.0} for row in rows],
    }


@pytest.fixture
def file(tmp_path):
    for ranks, times in ((1, [9.0]), (2, [3.0, 5.0, 12.0]), (1, [4.0, 10.0])):
        append(tmp_path / NAME, table(ranks, times))
    return tmp_path / NAME


def test_ratios_are_those_of_the_last_runs(file):
    found = Scaled.beside(file.parent)
    assert not found.shipped
    (title,) = found.titles
    strong, weak = found.strong(title), found.weak(title)
    assert [(s.row.unknowns, s.times["states_s"]) for s in strong] == [(50_000, 4 / 3), (100_000, 2.0)]
    assert [(w.one.unknowns, w.row.unknowns) for w in weak] == [(50_000, 100_000), (100_000, 200_000)]
    assert [w.times["seconds"] for w in weak] == pytest.approx([4 / 5, 10 / 12])


def test_a_small_mesh_tells_nothing_of_ranks(tmp_path):
    for ranks in (1, 2):
        small = table(ranks, [1.0])
        small["rows"][0]["unknowns"] = 1000
        append(tmp_path / NAME, small)
    assert Scaled.beside(tmp_path).strong("Tube <t>") == []


def test_without_a_file_the_report_shows_the_runs_that_the_package_brings(tmp_path):
    found = Scaled.beside(tmp_path)
    assert found.shipped
    for title in found.titles:
        assert found.strong(title)
    page = render(RunOutcome("quick", "all", "", 0.0, {}))["scaling.html"]
    assert "No times of large surfaces" in page


@pytest.mark.parametrize("text", ["{", '{"title": "x"}', "[1]", "[" * 9000])
def test_a_damaged_file_is_shown_as_such(tmp_path, text):
    (tmp_path / NAME).write_text(text)
    with pytest.raises(InputError, match=NAME):
        load(tmp_path / NAME)
    found = Scaled.beside(tmp_path)
    assert found.problem
    page = render(RunOutcome("quick", "all", "", 0.0, {}), Beside(scaled=found))["scaling.html"]
    assert '<p class="problem-label">' in page


def test_the_page_shows_times_and_ratios(file):
    empty, beside = RunOutcome("quick", "all", "", 0.0, {}), Beside.read(file.parent)
    page = render(empty, beside)["scaling.html"]
    for text in (
        "up to 200\u00a0000 unknowns, on 1 and 2 ranks",
        "Tube &lt;t&gt;",
        "1.33",
        "0.80",
        "Strong scaling",
        "<svg",
    ):
        assert text in page
    assert 'id="scaling"' in render_whole(empty, beside)
