"""Columns of other names and in units: maps, constants, and the dimension that each number has."""

import math

import numpy as np
import pytest
from curves_of_a_tube import CASE, CURVE, ONLY_P, as_csv, table

from weakforms import dimensional, nondimensional
from weakforms.errors import InputError
from weakforms.problems import registry
from weakforms.problems.about import About
from weakforms.problems.column import DIMENSIONS, PLACEHOLDER, Column, Units
from weakforms.scaling import unit
from weakforms.verification.crosscheck.compare import compare

CONSTANTS = {"R_f": 0.02, "C1": 2.1e5, "h_o": 1.5e-4}


def test_columns_of_other_names(weakforms, tmp_path):
    columns = table()
    file = as_csv(tmp_path / "c.csv", {"Pressure": columns["p"], "bulge": columns["u_max"]})
    words = (*ONLY_P, file, "--map", "p=Pressure", "--map", "u_max=bulge")
    assert weakforms(*words).status == 0
    swapped = weakforms(*words[:-3], "p=bulge", "--map", "u_max=Pressure")
    assert (swapped.status, "must rise, or fall" in swapped.err) == (2, True)


@pytest.mark.parametrize(
    ("mapping", "said"),
    [
        ("q=Pressure", "the table has no 'q'; it has u_max, p"),
        ("p=nothing", "the curve has no column 'nothing'; it has Pressure, bulge"),
        ("p", "--map 'p': NAME=VALUE is wanted"),
    ],
)
def test_a_wrong_map_is_named(weakforms, tmp_path, mapping, said):
    file = as_csv(tmp_path / "c.csv", {"Pressure": table()["p"], "bulge": table()["u_max"]})
    called = weakforms("compare", CASE, file, "--curve", CURVE, "--map", mapping)
    assert (called.status, called.err.count("\n")) == (2, 1)
    assert said in called.err


def test_a_curve_with_units(weakforms, tmp_path):
    metres_and_pascals = dimensional("tube", table(), **CONSTANTS)
    assert metres_and_pascals["p"][5] == pytest.approx(table()["p"][5] * 2.1e5 * 1.5e-4 / 0.02, rel=1e-15)
    file = as_csv(tmp_path / "c.csv", metres_and_pascals)
    words = [*ONLY_P, file]
    assert weakforms(*words).status == 1, "a factor of 1575"
    given = [word for name, value in CONSTANTS.items() for word in ("--constant", f"{name}={value}")]
    assert weakforms(*words, *given).status == 0
    thicker = (*words, *given[:-1], "h_o=1.6e-4")
    assert (weakforms(*thicker, "--accuracy", "1e-6").status, weakforms(*thicker).status) == (1, 5)


@pytest.mark.parametrize(
    ("constants", "said"),
    [
        (
            {"R_f": 0.02, "C1": 2e5},
            "h_o is missing: length is divided by R_f; .* volume is divided by 2 pi R_f",
        ),
        (CONSTANTS | {"h_o": 0.0}, "h_o = 0 must be positive"),
        (CONSTANTS | {"h_o": math.nan}, "h_o = nan must be positive"),
        (CONSTANTS | {"h": 1.0}, "no constant 'h'; its scaling takes R_f, C1, h_o"),
        (CONSTANTS | {"h_o": "thin"}, "h_o = 'thin' is not a number"),
    ],
)
def test_a_wrong_constant_is_named(constants, said):
    with pytest.raises(InputError, match=said):
        compare(CASE, table(), CURVE, constants=constants)


def test_there_and_back():
    columns = {name: np.linspace(0.1, 2.0, 5) for name in registry.abouts()["tube"].dimensions} | {
        "lam1": np.ones(5)
    }
    back = nondimensional("tube", dimensional("tube", columns, **CONSTANTS), **CONSTANTS)
    for name, values in columns.items():
        np.testing.assert_allclose(back[name], values, rtol=1e-14)


