"""Summaries of a run in words and numbers: counts, worst checks, and the table for the terminal."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from weakforms.terminal import plain
from weakforms.verification.judging.outcome import (
    CaseOutcome,
    Convergence,
    CurveOutcome,
    PanelOutcome,
    RunOutcome,
    Verdict,
)
from weakforms.verification.report.junit import clean
from weakforms.verification.report.wording import duration, fraction, order, plain_tex, plural, scientific

NARROW = 90
"""On narrower terminals the table leaves out some columns."""
STYLES = {"passed": "green", "failed": "bold red", "error": "bold yellow"}
ORDER = {"error": 0, "failed": 1, "passed": 2}
LOST = "not recoverable"
LABELS = {
    "misprint": "misprint proven",
    "cut off": "truncated, not rounded",
    "grid of a scan": "resolution of the printed grid",
    "input, not judged": "not judged",
    "input, decoded": "input recovered",
    "input, not decoded": LOST,
    "input, placed": "state found",
    "input, not placed": "state not found",
    LOST: LOST,
}
"""Labels of the status of a printed number; any other status is its own label."""

MEANINGS = {
    "reproduced": "the computed value rounds to every printed digit",
    "state found": "a figure shows a state at this value, and the branch of the paper has it",
    "input recovered": "the number is an input of a figure, and follows from a round value of another one",
    LABELS["cut off"]: "the printed digits are those of the computed value, without rounding",
    LABELS["grid of a scan"]: "the printed number is a multiple of a step, and the computed value lies less "
    "than a step beside it",
    "misprint proven": "the computed value rounds to another number, which the entry gives with its reason",
    LOST: "the number is an input of a figure, and no round value of another quantity gives it",
    "not reproduced": "the computed value rounds to other digits, and no explanation of this was proven",
    "not judged": "the computed value is not accurate enough, or lies outside of what was searched",
    "state not found": "the branch of the paper has no state at this value",
}
"""What the labels of printed numbers mean."""


@dataclass(frozen=True)
class Accuracy:
    """The accuracy that a case asks of a column, and the widest bound that it achieves."""

    case: str
    column: str
    asked: float
    delivered: float

    @property
    def ratio(self) -> float:
        """Asked accuracy over achieved bound."""
        return self.asked / self.delivered


def case_status(case: CaseOutcome) -> str:
    """The status of a case; a failed check counts even if the case says that it passed."""
    if case.status == "passed" and not all(verdict.passed for verdict in case.verdicts):
        return "failed"
    return case.status


def run_status(run: RunOutcome) -> str:
    """The worst status among the cases; ``passed`` needs at least one check."""
    kinds = {case_status(case) for case in run.cases}
    if not any(case.verdicts for case in run.cases) and not kinds & {"failed", "error"}:
        return "empty"
    return next((kind for kind in ("error", "failed") if kind in kinds), "passed")


def verdicts_of(run: RunOutcome) -> list[tuple[CaseOutcome, Verdict]]:
    """Every check of the run with its case."""
    return [(case, verdict) for case in run.cases for verdict in case.verdicts]


def headline(run: RunOutcome) -> str:
    """The verdict on the whole run in one short sentence."""
    checks = verdicts_of(run)
    failed = sum(not verdict.passed for _, verdict in checks)
    stuck = sum(case_status(case) == "error" for case in run.cases)
    parts = []
    if stuck:
        parts.append(f"{plural(stuck, 'case')} could not be solved")
    if failed:
        parts.append(f"{failed} of {plural(len(checks), 'check')} failed")
    elif run_status(run) == "failed":
        parts.append("a case failed without a failed check")
    if parts:
        return "; ".join(parts)
    if not run.cases:
        return "no case was run"
    if not checks:
        return "no check was made"
    return "the only check holds" if len(checks) == 1 else f"all {len(checks)} checks hold"


def ratio(verdict: Verdict) -> float | None:
    """Error over bound, infinite where the error is; ``None`` for a check without a bound."""
    if verdict.bound is None:
        return None
    if verdict.error is None:
        return math.inf
    if verdict.bound == 0:
        return 0.0 if verdict.error == 0 else math.inf
    return verdict.error / verdict.bound


def worst(verdicts: Iterable[Verdict]) -> Verdict | None:
    """The numerical check with the largest error in units of its bound."""
    judged = [verdict for verdict in verdicts if ratio(verdict) is not None]
    return max(judged, key=lambda verdict: _rank(ratio(verdict)), default=None)


def sharpest(verdicts: Iterable[Verdict]) -> Verdict | None:
    """The numerical check that holds within the smallest bound (exact statements aside)."""
    judged = [verdict for verdict in verdicts if verdict.passed and (verdict.bound or 0) > 0]
    return min(judged, key=lambda verdict: verdict.bound, default=None)


def bluntest(verdicts: Iterable[Verdict]) -> Verdict | None:
    """The numerical check whose bound comes closest to the asked accuracy, or exceeds it most."""
    judged = [verdict for verdict in verdicts if verdict.bound is not None and verdict.asked]
    return max(judged, key=lambda verdict: _rank(verdict.bound / verdict.asked), default=None)


LOOSE = 100
"""Largest ratio of asked accuracy to achieved bound that is not listed."""


def accuracies(run: RunOutcome) -> list[Accuracy]:
    """The accuracies that every case asks of a column, with its widest bounds, in descending ratio.

    Checks of one result against itself are left out: other programs' curves are not judged by them.
    """
    widest: dict[tuple[str, str, float], float] = {}
    for case, verdict in verdicts_of(run):
        bound = verdict.bound if verdict.widest is None else verdict.widest
        if verdict.passed and verdict.asked and bound and verdict.kind != "trace":
            key = (case.id, verdict.check.rpartition(":")[2], verdict.asked)
            widest[key] = max(widest.get(key, 0.0), bound)
    found = [Accuracy(*key, bound) for key, bound in widest.items()]
    return sorted(found, key=lambda accuracy: -accuracy.ratio)


def of_curve(curve: CurveOutcome, verdicts: Iterable[Verdict]) -> list[Verdict]:
    """The checks that hold this curve against its reference table, at the table's own rows."""
    name = curve.reference_name
    at_rows = (v for v in verdicts if v.kind != "trace")
    return [v for v in at_rows if name and (v.reference == name or v.check.split(":")[0] == name)]


