"""Closed forms of homogeneous sheets: derivatives by hand against differences of the energy."""

import csv
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_table, uncertainties

from reference_data.solvers.__main__ import main
from reference_data.solvers.beyond.bent_sheet import quadrature, shooting
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


SHEETS = [shooting.Sheet(0.0, 1.05, 1.0), shooting.Sheet(0.3, 1.3, 1.1)]


@pytest.mark.parametrize("sheet", SHEETS, ids=str)
@pytest.mark.parametrize("kap", [0.05, 0.9, 1.4])
def test_both_ways_agree_on_a_bent_sheet(sheet, kap):
    one, other = shooting.bent(sheet, kap, 1e-12), quadrature.bent(sheet, kap, 24)
    for part, value in vars(one).items():
        assert value == pytest.approx(getattr(other, part), rel=1e-11, abs=1e-12), part
    assert (one.wrinkled > 0) is (kap > shooting.onset(sheet, 1e-12))


def test_force_and_moment_of_a_bent_sheet_are_rates_of_its_energy():
    sheet, kap, h = SHEETS[1], 1.2, 1e-4
    sides = [shooting.bent(sheet, kap + d, 1e-12).energy for d in (h, -h)]
    assert shooting.bent(sheet, kap, 1e-12).moment == pytest.approx(np.subtract(*sides) / (2 * h), rel=1e-6)
    sides = [shooting.bent(replace(sheet, lam0=1.3 + d), kap, 1e-12).energy for d in (h, -h)]
    assert shooting.bent(sheet, kap, 1e-12).force == pytest.approx(np.subtract(*sides) / (2 * h), rel=1e-6)


def test_a_bent_sheet_of_small_strain_is_that_of_stein_and_hedgepeth():
    off = []
    for strain in (1e-3, 1e-4):
        at = shooting.bent(shooting.Sheet(0.0, 1 + strain, 1 + strain), 8 * strain, 1e-12)
        ratio = at.moment / at.force
        off.append(
            (at.wrinkled - (3 * ratio - 0.5), 8 * strain * 3 / at.force * 9 / 4 * (1 - 2 * ratio) ** 2 - 1)
        )
    assert np.abs(off[0]).max() < 2e-3
    assert np.divide(*off) == pytest.approx([10, 10], rel=0.02)


def test_a_sheet_that_is_bent_far_is_wrinkled_all_over():
    """Lines of tension that reach from guide to guide: no force along the sheet is left."""
    narrow = shooting.Sheet(0.1, 1.01, 1.6)
    for bend, level in ((shooting.bent, 1e-12), (quadrature.bent, 24)):
        found = bend(replace(narrow, lam0=0.6), 0.01, level)
        assert (found.force, found.moment, found.wrinkled) == (0.0, 0.0, pytest.approx(1.0))
        assert found.energy == pytest.approx(sheets.stored(0.1, 1.6**-0.5, 1.6), rel=1e-12)


@pytest.mark.parametrize(
    "name",
    # the same as bent_sheet, of another sheet, which bent_sheet_onset has as well
    [pytest.param(n, marks=pytest.mark.slow) if n == "bent_sheet_wide" else n for n in TABLES],
)
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(DATA / f"{name}.toml")
    new_about, new = read(tmp_path / "beyond" / f"{name}.toml")
    assert_same_table(new, committed, about, uncertainties(new_about))
    assert new_about["method"] == about["method"]
