"""What a verdict on a user's curve accepts and what it does not."""

import json

import numpy as np
import pytest
from curves_of_tables import FREE, PIECE, TUBE, columns_of, verdict_on
from hypothesis import given, settings
from hypothesis import strategies as st

from weakforms import InputError, compare
from weakforms.results import Branch, Result
from weakforms.verification.cases import references
from weakforms.verification.crosscheck.rows import FLOOR, interpolated, judge_column, met, scale_of

ASKED = 5e-10
"""Accuracy that the case of the test piece asks of our own code."""
FAST = settings(max_examples=40, deadline=None)


def stress(lam):
    """Nominal stress of the neo-Hookean test piece, uniaxial."""
    return 2 * (lam - lam**-2)


# -- columns -------------------------------------------------------------------------------------


@pytest.mark.parametrize("missing", ["p", "lam1_mid", "t1_mid", "V"])
def test_a_missing_column_is_named_and_does_not_pass(missing):
    curve = columns_of(TUBE)
    del curve[missing]
    verdicts = verdict_on(TUBE, curve)
    assert (verdicts.status, verdicts.missing, verdicts.exit_status) == ("not judged", (missing,), 5)
    assert not verdicts.passed
    (absent,) = [v for v in verdicts.verdicts if v.column == missing]
    assert (absent.status, absent.error) == ("not judged", None)
    assert f"no column {missing}" in absent.detail
    others = [name for name in ("p", "lam1_mid", "t1_mid", "V") if name != missing]
    asked_for = verdict_on(TUBE, curve, only=others)
    assert (asked_for.passed, asked_for.left_out) == (True, (missing,))


def test_a_wrong_column_fails_though_another_is_missing():
    curve = columns_of(TUBE, V=1.01)
    del curve["p"]
    assert verdict_on(TUBE, curve, 1e-6).status == "failed"
    curve["V"] = 2 * curve["V"]
    assert verdict_on(TUBE, curve).status == "failed"


def test_what_a_case_draws_in_three_panels_is_judged_in_three_columns():
    which = ("paper5.fig05", "modes_fluid_n_20")
    curve = columns_of(which)
    assert [v.column for v in verdict_on(which, curve).verdicts] == ["Lambda_1", "Lambda_2", "Lambda_3"]
    theirs = {name.replace("Lambda", "Lambda_n20"): values for name, values in curve.items()}
    assert verdict_on(which, theirs).passed, "our own solutions call them so"
    wrong = theirs | {"Lambda_n20_3": 1.01 * curve["Lambda_3"]}
    assert [v.status for v in verdict_on(which, wrong, 1e-6).verdicts] == ["passed", "passed", "failed"]
    assert [v.status for v in verdict_on(which, wrong).verdicts] == ["passed", "passed", "not judged"]


def test_columns_are_asked_for_by_names_that_the_table_has():
    with pytest.raises(InputError, match=r"--column q: table .* has no such column; it has p, lam1_mid"):
        compare(TUBE[0], columns_of(TUBE), TUBE[1], only=["q"])


# -- scale ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("upto", [0.05, 0.15])
@pytest.mark.parametrize("part", [slice(0, 3), slice(None)])
@pytest.mark.parametrize("which", [FREE, ("paper1.free", "free_alpha_0_beta_1")])
def test_the_first_rows_count_as_much_as_the_last(which, part, upto):
    curve = columns_of(which, part)
    assert verdict_on(which, curve, 1e-2).passed
    curve["p"] = curve["p"] * np.where(curve["t0"] <= upto, 1.5, 1.0)
    verdicts = verdict_on(which, curve, 1e-2)
    assert verdicts.exit_status == 1
    assert verdicts.verdicts[0].where in ("t0 = 0.05", "t0 = 0.1", "t0 = 0.15")


@pytest.mark.parametrize(
    ("rows", "factor", "said"),
    [
        (slice(0, 3), 1.5, "3 of 100 rows are out of bounds, at u_max = 0.05 to 0.15, above the table"),
        (slice(9, 10), 0.9, "1 of 100 rows is out of bounds, at u_max = 0.5, below the table"),
        (
            slice(0, 10, 9),
            np.array([0.9, 1.1]),
            "2 of 100 rows are out of bounds, at u_max = 0.05 to 0.5, on both",
        ),
        (slice(0, 60), 0.9, "the errors lie below the table and fall with u_max"),
    ],
)
def test_the_rows_out_of_bounds_are_named_and_on_which_side_they_lie(rows, factor, said):
    curve = columns_of(TUBE)
    curve["p"] = curve["p"].copy()
    curve["p"][rows] *= factor
    verdicts = verdict_on(TUBE, curve, accuracy=1e-3, only=["p"])
    assert verdicts.verdicts[0].trend.startswith(said)


