"""Docstrings, Markdown and formulas as self-contained HTML, without scripts and fonts."""

from __future__ import annotations

import hashlib
import html
import inspect
import re
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from markdown_it import MarkdownIt
from markupsafe import Markup
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from mdit_py_plugins.dollarmath import dollarmath_plugin

from weakforms.verification.report.figures.canvas import LETTERS, drawing, svg
from weakforms.verification.report.figures.svg import inline_svg
from weakforms.verification.report.look import LOOK
from weakforms.verification.report.wording import html_tex

FIGURE_COLOURS = {value: f"--f-{name}" for name, value in LOOK["light"].items()}
"""Variables for the colours of figures, which differ on dark pages."""

SIZE = 13.0
"""Font size of formulas in points; on the page they scale with the text."""
PLAIN = {
    r"\!": "",
    r"\Big": "",
    r"\big": "",
    r"\le": r"\leq",
    r"\ge": r"\geq",
    r"\text": r"\mathrm",
    r"\qquad": r"\quad\quad ",
    r"\oint": r"\int",
}
"""TeX that matplotlib does not know, with replacements that it knows."""
ARGUMENT = r"\s*(\{(?:[^{}]|\{[^{}]*\})*\}|\\[a-zA-Z]+|[^\s{}\\])"
FRACTION = re.compile(r"\\([td]?)frac(?![a-zA-Z])" + 2 * ARGUMENT)
"""A fraction with its arguments, in braces or not."""
SECTIONS = ("Args", "Returns", "Raises", "Attributes", "Yields", "Note", "Notes")
ROLE = re.compile(r":(?:py:)?(?:class|func|meth|mod|data|attr|exc|obj):`~?([^`]*)`")
CODE = re.compile(r"``([^`]+)``")
MATH = re.compile(r":math:`([^`]*)`", re.S)


def markdown(text: str) -> Markup:
    """Markdown with tables and formulas as HTML.

    Formulas stand between dollars, or as a block in ``math`` fences. Headings of alternatives
    (``=== Python``) become ordinary headings.
    """
    text = re.sub(r"(?m)^=== (.+)$", r"#### \1", text)
    parser = MarkdownIt("commonmark", {"html": False, "highlight": _highlighted}).enable("table")
    parser.use(dollarmath_plugin, allow_space=False, allow_digits=False, renderer=_short_or_long)
    rendered = parser.render(text)
    rendered = re.sub(
        r'<pre><code class="language-math">(<div.*?</div>)\s*</code></pre>', r"\1", rendered, flags=re.S
    )
    rendered = re.sub(
        r"<table>", '<div class="scroll" role="region" tabindex="0" aria-label="Table"><table>', rendered
    )
    rendered = rendered.replace("</table>", "</table></div>")
    return Markup(re.sub(r'<a href="(?!https?:|#)([^"]*?)\.md(#[^"]*)?"', r'<a href="\1.html\2"', rendered))


def _short_or_long(tex: str, options: Mapping[str, bool]) -> str:
    """A formula in a line of text, or in a line of its own."""
    return formula(tex) if options["display_mode"] else html_tex(f"${' '.join(tex.split())}$")


def _highlighted(code: str, language: str, _attributes: str) -> str:
    """A fenced block: a formula, or nothing, which leaves the code as it is."""
    return formula(code) if language == "math" else ""


def docstring(text: str | None) -> Markup:
    """A docstring as HTML: paragraphs, formulas, code, and the sections of Google's style."""
    if not text:
        return Markup("")
    out: list[str] = []
    for kind, block in _blocks(inspect.cleandoc(text)):
        if kind == "math":
            out.append(formula(block))
        elif kind == "code":
            out.append(f"<pre>{html.escape(block)}</pre>")
        elif kind in SECTIONS:
            out.append(_section(kind, block))
        elif block.lstrip().startswith(("* ", "- ")):
            items = re.split(r"(?m)^\s*[*-] ", block)[1:]
            out.append("<ul>" + "".join(f"<li>{_inline(item)}</li>" for item in items) + "</ul>")
        else:
            out.append(f"<p>{_inline(block)}</p>")
    return Markup("".join(out))


def _blocks(text: str) -> Iterable[tuple[str, str]]:
    """Paragraphs of a docstring, each with its kind."""
    paragraphs = re.split(r"\n\s*\n", text)
    at = 0
    while at < len(paragraphs):
        block = paragraphs[at]
        at += 1
        first, _, rest = block.partition("\n")
        if first.strip().startswith(".. math::"):
            lines = [first.partition("::")[2], rest]
            while at < len(paragraphs) and paragraphs[at].startswith("    ") and not rest.strip():
                lines.append(paragraphs[at])
                at += 1
            yield "math", "\n".join(lines)
        elif first.rstrip(":") in SECTIONS and first.endswith(":"):
            lines = [rest]
            while at < len(paragraphs) and paragraphs[at].startswith("    "):
                lines.append(paragraphs[at])
                at += 1
            yield first.rstrip(":"), inspect.cleandoc("\n".join(["", *lines]))
        elif block.startswith("    ") or re.match(r"\s*=+ +=+", block):  # a table drawn with lines
            yield "code", inspect.cleandoc("\n" + block)
        else:
            yield "text", block.removesuffix("::")


