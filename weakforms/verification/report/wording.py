"""Numbers, formulas, names and durations as text: what report, terminal and other pages write alike."""

from __future__ import annotations

import html
import math
import re
from itertools import chain, count

from weakforms.verification.report.junit import clean


def plain_tex(text: str) -> str:
    r"""TeX between dollars as plain Unicode: ``$\delta_1 = 1$`` becomes ``δ1 = 1``."""
    return re.sub(r"\$([^$]*)\$", lambda hit: re.sub(r"[{}^_]", "", _symbols(hit[1])), clean(text))


GREEK = "alpha beta gamma delta eta kappa lam mu rho sigma theta phi psi chi pi Lambda Pi Theta Phi Psi"
"""Names of numbers that begin with a Greek letter; ``lam`` is lambda."""
NAMED = re.compile(
    rf"({'|'.join(GREEK.split())}|[A-Za-z]{{1,2}})((?<=[a-z]{{3}})[A-Z]|\d*)((?:_[A-Za-z0-9]+)*)"
)
"""A name as a symbol: a letter, a number (after LambdaV a capital), and words or numbers after underlines."""
LINES = {
    "fold": "limit point",
    "mirror": "mirror breaking",
    "localisation": "long waves",
    "wrinkling": "first wrinkling",
    "contact": "first contact",
}
"""Conditions on whose lines two at once hold, or that turn, at a special point."""
WORDS = {"of", "in", "at", "to", "is", "or", "no", "on", "an", "as", "by"}
"""Words that look like symbols."""


def symbol(name: str) -> str:
    r"""A raw name of a number as TeX: ``lam1_mid`` becomes ``$\lambda_{1,\mathrm{mid}}$``."""
    found = NAMED.fullmatch(name)
    if not found or found[1] in WORDS:
        return name
    letter, number, rest = found.groups()
    stem = "\\" + {"lam": "lambda"}.get(letter, letter) if letter in GREEK.split() else letter
    if len(letter) == 2 and letter not in GREEK.split():  # zw, Af
        stem, number = letter[0], letter[1] + number
    parts = [number] * bool(number) + [_index(p) for p in rest.split("_")[1:]]
    return f"${stem}_{{{','.join(parts)}}}$" if parts else f"${stem}$"


def _index(word: str) -> str:
    """An index of a symbol: a letter, Greek or not, or a word."""
    if word in GREEK.split():
        return "\\" + {"lam": "lambda"}.get(word, word)
    return word if len(word) < 2 else rf"\mathrm{{{word}}}"


def kind_of_point(kind: str) -> str:
    """A kind of special points in words: ``fold_n1`` is a limit point and a bifurcation with one wave."""

    def line(word: str) -> str:
        waves = re.fullmatch(r"n(\d+)", word)
        return f"$n = {waves[1]}$" if waves else LINES.get(word, "")

    first, _, second = kind.partition("_")
    if first == "tip" and line(second):
        return f"turn of {line(second)}"
    if line(first) and line(second):
        return f"{line(first)} and {line(second)}"
    if first == "bifurcation" and second not in LINES and line(second):
        return f"{first}, {line(second)}"
    return kind.replace("_", " ")


def typeset(text: str) -> str:
    """Text with raw names and their values as TeX: ``gas_M_0.5_delta_2`` is gas, M = 0.5, delta = 2.

    Text that has TeX already stays as it is.
    """
    if "$" in text or not text:
        return text
    if " = " in text:
        return re.sub(r"\b([A-Za-z]\w*) = ", lambda hit: f"{symbol(hit[1])} = ", text)
    call = re.fullmatch(r"(\w+)\((.*)\)", text)
    if call:
        listed = re.sub(r"(\w+)=", lambda hit: f"{symbol(hit[1])} = ", call[2])
        return f"{call[1].replace('_', ' ')}: {listed}" if listed else call[1].replace("_", " ")
    if not re.search(r"[ _]-?\d", text):
        return symbol(text)
    out: list[str] = []
    for word in re.split(r"[ _]", text):
        number = re.fullmatch(r"-?\d+(\.\d+)?", word)
        if number and out and NAMED.fullmatch(out[-1]):
            out[-1] = f"{symbol(out[-1])} = {word}"
        else:  # case2 is case 2
            out.append(word if NAMED.fullmatch(word) else re.sub(r"^([a-z]{3,})(\d+)$", r"\1 \2", word))
    return ", ".join(out) if any("$" in part for part in out) else text


