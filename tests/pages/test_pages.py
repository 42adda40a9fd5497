"""The pages contain every check, need no other files, are linked, and remain valid with hostile texts."""

import csv
import os
import re
from itertools import pairwise
from xml.etree import ElementTree as ET

import pytest
from canned_run import CaseOutcome, Reader, passing_case, sample, verdict

from weakforms.verification.report.junit import junit_xml
from weakforms.verification.report.pages import GROUPS, render, render_whole
from weakforms.verification.report.wording import typeset


@pytest.fixture(scope="session")
def readers(pages):
    return {name: Reader(text) for name, text in pages.items()}


def words(*readers: Reader) -> str:
    return " ".join(" ".join(word for reader in readers for word in reader.words).split())


def test_pages_are_well_formed_and_nothing_half_written_remains(readers, folder):
    assert [name for name, reader in readers.items() if reader.open] == []
    expected = {
        "index.html",
        "audit.html",
        "coverage.html",
        "faults.html",
        "scaling.html",
        "thesis.html",
        "junit.xml",
        "report.json",
        "shapes",
        "figures",
    }
    assert expected | {"paper2.html"} < set(os.listdir(folder))
    assert len(os.listdir(folder)) == 14, "with two pages for each of two groups, and the folder of figures"
    assert not [path for path in folder.rglob("*") if path.name.startswith(".")]


def test_pages_load_nothing(readers, pages, folder):
    for page, reader in readers.items():
        assert not {"script", "iframe", "object", "embed", "img", "base"} & set(reader.tags)
        ids = {value for _, name, value in reader.attributes if name == "id"}
        for tag, name, value in reader.attributes:
            if name in ("src", "href", "xlink:href", "srcset", "action", "poster"):
                local = tag == "a" and (folder / value.partition("#")[0]).is_file()
                assert local or value.startswith(("#", "data:,")), (name, value)
            assert not name.startswith("on")
        assert set(re.findall(r"https?://[^\s\"'<]+", pages[page])) <= {"http://www.w3.org/2000/svg"}
        assert "@import" not in pages[page]
        assert set(re.findall(r"url\(([^)]*)\)", pages[page])) <= {f"#{value}" for value in ids}


def test_ids_are_unique_and_links_arrive(readers, folder):
    ids = {page: [v for _, name, v in reader.attributes if name == "id"] for page, reader in readers.items()}
    assert {"paper2.fig03", "paper2.fig02:bad:p"} <= set(ids["paper2.html"])
    for page, reader in readers.items():
        assert len(ids[page]) == len(set(ids[page]))
        assert not any(re.search(r"\s", value) for value in ids[page])
        for tag, name, value in reader.attributes:
            if tag == "a" and name == "href":
                file, _, anchor = value.partition("#")
                assert (folder / (file or page)).is_file(), value
                assert not anchor or anchor in ids[file or page], value
            if name in ("aria-labelledby", "aria-describedby"):
                assert set(value.split()) <= set(ids[page])


def test_every_check_figure_and_status_appears(run, pages, readers):
    page, reader = pages["paper2.html"], readers["paper2.html"]
    for case in run.cases[:2]:
        for item in case.verdicts:
            assert f"<code>{item.check}</code>" in page
            assert item.statement in page
    text = words(reader)
    assert "12 rows out of bound" in text
    assert "not recoverable" in text
    assert "shapes/paper2_fig03-bulge.vtu" in text
    pictures = [reader.tags.count("svg"), reader.tags.count("figure")]
    pictures.append(len([1 for _, n, v in reader.attributes if (n, v) == ("role", "img")]))
    assert pictures == [8, 6, 6], "three panels, a surface, a convergence plot, a sketch; letters, arrows"
    assert text.rindex("bad:p") < text.rindex("good:p")