def describe(panel: PanelOutcome, verdicts: Iterable[Verdict] = ()) -> str:
    """A panel in words, for screen readers."""
    x, y = panel.x_range, panel.y_range
    parts = [f"{panel.y} from {y[0]:g} to {y[1]:g} against {panel.x} from {x[0]:g} to {x[1]:g}"]
    names = [plain_tex(curve.label or curve.name) for curve in panel.curves]
    parts.append(f"{plural(len(names), 'curve')}: {'; '.join(names)}" if names else "No curves")
    if any(any(curve.unstable) for curve in panel.curves):
        if panel.dotted:
            parts.append(f"Dashed: {panel.dashed}; dotted: {panel.dotted}")
        else:
            parts.append(f"{panel.dashed.capitalize()} parts are dashed")
    if panel.markers:
        parts.append("Marked: " + "; ".join(plain_tex(m.label or m.kind) for m in panel.markers))
    checks = list(verdicts)
    top = worst(v for curve in panel.curves for v in of_curve(curve, checks))
    if top:
        place = f" at {plain_tex(top.where)}" if top.where else ""
        sizes = f"error {scientific(top.error)}, bound {scientific(top.bound)}"
        parts.append(f"Worst check: {sizes}{place}")
    return ". ".join(parts) + "."


def describe_histories(records: Sequence[Convergence]) -> str:
    """Refinement histories in words."""
    return " ".join(
        f"P{r.degree}: error {scientific(r.errors[-1] if r.errors else None)} on the finest mesh, "
        f"observed order {order(r.observed_order)}, expected {order(r.expected_order)}."
        for r in records
    )


