"""The pages: guides from the folder ``docs``, one page for each problem, the cases, the API."""

from __future__ import annotations

import inspect
import re
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import ChoiceLoader, Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from weakforms.docs import api
from weakforms.docs.gallery import gallery, scripts
from weakforms.docs.pictures import pictures
from weakforms.docs.prose import docstring, formula, markdown, with_pictures
from weakforms.docs.search import SCRIPT, entries, policy
from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.results import write_atomically
from weakforms.results.io import require_writable
from weakforms.solvers.support.provenance import revision
from weakforms.terminal import WorkProgress
from weakforms.verification.cases import examples
from weakforms.verification.cases.catalogue import describe
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.cases.references import ROOT
from weakforms.verification.report.formulas import html_formula
from weakforms.verification.report.look import LOOK, TEMPLATES
from weakforms.verification.report.wording import html_tex, symbol

FIRST = ("tutorials", "theory", "glossary")
"""Guides for a newcomer, which come before the others."""
VARIATIONS = (
    r"\delta\Pi(u; v) = \frac{\mathrm{d}}{\mathrm{d}\epsilon} \Pi(u + \epsilon v) \,|_{\epsilon = 0} = 0, "
    r"\quad K(u; v, w) = \frac{\mathrm{d}}{\mathrm{d}\epsilon} "
    r"\delta\Pi(u + \epsilon w; v) \,|_{\epsilon = 0}"
)


def write_docs(out: Path, jobs: int = 1, solve: bool = True, progress: WorkProgress | None = None) -> Path:
    """Write the documentation as static pages.

    Args:
        out: Folder; created if missing. Solutions for the pictures are stored in ``out/solutions``.
        jobs: Number of processes that solve at the same time.
        solve: Whether to solve the problems' examples for their pictures.
        progress: Called with what is being solved.

    Returns:
        The path of the first page.

    Raises:
        InputError: If the folder cannot be written to.
    """
    for folder in (out, out / "problems", out / "api"):
        require_writable(folder)
    names = list(registry.abouts())
    drawn = pictures(out / "solutions", jobs, names, progress) if solve else {}
    site = Site(out, names)
    for name in names:
        site.problem(registry.get(name), *drawn.get(name, (None, "")))
    for group, title in api.GROUPS.items():
        site.write(
            f"api/{group}.html", "api.html", f"{group}", "API", about=title, modules=api.modules(group)
        )
    site.write("symbols.html", "symbols.html", "Symbols", "Guide", symbols=_symbols())
    site.write("cases.html", "cases.html", "Cases", "Documentation", cases=find_cases())
    if scripts():
        shown = gallery(out / "gallery", scripts() if solve else (), progress)
        site.write("gallery.html", "gallery.html", "Gallery", "Guide", scripts=shown)
    for path in site.guides:
        site.guide(path)
    site.home()
    site.search()
    return out / "index.html"