def test_the_first_page_says_what_disagrees_and_why(readers):
    text = words(readers["index.html"])
    assert "1 case could not be solved; 4 of 8 checks failed" in text
    assert "misprint proven δ 2 is printed as 0.8164 ; computed 0.8164965809" in text
    assert "the paper The text has three. Shown instead: Two limit points." in text
    assert "not recoverable n , printed as -" in text
    for title in GROUPS["paper2"][:2]:
        assert title in text


def test_headings_come_in_order(readers):
    for reader in readers.values():
        levels = [int(tag[1]) for tag in reader.tags if re.fullmatch(r"h[1-6]", tag)]
        assert levels[0] == 1
        assert levels.count(1) == 1
        assert all(after <= before + 1 for before, after in pairwise(levels))
        assert ("html", "lang", "en") in reader.attributes


def test_hostile_texts_are_escaped(pages, readers):
    for page in pages.values():
        assert "<script" not in page
        assert "&lt;script&gt;" in page
        assert "\x00" not in page
        assert "\x1b" not in page
    assert "{{ 7*7 }}" in words(*readers.values())


def test_close_numbers_are_told_apart(pages):
    assert "1.3004e-09" in pages["paper2.html"]
    assert "&gt;1.000" in pages["paper2.html"]


def test_groups_have_pages_of_their_own():
    names = ("paper2.fig02", "materials.laws", "closed_form.sphere", "index", "a:b.c", "A B.c", "A-B.d")
    pages = render(sample(*(CaseOutcome(name, "T", "S", "", "passed", [verdict("x")]) for name in names)))
    known = {
        "audit.html",
        "coverage.html",
        "index.html",
        "faults.html",
        "scaling.html",
        "thesis.html",
        "paper2.html",
        "materials.html",
        "closed_form.html",
    }
    known |= {"index-2.html"}
    assert set(pages) == {*known, "a-b.html", "A-B.html", "A-B-2.html"}
    assert 'href="materials.html#materials.laws"' in pages["index.html"]
    assert "Closed forms" in pages["closed_form.html"]


def test_as_one_page_for_printing_every_link_stays_within(run):
    reader = Reader(render_whole(run))
    ids = {value for _, name, value in reader.attributes if name == "id"}
    links = [v for tag, name, v in reader.attributes if (tag, name) == ("a", "href")]
    inner = [v for v in links if v.startswith("#")]
    assert {v[1:] for v in inner} <= ids
    assert {v for v in links if v not in inner} <= {v for v in links if v.startswith(("shapes/", "figures/"))}
    assert reader.open == []


@pytest.mark.parametrize(
    ("cases", "said"),
    [
        ([], "No case was run"),
        ([CaseOutcome("paper9.empty", "T", "S", "", "passed")], "No check was made"),
        ([CaseOutcome("odd", "T", "S", "", "error")], "no reason was recorded"),
    ],
)
def test_empty_runs_say_so(cases, said):
    pages = render(sample(*cases))
    assert said in words(*(Reader(page) for page in pages.values()))
    ET.fromstring(junit_xml(sample(*cases)).encode())


def test_many_checks_have_a_page_of_their_own():
    checks = [verdict(f"bulk_{i}:p") for i in range(600)] + [verdict("broken:p", passed=False)]
    case = CaseOutcome("paper2.bulk", "Many", "", "", "failed", checks)
    pages = render(sample(case))
    page, listed = pages["paper2.html"], pages["paper2-checks.html"]
    assert "600 checks that hold" in page
    assert "broken:p" in page
    assert "<code>bulk_" not in page
    assert 'href="paper2-checks.html#paper2.bulk--checks"' in page
    assert 'id="paper2.bulk--checks"' in listed
    assert all(f"<code>bulk_{i}:p</code>" in listed for i in range(600))
    assert "<code>broken:p</code>" not in listed
    assert 'href="paper2-checks.html#paper2.bulk:bulk_0:p"' in pages["index.html"], "the sharpest bound"


def test_the_page_for_printing_has_the_folded_checks_too():
    checks = [verdict(f"bulk_{i}:p") for i in range(40)]
    page = render_whole(sample(CaseOutcome("paper2.bulk", "Many", "", "", "passed", checks)))
    assert all(f"<code>bulk_{i}:p</code>" in page for i in range(40))


