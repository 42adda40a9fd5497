"""One picture for each problem, drawn from the solution of its example."""

from __future__ import annotations

from pathlib import Path

from markupsafe import Markup

from weakforms.problems.about import Example
from weakforms.problems.registry import abouts
from weakforms.results import Branch, Result
from weakforms.terminal import WorkProgress
from weakforms.verification.cases import examples
from weakforms.verification.cases.specs import Spec
from weakforms.verification.judging.outcome import CurveOutcome, Marker, PanelOutcome
from weakforms.verification.report.figures.panel import panel_figure
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.solving import Solver

MARGIN = 0.05
"""Fraction of an axis's length that stays empty at each end."""


def pictures(
    folder: Path, jobs: int, names: list[str], progress: WorkProgress | None
) -> dict[str, tuple[Markup | None, str]]:
    """Pictures and captions by problem; where the example cannot be solved, the caption says why.

    Args:
        folder: Folder in which solutions are stored, so that the same code need not compute them again.
        jobs: Number of processes that solve at the same time.
        names: Problems.
        progress: Called with what is being solved.
    """
    shown = {name: abouts()[name].example for name in names}
    specs = {name: examples.specs(abouts()[name]) for name in names if shown[name]}
    plan = Plan({spec: [] for of in specs.values() for spec in of}, {})
    folder.mkdir(parents=True, exist_ok=True)
    solver = Solver(folder, jobs, resume=True)
    solver.run(plan, progress)
    out: dict[str, tuple[Markup | None, str]] = {}
    for name, of in specs.items():
        missing = [f"{spec}: {solver.failures[spec]}" for spec in of if spec in solver.failures]
        if missing:
            out[name] = None, f"No picture: {missing[0]}"
            continue
        panel = _panel(name, shown[name], of, [solver.results[spec] for spec in of])
        out[name] = Markup(panel_figure(panel, f"picture-{name}")), _caption(shown[name])
    return out


def _caption(shown: Example) -> str:
    coarse = ", ".join(f"{key} = {value}" for key, value in shown.numerics.items())
    what = f"{shown.y} over {shown.x}" + (
        ", one mark for each solution" if shown.values else ", of this example"
    )
    return f"Drawn: {what}" + (f" ({coarse})." if coarse else ".")


def _panel(name: str, shown: Example, specs: list[Spec], results: list[Result]) -> PanelOutcome:
    """Branches with their special points, or the quantity over the parameter."""
    if shown.values:
        x = list(shown.values)
        y = [float(result.quantities[shown.y].value) for result in results]
        markers = [Marker("solution", "", a, b) for a, b in zip(x, y, strict=True)]
        curves = [CurveOutcome(name, name, x, y, [])]
    else:
        (result,) = results
        drawn = [branch for branch in result.branches if {shown.x, shown.y} <= set(branch.columns)]
        named = {branch.name: branch.name if len(drawn) > 1 else str(specs[0]) for branch in drawn}
        curves = [_curve(name, named[branch.name], branch, shown) for branch in drawn]
        markers = [
            Marker(point.kind, point.kind.replace("_", " "), point.values[shown.x], point.values[shown.y])
            for point in result.special_points
            if point.branch in named and {shown.x, shown.y} <= set(point.values)
        ]
    ranges = [_range([v for curve in curves for v in getattr(curve, axis)]) for axis in "xy"]
    return PanelOutcome(
        name, f"{shown.y} over {shown.x}", shown.x, shown.y, shown.x, shown.y, *ranges, curves, markers
    )


def _curve(name: str, label: str, branch: Branch, shown: Example) -> CurveOutcome:
    x, y = (branch.columns[column].tolist() for column in (shown.x, shown.y))
    unstable = [count > 0 for count in branch.columns["n_negative"]] if "n_negative" in branch.columns else []
    return CurveOutcome(name, label, x, y, unstable)


def _range(values: list[float]) -> tuple[float, float]:
    low, high = min(values), max(values)
    margin = MARGIN * (high - low or 1.0)
    return low - margin, high + margin