def html_tex(text: str) -> str:
    """Any text as safe HTML; TeX between dollars becomes italics, Greek, sub- and superscripts."""
    parts = re.split(r"\$([^$]*)\$", clean(text))
    parts[::2] = [html.escape(part) for part in parts[::2]]
    for index in range(1, len(parts), 2):
        math_part = html.escape(_symbols(parts[index]), quote=False)
        math_part = re.sub(r"(?<![A-Za-zα-ω])([A-Za-zα-ω])(?![A-Za-z;])", r"<i>\1</i>", math_part)
        for sign, tag in (("_", "sub"), ("\\^", "sup")):
            pattern = sign + r"(?:\{([^{}]*)\}|(<i>.</i>|[^<\s]))"
            math_part = re.sub(pattern, lambda hit, tag=tag: f"<{tag}>{hit[1] or hit[2]}</{tag}>", math_part)
        parts[index] = re.sub("[{}]", "", math_part)
    return "".join(parts)


def _symbols(tex: str) -> str:
    tex = re.sub(r"\\(mathrm|text|mathit)\{([^{}]*)\}", r"\2", tex)
    tex = re.sub(r"\\[,;: ]|~", "\u2009", re.sub(r"\\(mathrm|text|mathit|left|right)\b", "", tex))
    tex = re.sub(r"\\[td]?frac\s*(\{[^{}]*\}|\w)\s*(\{[^{}]*\}|\w)\s*", "\\1/\\2\u2009", tex)
    tex = re.sub(r"\\partial ?", "∂", tex.replace("\\sqrt", "√"))
    named = re.sub(r"\\([A-Za-z]+)", lambda hit: html.unescape(f"&{hit[1]};").strip("&;"), tex)
    return named.replace("\\", "")


def order(value: float | None) -> str:
    """An order of convergence: ``3.98``, or a dash."""
    return "–" if value is None or not math.isfinite(value) else f"{value:.2f}"


def plural(count: int, noun: str) -> str:
    """``1 check``, ``2 checks``."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def scientific(value: float | None, digits: int = 2) -> str:
    """A relative error as text: ``3.2e-10``; an exact zero is ``0``."""
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    return "0" if value == 0 else f"{value:.{digits - 1}e}"


def signed(value: float | None) -> str:
    """A relative error with its sign: ``+3.2e-10``."""
    text = scientific(value)
    return f"+{text}" if value is not None and value > 0 else text


def fraction(value: float | None) -> str:
    """A ratio as text: at most three decimals, large ones rounded."""
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞"
    if 0 < value < 0.0005 or 1 < value < 1.0005:
        return "<0.001" if value < 1 else ">1.000"
    return f"{value:.3f}" if value < 10 else f"{value:.3g}"


def with_uncertainty(value: float | None, uncertainty: float | None) -> str:
    """A value with the digits that its uncertainty justifies: ``1.16299 ± 2e-05``."""
    if value is None or not math.isfinite(value):
        return "–"
    if not uncertainty or not math.isfinite(uncertainty):
        return f"{value:.12g}"
    places = -math.floor(math.log10(abs(uncertainty)))
    if abs(uncertainty) * 10.0**places < 2:
        places += 1
    if places > 15 or abs(value) >= 1e9:
        return f"{value:.12g} ± {uncertainty:.0e}"
    return f"{round(value, places):.{max(places, 0)}f} ± {uncertainty:.0e}"


def duration(seconds: float) -> str:
    """``0.43 s``, ``12 s``, ``3 min 05 s``, ``2 h 10 min``."""
    if not math.isfinite(seconds):
        return "–"
    if seconds < 59.95:
        return f"{seconds:.2f} s" if seconds < 9.995 else f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {rest:02d} s"


def file_name(text: str) -> str:
    """The text as part of a file name, which may have 255 characters."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "-", text).strip("-.").replace(".", "_")[:100] or "item"


def anchor(text: str, taken: set[str]) -> str:
    """A unique identifier from a text."""
    stem = re.sub(r"[^\w.:-]+", "-", clean(text), flags=re.ASCII).strip("-") or "item"
    return unused(stem, taken)


def unused(stem: str, taken: set[str]) -> str:
    """The stem, followed by a number if it is taken."""
    name = next(n for n in chain([stem], (f"{stem}-{k}" for k in count(2))) if n not in taken)
    taken.add(name)
    return name
