"""Outlines: what pictures and texts show, as plain text that is committed and compared.

A picture or a page has hundreds of details (line styles, sizes, places, words) that no statement of a test
names one by one. An outline lists them for a small prepared input. A change of one of them is a difference
to a committed file, which its author looks at. After a change that is meant, write all outlines again::

    ./run shell -c 'python3 tests/outlines.py'
"""

import sys
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
FILES = {"results/outlined_results.py": "results/outlines.txt"}
"""Modules with a function ``sections``, and the files with what its texts should be."""

TITLE = "=== "


def number(value: float) -> str:
    """A number with five digits; what is only round-off is zero."""
    return "masked" if np.ma.is_masked(value) else f"{0.0 if abs(value) < 1e-12 else float(value):.5g}"


def numbers(values: Any) -> str:
    """All numbers of a short list; first, last, count and mean square of a long one."""
    values = np.ma.array(values, dtype=float).ravel()
    if len(values) <= 12:
        return " ".join(map(number, values))
    ends = f"{number(values[0])} .. {number(values[-1])}"
    return f"{ends}, {len(values)} numbers, {values.count()} shown, mean square {number((values**2).mean())}"


def drawn(figure: Any) -> str:
    """The artists of a figure of matplotlib with their styles, places and texts."""
    lines = [f"figure {numbers(figure.get_size_inches())} {type(figure.get_layout_engine()).__name__}"]
    for axes in figure.axes:
        lines += [f"axes {numbers(axes.get_xlim())} by {numbers(axes.get_ylim())}"]
        lines += [f"  below the curves: {axes.get_axisbelow()}"]
        lines += [f"  {name} label: {getattr(axes, f'get_{name}label')()!r}" for name in "xy"]
        lines += [f"  title: {axes.get_title('left')!r} {axes._left_title.get_fontsize():.4g}"]
        grids = [axis.get_gridlines()[0] for axis in (axes.xaxis, axes.yaxis)]
        lines += [f"  grid {number(line.get_linewidth())} {line.get_color()}" for line in grids]
        lines += [f"  {text}" for line in axes.lines for text in _line(line)]
        lines += [f"  {_text(text)}" for text in axes.texts]
        lines += [f"  {_filled(filled)}" for filled in axes.collections]
        legend = axes.get_legend()
        if legend is not None:
            lines += [f"  legend, frame {legend.get_frame_on()}"]
            lines += [f"    {text.get_text()!r} {text.get_fontsize():.4g}" for text in legend.get_texts()]
    return "\n".join(lines)


def _line(line: Any) -> Iterator[str]:
    dashes = numbers(line._unscaled_dash_pattern[1] or ())
    name = line.get_label()
    yield (
        f"line {line.get_color()} {line.get_linestyle()} [{dashes}] {number(line.get_linewidth())} "
        f"alpha {line.get_alpha()} label {None if name.startswith('_') else repr(name)}"
    )
    if line.get_marker() not in ("None", "", None):
        yield f"  mark {line.get_marker()!r} {line.get_markersize():.5g} edge {line.get_markeredgecolor()}"
    yield f"  x {numbers(line.get_xdata())}"
    yield f"  y {numbers(line.get_ydata())}"


def _text(text: Any) -> str:
    point, of = getattr(text, "xy", ()), getattr(text, "anncoords", "")
    place = f"{numbers(text.get_position())} {numbers(point)} {of}"
    look = f"{text.get_ha()} {text.get_va()} {text.get_fontsize():.4g} {text.get_color()}"
    return f"text {text.get_text()!r} at {place}, {look}"


def _filled(filled: Any) -> str:
    corners = np.concatenate([path.vertices for path in filled.get_paths()])
    extent = f"{numbers(corners.min(axis=0))} to {numbers(corners.max(axis=0))}"
    return f"area {numbers(filled.get_facecolor())} zorder {filled.get_zorder():.4g}: {extent}"


def stored(name: str) -> dict[str, str]:
    """The committed sections of a file by their titles."""
    parts = ("\n" + (HERE / name).read_text("utf-8")).split(f"\n{TITLE}")[1:]
    return {title: text.rstrip("\n") for title, _, text in (part.partition("\n") for part in parts)}


def written(sections: Mapping[str, Callable[[], str]]) -> str:
    """The text of a file."""
    return "".join(f"{TITLE}{title}\n{clean(make())}\n" for title, make in sections.items())


def clean(text: str) -> str:
    """A text without blanks at the ends of its lines."""
    return "\n".join(line.rstrip() for line in text.rstrip("\n").split("\n"))


if __name__ == "__main__":
    sys.path[:0] = [str(HERE.parent), str(HERE), *(str((HERE / module).parent) for module in FILES)]
    for module, name in FILES.items():
        (HERE / name).write_text(written(import_module(Path(module).stem).sections()), "utf-8")
