"""A result as HTML, which a notebook shows: a table of its numbers, and a picture of its branches."""

from __future__ import annotations

import io
from html import escape

from weakforms.errors import WeakformsError
from weakforms.results.result import Result
from weakforms.results.wording import extent, notes, parameters_line, point_rows, state_rows


def html(result: Result) -> str:
    """Branches with their ends, special points, states, quantities, what is missing, and a picture."""
    parts = [f"<b>{escape(result.problem)}</b> <small>{escape(parameters_line(result))}</small>"]
    parts += [f"<div>branch {escape(b.name)}: {escape(extent(b))}</div>" for b in result.branches]
    rows = [*point_rows(result), *state_rows(result, whole=True)]
    parts += [_table(rows)] if rows else []
    parts += [f"<div>{escape(name)} = {escape(f'{q}')}</div>" for name, q in result.quantities.items()]
    parts += [f"<div><i>{escape(text)}</i></div>" for text in notes(result, 'crossing="all"')]
    return "\n".join([*parts, _picture(result)])


def _table(rows: list[tuple[str, dict[str, str]]]) -> str:
    """A row for each place, a column for each number."""
    names = list(dict.fromkeys(name for _, numbers in rows for name in numbers))
    head = "".join(f"<th>{escape(name)}</th>" for name in ("", *names))
    lines = [[place, *(numbers.get(name, "") for name in names)] for place, numbers in rows]
    cells = ["".join(f"<td>{escape(cell)}</td>" for cell in line) for line in lines]
    body = "".join(f"<tr>{line}</tr>" for line in cells)
    table = f"<table style='white-space:nowrap'><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return f"<div style='overflow-x:auto'>{table}</div>"


def _picture(result: Result) -> str:
    """The branches as SVG; nothing if there is nothing to draw, or nothing to draw with."""
    try:
        figure = result.plot()
    except WeakformsError:
        return ""
    stream = io.StringIO()
    figure.savefig(stream, format="svg", metadata={"Date": None})
    text = stream.getvalue()
    return text[text.index("<svg") :]
