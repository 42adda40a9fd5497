"""The committed tables of paper 3: accuracy, regeneration, and the paper's claims about the numbers."""

import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from committed_tables import assert_same_table, uncertainties

from reference_data.solvers.__main__ import main
from reference_data.solvers.paper3 import tables_critical as paper3_critical
from reference_data.solvers.paper3 import tables_primary as paper3
from reference_data.solvers.paper3 import tables_secondary as paper3_secondary
from reference_data.solvers.paper3.data import FluidTube

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "paper3"
SETS = [(L, d) for L in (8, 24) for d in (1.5, 2, 3)]
SECONDARY = {*paper3_secondary.TABLES}


def read(name: str, folder: Path = DATA) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a table."""
    lines = (folder / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    columns = dict(zip(lines[0].split(","), numbers.T, strict=True))
    return tomllib.loads((folder / f"{name}.toml").read_text()), columns


def critical(L: float, delta: float, n: int, gamma: float = 0.116) -> dict[str, float]:
    """Row of the table of critical points."""
    _, c = read("critical_points")
    row = np.flatnonzero(
        (c["L"] == L) & (c["delta"] == delta) & (np.abs(c["gamma"] - gamma) < 1e-9) & (c["n"] == n)
    )
    assert len(row) == 1
    return {k: float(v[row[0]]) for k, v in c.items()}


@pytest.mark.parametrize("name", sorted({*paper3.TABLES, *paper3_critical.TABLES}))
def test_axisymmetric_tables_are_accurate(name):
    about, columns = read(name)
    for column, facts in about["columns"].items():
        assert facts["uncertainty"] < 2e-9 * max(1.0, np.abs(columns[column]).max()), column


@pytest.mark.parametrize("name", sorted(SECONDARY))
def test_secondary_tables_are_accurate(name):
    """At least five times more accurate than the weak forms must be: 1e-5, stress resultants 1e-4."""
    about, columns = read(name)
    for column, facts in about["columns"].items():
        sharp = 2e-5 if column.startswith(("T", "lam")) else 1e-4 if column.startswith("Lambda") else 2e-6
        assert facts["uncertainty"] < sharp * max(1.0, np.abs(columns[column]).max()), column


@pytest.mark.parametrize("name", ["dry", "fig05a_zw_4"])
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    regenerate_and_compare(name, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["primary_L_24_delta_2", "spectrum_L_8_delta_2", "secondary_turn"])
def test_regenerated_large_table_equals_the_committed_one(name, tmp_path):
    regenerate_and_compare(name, tmp_path)


def regenerate_and_compare(name, folder):
    assert main([name, "--out", str(folder)]) == 0
    about, committed = read(name)
    new_about, new = read(name, folder / "paper3")
    assert_same_table(new, committed, about, uncertainties(new_about))
    for key in ("title", "source", "type", "method", "grid", "abscissa", "regenerate"):
        assert new_about[key] == about[key]


@pytest.mark.parametrize(("L", "delta"), SETS)
def test_level_has_one_maximum_and_volume_rises(L, delta):
    _, c = read(f"primary_L_{L}_delta_{delta}")
    assert np.all(np.diff(c["V"]) > 0)
    assert np.sum(np.diff(np.sign(np.diff(c["zw"]))) != 0) == 1
    limit = critical(L, delta, 0)
    assert (limit["zw"] > L) == (L == 8)
    assert limit["zw"] > c["zw"].max()


def test_limit_point_comes_first_unless_the_stretch_is_extreme():
    for L, delta in SETS:
        assert critical(L, delta, 0)["V"] < critical(L, delta, 1)["V"] < critical(L, delta, 2)["V"]
    for L, delta in ((8, 5), (24, 1.1), (8, 7)):
        assert critical(L, delta, 1)["V"] < critical(L, delta, 0)["V"]
    assert critical(8, 7, 2)["V"] < critical(8, 7, 1)["V"]


def test_order_changes_where_the_two_points_coincide():
    _, c = read("coincidence")
    assert list(c["L"]) == [8, 24]
    assert 3 < c["delta"][0] < 5
    assert 1.1 < c["delta"][1] < 1.5


@pytest.mark.parametrize(("L", "delta"), SETS)
def test_signs_of_the_eigenvalues(L, delta):
    _, c = read(f"spectrum_L_{L}_delta_{delta}")
    limit, fork = critical(L, delta, 0)["V"], critical(L, delta, 1)["V"]
    assert np.array_equal(c["Lambda_n0"] > 0, c["V"] < limit)
    assert np.array_equal(c["Lambda_n1"] > 0, c["V"] < fork)
    before = c["V"] < fork
    for name in ("Lambda_n2", "Lambda_n3", "Lambda_torsion", "LambdaV_n0"):
        assert np.all(c[name][before] > 0), name


def test_heavier_fluid_lowers_both_critical_levels():
    for L in (8, 24):
        for n in (0, 1):
            levels = [critical(L, 2, n, gamma)["zw"] for gamma in (0.058, 0.116, 0.232)]
            assert levels[0] > levels[1] > levels[2]
    assert critical(8, 2, 0, 0.232)["zw"] < 8  # double density: the limit point is partially filled


def test_limit_level_falls_with_the_stretch_then_rises():
    for L in (8, 24):
        levels = [critical(L, d, 0)["zw"] for d in (1.5, 2, 3)]
        assert levels[0] > levels[1] > levels[2]
    assert critical(8, 5, 0)["zw"] > critical(8, 3, 0)["zw"]


def test_two_values_of_gamma_differ_by_half_a_thousandth():
    exact = 3.924 / 33.8
    for L, delta in SETS:
        for n in (0, 1):
            ratio = critical(L, delta, n, exact)["zw"] / critical(L, delta, n)["zw"]
            assert 1e-4 < 1 - ratio < 1e-3


@pytest.mark.parametrize(("L", "delta"), SETS)
def test_secondary_branch_falls_and_keeps_one_negative_eigenvalue(L, delta):
    _, c = read(f"secondary_L_{L}_delta_{delta}")
    assert np.all(np.diff(c["zw"]) > 0)
    fork = critical(L, delta, 1)
    assert c["zw"][-1] < fork["zw"]
    assert c["V"].max() < fork["V"]
    assert np.all(c["Lambda_1"] < 0)
    assert np.all(c["LambdaV_1"] < 0)
    assert np.all(c["r_mid"] > c["r_mid_pi"])
    assert np.all(np.diff(c["z_min"]) >= 0)  # it hangs lower and lower, in the end below the ring
    assert c["z_min"][0] < 0
    if (L, delta) == (24, 1.5):
        assert "Lambda_2" not in c  # compressed: see the table's notes
        assert np.all(c["T_min"] < 0)
    else:
        assert np.all(c["Lambda_2"] > 0)
        assert np.all(c["Lambda_breaking"] > 0)
        assert np.all(c["T_min"] > 0)


def test_displacement_of_the_secondary_branch_turns_for_the_short_tube_only():
    _, c = read("secondary_L_8_delta_2")
    top = int(np.argmax(c["r_mid"]))
    assert 0 < top < len(c["r_mid"]) - 1
    _, t = read("secondary_turn")
    assert t["r_mid"][0] >= c["r_mid"].max()
    assert t["zw"][0] > 7.336
    _, c = read("secondary_L_24_delta_2")
    assert np.all(np.diff(c["r_mid"][c["zw"] >= 7.7]) < 0)


def test_initial_slope_continues_the_branch():
    _, s = read("secondary_slopes")
    assert np.all(s["dzw_dV"] > 0)
    assert np.all(s["dzw_dA2"] < 0)
    for L, delta, slope in zip(s["L"], s["delta"], s["dzw_dV"], strict=True):
        fork = critical(L, delta, 1)
        _, c = read(f"secondary_L_{L:g}_delta_{delta:g}")
        chord = (fork["zw"] - c["zw"][-1]) / (fork["V"] - c["V"][-1])
        assert chord == pytest.approx(slope, rel=0.02)


def test_no_wrinkles_on_the_primary_branches_of_the_paper():
    for name in paper3.TABLES:
        if name.startswith("fig0"):
            _, c = read(name)
            assert np.all(c["T1"] > 0)
            assert np.all(c["T2"] > 0)


def test_published_secondary_states_are_tense():
    for name in ("fig08a", "fig08b", "fig06", "fig06_L_8"):
        about, c = read(name)
        assert about["parameters"]["T_min"] > 0
        assert c["T1"].min() > 0
        assert c["T2"].min() > 0


def test_pre_stretch_stiffens_at_low_levels_only():
    _, c = read("crossings")
    for L in (8, 24):
        early = (c["L"] == L) & (c["post_a"] == 0) & (c["post_b"] == 0)
        assert np.all((c["zw"][early] > 4) & (c["zw"][early] < 7.5))
        assert early.sum() == 3


def test_deformation_concentrates_below_after_the_limit_point():
    _, c = read("primary_L_24_delta_2")
    after = c["V"] > critical(24, 2, 0)["V"]
    assert np.all(np.diff(c["r_max"][after]) > 0)
    assert np.all(np.diff(c["zw"][after]) < 0)


def test_tables_belong_to_the_sets_of_the_paper():
    assert {FluidTube(L, d) for L, d in SETS} == set(paper3.PAPER) == set(paper3_secondary.LEVELS)


LEVELS = paper3_secondary.LEVELS | paper3_secondary.DENSER


@pytest.mark.parametrize("tube", LEVELS, ids=str)
def test_the_levels_of_the_secondary_branch_are_those_of_its_committed_table(tube):
    density = f"_gamma_{tube.gamma:g}" if tube in paper3_secondary.DENSER else ""
    _, columns = read(f"secondary_L_{tube.L:g}_delta_{tube.delta:g}{density}")
    assert tuple(columns["zw"]) == LEVELS[tube]


@pytest.mark.parametrize("compressed", [True, False])
def test_a_compressed_tube_keeps_the_eigenvalues_that_both_methods_resolve(compressed, monkeypatch):
    """The table of such a tube has two eigenvalues only: the others belong to short wrinkles of the mesh."""
    eigen = {"Lambda_1": 1.0, "Lambda_2": 2.0, "Lambda_breaking": 3.0, "LambdaV_1": 4.0}
    of = SimpleNamespace(rotation=0.0, columns=lambda: eigen)
    monkeypatch.setattr(paper3_secondary, "compared", lambda _, found: found[:2])
    monkeypatch.setattr(paper3_secondary, "states", SimpleNamespace(stability=lambda *_: of, quantities=dict))
    balance = SimpleNamespace(stability=lambda _: eigen, quantities=dict)
    monkeypatch.setattr(paper3_secondary, "balance", balance)
    both = SimpleNamespace(
        STEEP=(), balanced=lambda _: ({"V": 1.0},) * 2, paired=lambda _, column, *__: column
    )
    monkeypatch.setattr(paper3_secondary, "bent", both)
    tube = FluidTube(24, 1.5) if compressed else FluidTube(24, 2)
    columns, _ = paper3_secondary.curve_columns("a table", tube, (8.0,), lambda *_: ({"V": 1.0},) * 3)
    kept = ["Lambda_1", "LambdaV_1"] if compressed else [*eigen]
    assert columns[1:] == ["V", *kept]
