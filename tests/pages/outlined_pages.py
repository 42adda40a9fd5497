"""What the pictures, pages and files of a prepared run show."""

import math
import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import cache
from io import StringIO
from unittest.mock import patch

import numpy as np
from canned_run import curve, failing_case, panel, passing_case, sample, surface, verdict
from outlines import drawn
from rich.console import Console

from weakforms.verification.judging.outcome import (
    CaseOutcome,
    CurveOutcome,
    Marker,
    PathOutcome,
    SurfaceOutcome,
)
from weakforms.verification.report import summary, wording
from weakforms.verification.report.case_views import panel_csv, surface_csv
from weakforms.verification.report.figures import convergence, surfaces, svg
from weakforms.verification.report.figures import panel as panels
from weakforms.verification.report.figures.canvas import as_math
from weakforms.verification.report.junit import junit_xml
from weakforms.verification.report.pages import render
from weakforms.verification.report.vtu import vtu


@contextmanager
def outlined() -> Iterator[None]:
    """Pictures are outlines, with the title and the description that a screen reader reads."""

    def outline(figure: object, ident: str, title: str, description: str) -> str:
        return f"{title}\n{description}\n{drawn(figure)}"

    with ExitStack() as patches:
        for module in (panels, convergence, surfaces):
            patches.enter_context(patch.object(module, "svg", outline))
        yield


def pictured(draw: Callable, *given: object) -> str:
    """The outline of a picture."""
    with outlined():
        shown = draw(*given)
    return shown if isinstance(shown, str) else shown.svg


def crowded():
    """More curves than colours, each with a part that is unstable twice, and a line across the panel."""
    many = [replace(curve(f"c{i}", 1.0 + i / 30), label=f"$n = {i}$") for i in range(9)]
    many = [replace(item, reference_x=[], reference_y=[], residual=[], residual_x=[]) for item in many]
    many[1].unstable = [0] * 20 + [2] * 20 + [1] * 10
    marks = [Marker("limit_point", f"$p_{i}$", 1.75 + i / 50, i / 3) for i in range(13)]
    path = PathOutcome(0.5, [1.8, 1.9], [1.0, 2.0])
    return replace(panel(many), markers=marks, dotted="twice unstable", level=2.5, paths=[path], title="")


def long_errors():
    """One curve with more rows than are drawn; rows beyond the bound, a zero, and one that is no number."""
    x = np.linspace(0.0, 4.0, 90)
    errors = (4e-9 * np.abs(np.sin(3 * x))).tolist()
    errors[10], errors[47] = 0.0, math.nan
    errors[3] = 8e-9
    of = curve("many", 1.0)
    rows = {"reference_x": x.tolist(), "reference_y": x.tolist(), "residual_x": x[::-1].tolist()}
    bounds = np.linspace(1e-9, 5e-9, 90).tolist()
    of = replace(of, **rows, residual=errors, residual_bound=bounds, residual_abscissa="p")
    return replace(panel([of]), x_range=(0.0, 3.0), markers=[])


def error_case():
    """A case that was not solved in full, and one that failed without a failed check."""
    return [
        CaseOutcome("paper4.a", "A", "fig. 1", "", "error", [verdict("a:p")], errors=["no state\nat p = 2"]),
        CaseOutcome("paper4.b", "B", "fig. 2", "", "failed", [verdict("b:p")], seconds=math.inf),
        CaseOutcome("paper4.c", "C", "", "", "error", []),
    ]


def whole_run():
    """The run of all these cases."""
    return sample(passing_case(), failing_case(), *error_case())


@cache
def rendered() -> dict[str, str]:
    """The pages of the run, without pictures."""
    with outlined():
        pages = render(whole_run())
    return {name: markup(text) for name, text in pages.items()}


