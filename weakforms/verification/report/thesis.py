"""The panels of the thesis one by one, and its statements, from the outcome of a run.

A panel of the thesis is *held* if every curve that the case draws for it is compared with a reference and
agrees, or if it has no curves of its own (a table, a sketch) and all statements of its case hold.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

from weakforms.verification.judging.outcome import (
    CaseOutcome,
    CurveOutcome,
    PanelOutcome,
    RunOutcome,
    Verdict,
)
from weakforms.verification.report.summary import of_curve

THESIS = """
1 3a fig03 a;1 3b fig03 b;1 4a fig04 a;1 4b fig04 b;1 5a fig05 a;1 5b fig05 b;1 6a fig06 a;1 6b fig06 b
1 7a fig07 a,;1 7b fig07 b;1 8a fig08 fig08, lam1;1 8b fig08 fig08, lam2;1 9a fig08 fig09, lam1
1 9b fig08 fig09, lam2;1 10a fig10 a;1 10b fig10 b;1 10c fig10 c;1 11a fig11 fig11a;1 11b fig11 fig11b
1 12a fig11 fig12a;1 12b fig11 fig12b
2 2a fig02 a;2 2b fig02 b;2 3a fig03 a;2 3b fig03 b;2 4 fig04 lam;2 5 fig05 profiles;2 6a fig06 a;2 6b fig06 b
2 7a fig07 a,;2 7b fig07 b,;2 7c fig07 c,;2 8a fig08 a,;2 8b fig08 b,;2 8c fig08 c,;2 9a fig09 a;2 9b fig09 b
2 10a fig10 a;2 10b fig10 b;2 11a fig11 a;2 11b fig11 b;2 12a fig12 a,;2 12b fig12 b,;2 13 fig13 bilateral
2 table 1 table1 -
3 2a fig02 a;3 2b fig02 b;3 3a fig03 a;3 3b fig03 b;3 4 fig04 L_;3 5a fig05 a_;3 5b fig05 b_;3 6a fig06 a,
3 6b fig06 b,;3 7a fig07 profiles;3 7b fig07 profiles;3 8a fig08 meridians of a;3 8b fig08 meridians of b
4 2a fig02 a;4 2b fig02 b;4 3a fig03 a;4 3b fig03 b;4 4a fig04 a,;4 4b fig04 b,;4 5a fig05 a;4 5b fig05 b
4 6a fig06 a,;4 6b fig06 b,;4 7 fig07 7;4 8 fig08 8;4 9 fig09 delta;4 10a fig10 a,;4 10b fig10 b,
4 11 fig11 11;4 table 1 table1 -;4 table 2 table2 -
5 1 fig01 1;5 2 fig02 a;5 4a fig04 a;5 4b fig04 b;5 5a fig05 a,;5 5b fig05 b,;5 5c fig05 c,;5 6 fig06 @
5 7a fig07 a,;5 7b fig07 b,;5 7c fig07 c,;5 7d fig07 d,;5 9 fig09 gw;5 10a fig10 a,;5 10b fig10 b,
5 section 6 surface -
"""
"""Paper, panel, case, and the beginning of the names of its panels in the case: ``-`` for none, ``@`` for
all."""

COMPRESSED = (
    "the secondary branch for delta = 1.5 is on a coarse mesh: its dry part is compressed, and a membrane "
    "without bending stiffness wrinkles there as finely as a mesh allows"
)
REMARKS = {
    (3, "2b"): COMPRESSED,
    (3, "3b"): COMPRESSED,
    (3, "4"): "the aspect ratio is not printed; both of figure 2 are shown",
}

CURVES = ("curve", "field")
"""Kinds of verdicts on curves and profiles."""


@dataclass(frozen=True)
class Row:
    """A panel, or a table, of the thesis."""

    paper: int
    name: str
    case: str
    drawn: int = 0
    """Curves and paths that the case draws for it."""
    compared: int = 0
    """Those of them that are compared with a reference and agree."""
    asked: tuple[float, float] | None = None
    """Smallest and largest relative accuracy asked of their columns."""
    delivered: tuple[float, float] | None = None
    """Smallest and largest bound."""
    statements: int = 0
    """Statements and printed numbers of the whole case that hold."""
    failed: int = 0
    """Checks of the panel, or statements of its case, that fail."""
    run: bool = False
    """Whether its case was run."""

    @property
    def remark(self) -> str:
        """What a reader must know of its curves."""
        return REMARKS.get((self.paper, self.name), "")

    @property
    def held(self) -> bool:
        """Whether it is held as a whole."""
        if not self.run or self.failed:
            return False
        return self.compared == self.drawn if self.compared else bool(self.statements)


def panels(run: RunOutcome) -> list[Row]:
    """Every panel and table of the thesis, in its order, with the state in a run."""
    cases = {case.id: case for case in run.cases}
    return [_row(cases, *item.split(" ", 1)) for item in chain(*(line.split(";") for line in _lines()))]


def statements(run: RunOutcome) -> list[tuple[CaseOutcome, Verdict]]:
    """Every statement of the run with its verdict, in the order of the cases."""
    return [(case, verdict) for case in run.cases for verdict in case.verdicts if verdict.kind == "claim"]


def _lines() -> list[str]:
    return THESIS.strip().splitlines()


def _row(cases: dict[str, CaseOutcome], paper: str, rest: str) -> Row:
    words = rest.split(" ")
    size = 2 if words[0] in ("table", "section") else 1
    name, case_name, prefix = " ".join(words[:size]), words[size], " ".join(words[size + 1 :])
    place = {"paper": int(paper), "name": name, "case": f"paper{paper}.{case_name}"}
    case = cases.get(place["case"])
    if case is None:
        return Row(**place)
    shown = [panel for panel in case.panels if prefix == "@" or _is_part(panel, prefix)]
    curves = [c for panel in shown for c in panel.curves if c.reference_name or c.name != c.label]
    of_panels = [(curve, of_curve(curve, case.verdicts)) for curve in curves]  # exact lines left out
    of_panels += [(path, checks) for panel in shown for path, checks in _paths(panel, case)]
    numeric = [[v for v in checks if v.kind in CURVES] for _, checks in of_panels]
    every = [verdict for checks in numeric for verdict in checks]
    stated = [
        verdict for verdict in case.verdicts if verdict.kind not in (*CURVES, "trace", "identity", "marks")
    ]
    judged = every if any(numeric) else stated
    bounds = [v.bound if v.widest is None else v.widest for v in every if v.asked]
    return Row(
        **place,
        drawn=len(of_panels),
        compared=sum(bool(checks) and all(v.passed for v in checks) for checks in numeric),
        asked=_range([v.asked for v in every if v.asked]),
        delivered=_range(bounds),
        statements=sum(verdict.passed for verdict in stated),
        failed=sum(not verdict.passed for verdict in judged) + len(case.errors),
        run=True,
    )


def _is_part(panel: PanelOutcome, prefix: str) -> bool:
    """Whether a panel of a case is part of one of the thesis: ``a`` is exact, ``a,`` a beginning."""
    return panel.name.startswith(prefix) if len(prefix) > 1 else panel.name == prefix


def _paths(panel: PanelOutcome, case: CaseOutcome) -> Iterator[tuple[CurveOutcome, list[Verdict]]]:
    """The paths of a panel with the verdicts on them, by their table."""
    points = sorted({path.point for path in panel.paths})
    for point in points:
        end = f"_{point:g}"
        checks = [v for v in case.verdicts if v.check.startswith("paths_") and v.check.endswith(end)]
        yield CurveOutcome(end, end, [], []), [v for v in checks if v.reference.endswith(panel.name)]


def _range(values: list[float]) -> tuple[float, float] | None:
    return (min(values), max(values)) if values else None
