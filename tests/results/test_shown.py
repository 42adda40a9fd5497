"""How results and their numbers show themselves in Python and in a notebook."""

import builtins
import math
import re
import subprocess
import sys

import numpy as np
import pytest
from matplotlib.markers import MarkerStyle

import weakforms
from weakforms import EnvironmentLackError
from weakforms.results import Absence, Branch, Ended, Failure, Field, Quantity, Result, SpecialPoint, State
from weakforms.results.plot import MARKERS, draw_results, label_of
from weakforms.results.uncertain import uncertain
from weakforms.results.wording import point_rows

VERSIONS = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")


@pytest.fixture
def result():
    u = np.linspace(0, 5, 11)
    p = u * (5 - u)
    branch = Branch(
        "primary",
        "p",
        {"p": p, "u_max": u, "n_negative": (u > 2.5).astype(int)},
        {"p": np.full(11, 1e-9)},
        Ended("u_end", "u_max", 5.0),
    )
    point = SpecialPoint("limit_point", "primary", "p", {"p": 6.25, "u_max": 2.5}, {"p": 1e-8, "u_max": 1e-7})
    profile = Field("profile", {"Z": u, "rho": 1 + u}, {"Z": 0.0, "rho": 1e-9})
    state = State(
        {"p": 4.0}, "primary", {"u_max": Quantity(1.0, 2e-9), "n_negative": Quantity(0)}, (profile,), 1, 2
    )
    return Result(
        "tube",
        {"alpha": 0.1, "delta1": 1.1},
        {"p": "P R_f/(C1 h_o)"},
        {},
        VERSIONS | {"ranks": 1, "wall_s": 0.5},
        [branch],
        [point],
        {"area": Quantity(2.0, 1e-3)},
        [state],
        warnings=["k = 3.0 has no effect here; it needs contact = adhesive"],
    )


@pytest.mark.parametrize(
    ("value", "spread", "text"),
    [
        (2.018852029123, 2.0e-8, "2.018852029(20)"),
        (0.854081807108, 1.0e-11, "0.854081807108(10)"),
        (0.854081807108, 0.99e-11, "0.8540818071080(99)"),
        (1.0, 0.999e-3, "1.0000(10)"),
        (1.0, 0.9901e-3, "1.0000(10)"),
        (-3.5, 0.021, "-3.500(21)"),
        (1234.0, 56.0, "1234(56)"),
        (1234.0, 560.0, "1230(560)"),
        (0.0, 1e-3, "0.0000(10)"),
        (3.2e-9, 1.5e-10, "3.20(15)e-09"),
        (2.5e7, 1e3, "2.50000(10)e+07"),
        (1.001e6, 1e3, "1.0010(10)e+06"),
        (0.999e6, 1e3, "999000(1000)"),
        (1.0, 1e-30, "1.00000000000000(1)"),
        (123.456, 1e-30, "123.456000000000(1)"),
        (1.0, 0.0, "1"),
        (2 / 3, None, "0.666666666667"),
        (1.0, math.inf, "1"),
        (math.nan, 1e-3, "nan"),
    ],
)
def test_a_number_shows_the_digits_that_its_uncertainty_allows(value, spread, text):
    assert uncertain(value, spread) == text
    assert f"{Quantity(value, spread)}" == str(Quantity(value, spread)) == text


@pytest.mark.parametrize("spread", [1.04e-7, 1.051e-7, 9.96e-5, 0.5])
def test_the_shown_uncertainty_is_never_smaller_than_the_stated_one(spread):
    text = uncertain(1.0, spread)
    digits, last = text.rstrip(")").split("(")
    places = len(digits.partition(".")[2])
    assert float(last) * 10.0**-places >= spread * (1 - 1e-9)


def test_a_format_is_for_the_value_alone():
    assert f"{Quantity(2.018852029, 2e-8):.3f}" == "2.019"


def test_a_branch_gives_its_columns_by_name(result):
    branch = result.branch()
    assert branch["u_max"][-1] == 5
    with pytest.raises(KeyError, match="no column 'umax'; did you mean 'u_max'"):
        branch["umax"]
    with pytest.raises(KeyError, match="no branch 'primry'; did you mean 'primary'"):
        result.branch("primry")


def test_a_misspelt_kind_of_special_point_is_an_error_and_not_an_empty_list(result):
    assert len(result.points("limit_point")) == 1
    assert result.points("cusp_point") == []
    with pytest.raises(KeyError, match="'limit_points'; did you mean 'limit_point'"):
        result.points("limit_points")
    with pytest.raises(KeyError, match=r"'bulge'\. The result has limit_point"):
        result.points("bulge")


