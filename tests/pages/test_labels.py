"""What a reader of a page sees of names: labels of pictures, sketches, words of the ledger, failed checks."""

import re
from dataclasses import replace

import numpy as np
import pytest
from canned_run import Reader, curve, failing_case, panel, passing_case, sample, surface, verdict
from matplotlib.figure import Figure

from weakforms.problems.registry import abouts, symbol
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.report import manual, summary, wording
from weakforms.verification.report.case_views import surface_csv, what_differs
from weakforms.verification.report.figures import points
from weakforms.verification.report.figures.panel import failed_rows, panel_figure
from weakforms.verification.report.figures.surfaces import surface_picture
from weakforms.verification.report.formulas import html_formula
from weakforms.verification.report.look import LOOK, TEMPLATES
from weakforms.verification.report.pages import render
from weakforms.verification.report.wording import kind_of_point, typeset

RAW = re.compile(
    r"[A-Za-z]\w*_\w|\b(alpha|beta|gamma|delta|eta|kappa|lam|mu|rho|sigma|theta|psi)\d?\b|\b[a-z]+\d+\b|\\"
)
"""Names of files and programs: underlines, spelled Greek letters, letters with numbers; commands of TeX."""


def raw(text):
    """Whether a text, as it is drawn, has a raw name outside of its formulas."""
    return bool(RAW.search(re.sub(r"\$[^$]*\$", "", typeset(text))))


def shown():
    """Every label of every picture of every case: axes, titles, curves, abscissas of errors, points."""
    for found in find_cases():
        for picture in found.case.panels:
            kinds = (picture.markers,) if isinstance(picture.markers, str) else picture.markers
            tables = [table for c in picture.curves if (table := c.table(found.paper)) is not None]
            yield (
                f"{found.id}, {picture.name}",
                [picture.x.tex, picture.y.tex, picture.title or picture.name, picture.note]
                + [item.label for item in (*picture.curves, *picture.lines)]
                + [symbol(table.abscissa) or table.abscissa for table in tables]
                + [kind_of_point(kind) for kind in kinds],
            )
        for picture in found.case.surfaces:
            axes = [axis.tex for axis in picture.axes]
            yield f"{found.id}, {picture.name}", [picture.title or picture.name, picture.note, *axes]


def test_the_table_of_symbols_has_those_that_columns_declare_and_else_typesets_the_name():
    case = passing_case()
    case.solutions = [{"problem": "tube", "parameters": {"alpha": 0.1, "delta1": 1.2, "lf": 6.0, "k": 20.0}}]
    (entry,) = manual.manual(case)
    symbols = {name: shown for shown, name, _ in entry["symbols"]}
    assert {"alpha", "delta1", "lf", "k"} <= {*symbols}
    assert symbols == {name: symbol(name) or wording.symbol(name) for name in symbols}
    assert {name for name in symbols if symbol(name)} not in (set(), {*symbols})
    assert symbol("delta1") != wording.symbol("delta1")


@pytest.mark.parametrize(
    ("problem", "given", "sketch"),
    [
        ("sheet", [{"loading": "bend"}], "bent"),
        ("sheet", [{"loading": "shear"}], "sheet"),
        ("sheet", [{"loading": "bend"}, {"loading": "shear"}], "sheet"),
        ("diagram", [{"body": "infinite_tube"}], "cylinder"),
        ("diagram", [{"body": "tube"}, {"body": "circular"}], "tube"),
    ],
)
def test_a_sketch_shows_the_only_loading_or_body_of_a_case(problem, given, sketch):
    case = passing_case()
    case.solutions = [{"problem": problem, "parameters": parameters} for parameters in given]
    (entry,) = manual.manual(case)
    assert entry["sketch"] == sketch
    assert f"macro {sketch}()" in (TEMPLATES / "sketches.html").read_text("utf-8")


def test_no_picture_shows_a_raw_name():
    labels = list(shown())
    assert len(labels) > 250
    assert {place: [t for t in texts if raw(t)] for place, texts in labels if any(map(raw, texts))} == {}
    assert all(map(raw, ("fold n1", "|lam1 - lam2| < 1e-4", "r_max in mm", r"\Lambda"))), "what would be seen"


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("limit_point", "limit point"),
        ("mass_fold", "mass fold"),
        ("wrinkling_onset", "wrinkling onset"),
        ("bifurcation_n1", "bifurcation, $n = 1$"),
        ("bifurcation_point", "bifurcation point"),
        ("mirror_breaking", "mirror breaking"),
        ("fold_n1", "limit point and $n = 1$"),
        ("n1_n2", "$n = 1$ and $n = 2$"),
        ("tip_mirror", "turn of mirror breaking"),
        ("localisation_n1", "long waves and $n = 1$"),
        ("wrinkling_fold", "first wrinkling and limit point"),
    ],
)
def test_kinds_of_points_are_words(kind, words):
    assert kind_of_point(kind) == words


@pytest.fixture(scope="module")
def manuals() -> dict[str, str]:
    """What a page says of each problem, from one case that solves all of them."""
    case = passing_case()
    case.solutions = [{"problem": name, "parameters": {"n": [1, 20]}} for name in abouts()]
    page = render(sample(case))["paper2.html"]
    assert Reader(page).open == []
    texts = re.findall(r'<details class="manual".*?</details>', page, re.S)
    return dict(zip(abouts(), texts, strict=True))


