"""First point of a line of limit points of parts of spheres, by both methods, against the committed table."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_rows

from reference_data.solvers.beyond.caps import energy, shooting, tables

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"
COARSER = (shooting.Accuracy(12, 2e-6), shooting.Accuracy(16, 1e-6))


def test_first_point_of_a_line_equals_the_committed_one():
    name, vary, alpha, angle, hold, targets, begin = tables.TABLES["caps_fold_alpha"].args
    table = tables.line(name, vary, alpha, angle, hold, targets[:1], begin, levels=COARSER)
    head, *lines = (DATA / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines])
    about = tomllib.loads((DATA / f"{name}.toml").read_text())
    new = {c.name: c.values for c in table.columns}
    sizes = {c.name: c.uncertainty for c in table.columns}
    committed = dict(zip(head.split(","), numbers.T, strict=True))
    assert_same_rows(new, committed, about, sizes, slice(1))


def test_a_limit_point_that_is_not_there_is_refused():
    """Beyond the cusp no limit point has this ratio."""
    near = energy.start("alpha", 0.1, np.pi / 2, 2.4, 12)
    with pytest.raises(RuntimeError, match="limit point at"):
        energy.limit(near, alpha=0.2)
