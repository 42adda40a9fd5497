"""Tables match their checksums, and interpolation states its own uncertainty."""

import hashlib

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from weakforms.errors import InputError
from weakforms.verification.cases import references
from weakforms.verification.crosscheck.compare import compare
from weakforms.verification.crosscheck.rows import interpolated

FACTS = """
type = "independent"
abscissa = "x"
sha256 = "{sha}"
[parameters]
alpha = 0.1
[columns.x]
uncertainty = 0
[columns.y]
uncertainty = 1e-9
"""
ROWS = "x,y\n1,10\n2,20\n3,40\n"


@pytest.fixture
def stored(tmp_path):
    """Write a table with a correct checksum and return what is read from it."""
    folder = tmp_path / "reference_data" / "paper1"
    folder.mkdir(parents=True)

    def store(csv: str | bytes = ROWS, facts: str = FACTS, curve: bool = False) -> references.Reference:
        raw = csv.encode() if isinstance(csv, str) else csv
        (folder / "t.csv").write_bytes(raw)
        digest = hashlib.sha256(raw + facts.replace('sha256 = "{sha}"\n', "").encode()).hexdigest()
        (folder / "t.toml").write_text(facts.replace("{sha}", digest))
        references.load.cache_clear()
        if not curve:
            return references.load(1, "t", tmp_path)
        with pytest.MonkeyPatch.context() as patch:
            load = references.load
            patch.setattr(references, "load", lambda paper, name: load(paper, name, tmp_path))
            return references.load_curve(1, "t")

    yield store
    references.load.cache_clear()


def test_table_is_read(stored):
    table = stored(curve=True)
    assert (len(table), table.ordinates, table.kind) == (3, ["y"], "independent")
    assert table.columns["y"].tolist() == [10, 20, 40]
    assert table.uncertainty == {"x": 0.0, "y": 1e-9}
    assert table.parameters == {"alpha": 0.1}


def test_every_byte_counts(stored, tmp_path):
    stored()
    path = tmp_path / "reference_data" / "paper1" / "t.csv"
    about = path.with_suffix(".toml")
    whole = about.read_text()
    damages = [(path, text) for text in (ROWS[:-1], ROWS.replace("40", "41"), ROWS + "\n", "")]
    damages += [(about, whole.replace("1e-9", "1e-2")), (about, whole + "# a remark\n")]
    for changed, damaged in damages:
        before = changed.read_text()
        changed.write_text(damaged)
        references.load.cache_clear()
        with pytest.raises(InputError, match="truncated or altered"):
            references.load(1, "t", tmp_path)
        changed.write_text(before)
    references.load.cache_clear()
    assert len(references.load(1, "t", tmp_path)) == 3


@pytest.mark.parametrize(
    "csv",
    [
        "",
        "x,y\n",
        "x,y\n1,2\n3\n",
        "x,y\n1,2,3\n",
        "x,y\n1,nan\n",
        "x,y\n1,a\n",
        "x,x\n1,2\n",
        b"x,y\n1,\xff",
    ],
)
def test_what_is_no_table_is_refused_even_with_its_checksum(stored, csv):
    with pytest.raises(InputError, match=r"t\.csv"):
        stored(csv)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("1e-9", "-1e-9"),
        ("1e-9", "inf"),
        ("1e-9", "true"),
        ("[columns.y]", "[columns.z]"),
        ('"independent"', "3"),
        ('"x"', '"z"'),
        ("[parameters]", "columns = 3\n[parameters]"),
        ("abscissa", "= ="),
    ],
)
def test_facts_that_say_too_little_are_refused(stored, old, new):
    with pytest.raises(InputError, match="t"):
        stored(facts=FACTS.replace(old, new))


@pytest.mark.parametrize("x", [(1, 2, 2), (1, 3, 2)])
def test_curve_needs_an_abscissa_that_rises_or_falls(stored, x):
    csv = "x,y\n" + "".join(f"{v},0\n" for v in x)
    assert len(stored(csv)) == 3
    with pytest.raises(InputError, match="rise, or fall"):
        stored(csv, curve=True)


