"""The reference codes as a whole: material law, committed tables, the command, and what may be imported."""

import ast
import hashlib
import subprocess
import sys
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from led_astray import always, refused

from reference_data.solvers import registry
from reference_data.solvers.__main__ import main
from reference_data.solvers.core import continuity, tables
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.registry import tables as registered

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT / "reference_data"
EVERY = sorted(DATA.glob("*/*.toml"))
TOMLS = sorted(DATA.glob("paper*/*.toml"))
STEP = 1e-30


def read(path: Path) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a table, given its TOML file."""
    lines = path.with_suffix(".csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    columns = dict(zip(lines[0].split(","), numbers.T, strict=True))
    return tomllib.loads(path.read_text()), columns


def derive(f, *args) -> float:
    """Derivative with respect to the argument that carries the imaginary step."""
    return np.imag(f(*args)) / STEP


@pytest.mark.parametrize("alpha", [0.0, 0.1, 0.37])
@pytest.mark.parametrize(("l1", "l2"), [(1.3, 0.9), (0.7, 2.1), (3.0, 4.0)])
def test_constitutive_derivatives_against_complex_step(alpha, l1, l2):
    h = 1j * STEP
    assert mat.slope(l1, l2, alpha) == pytest.approx(derive(mat.energy, l1 + h, l2, alpha), 1e-13)
    assert mat.slope(l2, l1, alpha) == pytest.approx(derive(mat.energy, l1, l2 + h, alpha), 1e-13)
    assert mat.curvature(l1, l2, alpha) == pytest.approx(derive(mat.slope, l1 + h, l2, alpha), 1e-13)
    assert mat.mixed(l1, l2, alpha) == pytest.approx(derive(mat.slope, l1, l2 + h, alpha), 1e-13)


def test_energy_is_that_of_an_incompressible_mooney_rivlin_sheet():
    l1, l2, alpha = 1.7, 0.8, 0.1
    squares = np.array([l1, l2, 1 / (l1 * l2)]) ** 2
    invariants = squares.sum(), (squares.prod() / squares).sum()
    expected = invariants[0] - 3 + alpha * (invariants[1] - 3)
    assert mat.energy(l1, l2, alpha) == pytest.approx(expected, rel=1e-14)


def test_stress_resultants_vanish_as_they_should_in_uniaxial_tension():
    tube = Tube(0.1, 1.5, 6.0)
    t1, t2 = mat.resultants(tube.delta1, 1 / tube.r0, tube.alpha)
    assert t2 == pytest.approx(0, abs=1e-14)
    assert t1 > 0


def test_every_table_is_committed_and_listed(capsys):
    assert main(["--list"]) == 0
    listed = {line.split()[1] for line in capsys.readouterr().out.splitlines()}
    assert {p.stem for p in EVERY} == set(registered()) == listed


@pytest.mark.parametrize("path", EVERY, ids=lambda p: p.stem)
def test_committed_table_is_whole(path):
    about, columns = read(path)
    data = path.with_suffix(".csv").read_bytes()
    described = [x for x in path.read_bytes().splitlines(keepends=True) if not x.startswith(b"sha256 = ")]
    assert about["sha256"] == hashlib.sha256(data + b"".join(described)).hexdigest()
    assert about["type"] in {"exact", "independent", "printed", "other-code"}
    assert about["regenerate"] == f"python -m reference_data.solvers {path.stem}"
    assert list(columns) == list(about["columns"])
    assert b"\r" not in data
    assert b"e" not in data.split(b"\n", 1)[1]
    for column in about["columns"].values():
        assert column["uncertainty"] >= 0
        assert column["meaning"]
        assert column["scaling"]


@pytest.mark.parametrize("path", TOMLS, ids=lambda p: p.stem)
def test_table_of_a_paper_is_in_order_and_sharp(path):
    about, columns = read(path)
    keys = about.get("keys", [about["abscissa"]])
    rows = list(zip(*(columns[k] for k in keys), strict=True))
    assert keys[0] == about["abscissa"]
    if len(keys) == 1:
        assert all(a < b for a, b in pairwise(rows)) or all(a > b for a, b in pairwise(rows))
    assert len(set(rows)) == len(rows)
    for name, column in about["columns"].items():
        # Constrained inflation and papers 3 and 5 have bounds of their own, in the tests of their rooms.
        own = "contact" in about["parameters"] or "kind" in about["columns"]
        own |= path.parent.name in ("paper3", "paper5")
        if not own and not path.stem.startswith("ftim_"):
            assert column["uncertainty"] < 1e-9 * max(1.0, np.abs(columns[name]).max())


def test_disagreement_names_table_column_and_row():
    good, off = np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.001, 3.0])
    small = np.full(3, 1e-9)
    a, b = (tables.Estimate(v, small) for v in (good, off))
    with pytest.raises(tables.DisagreementError, match=r"table T, column p, row 1:"):
        tables.agreed("T", "p", a, b, ("1", "pressure"))


def test_numbers_are_plain_decimals():
    assert tables.plain(0.1) == "0.1"
    assert tables.plain(-1e-7 / 3) == "-0.0000000333333333333"
    assert tables.plain(12345.6789012345) == "12345.6789012"
    assert tables.plain(0.0) == "0"


@pytest.mark.parametrize("arguments", [["fig99"], ["fig02a_delta1_1", "fig99"], []])
def test_bad_request_is_one_line_and_status_two(arguments, tmp_path):
    command = [sys.executable, "-m", "reference_data.solvers", *arguments, "--out", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", sorted(DATA.rglob("*.py")), ids=lambda p: p.stem)
def test_reference_side_imports_nothing_of_the_other(path):
    allowed = {"numpy", "scipy", "reference_data"} | sys.stdlib_module_names
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            names = [node.module]
        else:
            continue
        assert {n.split(".")[0] for n in names} <= allowed


def test_a_table_of_one_name_in_two_modules(monkeypatch):
    monkeypatch.setattr(registry, "solvers_folders", always(["paper1", "paper1"]))
    refused("^table .* is defined twice$", registry.tables, error=ValueError)


def test_methods_of_two_that_differ():
    good = tables.Estimate(np.ones(2), np.full(2, 1e-9))
    about = "over C1", "pressure"
    tables.agreed("t", "p", good, good, about)
    for value in (1 + 1e-6, np.nan):
        other = tables.Estimate(np.array([1.0, value]), np.full(2, 1e-9))
        words = "^table t, column p, row 1: finite differences "
        refused(words, tables.agreed, "t", "p", other, good, about, error=tables.DisagreementError)


def test_orders_of_continuity_that_depend_on_the_mesh():
    """A jump of order 1 on one mesh and of order 2 on the other; equal orders are a table."""
    jumps = [dict.fromkeys(continuity.FIELDS, np.array(row)) for row in ([0, 0.5, 0.7, 1], [0, 0, 0.7, 1])]
    columns = continuity.columns("t", {2: lambda: (jumps[1], jumps[1])}, "X", "2 frictionless")
    assert next(c for c in columns if c.name == "first_jump").values == pytest.approx(np.full(6, 2.0))
    words = "^table t: order of rho, kind 2, depends on the resolution$"
    given = "t", {2: lambda: tuple(jumps)}, "X", "2 frictionless"
    refused(words, continuity.columns, *given, error=tables.DisagreementError)


def test_tables_of_a_series_say_what_the_series_says():
    series = tables.Series(2, "Paper", {"p": ("P", "pressure")}, "by hand", "none", "exact")
    columns = series.keys(p=[1, 2])
    table = series.table("t", "A table", "figure 1", {"alpha": 0.1}, columns, grid="fine")
    assert (table.source, table.method, table.grid) == ("Paper, figure 1", "by hand", "fine")
    assert (table.abscissa, columns[0].uncertainty, columns[0].meaning) == ("p", 0.0, "pressure")


def test_the_finer_of_two_levels_counts():
    levels = tables.Levels([1.0, 30.0], [1.5, 30.0], floor=0.25, rounding=1e-3)
    assert levels.value == pytest.approx([1.5, 30.0])
    assert levels.uncertainty == pytest.approx([0.5 + 0.25 + 1.5e-3, 0.25 + 0.03])