def test_where_a_column_passes_through_zero_there_is_a_floor():
    x = np.linspace(-1, 1, 11)
    scale, floor = scale_of(x, x[3:8], x[3:8])
    assert floor == pytest.approx(FLOOR * 0.4)
    assert scale == pytest.approx(np.maximum(np.abs(x[3:8]), floor))
    zero = np.zeros(3)
    assert scale_of(np.array([0.0, 0, 0, 5]), zero, zero)[1] == FLOOR * 5
    assert scale_of(zero, zero, zero)[1] == 1.0


def test_the_scale_is_said():
    (verdict, *_) = verdict_on(TUBE, columns_of(TUBE)).verdicts
    assert "the table's value at the row, but no less than 0.01 of its largest" in verdict.scale
    assert verdict.scale_floor == pytest.approx(FLOOR * columns_of(TUBE)["p"].max())


# -- enough rows ---------------------------------------------------------------------------------


def test_one_good_row_does_not_speak_for_eight_that_cannot_be_judged():
    lam = np.array([1.15, 1.25, 1.3, 1.35, 1.45, 1.55, 1.65, 1.75, 1.85])
    wrong = stress(lam) * np.where(np.isclose(lam, 1.3), 1, 1 + 1e-7)
    verdicts = verdict_on(PIECE, {"lam": lam, "T": wrong})
    assert (verdicts.status, verdicts.unjudged_rows) == ("not judged", {"T": 8})
    assert "a verdict needs more than half of the rows" in verdicts.verdicts[0].detail
    # What is beyond even the wide bound is wrong, and fails.
    far = {"lam": lam, "T": stress(lam) * np.where(lam > 1.8, 1.1, 1)}
    assert verdict_on(PIECE, far, ASKED).status == "failed"
    assert verdict_on(PIECE, far | {"T": 1.1 * far["T"]}).status == "failed"


@pytest.mark.parametrize(("good", "status"), [(4, "not judged"), (5, "passed")])
def test_more_than_half_of_the_rows_are_needed(good, status):
    lam = np.sort(np.r_[columns_of(PIECE)["lam"][:good], 1.13, 1.23, 1.33, 1.43])
    assert verdict_on(PIECE, {"lam": lam, "T": stress(lam)}).status == status


@pytest.mark.parametrize("count", [1, 2])
def test_two_rows_are_no_curve(count):
    ends = [0, -1][:count]
    curve = {name: values[ends] for name, values in columns_of(TUBE).items()}
    verdicts = verdict_on(TUBE, curve)
    assert verdicts.status == "not judged"
    assert "a verdict needs 3 rows" in verdicts.verdicts[0].detail


@pytest.mark.parametrize("part", [slice(0, 20), slice(40, 60), slice(None)], ids=["begin", "middle", "all"])
def test_errors_are_relative_to_the_part_of_the_table_that_a_curve_covers(part):
    """The largest value may lie between rows of the curve, and values beyond its ends do not count."""
    table = references.load(2, TUBE[1])
    x, values = (table.columns[name][part] for name in ("u_max", "p"))
    ends = np.array([0, len(x) - 1])
    judged = judge_column(table, "p", x[ends], values[ends], 1e-3, ends + 1)
    assert judged.verdict.scale_floor == pytest.approx(FLOOR * values.max(), rel=1e-12)


def test_a_curve_that_jumps_over_the_table_is_told_so():
    curve = {name: values[[0, 50, -1]] for name, values in columns_of(TUBE).items()}
    verdicts = verdict_on(TUBE, curve)
    assert (verdicts.passed, verdicts.partial) == (True, True)
    assert (verdicts.met_rows, verdicts.table_rows) == (2 + 3 + 2, 100)
    assert "7 of 100 rows are covered" in verdicts.extent
    rows = np.linspace(0, 1, 11)
    assert met(rows, rows[::2]) == 11
    assert met(rows, np.array([0.5])) == 3
    assert met(rows, np.array([0.55])) == 2


def test_an_accuracy_that_nearly_anything_meets_is_refused():
    for accuracy in (0.2, 0.99, 1.0, 0.0, -1e-3, np.nan):
        with pytest.raises(InputError, match=r"must lie between 0 and 0\.1"):
            compare(TUBE[0], columns_of(TUBE), TUBE[1], accuracy)


def test_an_accuracy_beyond_the_tables_own_is_not_judged():
    assert verdict_on(TUBE, columns_of(TUBE), 1e-14).status == "not judged"


# -- rounding ------------------------------------------------------------------------------------


@FAST
@given(st.lists(st.integers(-3, 3), min_size=29, max_size=29), st.booleans())
def test_an_abscissa_off_by_rounding_loses_no_row(units, falling):
    lam = columns_of(PIECE)["lam"]
    off = lam + np.array(units) * np.spacing(lam)
    curve = {"lam": off, "T": stress(off)}
    if falling:
        curve = {name: values[::-1] for name, values in curve.items()}
    verdicts = verdict_on(PIECE, curve)
    assert verdicts.passed
    assert (verdicts.rows, verdicts.ignored_rows, verdicts.partial) == (29, 0, False)
    (verdict,) = verdicts.verdicts
    assert (
        verdict.bound < 10 * verdict.asked
    )  # the rounding times the slope, and nothing of the interpolation