class Site:
    """Writes pages with the same layout that link to each other.

    Args:
        out: Folder.
        names: Problems.
    """

    def __init__(self, out: Path, names: list[str]) -> None:
        self.out = out
        self.written: dict[str, str] = {}
        """Pages by file name."""
        self.guides = [*sorted((ROOT / "docs").glob("*.md")), *ROOT.glob("CONTRIBUTING.md")]
        first = [(_title(p), f"{p.stem}.html") for p in self.guides if p.stem in FIRST]
        first.sort(key=lambda link: FIRST.index(link[1].removesuffix(".html")))
        shown = [("Gallery", "gallery.html")] * bool(scripts())
        home = (("Home", "index.html"), ("Search", "search.html"))
        self.contents = [
            ("", [*home, *first[:1], *shown, *first[1:], ("Symbols", "symbols.html")]),
            ("Guides", [(_title(p), f"{p.stem}.html") for p in self.guides if p.stem not in FIRST]),
            ("Problems", [(name, f"problems/{name}.html") for name in names]),
            ("Reference", [("cases", "cases.html"), *((g, f"api/{g}.html") for g in api.GROUPS)]),
        ]
        here = Path(__file__).parent / "templates"
        self._environment = Environment(
            loader=ChoiceLoader([FileSystemLoader(here), FileSystemLoader(TEMPLATES)]),
            autoescape=True,
            undefined=StrictUndefined,
            trim_blocks=True,
            lstrip_blocks=True,
        )
        self._environment.filters["tex"] = lambda text: Markup(html_tex(text))
        self._environment.filters["formula"] = lambda text: Markup(html_formula(text))

    def write(self, page: str, template: str, title: str, section: str, **facts: Any) -> None:
        """Write one page."""
        text = self._environment.get_template(template).render(
            title=title,
            section=section,
            contents=self.contents,
            here=page,
            up="../" * page.count("/"),
            look=LOOK,
            version=revision(),
            **{"policy": ""} | facts,
        )
        self.written[page] = text
        write_atomically(self.out / page, text)

    def home(self) -> None:
        """The first page: the text of the README without its picture."""
        text = (ROOT / "README.md").read_text("utf-8") if (ROOT / "README.md").exists() else ""
        text = re.sub(r"(?m)^!\[.*\n(\n\*.*(?:\n.+)*)?", "", text.partition("\n")[2])
        text = text.replace("](docs/", "](")
        self.write("index.html", "docs.html", "weakforms", "Documentation", body=self._prose(text))

    def search(self) -> None:
        """The page that searches all pages written so far."""
        found = Markup(entries(self.written))
        self.write(
            "search.html",
            "search.html",
            "Search",
            "Guide",
            entries=found,
            script=Markup(SCRIPT),
            policy=policy(),
        )

    def guide(self, path: Path) -> None:
        """A page of the folder ``docs``."""
        text = path.read_text("utf-8")
        body = with_pictures(self._prose(re.sub(r"\A# .*\n", "", text)), path.parent)
        self.write(f"{path.stem}.html", "docs.html", _title(path), "Guide", body=body)

    def _prose(self, text: str) -> Markup:
        """Markdown; links to files that have no page here become plain text."""
        known = "|".join(re.escape(f"{path.stem}.html") for path in self.guides)
        link = re.compile(rf'<a href="(?!https?:|#|(?:{known})[#"])[^"]*">(.*?)</a>', re.S)
        return Markup(link.sub(r"\1", markdown(text)))

    def problem(self, problem: Any, picture: Markup | None, caption: str) -> None:
        """The page of a problem, with the same facts that ``weakforms show`` prints."""
        name, about = problem.name, problem.about
        forms = [
            (place, docstring(inspect.getdoc(what)), source)
            for place, what, source in examples.written_forms(about)
        ]
        self.write(
            f"problems/{name}.html",
            "problem.html",
            about.title,
            "Problems",
            facts=describe(name),
            paper=about.paper,
            unknown=about.unknown,
            weak=Markup(formula(VARIATIONS)),
            forms=forms,
            about=docstring(sys.modules[type(problem).__module__].__doc__),
            picture=picture,
            caption=caption,
            cases=_cases_of(name),
        )


def _symbols() -> dict[tuple[str, str, str], list[str]]:
    """The problems that have a number, by its symbol, name and meaning, in the order of the alphabet."""
    found: dict[tuple[str, str, str], list[str]] = {}
    for about in registry.abouts().values():
        for name, meaning in about.scales.items():
            found.setdefault((registry.symbol(name) or symbol(name), name, meaning), []).append(about.name)
    return dict(sorted(found.items(), key=lambda item: (item[0][1].lower(), item[0])))


def _title(path: Path) -> str:
    first = path.read_text("utf-8").partition("\n")[0]
    return first.removeprefix("# ").strip() or path.stem


@cache
def _problems_of_cases() -> dict[str, set[str]]:
    """The problems that each case solves; none for a case whose tables cannot be read."""
    from weakforms.verification.run.plan import case_wants

    out = {}
    for found in find_cases():
        with suppress(InputError):
            out[found.id] = {spec.problem for spec, _ in case_wants(found)}
    return out


def _cases_of(problem: str) -> list[tuple[str, str]]:
    """Ids and titles of the cases that solve a problem."""
    solved = _problems_of_cases()
    return [(found.id, found.case.title) for found in find_cases() if problem in solved.get(found.id, ())]
