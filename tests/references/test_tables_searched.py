"""Sets in which points are searched: those with a row, and those that the table names as without any."""

import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.beyond import tables_controls
from reference_data.solvers.beyond import tables_tube_bends as bends
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2 import tables_free
from reference_data.solvers.paper3 import tables_critical

DATA = Path(__file__).resolve().parents[2] / "reference_data"
TUBE = ("alpha", "delta1", "lf")


def read(path: str) -> tuple[list[dict[str, float]], str]:
    """Rows of a committed table, and its notes."""
    head, *rows = (DATA / f"{path}.csv").read_text().splitlines()
    names = head.split(",")
    about = tomllib.loads((DATA / f"{path}.toml").read_text())
    return [dict(zip(names, map(float, row.split(",")), strict=True)) for row in rows], about.get("notes", "")


def named(notes: str, size: int) -> set[tuple[float, ...]]:
    """Sets of numbers in brackets in the notes."""
    groups = re.findall(r"\(([-\d., ]+)\)", notes)
    sets = (tuple(float(x) for x in group.split(",")) for group in groups)
    return {numbers for numbers in sets if len(numbers) == size}


@pytest.mark.parametrize("name", ["tube_waves", "tube_waves_limits", "tube_waves_wrinkling"])
def test_tubes_whose_waves_are_searched(name):
    rows, notes = read(f"beyond/{name}")
    with_points = {tuple(row[k] for k in TUBE) for row in rows}
    without = named(notes, 3)
    assert not with_points & without
    assert with_points | without == {(t.alpha, t.delta1, t.lf) for t in bends.TUBES}
    assert len(set(bends.TUBES)) == len(bends.TUBES)
    for row in rows:
        assert row["u_end"] == bends.u_end(Tube(*(row[k] for k in TUBE)))


def test_families_of_waves_that_are_searched():
    rows, notes = read("beyond/tube_waves")
    searched = {
        (int(n), 1 if word == "even" else -1) for n, word in re.findall(r"n = (\d) (even|odd)", notes)
    }
    assert searched == {(f.n, f.parity) for f in bends.FAMILIES}
    assert {(row["n"], row["parity"]) for row in rows} <= searched


def test_tubes_and_gases_whose_mass_is_searched():
    rows, notes = read("beyond/controls_mass_folds")
    keys = (*TUBE, *tables_controls.NAMES)
    with_points = {tuple(row[k] for k in keys) for row in rows}
    numbers = [float(x) for x in re.findall(r"=([\d.]+)", notes)]
    without = set(map(tuple, np.reshape(numbers, (-1, 6)).tolist()))
    cases = {(t.alpha, t.delta1, t.lf, g.kappa, g.p_atm, g.V_r) for t, g in tables_controls.CASES}
    assert (with_points | without, with_points & without) == (cases, set())


@pytest.mark.parametrize("name", ["limit_points_alpha_0", "limit_points_alpha_0.1", "limit_points_off"])
def test_tubes_whose_limit_points_are_searched(name):
    rows, notes = read(f"paper2/{name}")
    _, tubes, keys, _ = tables_free.TABLES[name].args
    common = {k: getattr(tubes[0], k) for k in TUBE}
    with_points = {tuple((common | row)[k] for k in TUBE) for row in rows}
    assert with_points | named(notes, 3) == {(t.alpha, t.delta1, t.lf) for t in tubes}
    assert set(keys) <= set(rows[0])


def test_sets_whose_cusps_are_searched():
    rows, notes = read("paper2/cusp")
    with_points = {(row["alpha"], row["lf"]) for row in rows}
    assert with_points | named(notes, 2) == set(tables_free.CUSP_SETS)


def test_tubes_and_waves_whose_critical_points_are_searched():
    rows, _ = read("paper3/critical_points")
    found = {(row["L"], row["delta"], round(row["gamma"], 12), row["n"]) for row in rows}
    searched = {
        (t.L, t.delta, round(t.gamma, 12), n)
        for t, (_, waves) in tables_critical.SEARCH.items()
        for n in waves
    }
    assert found == searched