@pytest.mark.parametrize(
    "function",
    [
        np.sin,
        np.exp,
        lambda x: np.sqrt(x + 0.02),
        lambda x: np.tanh(8 * (x - 1)),
        lambda x: 1 / (1 + 9 * x**2),
    ],
)
@pytest.mark.parametrize("rows", [17, 33, 81])
@pytest.mark.parametrize("falling", [False, True])
def test_interpolation_error_is_bounded_and_not_by_far(function, rows, falling):
    table = np.linspace(0, 3, rows)
    x = np.linspace(0, 3, 777)[1:-1]
    order = slice(None, None, -1) if falling else slice(None)
    value, slack = interpolated(table[order], function(table)[order], x)
    error = np.abs(value - function(x))
    assert np.all(error <= slack + 1e-14)
    cubic = np.abs(make_interp_spline(table, function(table), k=3)(x) - function(x))
    assert slack.max() < 12 * cubic.max()


def test_rows_themselves_have_no_interpolation_error():
    x = np.linspace(0, 3, 20)
    value, slack = interpolated(x, np.sqrt(x), x)
    assert np.all(slack == 0)
    assert value == pytest.approx(np.sqrt(x), abs=1e-15)
    assert interpolated(x, np.sqrt(x), x[3:4] + 1e-9)[1] > 0


def test_short_table_is_not_interpolated():
    with pytest.raises(InputError, match="too short"):
        interpolated(np.arange(5.0), np.arange(5.0), np.array([0.5]))


def test_columns_of_python_lists_and_numpy_arrays_are_curves():
    columns = references.load(2, "fig03a_delta1_1").columns
    for kind in (list, np.asarray):
        curve = {name: kind(columns[name]) for name in ("u_max", "p")}
        verdicts = compare("paper2.fig03", curve, "fig03a_delta1_1", only=["p"])
        assert verdicts.passed
        assert not verdicts.partial
        assert verdicts.unjudged_rows == {"p": 0}


def test_rows_outside_the_table_are_counted_not_judged():
    columns = references.load(2, "fig03a_delta1_1").columns
    u = np.r_[0.0, columns["u_max"], 7.0]
    curve = {"u_max": u, "p": np.r_[99, columns["p"], 99]}
    verdicts = compare("paper2.fig03", curve, "fig03a_delta1_1", only="p")
    assert (verdicts.ignored_rows, verdicts.rows, verdicts.passed) == (2, len(columns["p"]), True)
    assert not verdicts.partial


def test_columns_the_case_does_not_ask_for_need_an_accuracy(monkeypatch):
    columns = references.load(2, "fig03a_delta1_1").columns
    curve = {name: columns[name] for name in ("u_max", "V")}
    from dataclasses import replace

    from weakforms.verification.cases.discovery import get_case
    from weakforms.verification.crosscheck import targets as module

    found = get_case("paper2.fig03")
    panels = [
        replace(panel, curves=tuple(replace(c, asked={"p": 1e-7}) for c in panel.curves))
        for panel in found.case.panels
    ]
    found = replace(found, case=replace(found.case, panels=tuple(panels)))
    monkeypatch.setattr(module, "get_case", lambda _: found)
    with pytest.raises(InputError, match="that are judged: p"):
        compare("paper2.fig03", curve, "fig03a_delta1_1")
    # p, which the case asks for, is missing: V alone is judged when it is asked for by name.
    assert compare("paper2.fig03", curve, "fig03a_delta1_1", 1e-6).status == "not judged"
    assert compare("paper2.fig03", curve, "fig03a_delta1_1", 1e-6, only=["V"]).passed
    with pytest.raises(InputError, match="state --accuracy"):
        compare("paper2.fig03", curve, "fig03a_delta1_1", only=["V"])
