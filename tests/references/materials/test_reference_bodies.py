"""The reference side of closed forms and laws: samples of their tables are made again."""

import csv
import tomllib
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_table, uncertainties

from reference_data.solvers.__main__ import main

DATA = Path(__file__).resolve().parents[3] / "reference_data"


def read(path: Path) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a table."""
    head, *rows = csv.reader(path.with_suffix(".csv").read_text().splitlines())
    return tomllib.loads(path.read_text()), dict(zip(head, np.array(rows, float).T, strict=True))


@pytest.mark.parametrize(
    "name",
    [
        *("sphere_gent", "sphere_limits_gent", "uniaxial_saint_venant_kirchhoff", "equibiaxial_ogden"),
        *("pure_shear_arruda_boyce", "infinite_tube_limits_mooney_rivlin"),
        *("sphere_merge_gent", "infinite_tube_maxwell_gent"),
        *("law_ogden", "law_gent"),
    ],
)
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    group = "materials" if name.startswith("law") else "closed_form"
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(DATA / group / f"{name}.toml")
    new_about, new = read(tmp_path / group / f"{name}.toml")
    assert_same_table(new, committed, about, uncertainties(new_about))
    for key in ("title", "source", "type", "method", "regenerate"):
        assert new_about[key] == about[key]
