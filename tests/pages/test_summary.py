"""The summary of a run: the terminal's table, headlines, readable numbers and formulas."""

import io
import math
import re
from dataclasses import replace

import pytest
from canned_run import failing_case, passing_case, sample, verdict
from rich.cells import cell_len
from rich.console import Console

from weakforms.verification.report import summary, wording


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
    assert "1 reproduced, 1 misprint proven, 1 not recoverable" in words


def test_the_worst_check_and_its_place_where_there_are_any(monkeypatch):
    """A case may have statements only, and a check may have no place in the paper."""
    monkeypatch.setenv("NO_COLOR", "1")
    nowhere = replace(passing_case(), verdicts=[verdict("nowhere", where="")])
    stated = replace(passing_case(), verdicts=[v for v in passing_case().verdicts if v.bound is None])
    for case, said in ((passing_case(), "at u_max = 1.25"), (nowhere, "nowhere "), (stated, " – ")):
        stream = io.StringIO()
        summary.print_summary(sample(case), Console(file=stream, width=160))
        assert said in stream.getvalue()
        assert (" at " in stream.getvalue()) == (case.verdicts[0].where != "")


def test_accuracies_asked_far_beyond_what_is_delivered_are_named():
    case = replace(
        passing_case(),
        verdicts=[
            verdict("a:p", bound=1e-10),
            verdict("b:p", bound=1e-9),  # the widest of a column counts
            verdict("a:u", bound=1e-13, widest=1e-12),
            verdict("b:V", bound=1e-12, passed=False),
            verdict("c:V", bound=0.0),
            replace(verdict("trace:tube:N", bound=1e-12), kind="trace"),
        ],
    )
    found = summary.accuracies(sample(case))
    assert [(a.column, round(a.ratio)) for a in found] == [("u", 100000), ("p", 100)]
    assert [a.column for a in found if a.ratio > summary.LOOSE] == ["u"]


def test_headlines():
    assert summary.headline(sample(passing_case())) == "all 3 checks hold"
    lying = replace(passing_case(), verdicts=[verdict("x", passed=False)])
    assert summary.run_status(sample(lying)) == "failed"
    assert summary.headline(sample()) == "no case was run"
    assert summary.run_status(sample()) == "empty"
    assert summary.run_status(sample(replace(passing_case(), verdicts=[], status="error"))) == "error"
    assert summary.run_status(sample(passing_case(), failing_case())) == "failed"


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
    assert wording.with_uncertainty(value, uncertainty) == text


def test_tex_becomes_html_without_a_way_out():
    assert wording.plain_tex(r"$\delta_1 = 1$") == "δ1 = 1"
    assert wording.html_tex(r"$u_{max}$ & <b>") == "<i>u</i><sub>max</sub> &amp; &lt;b&gt;"
    assert "<script" not in wording.html_tex(r"$\lt script\gt$ $\ltscript$ $&lt;$")
    assert [wording.scientific(v) for v in (3.21e-10, 0.0, None)] == ["3.2e-10", "0", "–"]
    assert [wording.duration(s) for s in (0.431, 12, 185, 7800)] == [
        "0.43 s",
        "12.0 s",
        "3 min 05 s",
        "2 h 10 min",
    ]
