"""What every figure of the report is drawn on: style, axes, text and the files that come of it.

Text is drawn as paths, so that it looks the same everywhere. Colours are CSS variables with light colours as
default.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from io import BytesIO, StringIO

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser
from matplotlib.textpath import TextToPath

from weakforms.verification.report.figures.svg import inline_svg
from weakforms.verification.report.junit import clean
from weakforms.verification.report.look import LEFT, LOOK, RIGHT
from weakforms.verification.report.wording import plain_tex, typeset

INK, MUTED = LOOK["light"]["ink"], LOOK["light"]["muted"]
FOOT = 0.5
"""Room below axes, in inches."""
MARKERS = LOOK["markers"]
PALETTE = [colour for name, colour in LOOK["light"].items() if name[1:].isdigit()]
KINDS = list(zip(PALETTE * len(MARKERS), MARKERS * len(PALETTE), strict=True))
"""Colours and markers of curves, so that colour alone never carries information."""
DASHED, DOTTED = (0, (4, 2)), (0, (1, 1.5))
LETTERS = TextToPath()
"""Sets every text and formula once; each renderer of matplotlib would begin with nothing."""


@dataclass(frozen=True)
class Picture:
    """A drawing for a page, and the same for print."""

    svg: str
    """An ``<svg>`` element."""
    pdf: bytes = b""
    """A file, if it was asked for."""


class Pen(RendererSVG):
    """Draws or measures a figure of 72 dots an inch."""

    def __init__(self, width: float, height: float, stream: StringIO) -> None:
        super().__init__(width, height, stream)
        self._text2path = LETTERS


@contextmanager
def drawing(ident: str) -> Iterator[None]:
    """Context with the style of the report, without warnings about missing glyphs."""
    style = ["default", LOOK["style"] | {"svg.hashsalt": ident}]
    with matplotlib.style.context(style), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


def svg(figure: Figure, ident: str, title: str, description: str) -> str:
    """The figure as an ``<svg>`` element with a title, a description and the colours of the page."""
    buffer = StringIO()
    for part in (figure, *figure.axes):
        part.patch.set(facecolor="none", edgecolor="none")
    pen = Pen(*figure.bbox.size, buffer)
    figure.draw(pen)
    pen.finalize()
    colours = {value: f"--f-{name}" for name, value in LOOK["light"].items()}
    return inline_svg(buffer.getvalue(), ident, title, description, colours)


def pdf(figure: Figure, title: str) -> bytes:
    """The figure as a file for papers, the same at every run."""
    buffer = BytesIO()
    facts = {"CreationDate": None, "Title": clean(title)}
    figure.savefig(buffer, format="pdf", transparent=True, metadata=facts)
    return buffer.getvalue()


@cache
def as_math(text: str) -> str:
    """Text for a figure: TeX between dollars if matplotlib can set it, else the plain text."""
    text = typeset(" ".join(clean(text).split()))
    try:
        MathTextParser("path").parse(text)
    except (ValueError, RuntimeError):
        text = text.replace("$", r"\$")
    return text if len(text) <= 80 else plain_tex(text)[:60].replace("$", r"\$") + "…"


def new_ruler(figure: Figure) -> Pen:
    """Measures text as it will be drawn, in points; it draws nothing."""
    return Pen(*figure.bbox.size, StringIO())


def new_axes(figure: Figure, bottom: float, height: float, x: str = "", y: str = "") -> Axes:
    """Axes between the margins of a figure, with their height and distance from its foot in inches."""
    width, total = figure.get_size_inches()
    inner = width - LEFT - RIGHT
    axes = figure.add_axes((LEFT / width, bottom / total, inner / width, height / total))
    axes.set(xlabel=x, ylabel=y)
    axes.yaxis.set_label_coords(-0.46 / inner, 0.5)
    return axes


def clear_label(axes: Axes) -> None:
    """Move the label of the vertical axis away from its numbers, as far as the margin has room."""
    figure = axes.figure
    ruler, shown = new_ruler(figure), [text for text in axes.get_yticklabels() if text.get_text()]
    numbers = max((text.get_window_extent(ruler).width for text in shown), default=0.0) / figure.dpi
    inner = figure.get_size_inches()[0] - LEFT - RIGHT
    axes.yaxis.set_label_coords(-min(max(0.46, numbers + 0.19), LEFT - 0.08) / inner, 0.5)


def as_columns(*columns: Sequence[float]) -> list[np.ndarray]:
    """Columns as arrays, as long as the shortest of them."""
    rows = min(map(len, columns))
    return [np.asarray(column[:rows], float) for column in columns]


def floor_of(values: Iterable[float]) -> float:
    """The position of a zero on a logarithmic axis: a decade below everything else."""
    positive = [value for value in values if 0 < value < math.inf]
    return 10.0 ** (math.floor(math.log10(min(positive))) - 1) if positive else 1e-17