def test_the_rows_that_linspace_gives_are_all_judged():
    lam = np.linspace(1.1, 3.9, 29)
    assert not np.isin(lam, columns_of(PIECE)["lam"]).all()
    verdicts = verdict_on(PIECE, {"lam": lam, "T": stress(lam)})
    assert (verdicts.passed, verdicts.unjudged_rows) == (True, {"T": 0})
    assert verdict_on(PIECE, {"lam": lam, "T": stress(lam) * (1 + 1e-7)}, ASKED).status == "failed"


def test_single_precision_of_the_abscissa_is_near_enough():
    lam = columns_of(PIECE)["lam"].astype(np.float32).astype(float)
    verdicts = verdict_on(PIECE, {"lam": lam, "T": stress(lam)})
    assert verdicts.passed
    # What was computed at another abscissa than it is given at is off by the slope times the offset.
    assert verdict_on(PIECE, {"lam": lam, "T": stress(columns_of(PIECE)["lam"])}, ASKED).status == "failed"


@FAST
@given(st.floats(0, 1), st.sampled_from([np.sin, np.exp, lambda x: np.sqrt(x + 0.2)]))
def test_close_to_a_row_the_interpolation_is_closer(part, function):
    rows = np.linspace(0, 3, 40)
    x = rows[:-1] + part * 1e-3 * np.diff(rows)
    value, slack = interpolated(rows, function(rows), x)
    assert np.all(np.abs(value - function(x)) <= slack + 1e-14)
    middle = interpolated(rows, function(rows), rows[:-1] + np.diff(rows) / 2)[1]
    assert np.all(slack <= 0.04 * middle + 1e-14)


# -- what is said of the errors ------------------------------------------------------------------


def test_the_largest_error_stands_beside_the_one_nearest_its_bound():
    lam = np.sort(np.r_[columns_of(PIECE)["lam"], 2.45])
    values = stress(lam)
    values[list(lam).index(2.45)] *= 1 - 1e-3  # the largest, where the table is coarse
    values[20] *= 1 + 1e-4  # less, but at a row of the table
    (found,) = verdict_on(PIECE, {"lam": lam, "T": values}, ASKED).verdicts
    assert (found.row, found.signed_error) == (21, pytest.approx(1e-4, rel=1e-3))
    assert (found.error, found.where) == (found.signed_error, f"lam = {lam[20]:g}")
    assert (found.largest["row"], found.largest["error"]) == (15, pytest.approx(-1e-3, rel=1e-2))
    assert found.largest["bound"] > found.bound
    # Claiming a little more than the largest error passes.
    assert verdict_on(PIECE, {"lam": lam, "T": values}, 1.01e-3).passed


def test_rows_are_numbered_as_they_were_given():
    curve = columns_of(TUBE, slice(None, None, -1))
    curve = {name: np.r_[values[0] + 1, values] for name, values in curve.items()}  # one beyond the table
    curve["p"][31] *= 1.01
    (found,) = [v for v in verdict_on(TUBE, curve, 1e-6).verdicts if v.column == "p"]
    assert found.row == found.largest["row"] == 32


# -- parameters ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("problem", "parameters", "said"),
    [
        ("tube", {"alpha": 0.1, "delta1": 1.1, "lf": 6.0, "p_end": 2.0, "contact": "none"}, None),
        ("tube", {"alpha": 0.1, "delta1": 1.2, "lf": 6}, "delta1 = 1.2 (the table's: 1.1)"),
        ("tube", {"alpha": 0.1, "delta1": 1.1, "lf": 6, "model": "gent"}, "model = gent"),
        ("tube", {"alpha": 0.1, "delta1": 1.1, "lf": 6, "contact": "adhesive"}, "contact = adhesive"),
        ("tube_fold", {"alpha": 0.1}, "a result of tube_fold, table fig03a_delta1_1.1 is for tube"),
    ],
)
def test_a_result_for_other_parameters_is_refused(problem, parameters, said, tmp_path):
    (tmp_path / "r.json").write_text(json.dumps(result(problem, parameters, columns_of(TUBE))))
    if said is None:
        assert verdict_on(TUBE, tmp_path / "r.json").passed
        return
    with pytest.raises(InputError) as refused:
        compare(TUBE[0], tmp_path / "r.json", TUBE[1])
    assert said in str(refused.value)


def result(problem, parameters, columns, branch="primary"):
    """A result that follows the schema."""
    versions = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")
    provenance = {**versions, "ranks": 1, "wall_s": 0.0}
    branches = [Branch(branch, "p", columns)]
    return Result(problem, parameters, {}, {}, provenance, branches).to_json()
