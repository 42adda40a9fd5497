"""First points of the lines of critical points of a tube, by both methods, against the committed tables."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from committed_tables import WIDER, assert_same_table, uncertainties

from reference_data.solvers.beyond import tables_lines

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"


def read(name: str, rows: int) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and the first rows of a committed table."""
    head, *lines = (DATA / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[:rows]])
    about = tomllib.loads((DATA / f"{name}.toml").read_text())
    return about, dict(zip(head.split(","), numbers.T, strict=True))


LINES = (
    "lines_fold_alpha",
    *(pytest.param(f"lines_wrinkling_{place}", marks=pytest.mark.slow) for place in ("disk", "front")),
)


@pytest.mark.parametrize("name", LINES)
def test_first_point_of_a_line_equals_the_committed_one(name):
    _, kind, tube, vary, targets, begin = tables_lines.TABLES[name].args
    table = tables_lines.line(name, kind, tube, vary, targets[:1], begin)
    about, committed = read(name, 1)
    new = {c.name: c.values for c in table.columns}
    sizes = {c.name: c.uncertainty for c in table.columns}
    whole = uncertainties(about)
    assert all(sizes[name] <= WIDER * whole[name] for name in sizes)  # theirs are those of the worst row
    assert_same_table(new, committed, about, whole)
