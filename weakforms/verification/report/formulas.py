"""Formulas written in plain characters, ``int_0^L eta W ds`` or ``lam2 = lam1^(-1/2)``, as HTML."""

from __future__ import annotations

import html
import re

from weakforms.problems.registry import symbol as declared
from weakforms.verification.report.junit import clean
from weakforms.verification.report.wording import GREEK, html_tex, symbol

PAIRS = ("Af", "Ao", "Lx", "gw", "lf", "zw")
"""Symbols of two letters; other pairs are words, such as ``of``."""
LIMIT = r"(\{[^{}]*\}|[A-Za-z0-9]+)"
TOKEN = re.compile(
    rf"int_{LIMIT}\^{LIMIT}"
    r"|\^(\([^()]*\)|\{[^{}]*\}|-?[A-Za-z0-9.]+)"  # a power
    r"|(?<=\))_([A-Za-z0-9]+)"  # an index of brackets
    r"|(?<!\w)(oint|int|sqrt(?=\())(?!\w)|([<>]=| - )|\b[ei]\.[eg]\.|(?<!\w)\([a-h]\)"
    r"|(?<![\w'])(?<!\d-)([A-Za-z]+\d*(?:_[A-Za-z0-9]+)*)('*)(?![A-Za-z0-9_]|\.\d)"  # a word or a symbol
)
SIGNS = {"oint": "∮", "int": "∫", "sqrt": "√", "<=": "≤", ">=": "≥", " - ": " − "}
DIFFERENTIAL = re.compile(rf"d((?:[xtsrpuUARSVXYZ]|{'|'.join(GREEK.split())})\d*(?:_[a-z]+)?)")
INDEXED = re.compile(rf"(?:{'|'.join((*GREEK.split(), *PAIRS))}|[A-Za-z])\d*(?:_[A-Za-z0-9]+){{0,2}}")
"""A letter, or a known pair, with numbers and up to two indices; names of tables have more."""
NO_ARTICLE = re.compile(r"\s*(?:[\^=/,;:).\]+*-]|$)|\s+(?:is|and|or|in)\b|\s+[A-Z]\b")
"""What follows the symbols ``a`` and ``A``, but not the article."""


def html_formula(text: str) -> str:
    """Text with formulas in plain characters as safe HTML: italics, Greek, sub- and superscripts.

    Formulas between dollars are TeX. Words stay as they are: a name is a symbol only if it is a letter,
    spelled Greek, or a known pair of letters, with or without numbers and indices.
    """
    parts = re.split(r"(\$[^$]*\$)", clean(text))
    return "".join(html_tex(part) if part.startswith("$") else _plain(part) for part in parts)


def svg_formula(text: str) -> str:
    """The same for a text of a drawing."""
    drawn = re.sub("<i>(.*?)</i>", r'<tspan font-style="italic">\1</tspan>', html_formula(text))
    # What follows an index returns to the line; a space without width carries the step if nothing does.
    low = r'<tspan dy="3" font-size="75%">\1</tspan><tspan dy="-3">&#8203;</tspan>'
    return re.sub("<sub>(.*?)</sub>", low, drawn)


def _plain(text: str) -> str:
    """The same without TeX."""
    out, at = [], 0
    for token in TOKEN.finditer(text):
        out += [html.escape(text[at : token.start()], quote=False), _token(token)]
        at = token.end()
    return "".join([*out, html.escape(text[at:], quote=False)])


def _token(token: re.Match[str]) -> str:
    """One match of TOKEN."""
    low, high, power, index, operator, sign, name, primes = token.groups()
    if low:
        return f"∫<sub>{_plain(low.strip('{}'))}</sub><sup>{_plain(high.strip('{}'))}</sup>"
    if power:
        inner = power[1:-1] if power[0] in "({" else power
        return f"<sup>{_plain(inner).replace('-', '−')}</sup>"
    if index:
        return f"<sub>{index}</sub>"
    if name:
        return _name(name, token.string, token.start(), token.end()) + "′" * len(primes)
    return SIGNS.get(operator or sign, html.escape(token[0], quote=False))


def _name(name: str, text: str, start: int, end: int) -> str:
    """A name as a symbol, if it is one."""
    if variable := DIFFERENTIAL.fullmatch(name):
        return "d" + html_tex(symbol(variable[1]))
    if not INDEXED.fullmatch(name):
        return name
    before = text[:start].rstrip()
    if name in ("a", "A", "I") and not (before.endswith(("=", "/", "^")) or NO_ARTICLE.match(text, end)):
        return name
    return html_tex(declared(name) or symbol(name))
