"""First rows of tables of parts of spheres, by both methods, against the committed ones."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_rows

from reference_data.solvers.beyond.caps import energy, shooting, tables
from reference_data.solvers.core.tables import Table

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"
COARSER = (shooting.Accuracy(12, 2e-6), shooting.Accuracy(16, 1e-6))
COARSER_WAVES = (shooting.Accuracy(20, 1e-6), shooting.Accuracy(24, 1e-6))


def assert_begins(table: Table) -> None:
    """The table's only row is the first one of the committed table."""
    head, *lines = (DATA / f"{table.name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines])
    about = tomllib.loads((DATA / f"{table.name}.toml").read_text())
    new = {c.name: c.values for c in table.columns}
    sizes = {c.name: c.uncertainty for c in table.columns}
    committed = dict(zip(head.split(","), numbers.T, strict=True))
    assert_same_rows(new, committed, about, sizes, slice(1))


def test_first_point_of_a_line_equals_the_committed_one():
    name, vary, alpha, angle, hold, targets, begin = tables.TABLES["caps_fold_alpha"].args
    assert_begins(tables.line(name, vary, alpha, angle, hold, targets[:1], begin, levels=COARSER))


def test_first_state_of_a_table_of_waves_equals_the_committed_one():
    name, angle, begin, pressures = tables.TABLES["caps_waves"].args
    assert_begins(tables.waves(name, angle, begin, pressures[:1], levels=COARSER_WAVES))


def test_a_limit_point_that_is_not_there_is_refused():
    """Beyond the cusp no limit point has this ratio."""
    near = energy.start("alpha", 0.1, np.pi / 2, 2.4, 12)
    with pytest.raises(RuntimeError, match="limit point at"):
        energy.limit(near, alpha=0.2)
