"""First points of the lines of critical points of a tube, by both methods, against the committed tables."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_rows

from reference_data.solvers.beyond import tables_lines

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"


def read(name: str) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a committed table."""
    head, *lines = (DATA / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines])
    about = tomllib.loads((DATA / f"{name}.toml").read_text())
    return about, dict(zip(head.split(","), numbers.T, strict=True))


LINES = (
    "lines_fold_alpha",
    *(pytest.param(f"lines_wrinkling_{place}", marks=pytest.mark.slow) for place in ("disk", "front")),
)


@pytest.mark.parametrize("name", LINES)
def test_first_point_of_a_line_equals_the_committed_one(name, monkeypatch):
    # of order 12; tables take over twice as many steps
    monkeypatch.setattr(tables_lines.shoot, "LEVELS", (10, 14))
    _, kind, tube, vary, targets, begin = tables_lines.TABLES[name].args
    table = tables_lines.line(name, kind, tube, vary, targets[:1], begin)
    about, committed = read(name)
    new = {c.name: c.values for c in table.columns}
    sizes = {c.name: c.uncertainty for c in table.columns}
    assert_same_rows(new, committed, about, sizes, slice(1))