def ledger_counts(cases: Iterable[CaseOutcome]) -> dict[str, int]:
    """Number of printed numbers by status, the good ones first."""
    known = (
        "reproduced",
        "state found",
        "input recovered",
        LABELS["cut off"],
        LABELS["grid of a scan"],
        "misprint proven",
        LOST,
    )
    counts = Counter(LABELS.get(entry.status, entry.status) for case in cases for entry in case.printed)
    names = [*known, *sorted(set(counts) - set(known))]
    return {name: counts[name] for name in names if counts[name]}


def case_line(case: CaseOutcome, done: int, total: int) -> str:
    """A line for a log: ``3 of 92 cases: paper2.fig03 passed, 53 checks, 12.0 s of solving``."""
    checks, failed = len(case.verdicts), sum(not v.passed for v in case.verdicts)
    held = f"{failed} of {plural(checks, 'check')} failed" if failed else plural(checks, "check")
    return (
        f"{done} of {plural(total, 'case')}: {case.id} {case_status(case)}, {held}, {duration(case.seconds)}"
    )


def print_summary(run: RunOutcome, console: Console) -> None:
    """Print the run to a terminal: one row for each case, the failures, and one last line.

    Args:
        run: What ``verify`` left.
        console: The terminal; its width, encoding and ``NO_COLOR`` are respected.
    """
    console.print(_table(run, narrow=console.width < NARROW))
    for case in run.cases:
        _print_problems(case, console)
    ledger = ", ".join(f"{count} {name}" for name, count in ledger_counts(run.cases).items())
    if ledger:
        console.print(Text(f"Printed numbers: {_for_terminal(ledger)}"))
    status = run_status(run)
    last = Text(f"{status.upper() if status != 'empty' else 'NOTHING JUDGED'}: ")
    last.stylize(STYLES.get(status, "bold"))
    last.append(f"{headline(run)} in {plural(len(run.cases), 'case')}, {duration(run.seconds)}", "")
    console.print(last)


def _table(run: RunOutcome, narrow: bool) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False, header_style="bold")
    table.add_column("Case", overflow="fold")
    table.add_column("Verdict", no_wrap=True)
    table.add_column("Checks", justify="right", no_wrap=True)
    table.add_column("Err/bound" if narrow else "Error / bound", justify="right", no_wrap=True)
    if not narrow:
        table.add_column("Worst check", overflow="fold")
        table.add_column("Time", justify="right", no_wrap=True)
    for case in run.cases:
        status = case_status(case)
        top = worst(case.verdicts)
        cells = [
            Text(_for_terminal(case.id)),
            Text(status, STYLES.get(status, "")),
            Text(f"{sum(v.passed for v in case.verdicts)}/{len(case.verdicts)}"),
            Text(fraction(ratio(top)) if top else "–"),
        ]
        if not narrow:
            place = f" at {top.where}" if top and top.where else ""
            cells += [
                Text(_for_terminal(top.check + place) if top else "–"),
                Text(duration(case.seconds)),
            ]
        table.add_row(*cells)
    return table


def _print_problems(case: CaseOutcome, console: Console) -> None:
    for message in case.errors:
        console.print(Text(f"error   {_for_terminal(case.id)}", STYLES["error"]))
        console.print(Padding(Text(_for_terminal(message)), (0, 0, 0, 8)))
    for verdict in case.verdicts:
        if verdict.passed:
            continue
        line = Text("failed  ", STYLES["failed"])
        line.append(f"{_for_terminal(case.id)}:{_for_terminal(verdict.check)}", "not red")
        numbers = [f"{n} {scientific(getattr(verdict, n))}" for n in ("error", "bound", "asked")]
        where = [f"at {_for_terminal(plain_tex(verdict.where))}"] if verdict.where else []
        judged = ", ".join(numbers * (verdict.bound is not None) + where)
        texts = [
            judged,
            _for_terminal(plain_tex(verdict.statement)),
            _for_terminal(plain_tex(verdict.detail)),
        ]
        console.print(line)
        console.print(Padding(Text("\n".join(filter(None, texts))), (0, 0, 0, 8)))


def _rank(value: float | None) -> float:
    return math.inf if value is None or math.isnan(value) else value


def _for_terminal(text: str) -> str:
    """The text for a terminal, without control characters except line ends."""
    return "\n".join(plain(line) for line in clean(text).split("\n"))