def test_a_notebook_offers_first_what_users_need():
    assert set(dir(weakforms)) - {"__doc__", "__version__"} == set(weakforms.__all__)
    assert {"solve", "compare", "sweep", "load", "save"} <= set(dir(weakforms))
    assert set(dir(weakforms)) <= set(vars(weakforms))


def test_a_notebook_shows_where_a_state_lies_and_says_in_python_how_to_get_all_of_them(result):
    page = result._repr_html_()
    assert "crossing=&quot;all&quot; gives all" in page
    assert "--crossing" not in page
    row = re.search(r"crossing 1 of 2</td>(.*?)</tr>", page)[1]
    value = next(iter(result.states[0].at.values()))
    assert f">{value:g}</td>" in row


def test_a_value_is_counted_each_time_that_the_column_takes_it(result):
    branch = result.branch()
    assert [branch.crossings("p", p) for p in (4.1, 7.0, 0.0)] == [2, 0, 2]
    assert branch.crossings("u_max", 5.0) == 1


def test_what_a_special_point_is_stands_before_its_other_numbers(result):
    values = {"V": 3.0, "n": 1.0, "p": 6.25}
    result.special_points = [SpecialPoint("bifurcation_point", "primary", "p", values, {"p": 1e-8, "n": 0.0})]
    ((place, numbers),) = point_rows(result)
    assert (place, list(numbers), numbers["n"]) == ("bifurcation_point 1", ["p", "n", "V"], "1")


def test_a_result_shows_itself_in_one_line(result):
    assert repr(result) == "<Result tube: branch primary (11 points); 1 limit_point; 1 state; 1 quantity>"
    assert "ends at u_max = 5 (u_end)" in repr(result.branch())
    result.failures.append(Failure("x", "y"))
    assert "1 FAILED" in repr(result)


def test_a_notebook_shows_numbers_warnings_and_a_picture(result):
    result.absent.append(Absence("contact", "<b>none</b>"))
    page = result._repr_html_()
    for text in (
        "6.250000000(10)",
        "ends at u_max = 5 (u_end)",
        "no effect",
        "crossed 2 times",
        "<svg",
        "2.0000(10)",
    ):
        assert text in page
    assert "<b>none</b>" not in page
    assert "&lt;b&gt;none" in page


def test_a_picture_of_a_profile_says_which_of_several_crossings_it_is(result):
    assert [
        t.get_text() for t in draw_results({"": result}, "Z", "rho").axes[0].get_legend().get_texts()
    ] == ["p = 4, crossing 1 of 2"]


def test_saving_and_loading_keeps_everything(result, tmp_path):
    weakforms.save(result, tmp_path / "r.json")
    again = weakforms.load(tmp_path / "r.json")
    assert again.to_json() == result.to_json()
    assert again.branch().ended == Ended("u_end", "u_max", 5.0)
    assert (again.states[0].crossings, again.warnings) == (2, result.warnings)


def test_unstable_parts_are_dashed_and_special_points_marked(result):
    axes = draw_results({"": result}).axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("u_max", "p:  P R_f/(C1 h_o)")
    solid, dashed = axes.get_lines()[:2]
    assert (solid.get_linestyle(), dashed.get_linestyle()) == ("-", "--")
    assert solid.get_xdata()[-1] == dashed.get_xdata()[0] == 2.5
    assert solid.get_xdata()[0] == result.branch()["u_max"][0]
    assert [2.5] in [list(line.get_xdata()) for line in axes.get_lines() if line.get_marker() == "o"]
    assert [text.get_text() for text in axes.texts] == ["u_max = 5 (u_end)"]
    assert [
        [*line.get_xdata(), *line.get_ydata()] for line in axes.get_lines() if line.get_marker() == "|"
    ] == [[5.0, 0.0]]
    assert axes.texts[0].xy == (5.0, 0.0)
    assert "limit point" in [text.get_text() for text in axes.get_legend().get_texts()]


@pytest.mark.parametrize(
    "curve",
    [
        lambda s: (s, s**3),
        lambda s: (s, np.sqrt(s)),
        lambda s: (s, 1 - s**2),
        lambda s: (s * (1.4 - s), s),
        lambda s: (1 - s, np.sqrt(1.01 - s)),
    ],
)
def test_what_ends_a_branch_is_written_beside_the_branch(result, curve):
    """Rising, rising to a plateau, falling, turning back, and falling to the left."""
    u, p = curve(np.linspace(0, 1, 400))
    result.branches = [Branch("primary", "p", {"p": p, "u_max": u}, ended=Ended("u_end", "u_max", 5.0))]
    result.special_points = []
    figure = draw_results({"": result})
    figure.canvas.draw()
    (text,) = figure.axes[0].texts
    box = text.get_window_extent()
    assert not any(box.contains(*point) for point in figure.axes[0].transData.transform(np.c_[u, p]))
    frame = figure.axes[0].get_window_extent()
    assert all(frame.contains(*corner) for corner in box.corners())