def markup(page: str) -> str:
    """Tags and texts of a page, one a line, without style sheets and pictures."""
    page = re.sub(r"(?s)<(style|svg|script)\b.*?</\1>", r"<\1>", page)
    page = re.sub(r"(?s)<figure\b([^>]*)>.*?<figcaption", r"<figure\1><figcaption", page)
    lines = (" ".join(line.split()) for line in re.sub(r"(<[^>]*>)", r"\n\1\n", page).split("\n"))
    return "\n".join(line for line in lines if line and not re.fullmatch(r"</[^>]*>", line))


def printed(width: int, colour: bool) -> str:
    """What the terminal shows."""
    stream = StringIO()
    system = "truecolor" if colour else None
    console = Console(
        file=stream, width=width, color_system=system, force_terminal=colour, no_color=not colour
    )
    summary.print_summary(whole_run(), console)
    cases = whole_run().cases
    lines = [summary.case_line(case, place, len(cases)) for place, case in enumerate(cases, start=1)]
    return repr(stream.getvalue()).replace("\\n", "\n").replace("\\x1b", "ESC") + "\n" + "\n".join(lines)


NUMBERS = (
    *(None, math.nan, math.inf, -math.inf, 0.0, -2.5),
    *(4e-4, 5e-4, 0.25, 1.0, 1.0004, 1.0005, 9.9996, 10.0, 123.456),
)
SECONDS = (math.nan, 0.4321, 9.99, 9.995, 12.34, 59.94, 59.95, 61.0, 3599.4, 3600.0, 7805.0)
UNCERTAIN = [(1.162993, u) for u in (None, 0.0, 2e-5, 1.9e-5, 9.99e-4, 0.3, 2.0, 19.0, 3e-16)] + [(2e9, 3.0)]
NAMES = (
    "lam1_mid", "zw", "Af", "of", "LambdaV", "f_w", "t0", "delta", "gas_M_0.5_delta_2", "case2 3", "a b",
    "tube(alpha=0.1, u_end=5)", "tube_fold()", "u_max = 1.25", "$x_1$", "p_1 and $2", "alpha -2.5", "n 3 x",
)  # fmt: skip


def words() -> str:
    """Numbers, names and durations as the pages write them."""
    functions = (wording.order, wording.scientific, wording.signed, wording.fraction)
    lines = [f"{value}: {' | '.join(write(value) for write in functions)}" for value in NUMBERS]
    lines += [f"{seconds} s: {wording.duration(seconds)}" for seconds in SECONDS]
    lines += [f"{value} +- {u}: {wording.with_uncertainty(value, u)}" for value, u in UNCERTAIN]
    named = (wording.symbol, wording.typeset, wording.file_name)
    lines += [f"{name}: {' | '.join(write(name) for write in named)}" for name in NAMES]
    formulas = [wording.typeset(name) for name in NAMES] + [
        r"$\lambda_{1,\mathrm{mid}}^2 < \sqrt{3}\,x_1$ & y"
    ]
    lines += [f"{wording.plain_tex(text)} | {wording.html_tex(text)}" for text in formulas]
    long = ["x" * 80, "x" * 81, "$x$ and " + "y" * 90, "$\\nothing{$", "u_max = 2"]
    lines += [as_math(text) for text in long]
    taken: set[str] = set()
    lines += [wording.anchor(text, taken) for text in ("a b", "a b", "a-b", "", "-")]
    lines += [wording.plural(count, "check") for count in (0, 1, 2)] + [wording.scientific(1.23456, 4)]
    return "\n".join(lines)


DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
viewBox="0 0 9 9" width="9">
<metadata>m</metadata><defs><style>*</style></defs>
<g id="figure_1"><g id="patch_1"><path d="M 0 0 L 9 0" style="fill: none"/></g>
<g clip-path="url(#clip)">
<path d="M 1.256 2 L 3.5 4.75 L 3.5 4.75 L -1 -0.004 z" style="stroke: #123456"/></g>
<path d="M 1.2345 2 C 1 2.3456 3 4 5 6" transform="translate(1.23456 -0.001) scale(0.125 -0.12567)"/>
<g><defs><path id="mark" d="M 0 1 L 1 0" style="stroke: #abcdef"/>
<path id="other" d="M 0 0 L 2 2"/><path id="idle" d="M 0 0"/></defs>
<g>{five}</g></g>
<g>{three}</g><g>{styled}</g>
<g>{mixed}</g>
<g transform="translate(5.555 1)">
<defs><path id="STIXGeneral-Regular-41" d="M 1 1 L 2 2" transform="scale(0.1)"/></defs>
<use xlink:href="#STIXGeneral-Regular-41" transform="translate(0 0)"/>
<use xlink:href="#STIXGeneral-Regular-41" transform="translate(7.25 0)"/></g>
</g><defs><clipPath id="clip"><rect x="1.999" y="2" width="3" height="4"/></clipPath></defs></svg>"""


def vectors() -> str:
    """A small drawing with marks, letters and a clipped line, as it is put into a page."""
    use = '<use xlink:href="#mark" x="{0}.125" y="{0}"{1}/>'
    given = {
        "five": "".join(use.format(k, "") for k in range(5)),
        "three": "".join(use.format(k, "") for k in range(3)),
        "mixed": "".join(use.format(k, "").replace("mark", ("mark", "other")[k % 2]) for k in range(5)),
        "styled": "".join(use.format(k, ' style="fill: #123456; stroke: #ffffff"') for k in range(4)),
    }
    text = svg.inline_svg(DRAWING.format(**given), "f", "Title", "Words < 2", {"#123456": "--f-c0"})
    table = "<table><tr> <td>1</td> <td>2</td> </tr> </table>"
    page = svg.share_letters(f"<html><body class='b'>{table}{text} {text}</body></html>")
    return "\n".join(part.replace("><", ">\n<") for part in (text, svg.standalone(text), page))


def small_surface() -> SurfaceOutcome:
    """Two quadrilaterals."""
    x, y = np.meshgrid([0.0, 1.0, 2.5], [0.0, 1.0])
    position = [x.tolist(), y.tolist(), (x * y / 3).tolist()]
    return SurfaceOutcome("s", "", position, [(0, 1)] * 3, ["x"] * 3, fields={"lam1": (1 + x).tolist()})


def sections() -> dict[str, Callable[[], str]]:
    """Every outline of the report by its title."""
    case, bad = passing_case(), failing_case()
    flat = replace(surface(), fields={}, title="")
    empty: CurveOutcome = replace(curve("x", 1.0), reference_kind="", unstable=[])
    bare = replace(panel([empty]), x_range=(math.nan, 1.0), y_range=(1.0, 1.0), markers=[])
    return {
        "a panel": lambda: pictured(panels.panel_picture, case.panels[0], "f", case.verdicts),
        "failed checks": lambda: pictured(panels.panel_picture, bad.panels[0], "f", bad.verdicts),
        "a panel without curves": lambda: pictured(panels.panel_picture, case.panels[1], "f"),
        "a panel without ranges": lambda: pictured(panels.panel_picture, bare, "f"),
        "a crowded panel": lambda: pictured(panels.panel_picture, crowded(), "f"),
        "a panel with many errors": lambda: pictured(panels.panel_picture, long_errors(), "f"),
        "orders of convergence": lambda: pictured(convergence.convergence_figure, case.convergence, "f"),
        "a surface": lambda: pictured(surfaces.surface_picture, surface(), "f"),
        "a surface without a field": lambda: pictured(surfaces.surface_picture, flat, "f"),
        "a drawing in a page": vectors,
        "words": words,
        "junit.xml": lambda: junit_xml(whole_run()),
        "a shape": lambda: vtu(small_surface()),
        "numbers of a surface": lambda: surface_csv(small_surface()),
        "numbers of a panel": lambda: panel_csv(replace(bad.panels[0], curves=[bad.panels[0].curves[0]])),
        "a wide terminal": lambda: printed(110, True),
        "a narrow terminal": lambda: printed(60, False),
        "index.html": lambda: rendered()["index.html"],
        "paper2.html": lambda: rendered()["paper2.html"],
    }
