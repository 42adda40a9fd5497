"""The documentation: complete pages, working links, formulas, correct examples."""

import ast
import json
import re
from importlib import import_module

import pytest
from canned_run import Reader
from headless import CONTRASTS, SIZES, Browser

from weakforms.docs import api, site
from weakforms.docs.gallery import gallery, scripts
from weakforms.docs.prose import docstring, formula, markdown
from weakforms.errors import EnvironmentLackError
from weakforms.problems import registry
from weakforms.problems.problem import validated
from weakforms.verification.cases import examples
from weakforms.verification.cases.catalogue import describe
from weakforms.verification.report.formulas import html_formula
from weakforms.verification.report.pdf import browser


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The pages, with pictures of two problems: one branch, and the lines of a diagram."""
    folder = tmp_path_factory.mktemp("docs")
    with pytest.MonkeyPatch.context() as patch:
        right = site.pictures
        drawn = ["sphere", "diagram"]
        patch.setattr(site, "pictures", lambda at, jobs, names, tell: right(at, jobs, drawn, tell))
        patch.setattr(site, "gallery", lambda at, names, tell: gallery(at, ["balloon"], tell))
        assert site.write_docs(folder) == folder / "index.html"
    return folder


@pytest.fixture(scope="module")
def readers(folder):
    paths = sorted(folder.rglob("*.html"))
    return {p.relative_to(folder).as_posix(): Reader(p.read_text("utf-8")) for p in paths}


def test_there_is_a_page_for_everything(readers, folder):
    wanted = {f"problems/{name}.html" for name in registry.abouts()}
    wanted |= {f"api/{group}.html" for group in api.GROUPS}
    wanted |= {"index.html", "cases.html", "gallery.html", "symbols.html", "search.html", "CONTRIBUTING.html"}
    wanted |= {f"{path.stem}.html" for path in (site.ROOT / "docs").glob("*.md")}
    assert set(readers) == wanted
    assert all(reader.open == [] for reader in readers.values())
    assert not [path for path in folder.rglob(".*")]


def test_a_picture_has_all_lines_of_a_diagram(folder):
    page = (folder / "problems" / "diagram.html").read_text("utf-8")
    picture = page.partition("picture-diagram--title")[2].partition("</svg>")[0]
    assert "No picture" not in page
    assert all(name in picture for name in ("fold", "end", "cusp point"))


@pytest.mark.parametrize("about", registry.abouts().values(), ids=lambda about: about.name)
def test_the_code_of_an_example_asks_for_a_branch_that_there_is(about):
    asked = re.findall(r'result\.branch\("(\w+)"\)', examples.code(about)[-1])
    assert set(asked) <= set(about.branches)


def test_links_arrive_and_nothing_is_loaded(readers, folder):
    ids = {page: {v for _, name, v in reader.attributes if name == "id"} for page, reader in readers.items()}
    for page, reader in readers.items():
        active = {"script"} if page != "search.html" else set()
        assert not (active | {"iframe", "object", "embed", "img"}) & set(reader.tags)
        for tag, name, value in reader.attributes:
            if name != "href" or value.startswith(("https://", "data:,")):
                continue
            assert tag == "a" or value.startswith("#"), page
            file, _, anchor = value.partition("#")
            target = ((folder / page).parent / file).resolve() if file else folder.resolve() / page
            there = target.relative_to(folder.resolve()).as_posix()
            assert there in readers, f"{page}: {value}"
            assert not anchor or anchor in ids[there], f"{page}: {value}"


def typeset(text):
    """The words of a formula on a page."""
    return " ".join(Reader(html_formula(text)).words)


@pytest.mark.parametrize("name", sorted(registry.abouts()))
def test_a_problem_is_shown_with_its_form_and_a_right_example(name, readers):
    problem, about = registry.get(name), registry.abouts()[name]
    shown = about.example
    text = " ".join(" ".join(readers[f"problems/{name}.html"].words).split())
    facts = describe(name)
    for said in (
        *(typeset(line) for line in facts["energy"].split("  ")),
        facts["command"],
        *facts["example"],
        *(p["name"] for p in facts["parameters"]),
    ):
        assert " ".join(said.split()) in text
    assert all(source for place, _, source in examples.written_forms(about) if not place.endswith("body"))
    assert len(facts["example"]) == 3
    ast.parse("\n".join(facts["example"]))
    for spec in examples.specs(about):
        validated(problem.parameters, dict(spec.parameters), name)
        validated(problem.numerics, dict(spec.numerics), name)
    if not shown.values:
        assert {shown.x, shown.y} <= {column.name for column in about.columns}


def test_every_number_with_a_meaning_is_in_the_table_of_symbols(readers):
    text = " ".join(" ".join(readers["symbols.html"].words).split())
    for about in registry.abouts().values():
        for name, meaning in about.scales.items():
            assert f"{name} {' '.join(typeset(meaning).split())}" in text
    assert "λ 1 lam1 meridional stretch, 1" in text


def test_guides_for_newcomers_come_first_and_other_lists_are_folded(folder):
    page = (folder / "tutorials.html").read_text("utf-8")
    contents = re.search('<nav class="contents".*?</nav>', page, re.S)[0]
    links = re.findall(r'<a href="([^"]*)"', contents)
    first = ["index", "search", "tutorials", "gallery", "theory", "glossary", "symbols"]
    assert [link.removesuffix(".html") for link in links[:7]] == first
    assert contents.count("<details>") == 3
    problem = (folder / "problems" / "tube.html").read_text("utf-8")
    assert re.search(r"<details open><summary>Problems</summary>", problem)


def test_a_table_drawn_with_lines_keeps_its_lines():
    shown = docstring("States.\n\n===== =====\nstate where\n===== =====\ntaut  here\n===== =====\n\nEnd.")
    assert "<pre>===== =====\nstate where" in shown
    assert docstring(r"It is :math:`\tfrac12 \rho^2`.").startswith("<p>It is 1/2\u2009<i>ρ</i><sup>2</sup>")


def test_show_prints_what_the_page_has():
    facts = describe("tube")
    assert "second variation" in facts["weak_form"]
    assert facts["command"] == "./run solve tube --set alpha=0.1 --set delta1=1.1 --out tube.json"
    json.dumps(facts)


def test_the_picture_is_drawn_from_the_solution(readers):
    page = readers["problems/sphere.html"]
    assert page.tags.count("figure") == 1
    text = " ".join(" ".join(page.words).split())
    assert "P over lam, of this example" in text
    assert "Marked: limit point; limit point" in text


def test_the_gallery_has_every_script_and_the_pictures_of_those_that_ran(readers):
    page = readers["gallery.html"]
    text = " ".join(" ".join(page.words).split())
    assert page.tags.count("figure") == 1
    for name in scripts():
        assert f"{name}.py" in text
        assert f"examples/gallery/{name}.py" in text, "the text says how to run it"


def test_the_search_finds_sections_and_needs_no_server(folder, tmp_path):
    text = (folder / "search.html").read_text("utf-8")
    (data,) = re.findall(r'id="entries">(.*?)</script>', text, re.S)
    found = json.loads(data)
    assert {place.partition("#")[0] for _, place, _ in found} >= {
        "index.html",
        "problems/tube.html",
        "theory.html",
    }
    assert any(place.startswith("problems/tube.html") and "delta1" in words for _, place, words in found)
    try:
        browser()
    except EnvironmentLackError:
        pytest.skip("no Chromium or Chrome here; ./run test brings one")
    with Browser(tmp_path) as window:
        window.open(folder / "search.html", 1280, "light")
        ask = "(asked.value = {!r}, asked.dispatchEvent(new Event('input')), found.children.length)"
        assert window.evaluate(ask.format("limit_point tube")) > 0
        assert window.evaluate(ask.format("no-such-word-anywhere")) == 0
        assert window.complaints() == []


def test_a_script_that_fails_is_named_with_its_reason(tmp_path, monkeypatch):
    (tmp_path / "bad.py").write_text('"""Bad."""\nraise SystemExit("no such law")\n')
    monkeypatch.setattr("weakforms.docs.gallery.FOLDER", tmp_path)
    (shown,) = gallery(tmp_path / "out", ["bad"])
    assert (shown.title, shown.picture, shown.failure) == ("Bad.", None, "no such law")


def test_formulas_and_docstrings():
    assert "formula-line" in formula(r"\frac p2 \tfrac\gamma2 \int_0^1 \rho^2\,\mathrm dS \le \sqrt n")
    assert formula(r"\begin{pmatrix} a & <b> \end{pmatrix}").startswith('<pre class="tex">\\begin')
    text = docstring(
        """One ``a<b`` and :math:`\\lambda_1`, see :func:`~x.y`.

        .. math:: a = b

        Args:
            n: Number
                of things.
            m: More.

        Raises:
            ValueError: Never.
        """
    )
    assert "<code>a&lt;b</code>" in text
    assert "<i>λ</i><sub>1</sub>" in text
    assert "<code>y</code>" in text
    assert text.count("<dt>") == 3
    assert "<dd>Number" in text
    assert "formula-line" in text
    assert "∂<i>U</i>/∂<i>ψ</i>" in docstring(r":math:`\partial U/\partial\psi`")
    assert "<script" not in markdown("a <script>x</script> | b")
    assert 'href="other.html#x"' in markdown("[t](other.md#x)")


def test_pages_render_in_a_browser(folder, tmp_path):
    try:
        browser()
    except EnvironmentLackError:
        pytest.skip("no Chromium or Chrome here; ./run test brings one")
    with Browser(tmp_path) as window:
        for page in (
            "index.html",
            "problems/sphere.html",
            "problems/surface.html",
            "api/weakforms.html",
            "cases.html",
        ):
            for width, scheme in ((1280, "light"), (390, "dark")):
                window.open(folder / page, width, scheme)
                sizes = window.evaluate(SIZES)
                assert window.complaints() == []
                assert sizes["needed"] <= sizes["width"], page
                assert window.evaluate(CONTRASTS)[0][0] >= 4.5, (page, window.evaluate(CONTRASTS)[0])
                assert window.unnamed_images() == []


def test_signatures_are_as_written():
    member = api.modules("weakforms")[0]["members"]
    signatures = {entry["name"]: entry["signature"] for entry in member}
    assert re.match(r"\(problem: str, \*, at: States = \(\)", signatures["solve"])


def test_formulas_of_the_theory_are_numbered_in_order_and_drawn(folder):
    text = (site.ROOT / "docs/theory.md").read_text("utf-8")
    numbers = [int(n) for n in re.findall(r"\\tag\{(\d+)\}", text)]
    assert numbers == list(range(1, len(numbers) + 1))
    assert text.count("```math") == len(numbers)
    assert {int(n) for n in re.findall(r"equation \((\d+)\)", text)} <= set(numbers)
    page = (folder / "theory.html").read_text("utf-8")
    assert re.findall(r'class="number">\((\d+)\)<', page) == [str(n) for n in numbers]
    assert "language-math" not in page
    assert 'class="tex"' not in page, "a formula that cannot be drawn is shown as TeX"
    assert "$" not in re.sub(r"(?s)<(style|svg)\b.*?</\1>|<pre>.*?</pre>|<code>.*?</code>", "", page)


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("of $\\lambda_1$ here", "<i>λ</i><sub>1</sub>"),
        ("```math\na = b \\tag{7}\n```", '<span class="number">(7)</span>'),
        ("```\nrun $HOME and $PATH\n```", "run $HOME and $PATH"),
        ("it costs 5 $ or 6 $", "5 $ or 6 $"),
    ],
)
def test_markdown_has_formulas_and_leaves_dollars_of_commands(text, shown):
    assert shown in markdown(text)


@pytest.mark.parametrize("about", registry.abouts().values(), ids=lambda about: about.name)
def test_every_problem_has_an_example_and_names_the_functions_that_define_it(about):
    assert about.example, "its page has no picture"
    assert about.forms
    for place in about.forms:
        module, _, function = place.partition(":")
        found = import_module(f"weakforms.{module}")
        assert not function or callable(getattr(found, function)), place
