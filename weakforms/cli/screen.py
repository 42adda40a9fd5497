"""Results as a person reads them on a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

from weakforms.results import Result
from weakforms.results.tables import SPREAD
from weakforms.results.uncertain import uncertain
from weakforms.results.wording import LABELS, extent, notes, parameters_line, point_rows, state_rows
from weakforms.terminal import plain

if TYPE_CHECKING:
    from weakforms.verification.audit.diff import Diff
    from weakforms.verification.run.sweep import Sweep

TELLING = (*LABELS, "n_negative", "n_fixed_V", "n_fixed_m", "n_held")
"""Columns that say what a point is and whether it is stable: they stand early."""

SHOWN = 25
"""Number of different numbers that are shown of two results."""

GAP = "   "
"""Between the numbers of a line."""


def print_result(result: Result, console: Console, kept: str = "") -> None:
    """Print branches with their ends, special points, states, quantities, then what is missing, and the time.

    Args:
        result: Any result.
        console: Where to print; its width decides how many columns of a point are shown.
        kept: The file that holds the whole result, if there is one.
    """

    def line(text: str, style: str = "") -> None:
        console.print(Text(plain(text), style), soft_wrap=True)

    line(result.problem, "bold")
    line(f"  {parameters_line(result)}", "dim")
    for branch in result.branches:
        line(f"branch {branch.name}: {extent(branch)}")
    for title, rows in (("special points", point_rows(result)), ("states", state_rows(result))):
        if rows:
            line(title, "bold")
            _print_rows(rows, console)
    if result.quantities:
        line("quantities", "bold")
        for name, quantity in result.quantities.items():
            line(f"  {name} = {quantity}")
    for text in notes(result):
        line(text, "red" if text.startswith("not converged") else "yellow")
    line(_work(result) + (f"; all numbers: {kept}" if kept else "; --out FILE keeps all numbers"), "dim")


def _work(result: Result) -> str:
    """Time, versions and ranks."""
    of = result.provenance
    ranks = f" on {of['ranks']} ranks" if of.get("ranks", 1) > 1 else ""
    return f"solved in {of.get('wall_s', 0.0):.3g} s by DOLFINx {of.get('dolfinx', '?')}{ranks}"


def _print_rows(rows: Sequence[tuple[str, dict[str, str]]], console: Console) -> None:
    """Print a line for each place with as many of its numbers as fit, the same ones in every line."""
    first = max(len(plain(place)) for place, _ in rows)
    names = list(dict.fromkeys(name for _, numbers in rows for name in numbers))
    names[1:] = sorted(names[1:], key=lambda name: name not in TELLING)
    width, cells = first + 2, {}
    for name in names:
        texts = [numbers.get(name) for _, numbers in rows]
        shown = [f"{name} = {text}" if text is not None else "" for text in texts]
        longest = max(map(len, shown))
        if cells and width + len(GAP) + longest > console.width:
            break
        width += len(GAP) + longest
        cells[name] = [text.ljust(longest) for text in shown]
    for k, (place, _) in enumerate(rows):
        numbers = GAP.join(plain(column[k]) for column in cells.values())
        console.print(f"  {plain(place):{first}}{GAP}{numbers}".rstrip(), soft_wrap=True)
    left = len(names) - len(cells)
    if left:
        console.print(
            Text(f"  and {left} more: {', '.join(map(plain, names[len(cells) :]))}", "dim"),
            soft_wrap=True,
        )


def print_sweep(done: Sweep, console: Console, table: Path) -> None:
    """Print the special points and states of every combination, what failed, and where the table is."""
    rows, failed = [], []
    for row in done.rows():
        given = ", ".join(f"{name} = {row[name]:g}" for name in done.swept)
        if row["what"] in ("failed", "not there"):
            failed.append(f"{given}: {row['what']}: {row['reason']}")
        elif row["what"] not in ("end", "quantities"):
            names = [n for n in row if n not in (*done.swept, "what", "number", "branch") and SPREAD not in n]
            numbers = {name: uncertain(row[name], row.get(name + SPREAD)) for name in names}
            number = "" if row["number"] == 1 and row["what"].startswith("state") else f" {row['number']}"
            rows.append((f"{given}  {row['what']}{number}", numbers))
    if rows:
        _print_rows(rows, console)
    for text in failed:
        console.print(Text(plain(text), "yellow"), soft_wrap=True)
    count = len({**done.results, **done.failures})
    console.print(f"{count} combinations, {len(done.failures)} failed; table: {plain(table)}", soft_wrap=True)


def print_diff(found: Diff, console: Console, first: str, second: str) -> None:
    """Print the settings and numbers that differ, and how many agree."""
    for name, (one, two) in found.settings.items():
        console.print(Text(plain(f"{name}: {one} and {two}"), "yellow"), soft_wrap=True)
    for name in found.left_out:
        text = f"branch {name}: different numbers of points; its columns are not compared"
        console.print(Text(plain(text), "yellow"), soft_wrap=True)
    shown = [pair.cells for pair in found.different[:SHOWN]]
    if shown:
        rows = [("", first, second, "difference", "bound"), *shown]
        widths = [max(len(plain(row[k])) for row in rows) for k in range(5)]
        for row in rows:
            line = GAP.join(plain(cell).ljust(width) for cell, width in zip(row, widths, strict=True))
            console.print(Text(f"  {line}".rstrip(), "" if row[0] else "bold"), soft_wrap=True)
    if len(found.different) > SHOWN:
        console.print(f"  and {len(found.different) - SHOWN} more; --json lists all")
    agree = len(found.pairs) - len(found.different)
    console.print(f"{agree} of {len(found.pairs)} numbers agree within twice their combined uncertainty")