@pytest.mark.parametrize("name", sorted(abouts()))
def test_every_problem_has_a_sketch(name, manuals):
    sketches = (TEMPLATES / "sketches.html").read_text("utf-8")
    assert f"macro {manual.sketch(name)}()" in sketches
    text = manuals[name]
    assert 'class="sketch"' in text
    assert f"<code>{name}</code>" in text
    assert html_formula(abouts()[name].energy.split("  ")[0]) in text
    assert "<i>n</i> = 1, 20" in text, "several values of a parameter"
    assert re.search(r"<text[^>]*>[^<]*\b(lam|delta|gamma|psi)", text) is None


def test_a_surface_has_the_colours_of_a_field_and_a_bar_that_explains_them():
    shape = surface()
    drawn = surface_picture(shape, "s").svg
    fills = set(re.findall(r"fill: (#\w{6})", drawn)) - set(LOOK["light"].values())
    assert len(fills) >= 5
    assert "Colour shows lam1 from 0.7" in drawn or "Colour shows lam1 from 1" in drawn
    plain = surface_picture(replace(shape, fields={}), "s").svg
    assert not set(re.findall(r"fill: (#\w{6})", plain)) - set(LOOK["light"].values())
    assert "Colour" not in plain
    rows = surface_csv(shape).splitlines()
    assert rows[0] == "x,y,z,lam1"
    assert len(rows) == 1 + 7 * 13


def test_the_ledger_explains_its_words():
    case = passing_case()
    case.printed[0].status, case.printed[2].status = "cut off", "grid of a scan"
    pages = render(sample(case))
    for page in (pages["index.html"], pages["paper2.html"]):
        text = " ".join(" ".join(Reader(page).words).split())
        assert "Truncated, not rounded the printed digits are those of the computed value" in text
        assert "Resolution of the printed grid the printed number is a multiple" in text
        assert "Reproduced the computed" not in text, "only what occurs is explained"
    assert {*summary.LABELS.values(), "reproduced", "not reproduced"} <= set(summary.MEANINGS)


def test_a_failed_check_says_what_differs_and_is_marked_in_the_figure():
    case = failing_case()
    text = " ".join(" ".join(Reader(render(sample(case))["index.html"]).words).split())
    said = "differs from bad:p by 1.3004e-09 of its scale at u max = 1.25; this is >1.000 times the bound"
    assert said in text.replace("u max", "u max"), text
    drawn = case.panels[0].curves[0]
    drawn = replace(drawn, reference_name="bad")
    (row,) = failed_rows(drawn, [case.verdicts[1]], ("p", "u_max"))
    place = min(range(len(drawn.residual_x)), key=lambda i: abs(drawn.residual_x[i] - 1.25))
    assert row == (drawn.reference_x[place], drawn.reference_y[place])
    marked = panel_figure(case.panels[0], "f", case.verdicts)
    held = panel_figure(case.panels[0], "f", case.verdicts[:1])
    assert len(marked) > len(held)
    twice = replace(drawn, reference_x=[0.0] * len(drawn.reference_x) + drawn.reference_x)
    twice.reference_y = [0.0] * len(drawn.reference_y) + drawn.reference_y
    assert failed_rows(twice, [case.verdicts[1]], ("p",)) == [row], "a profile is mirrored to both sides"
    good = replace(drawn, residual=[0.0] * len(drawn.residual))
    assert failed_rows(good, [case.verdicts[1]], ("u_max",)) == [], "another column of the table is wrong"
    wrong = replace(drawn, residual=[1.0] * len(drawn.residual))
    assert failed_rows(wrong, [case.verdicts[1]], ("-p",)) == [row], "the curve is wrong too"


def test_a_check_with_a_wide_bound_says_that_it_is_wide():
    wide = verdict("t:p", passed=False, error=1e-7, bound=1e-5, asked=1e-6)
    assert what_differs(wide).endswith(
        "1.0e-05 is wider than the accuracy of 1.0e-06 that the case asks for."
    )
    assert what_differs(replace(wide, error=None)) == ""
    assert what_differs(replace(wide, asked=None)) == ""


def test_drawings_have_no_groups_without_a_purpose():
    drawn = panel_figure(panel([curve("a", 1.0)]), "f")
    assert "<g>" not in drawn
    assert 'style="fill: none"' not in re.sub(r"<marker.*?</marker>", "", drawn)


def test_where_colours_repeat_every_curve_has_its_label_beside_it():
    many = [replace(curve(f"c{i}", 1.0 + i / 30), label=f"$n = {i}$") for i in range(13)]
    axes = Figure().subplots()
    axes.set(xlim=(1.0, 2.05), ylim=(0.0, 5.0))
    points.draw_points(axes, replace(panel(many), markers=[]))
    assert [note.get_text() for note in axes.texts] == [item.label for item in many]
    for note, item in zip(axes.texts, many, strict=True):
        assert np.hypot(item.x - note.xy[0], item.y - note.xy[1]).min() < 1e-9
    few = Figure().subplots()
    points.draw_points(few, replace(panel(many[:7]), markers=[]))
    assert not few.texts
