"""The committed tables of paper 5: accuracy, regeneration, and the paper's claims about the numbers."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.__main__ import main
from reference_data.solvers.paper5 import tables_bending as paper5_bending
from reference_data.solvers.paper5 import tables_cylinder as paper5
from reference_data.solvers.paper5 import tables_hemisphere as paper5_hemisphere
from reference_data.solvers.paper5 import tables_linearised as paper5_linearised
from reference_data.solvers.paper5 import tables_other_hemispheres as paper5_others
from reference_data.solvers.paper5 import tables_surface as paper5_surface
from reference_data.solvers.paper5.cases import cylinder
from reference_data.solvers.paper5.hemisphere.states import levels
from reference_data.solvers.paper5.waves.cylinder import FLUID, quadratic

pytestmark = pytest.mark.paper5
DATA = Path(__file__).resolve().parents[3] / "reference_data" / "paper5"
MODULES = (paper5, paper5_bending, paper5_hemisphere, paper5_linearised, paper5_others, paper5_surface)
NAMES = sorted(name for m in MODULES for name in m.TABLES)


def read(name: str, folder: Path = DATA) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a table."""
    lines = (folder / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    columns = dict(zip(lines[0].split(","), numbers.T, strict=True))
    return tomllib.loads((folder / f"{name}.toml").read_text()), columns


def changes(name: str) -> dict[tuple[int, int], float]:
    """Loads by wave number and direction."""
    _, c = read(name)
    n, direction, load = c.values()
    return {(int(a), int(b)): float(x) for a, b, x in zip(n, direction, load, strict=True)}


@pytest.mark.parametrize("name", NAMES)
def test_tables_are_sharper_than_the_accuracy_asked(name):
    """Eigenvalues and crossings must be accurate to 1e-5."""
    about, columns = read(name)
    assert set(about["columns"]) == set(columns)
    for column, facts in about["columns"].items():
        size = max(1.0, float(np.abs(columns[column]).max()))
        limit = 1e-4 if name == "bending_critical" else 2e-6
        assert facts["uncertainty"] <= limit * size, column
        # or else the methods' agreement would say little
        assert facts.get("uncertainty_shooting", 0.0) <= 1e-4 * size, column


@pytest.mark.parametrize("name", ["gw_fluid_zw_6.6", "gw_gas_p_0.2", "gw_hemisphere_zw_-0.7"])
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, columns = read(name)
    new, values = read(name, tmp_path / "paper5")
    for key in ("title", "source", "type", "method", "abscissa", "regenerate", "parameters"):
        assert new[key] == about[key]
    # the hemisphere was shot with adaptive steps when its tables were written
    assert new["grid"] == about["grid"].replace(
        "tolerances 1e-11 and 1e-13", "then 32 segments of 5 and 10 steps"
    )
    for column, facts in about["columns"].items():
        room = facts["uncertainty"] + new["columns"][column]["uncertainty"]
        assert np.all(np.abs(values[column] - columns[column]) <= room), column


@pytest.mark.parametrize("n", [20, 50])
def test_a_stored_crossing_is_one(n):
    zw = changes("stability_changes_fluid")[n, 1]
    form = cylinder(FLUID, zw).forms[0]
    assert abs(form.first(n)) < 1e-7


def test_ends_of_the_unstable_intervals_move_as_the_paper_says():
    """Fluid: the lower end falls and the upper end rises with n; the printed 3.6 and 2.6."""
    found = changes("stability_changes_fluid")
    lower = [x for (_, d), x in sorted(found.items()) if d == 1]
    upper = [x for (_, d), x in sorted(found.items()) if d == -1]
    assert np.all(np.diff(lower) < 0)
    assert np.all(np.diff(upper) > 0)
    assert round(found[20, 1], 1) == 3.6
    assert found[50, 1] == pytest.approx(2.6, abs=0.05)


def test_signs_of_the_figures():
    """Figures 5, 7 and 10: which eigenvalues cross zero within the ranges shown."""
    for name, negative in (
        ("modes_fluid_n_1", False),
        ("modes_fluid_n_20", True),
        ("modes_fluid_n_50", True),
        ("modes_gas_n_1", False),
        ("modes_gas_n_5", False),
        ("modes_gas_n_15", True),
        ("modes_gas_n_20", True),
        ("modes_hemisphere_n_10", False),
        ("modes_hemisphere_n_50", True),
    ):
        _, c = read(name)
        lowest = c["Lambda_1"]
        assert bool(np.any(lowest < 0)) == negative, name
        assert np.all(lowest <= c["Lambda_2"]), name
        assert np.all(c["Lambda_2"] <= c["Lambda_3"]), name
    assert read("modes_gas_n_15")[1]["Lambda_1"][-1] > 0 > read("modes_gas_n_20")[1]["Lambda_1"][-1]
    hemisphere = read("modes_hemisphere_n_50")[1]
    assert hemisphere["Lambda_1"][0] < 0 < hemisphere["Lambda_1"][-1]


def test_mode_of_figure_6():
    """Almost no meridional motion; circumferential and normal motion have one sign where they are large."""
    _, c = read("mode_n_100_zw_3")
    assert np.abs(c["meridional"]).max() < 0.01 * np.abs(c["normal"]).max()
    large = np.abs(c["normal"]) > 0.01 * np.abs(c["normal"]).max()
    assert np.all(c["circumferential"][large] * c["normal"][large] > 0)
    assert np.all(c["Z"][large] < 4.2)  # "over some part of the membrane": the lower half


def test_printed_ranges_of_the_polyhedra():
    """The four ends to a hundredth; the meridional mesh matters only where a ring turns taut."""
    _, c = read("surface_ranges")
    rows = {
        (int(a), int(b), int(k)): i
        for i, (a, b, k) in enumerate(zip(c["N_S"], c["N_C"], c["rule"], strict=True))
    }
    first, second = rows[120, 48, 1], rows[80, 96, 1]
    assert c["lower"][first] == pytest.approx(5.14, abs=0.005)
    assert c["upper"][first] == pytest.approx(6.81, abs=0.005)
    assert c["lower"][second] == pytest.approx(4.03, abs=0.005)
    assert c["upper"][second] == pytest.approx(9.81, abs=0.005)
    assert abs(c["lower"][rows[60, 48, 1]] - c["lower"][first]) < 0.02
    assert abs(c["lower"][rows[40, 96, 1]] - c["lower"][second]) < 0.02
    assert np.all(np.abs(c["n_lower"] - c["N_C"] / 4) <= 2)
    assert np.all(c["n_eff_lower"] < c["N_C"] / (2 * np.pi))


def test_linearised_theory_overestimates():
    _, c = read("linearised")
    assert np.all(c["n_star"] > c["n_true"])
    assert np.all(c["B"] < 0)
    assert np.all(c["A"] > 0)


def test_bending_bounds_the_unstable_band():
    _, bands = read("bending_bands")
    assert np.all(bands["n_minus"] < bands["n_plus"])
    _, window = read("bending_window")
    assert np.all(read("bending_hemisphere")[1]["Lambda_B1"] > 0)
    membrane = changes("stability_changes_fluid")
    assert membrane[7, 1] < window["zw"][0] < window["zw"][1] < membrane[7, -1]


def test_hemisphere_limit_point_has_a_vanishing_axisymmetric_eigenvalue():
    _, limit = read("hemisphere_limit")
    near = quadratic(levels().at(-0.48)).first(0)
    nearer = quadratic(levels().at(-0.479)).first(0)
    gap = limit["zw"][0] + np.array([0.48, 0.479])
    assert near / nearer == pytest.approx(np.sqrt(gap[0] / gap[1]), rel=0.05)