def test_the_first_column_of_the_problem_is_drawn_whatever_the_order_of_a_branch(result):
    """A load that is a column too, such as the place of a front, comes first in a branch."""
    u = np.linspace(0, 5, 11)
    columns = {"p": u, "R_front": u**2, "u_max": u}
    result.branches, result.special_points = [Branch("primary", "p", columns)], []
    result.scales = {"p": "P", "u_max": "u", "R_front": "R"}
    assert draw_results({"": result}).axes[0].get_xlabel() == "u_max:  u"
    assert draw_results({"": result}, y="R_front").axes[0].get_xlabel() == "u_max:  u"


def test_lines_of_a_label_have_similar_lengths():
    text = label_of("zw", {"zw": "level of the liquid above the edge of the mid-plane"})
    assert text == "zw:  level of the liquid above\nthe edge of the mid-plane"


def test_a_long_scaling_is_not_cut_off(result):
    result.scales["p"] = "p r_o/(S h_o), S the model's stress (C1 for neo_hookean and mooney_rivlin)"
    figure = draw_results({"": result})
    figure.canvas.draw()
    box = figure.axes[0].yaxis.label.get_window_extent()
    assert 0 <= box.y0 < box.y1 <= figure.bbox.height


def test_several_results_are_named_by_what_differs(result):
    other = Result.from_json(result.to_json())
    other.parameters["delta1"] = 1.2
    axes = draw_results({"a": result, "b": other}).axes[0]
    names = [text.get_text() for text in axes.get_legend().get_texts()]
    assert names[:2] == ["delta1 = 1.1", "delta1 = 1.2"]
    other.parameters["delta1"] = 1.1
    axes = draw_results({"a": result, "b": other}).axes[0]
    assert [text.get_text() for text in axes.get_legend().get_texts()][:2] == ["a", "b"]


@pytest.mark.parametrize("name", ["pandas", "xarray"])
def test_what_is_missing_is_named_with_the_way_to_get_it(result, name, monkeypatch):
    known = builtins.__import__

    def without(module: str, *rest: object) -> object:
        if module.split(".", maxsplit=1)[0] == name:
            raise ImportError(name=name)
        return known(module, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    for of in (result, result.branch()):
        with pytest.raises(EnvironmentLackError, match=f"pip install {name}, or apt install python3-{name}"):
            getattr(of, f"to_{name}")()


def test_branches_become_tables_of_pandas(result):
    pytest.importorskip("pandas")
    frame = result.branch().to_pandas()
    assert list(frame) == ["p", "p_uncertainty", "u_max", "n_negative"]
    assert list(result.to_pandas()["branch"].unique()) == ["primary"]
    assert len(frame) == 11


def test_branches_become_datasets_of_xarray(result):
    pytest.importorskip("xarray")
    data = result.to_xarray()
    assert data["p"].attrs["scale"] == "P R_f/(C1 h_o)"
    assert (data.sizes["point"], data.attrs["problem"]) == (11, "tube")
    own = {"branch": "primary", "control": "p", "ended": "u_max = 5 (u_end)"}
    assert result.branch().to_xarray().attrs == own


def test_the_package_shows_first_what_most_people_need():
    assert {"solve", "sweep", "compare", "load", "save"} <= set(weakforms.__all__)
    assert len(weakforms.__all__) < 20
    assert "Curve" in weakforms.cases.__all__
    assert weakforms.Curve is weakforms.cases.Curve  # where case files imported it at first
    assert "paper2.fig03" in weakforms.cases()
    with pytest.raises(AttributeError):
        weakforms.nothing  # noqa: B018


def test_the_package_tells_type_checkers_that_it_is_annotated():
    code = "from importlib.resources import files; print(files('weakforms').joinpath('py.typed').is_file())"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"


def test_every_kind_of_special_point_has_a_marker_of_its_own_with_a_face():
    assert len(set(map(str, MARKERS.values()))) == len(MARKERS)
    # A marker without a face is drawn with an edge alone, and vanishes where edges are white.
    assert all(MarkerStyle(marker).is_filled() for marker in MARKERS.values())
