"""Closed forms of homogeneous sheets: derivatives by hand against differences of the energy."""

import csv
import tomllib
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_table, uncertainties

from reference_data.solvers.__main__ import main
from reference_data.solvers.beyond.tables_sheet import TABLES
from reference_data.solvers.closed_form import sheets

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"
WRINKLED = [(1.0, 0.4, 1.0), (1.7, 0.0, 0.6), (1.5, 1.4, 0.9), (1.0, 2.0, 1.2)]
TAUT = [(1.0, 0.3, 1.3), (1.4, 0.0, 1.0), (1.5, 0.4, 1.4)]


def read(path: Path) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a table."""
    head, *rows = csv.reader(path.with_suffix(".csv").read_text().splitlines())
    return tomllib.loads(path.read_text()), dict(zip(head, np.array(rows, float).T, strict=True))


@pytest.mark.parametrize("alpha", [0.0, 0.3])
@pytest.mark.parametrize("state", WRINKLED + TAUT)
def test_both_ways_agree(state, alpha):
    at = sheets.State(*state)
    one, other = sheets.by_hand(alpha, at), sheets.by_energy(alpha, at)
    assert one == pytest.approx(other, rel=1e-9, abs=1e-9)
    assert (one.lam1 * one.lam2**2 < 1) is (state in WRINKLED)


def test_a_wrinkled_sheet_bears_no_compression():
    """The Kirchhoff stress ``P F^T`` of a wrinkled sheet is a tension in one direction."""
    for state in WRINKLED:
        found = sheets.by_hand(0.1, sheets.State(*state))
        lam, gam, s = state
        along, across, shear = found.T_x * lam + found.tau * gam, found.T_y * s, found.tau * s
        assert along * across == pytest.approx(shear**2, rel=1e-9, abs=1e-12)
        assert along + across > 0


@pytest.mark.parametrize("name", TABLES)
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(DATA / f"{name}.toml")
    new_about, new = read(tmp_path / "beyond" / f"{name}.toml")
    assert_same_table(new, committed, about, uncertainties(new_about))
    assert new_about["method"] == about["method"]
