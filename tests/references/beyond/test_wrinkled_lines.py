"""First point of a line of the wrinkled tube, by both methods, against the committed table."""

import tomllib
from pathlib import Path

import numpy as np
from committed_tables import assert_same_rows

from reference_data.solvers.beyond.wrinkled_lines import tables

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"


def test_first_point_of_a_line_equals_the_committed_one():
    name, over, values = tables.TABLES["wrinkled_fold_Af"].args
    table = tables.folds(name, over, values[:1])
    head, *lines = (DATA / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines])
    about = tomllib.loads((DATA / f"{name}.toml").read_text())
    new = {c.name: c.values for c in table.columns}
    sizes = {c.name: c.uncertainty for c in table.columns}
    committed = dict(zip(head.split(","), numbers.T, strict=True))
    assert_same_rows(new, committed, about, sizes, slice(1))
