"""Outlines: what pictures and texts show, as plain text that is committed and compared.

A picture or a page has hundreds of details (line styles, sizes, places, words) that no statement of a test
names one by one. An outline lists them for a small prepared input. A change of one of them is a difference
to a committed file, which its author looks at. After a change that is meant, write all outlines again, or
those of some rooms of the tests::

    ./run shell -c 'python3 tests/outlines.py'
    ./run shell -c 'python3 tests/outlines.py pages results'
"""

import sys
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).resolve().parent
FILES = {
    "results/outlined_results.py": "results/outlines.txt",
    "pages/outlined_pages.py": "pages/outlines.txt",
    "verification/audit/outlined_audits.py": "verification/audit/outlines.txt",
    "problems/outlined_solves.py": "problems/outlines.txt",
}
"""Modules with a function ``sections``, and the files with what its texts should be."""

TITLE = "=== "


def number(value: float) -> str:
    """A number with five digits; what is only round-off is zero."""
    return "masked" if np.ma.is_masked(value) else f"{0.0 if abs(value) < 1e-14 else float(value):.5g}"


def numbers(values: Any) -> str:
    """All numbers of a short list; first, last, count and root mean square of a long one."""
    values = np.ma.array(values, dtype=float).ravel()
    if len(values) <= 12:
        return " ".join(map(number, values))
    ends = f"{number(values[0])} .. {number(values[-1])}"
    size = number(np.sqrt((values**2).mean()))
    return f"{ends}, {len(values)} numbers, {values.count()} shown, root mean square {size}"


def sizes(values: Any) -> str:
    """Numbers with three digits, because they depend on the sizes of letters."""
    return " ".join(f"{value:.3g}" for value in values)


def drawn(figure: Any) -> str:
    """The artists of a figure of matplotlib with their styles, places and texts."""
    lines = [f"figure {sizes(figure.get_size_inches())} {type(figure.get_layout_engine()).__name__}"]
    for axes in figure.axes:
        lines += [f"axes {numbers(axes.get_xlim())} by {numbers(axes.get_ylim())}"]
        if figure.get_layout_engine() is None:
            lines += [f"  place {sizes(axes.get_position().bounds)}"]
        lines += [f"  below the curves: {axes.get_axisbelow()}, title {axes.get_title('left')!r}"]
        lines += [f"  {name} {_axis(getattr(axes, name + 'axis'))}" for name in axes._axis_names]
        if axes.name == "3d":
            box = axes.get_box_aspect() / np.max(axes.get_box_aspect())
            lines += [f"  z {numbers(axes.get_zlim())} seen from {axes.elev} {axes.azim}, box {numbers(box)}"]
        lines += [f"  {text}" for line in axes.lines for text in _line(line)]
        lines += [f"  {_text(text)}" for text in axes.texts]
        lines += [f"  {_filled(filled)}" for filled in axes.collections]
        lines += [f"  {text}" for legend in filter(None, [axes.get_legend()]) for text in _legend(legend)]
    lines += [text for legend in figure.legends for text in _legend(legend)]
    return "\n".join(lines)


def _axis(axis: Any) -> str:
    """Label, scale and ticks of an axis, and its grid."""
    label, locator = axis.get_label(), axis.get_major_locator()
    grid = [f"{number(line.get_linewidth())} {line.get_color()}" for line in axis.get_gridlines()[:1]]
    kinds = [type(of).__name__ for of in (locator, axis.get_minor_locator(), axis.get_major_formatter())]
    ticks = [getattr(locator, name, None) for name in ("locs", "_nbins", "numticks")]
    look = f"{number(label.get_fontsize())} pad {number(axis.labelpad)}"
    return f"{axis.get_scale()} {label.get_text()!r} {look}, ticks {' '.join(kinds)} {ticks}, grid {grid}"


def _legend(legend: Any) -> Iterator[str]:
    box = legend.get_bbox_to_anchor()
    place = sizes(box.transformed(legend.figure.transFigure.inverted()).bounds)
    at = "" if legend.axes else f" at {place}, columns {legend._ncols}, {legend._loc}"
    yield f"legend, frame {legend.get_frame_on()}{at}"
    for text, line in zip(legend.get_texts(), legend.legend_handles, strict=True):
        yield f"  {text.get_text()!r} {number(text.get_fontsize())}"
        yield from (f"    {part}" for part in list(_line(line))[:-2])


def _line(line: Any) -> Iterator[str]:
    dashes = numbers(line._unscaled_dash_pattern[1] or ())
    name = line.get_label()
    yield (
        f"line {line.get_color()} {line.get_linestyle()} [{dashes}] {number(line.get_linewidth())} "
        f"alpha {line.get_alpha()} zorder {number(line.get_zorder())} {line.get_drawstyle()} "
        f"label {None if name.startswith('_') else repr(name)}"
    )
    if line.get_marker() not in ("None", "", None):
        face, size = line.get_markerfacecolor(), number(line.get_markersize())
        edge = f"{number(line.get_markeredgewidth())} {line.get_markeredgecolor()}"
        yield f"  mark {line.get_marker()!r} {size} edge {edge} face {face} every {line.get_markevery()}"
    yield f"  x {numbers(line.get_xdata())}"
    yield f"  y {numbers(line.get_ydata())}"


def _text(text: Any) -> str:
    point, of = getattr(text, "xy", ()), getattr(text, "anncoords", "")
    place = f"{numbers(text.get_position())} {numbers(point)} {of}"
    look = f"{text.get_ha()} {text.get_va()} {text.get_fontsize():.4g} {text.get_color()}"
    return f"text {text.get_text()!r} at {place}, {look}"


def _filled(filled: Any) -> str:
    if hasattr(filled, "_vec"):  # polygons in space, which have no place in the plane yet
        colours = f"{numbers(filled._facecolor3d)} edges {numbers(filled._edgecolor3d)}"
        return f"surface {numbers(filled._vec)}, {colours} {numbers(filled.get_linewidth())}"
    if not filled.get_paths():
        return "no area"
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
        if sys.argv[1:] and Path(name).parts[0] not in sys.argv[1:]:
            continue
        (HERE / name).write_text(written(import_module(Path(module).stem).sections()), "utf-8")
