"""Formulas in plain characters as a reader of a page sees them."""

import re
from pathlib import Path

import pytest

from weakforms.problems.registry import abouts
from weakforms.verification.report.formulas import html_formula, svg_formula

ROOT = Path(__file__).resolve().parents[2]
RAW = re.compile(
    r"[\^_]|<=|>=|\b(int|oint|sqrt|pi|alpha|beta|gamma|delta|eta|kappa|lam|mu|rho|Pi|Theta)\b|\blam"
)
"""What a typeset formula does not show."""


def seen(html):
    """The text of a page without its tags and its code."""
    return re.sub("<[^>]*>", "", re.sub("<code>.*?</code>", "", html))


@pytest.mark.parametrize(
    ("text", "html"),
    [
        ("lam2 = lam1^(-1/2)", "<i>λ</i><sub>2</sub> = <i>λ</i><sub>1</sub><sup>−1/2</sup>"),
        ("int_0^{L/delta} R dZ", "∫<sub>0</sub><sup><i>L</i>/<i>δ</i></sup> <i>R</i> d<i>Z</i>"),
        ("gw <= 1, zw - z", "<i>g<sub>w</sub></i> ≤ 1, <i>z<sub>w</sub></i> − <i>z</i>"),
        ("(Af)_c of a tube", "(<i>A<sub>f</sub></i>)<sub>c</sub> of a tube"),
        ("a = 1, x = a X", "<i>a</i> = 1, <i>x</i> = <i>a</i> <i>X</i>"),
        ("A tube (a part), e.g. the paper's", "A tube (a part), e.g. the paper's"),
        ("panel (a) is in limit_point at_end", "panel (a) is in limit_point at_end"),
        ("x_Theta, z'^2", "<i>x</i><sub>Θ</sub>, <i>z</i>′<sup>2</sup>"),
        ("p < 1 & <b>", "<i>p</i> &lt; 1 &amp; &lt;<i>b</i>&gt;"),
        (r"$\delta_1$ and t_0", "<i>δ</i><sub>1</sub> and <i>t</i><sub>0</sub>"),
        ("tables gw_gas_p_0.02 and gw_fluid_zw_3", "tables gw_gas_p_0.02 and gw_fluid_zw_3"),
        ("2.0e-11 of 3-D", "2.0e-11 of 3-D"),
    ],
)
def test_formulas_are_typeset_and_words_are_not(text, html):
    flat = html_formula(text).replace("<i>g</i><sub><i>w</i></sub>", "<i>g<sub>w</sub></i>")
    flat = re.sub(r"<i>(\w)</i><sub><i>(\w)</i></sub>", r"<i>\1<sub>\2</sub></i>", flat)
    html = re.sub(r"<i>(\w)</i><sub><i>(\w)</i></sub>", r"<i>\1<sub>\2</sub></i>", html)
    assert flat == html


@pytest.mark.parametrize("name", sorted(abouts()))
def test_no_equation_of_a_problem_shows_a_raw_name(name):
    about = abouts()[name]
    assert RAW.search(seen(html_formula(about.energy)).replace("...", "")) is None
    assert all(map(RAW.search, ("lam1 = 1", "int_0^L", "x <= 1"))), "what would be seen"


def test_an_index_in_a_drawing_returns_to_the_line():
    drawn = svg_formula("radius R_f of")
    assert drawn.count("<tspan") == 4
    assert re.findall(r'dy="(-?\d)"', drawn) == ["3", "-3"]


def test_no_formula_of_a_docstring_is_beyond_mathtext():
    """The docs would show its TeX: matplotlib draws no matrices and no cases."""
    texts = {path: path.read_text("utf-8") for path in (ROOT / "weakforms").rglob("*.py")}
    assert [str(path) for path, text in texts.items() if "\\begin{" in text] == []