def with_pictures(page: Markup, folder: Path) -> Markup:
    """A page with its drawings as elements, so that it loads no file.

    Args:
        page: HTML from :func:`markdown`.
        folder: Folder of the SVG files.
    """

    def drawn(image: re.Match[str]) -> str:
        path, words = folder / image[1], html.unescape(image[2])
        return inline_svg(path.read_text("utf-8"), f"picture-{path.stem}", words, words, FIGURE_COLOURS)

    return Markup(re.sub(r'<img src="([\w-]+\.svg)" alt="([^"]*)" ?/?>', drawn, page))


def _section(name: str, text: str) -> str:
    items = re.findall(r"(?m)^([^\s:][^:\n]*):[ \n]((?:.*)(?:\n[ \t]+.*)*)", text)
    if name in ("Returns", "Yields", "Note", "Notes") or not items:
        return f'<p class="field"><b>{name}</b> {_inline(text)}</p>'
    rows = "".join(
        f"<div><dt><code>{html.escape(word)}</code></dt><dd>{_inline(what)}</dd></div>"
        for word, what in items
    )
    return f'<p class="field"><b>{name}</b></p><dl class="fields">{rows}</dl>'


def _inline(text: str) -> str:
    """Text with code, roles and short formulas."""
    kept: list[str] = []

    def keep(rendered: str) -> str:
        kept.append(rendered)
        return f"\x00{len(kept) - 1}\x00"

    text = MATH.sub(lambda hit: keep(html_tex(f"${' '.join(hit[1].split())}$")), text)
    text = ROLE.sub(lambda hit: keep(f"<code>{html.escape(hit[1].rpartition('.')[2])}</code>"), text)
    text = CODE.sub(lambda hit: keep(f"<code>{html.escape(hit[1])}</code>"), text)
    text = re.sub(r"`([^`]+)`", lambda hit: keep(f"<code>{html.escape(hit[1])}</code>"), text)
    text = re.sub(r"\*([^*\n]+)\*", r"\1", text)
    return re.sub(r"\x00(\d+)\x00", lambda hit: kept[int(hit[1])], html.escape(text, quote=False))


def formula(tex: str) -> str:
    r"""A displayed formula as pictures of its lines, with its TeX as text for screen readers.

    A number in ``\tag{}`` is shown beside it.
    """
    source, _, number = " ".join(tex.split()).partition(r"\tag")
    lines = [line.replace("&", " ").strip() for line in re.split(r"\\\\", source)]
    try:
        drawn = [_drawn(line) for line in filter(None, lines)]
    except (ValueError, RuntimeError):
        return f'<pre class="tex">{html.escape(source)}</pre>'
    shown = f'<span class="number">({html.escape(number.strip("{}"))})</span>' if number else ""
    return f'<div class="formula-block scroll-x">{"".join(drawn)}{shown}</div>'


def _braced(fraction: re.Match[str]) -> str:
    """A fraction with braces around its arguments, large unless it is to be small."""
    above, below = (part[1:-1] if part.startswith("{") else part for part in fraction.groups()[1:])
    size = "\\frac" if fraction[1] == "t" else "\\dfrac"
    return f"{size}{{{above}}}{{{below}}}"


@cache
def _drawn(tex: str) -> str:
    """A line of a formula as a picture, which has the same name wherever it is shown."""
    plain = tex
    for _ in range(3):  # fractions within fractions
        plain = FRACTION.sub(_braced, plain)
    plain = re.sub(r"\\(mathrm|sqrt) ?([a-zA-Z])(?![a-zA-Z]*\{)", r"\\\1{\2}", plain)
    for old, new in PLAIN.items():
        plain = re.sub(
            re.escape(old) + (r"(?![a-zA-Z])" if old[-1].isalpha() else ""), lambda _, n=new: n, plain
        )
    ident = "m" + hashlib.sha256(tex.encode()).hexdigest()[:12]
    with drawing(ident):
        font = FontProperties(family="serif", size=SIZE)
        # Measured as it will be drawn: at another size it would be set a second time.
        width, height, depth = LETTERS.get_text_width_height_descent(f"${plain}$", font, ismath=True)
        width, height = width + 4, height + 4
        figure = FigureCanvasAgg(Figure(figsize=(width / 72, height / 72))).figure
        figure.text(2 / width, (2 + depth) / height, f"${plain}$", fontproperties=font, va="baseline")
        picture = svg(figure, ident, "formula", tex)
    size = f"width:{width / SIZE:.2f}em;height:{height / SIZE:.2f}em"
    return picture.replace('class="figure"', f'class="formula-line" style="{size}"')