FORCE_AND_LENGTH = {
    "number": (0, 0),
    "length": (0, 1),
    "curvature": (0, -1),
    "stress": (1, -2),
    "pressure": (1, -2),
    "resultant": (1, -1),
    "force": (1, 0),
    "axial": (1, 0),
    "volume": (0, 3),
    "energy": (1, 1),
}
"""Powers of force and length that a kind of quantity has, whatever it is divided by."""


def with_one_column(dimension, turn=1.0):
    columns = (Column("x", dimension=dimension),)
    return About("any", "Any", 1, "", "", "", units=Units("R", "C", "h", turn), columns=columns)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_a_number_does_not_depend_on_the_system_of_units(dimension):
    """Constants in metres and newtons or in inches and pounds: each is converted by its dimension."""
    inch, pound = 0.0254, 4.4482216152605
    force, length = FORCE_AND_LENGTH[dimension]
    about = with_one_column(dimension, 2 * np.pi)
    metric = unit(about, "x", {"R": 0.02, "C": 2.1e5, "h": 1.5e-4})
    imperial = unit(about, "x", {"R": 0.02 / inch, "C": 2.1e5 / (pound / inch**2), "h": 1.5e-4 / inch})
    assert metric == pytest.approx(imperial * pound**force * inch**length, rel=1e-14)
    thicker = unit(about, "x", {"R": 0.02, "C": 2.1e5, "h": 3e-4})
    along = 0 if dimension == "stress" else force
    assert thicker == pytest.approx(metric * 2**along, rel=1e-14), "a membrane: forces go with its thickness"
    unturned = unit(with_one_column(dimension), "x", {"R": 0.02, "C": 2.1e5, "h": 1.5e-4})
    turns = 2 * np.pi if dimension in ("axial", "volume", "energy") else 1.0
    assert metric == pytest.approx(turns * unturned, rel=1e-14)


def test_a_text_is_written_with_the_constants_of_the_problem():
    units = Units("R_f", "C1", "h_o", 2 * np.pi)
    assert Column("V", "volume over {volume}").scale(units) == "volume over 2 pi R_f^3"
    assert Column("p", "P {1/pressure}").scale(units) == "P R_f/(C1 h_o)"
    assert Column("kappa", "curvature times {1/curvature}").scale(units) == "curvature times R_f"
    assert Column("Pi", "potential over {energy}").dimension == "energy"
    assert (units.unit("pressure"), units.unit("number")) == ("C1 h_o/R_f", "")


def declared():
    return [(about, c) for about in registry.abouts().values() for c in (*about.columns, *about.numbers)]


SAID_OTHERWISE = {
    *("X", "X_contact", "X_iso", "Z_front", "Z_front_1", "W_relaxed", "W_modified", "force", "p_maxwell"),
}
"""Numbers whose dimension the text does not state: as another one, or in other words."""
PARAMETERS = {"C1", "mu", "beta"}
"""Numbers whose text says what the constants are, or by what a parameter is divided."""


def test_a_text_states_the_dimension_of_its_number():
    """Otherwise the text and the unit of ``--constant`` could differ."""
    for about, column in declared():
        stated = {hit[1] for hit in PLACEHOLDER.finditer(column.text)} or {"number"}
        if column.text and column.name not in SAID_OTHERWISE:
            assert stated == {column.dimension}, (about.name, column.name)
        modulus = about.units.modulus
        if column.dimension == "number" and modulus:
            assert modulus not in column.text.split() or column.name in PARAMETERS, (about.name, column.name)
        assert column.dimension in DIMENSIONS


def test_a_number_is_declared_once_in_a_problem_and_has_one_symbol():
    for about in registry.abouts().values():
        names = [column.name for column in {*about.columns, *about.numbers}]
        assert sorted(names) == sorted(set(names)), about.name
    symbols = {(column.name, column.symbol) for _, column in declared() if column.symbol}
    assert len({name for name, _ in symbols}) == len(symbols)
