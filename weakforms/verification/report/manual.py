"""What a page says of a case before its figures: geometry and loads, equations, symbols, data, references."""

from __future__ import annotations

from typing import Any

from weakforms.problems.registry import abouts
from weakforms.problems.registry import symbol as declared
from weakforms.verification.judging.outcome import CaseOutcome
from weakforms.verification.report.wording import symbol

SKETCHES = {
    "circular": "disk",
    "tube": "tube",
    "controls": "tube",
    "diagram": "tube",
    "infinite": "cylinder",
    "fluid": "liquid",
    "wrinkled": "wrinkled",
    "surface": "wrinkled",
    "wrinkled_material": "piece",
    "wrinkled_patch": "patch",
    "hemisphere": "hemisphere",
    "sphere": "balloon",
    "rectangle": "rectangle",
    "membrane": "outline",
    "annulus": "annulus",
    "sheet": "sheet",
    "sheet_bend": "bent",
    "torus": "torus",
    "homogeneous": "piece",
    "material": "piece",
}
"""Sketch by a problem's name, by the first word of it, or by the name and a loading."""

KINDS = {
    "exact": "a closed form",
    "independent": "computed by two other methods that share no code with the weak form",
    "printed": "printed in the thesis",
    "other-code": "another code",
}


def manual(case: CaseOutcome) -> list[dict[str, Any]]:
    """One entry for each problem that a case solves.

    Returns:
        The problem's own words (``about``), the name of its sketch, the symbols that the case uses with their
        scaling, and the values of every parameter.
    """
    out = []
    for name in dict.fromkeys(str(solution.get("problem")) for solution in case.solutions):
        about = abouts().get(name)
        if about is None:  # a stored run of another version
            continue
        data = [s.get("parameters") or {} for s in case.solutions if s.get("problem") == name]
        used = dict.fromkeys([*(key for of in data for key in of), *_drawn(case)])
        scales = about.scales
        symbols = [(declared(key) or symbol(key), key, scales[key]) for key in used if key in scales]
        out.append(
            {
                "about": about,
                "sketch": sketch(_drawn_as(name, data)),
                "symbols": symbols,
                "data": _data(data),
            }
        )
    return out


def sketch(problem: str) -> str:
    """The name of the sketch of a problem; empty if it has none."""
    return SKETCHES.get(problem, SKETCHES.get(problem.partition("_")[0], ""))


def _drawn_as(problem: str, data: list[dict[str, Any]]) -> str:
    """What is sketched of a problem: its only loading, or the only body of a diagram, if it is a problem."""
    kinds = {str(of.get("body", of.get("loading", ""))) for of in data}
    kind = kinds.pop() if len(kinds) == 1 else ""
    names = f"{problem}_{kind}", kind, kind.partition("_")[0]
    return next((name for name in names if name in SKETCHES), problem)


def references(case: CaseOutcome) -> dict[str, list[str]]:
    """Names of the tables by where their numbers come from."""
    found: dict[str, list[str]] = {}
    for panel in case.panels:
        for curve in panel.curves:
            if curve.reference_name and curve.reference_kind:
                names = found.setdefault(KINDS.get(curve.reference_kind, curve.reference_kind), [])
                if curve.reference_name not in names:
                    names.append(curve.reference_name)
    return found


def _drawn(case: CaseOutcome) -> list[str]:
    """Names on the axes of a case's panels."""
    return [name for panel in case.panels for name in (panel.x, panel.y)]


def _data(parameters: list[dict[str, Any]]) -> list[tuple[str, str]]:
    """Every parameter that is a number or a word, with the values that it takes."""
    values: dict[str, list[str]] = {}
    for of in parameters:
        for name, value in of.items():
            several = value if isinstance(value, list | tuple) else [value]
            for one in several:
                if not isinstance(one, int | float | str) or isinstance(one, bool) or one == "":
                    continue
                text = f"{one:g}" if isinstance(one, float) else str(one)
                seen = values.setdefault(name, [])
                if text not in seen:
                    seen.append(text)
    return [(name, ", ".join(seen)) for name, seen in values.items()]