def test_every_panel_has_a_number_and_its_files(folder, readers):
    reader = readers["paper2.html"]
    assert "paper2.fig03, panel 1" in words(reader)
    offered = {v for tag, n, v in reader.attributes if (tag, n) == ("a", "href") and v.startswith("figures/")}
    assert len(offered) == 12, "three panels and a surface"
    kinds = set()
    for name in offered:
        if name.endswith(".pdf"):
            printed = (folder / name).read_bytes()
            assert printed.startswith(b"%PDF")
            assert printed.count(b"/Type /Page ") == 1
            assert len(printed) > 3000, "the page is not blank"
            assert b"CreationDate" not in printed, "the same at every run"
            continue
        text = (folder / name).read_text("utf-8")
        if name.endswith(".svg"):
            assert text.startswith("<?xml")
            assert "var(" not in text, "a file of its own has its own colours"
        else:
            rows = list(csv.reader(text.splitlines()))
            if rows[0][:3] == ["x", "y", "z"]:
                kinds.add("surface")
                continue
            assert rows[0][:2] == ["curve", "what"]
            kinds |= {row[1] for row in rows[1:]}
    assert kinds == {"weak form", "reference", "error over u_max", "surface"}


def test_letters_and_marks_of_drawings_are_defined_once(readers):
    for name, reader in readers.items():
        ids = [v for _, n, v in reader.attributes if n == "id"]
        assert len(ids) == len(set(ids)), name
        used = {v[1:] for tag, n, v in reader.attributes if (tag, n) == ("use", "href")}
        marks = {v[5:-1] for _, n, v in reader.attributes if n.startswith("marker-")}
        assert used | marks <= set(ids)
    assert any(n == "marker-mid" for _, n, _ in readers["paper2.html"].attributes)


def test_a_failed_check_says_how_to_repeat_it(readers):
    text = words(readers["index.html"])
    assert "./run check paper2.fig02 ; the case is cases/paper2/fig02.py" in text


def test_a_case_begins_with_its_problem_its_symbols_and_its_references():
    case = passing_case()
    case.solutions = [
        {"problem": "tube", "parameters": {"alpha": 0.1, "delta1": d, "contact": "none", "spec": None}}
        for d in (1.0, 1.1)
    ]
    case.solutions.append({"problem": "of another version", "parameters": {}})
    reader = Reader(render(sample(case))["paper2.html"])
    text = words(reader)
    for said in (
        "Inflation of a pre-stretched cylindrical membrane",
        "axial pre-stretch, 1",
        "share no code",
    ):
        assert said in text
    assert "δ 1 = 1, 1.1;" in text, "the values of a parameter in all solutions"
    sketches = [v for _, n, v in reader.attributes if n == "aria-label" and v.startswith("A tube between")]
    assert len(sketches) == 1


@pytest.mark.parametrize(
    ("raw", "shown"),
    [
        ("r_max", r"$r_{\mathrm{max}}$"),
        ("lam1_mid", r"$\lambda_{1,\mathrm{mid}}$"),
        ("zw", "$z_{w}$"),
        ("fluid_M_1.5_delta_2_low", r"fluid, $M$ = 1.5, $\delta$ = 2, low"),
        ("alpha = 0.05, beta = 1.2", r"$\alpha$ = 0.05, $\beta$ = 1.2"),
        ("wrinkled_tube(Af=0.5, L=6.0)", "wrinkled tube: $A_{f}$ = 0.5, $L$ = 6.0"),
        ("height of the pole", "height of the pole"),
        ("first 3 points", "first 3 points"),
        (r"$\delta_1$ = 1.1, alpha = 2", r"$\delta_1$ = 1.1, alpha = 2"),
    ],
)
def test_raw_names_are_typeset(raw, shown):
    assert typeset(raw) == shown
