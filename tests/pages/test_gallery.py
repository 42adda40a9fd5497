"""The scripts of ``examples/gallery``: they run, print numbers that the references have, and draw."""

import importlib.util
import json
import os
import re
import runpy
import subprocess
import sys
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from weakforms.verification.cases import references

ROOT = Path(__file__).resolve().parents[2]
GALLERY = ROOT / "examples" / "gallery"


def script(name):
    spec = importlib.util.spec_from_file_location(name, GALLERY / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_picture_of_the_readme_has_four_bodies():
    picture = imread(ROOT / "docs" / "shapes.png")
    assert (ROOT / "docs" / "shapes.png").stat().st_size < 250_000
    columns = np.array_split(picture[70:, :, 3].max(axis=0) > 0.5, 4)
    assert all(0.3 < part.mean() < 0.95 for part in columns)


@pytest.mark.slow
def test_the_picture_of_the_readme_is_that_of_the_solved_states(tmp_path):
    shapes = script("shapes")
    shapes.picture(shapes.solved()).savefig(tmp_path / "shapes.png", dpi=shapes.DPI, transparent=True)
    drawn, kept = imread(tmp_path / "shapes.png"), imread(ROOT / "docs" / "shapes.png")
    assert drawn.shape == kept.shape
    assert np.mean(np.abs(drawn - kept)) < 0.01


def ran(name, tmp_path, *words):
    """What a script prints; its picture must be there, with two curves or more.

    It runs in this process, which has the imports behind it, in a folder of its own.
    """
    path = tmp_path / f"{name}.svg"
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(StringIO()) as said:
        patch.chdir(tmp_path)
        patch.setattr(sys, "argv", [str(GALLERY / f"{name}.py"), str(path), *words])
        runpy.run_path(sys.argv[0], run_name="__main__")
    return drawn(path, said.getvalue())


def ran_alone(name, tmp_path, *words):
    """The same in a process of its own, for what would be left behind in this one."""
    path = tmp_path / f"{name}.svg"
    command = [sys.executable, GALLERY / f"{name}.py", path, *words]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr
    return drawn(path, done.stdout)


def drawn(path, said):
    assert len(re.findall(r'<path d="[^"]{60,}" clip-path=', path.read_text("utf-8"))) >= 2
    return said


def numbers(text, pattern):
    """Values without their uncertain digits in brackets."""
    return [float(hit.partition("(")[0]) for hit in re.findall(pattern + r" ([-\d.]+)", text)]


def test_the_balloon(tmp_path):
    text = ran("balloon", tmp_path)
    (cusp,) = numbers(text, "merge at alpha =")
    assert cusp == pytest.approx(0.2144583, abs=1e-6)
    assert text.count("limit point") == 5


def test_the_tube_has_the_limit_points_and_the_cusp_of_the_tables(tmp_path):
    text = ran("tube", tmp_path)
    table = references.load(2, "limit_points_alpha_0.1").columns
    for delta1 in (1.0, 1.1):
        expected = table["p"][np.isclose(table["delta1"], delta1)]
        np.testing.assert_allclose(
            numbers(text, rf"delta1 = {delta1}: limit point \d at p ="), expected, rtol=1e-6
        )
    cusps = references.load(2, "cusp").columns
    row = np.isclose(cusps["alpha"], 0.1) & np.isclose(cusps["lf"], 6)
    np.testing.assert_allclose(numbers(text, "merge at delta1 ="), cusps["delta1"][row], rtol=1e-6)


def test_a_law_of_ones_own(tmp_path):
    text = ran_alone("own_law", tmp_path)
    assert "b = 0.1: limit points at P = none" in text
    assert "tube, b = 0.05: 2 limit points" in text


def test_contact(tmp_path):
    text = ran("contact", tmp_path)
    starts = numbers(text, "contact starts at p =")
    assert len(starts) == 2
    assert starts[0] == pytest.approx(starts[1], rel=1e-7), "before contact there is no difference"
    slides, sticks = numbers(text, "patch at p = 3:")
    assert 0 < sticks < slides < 1 or 0 < slides < sticks < 1


def test_bending_comes_before_the_limit_point(tmp_path):
    text = ran("bending", tmp_path, "quick")
    (limit,) = numbers(text, "limit_point at zw =")
    assert min(numbers(text, "bifurcation_point at zw =")) < limit


@pytest.mark.slow
def test_long_tubes_bend_before_their_limit_point(tmp_path):
    text = ran("bending_lines", tmp_path)
    one, two = numbers(text, r"fold_n1 on the line \w+: lf =")
    assert one == pytest.approx(two, abs=1e-7)
    assert 7.5 < one < 8.5
    assert "lf = 6: reaches its limit point first" in text
    assert "lf = 8: bends first" in text


@pytest.mark.slow
def test_a_held_tube_bends_and_bulges_at_once_where_a_closed_one_has_its_limit(tmp_path):
    text = ran("long_tubes", tmp_path, str(tmp_path / "pears.svg"))
    lam1, p = (numbers(text, rf"{name} =") for name in ("lam1", "p"))
    table = references.load("beyond", "uniform_both_waves").columns
    assert lam1 == pytest.approx([table["lam1"][0]] * 2, abs=1e-8)
    assert p == pytest.approx([table["p"][0]] * 2, abs=1e-8)
    assert "pears up to mu2 = 0.0070787" in text


@pytest.mark.slow
def test_a_heavy_liquid_keeps_the_corners_taut(tmp_path):
    gas, light, heavy = numbers(ran("corners", tmp_path), "wrinkled part")
    assert gas > light > heavy
    assert heavy == pytest.approx(0.0, abs=1e-9)


def test_a_stretched_annulus_wrinkles_less_and_a_narrow_one_everywhere(tmp_path):
    wide, stretched, narrow = numbers(ran("annulus", tmp_path), "wrinkled part")
    assert stretched < wide < narrow == pytest.approx(1.0, abs=1e-9)


@pytest.mark.slow
def test_only_a_bending_stiffness_gives_a_shortest_wave(tmp_path):
    without, beside = ran("wrinkling", tmp_path).splitlines()
    falling, turning = (numbers(line, r"n = \d+:") for line in (without, beside))
    assert len(falling) == len(turning) == 5
    assert falling == sorted(falling, reverse=True)
    assert turning[-1] > min(turning)


def notebooks():
    return script("../notebooks/from_gallery")


def code_of(found):
    return ["".join(cell["source"]) for cell in found["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("name", notebooks().SCRIPTS)
def test_a_notebook_has_the_code_of_its_script(name):
    """Beside the imports, only the last line is another: the picture is shown, not stored."""
    source = (GALLERY / f"{name}.py").read_text("utf-8")
    found = notebooks().notebook(source)
    assert "".join(found["cells"][0]["source"]).startswith("# ")
    assert "Run:" not in "".join(found["cells"][0]["source"])
    magic, *cells = code_of(found)
    assert magic == "%matplotlib inline"
    assert len(cells) > 2
    for cell in cells:
        compile(cell, name, "exec")
    shown = [line for line in "\n".join(cells).splitlines() if line.strip()]
    kept = [line for line in source.split('"""', 2)[2].splitlines() if line.strip() and line != "# %%"]
    changed = {line for line in kept if line not in shown}
    assert all(line.startswith(("import sys", "figure.savefig(", "bent = ")) for line in changed)
    assert shown[-1] == "figure"
    assert "sys." not in "\n".join(shown)
    ids = [cell["id"] for cell in found["cells"]]
    assert len(set(ids)) == len(ids)


def test_notebooks_that_are_there_stay(tmp_path):
    (tmp_path / "tube.ipynb").write_text("mine")
    written = notebooks().write(tmp_path)
    assert {path.stem for path in written} == set(notebooks().SCRIPTS) - {"tube"}
    assert (tmp_path / "tube.ipynb").read_text() == "mine"


@pytest.mark.slow
@pytest.mark.parametrize("name", notebooks().SCRIPTS)
def test_a_notebook_runs_from_cell_to_cell(name, tmp_path):
    """Without Jupyter: its cells one after another in a process of its own, as a kernel is."""
    cells = code_of(notebooks().notebook((GALLERY / f"{name}.py").read_text("utf-8")))[1:]
    end = "assert sum(len(axes.lines) for axes in figure.axes) >= 2"
    (tmp_path / "cells.json").write_text(json.dumps([*cells, end]))
    run = "import json\nspace = {}\nfor cell in json.load(open('cells.json')): exec(cell, space)"
    command, environment = [sys.executable, "-c", run], os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stderr


@pytest.mark.slow
def test_the_plane_of_tubes(tmp_path):
    said = ran("diagram", tmp_path)
    table = references.load("beyond", "lines_cusp_alpha")
    (alpha,) = numbers(said, "cusp_point on the line fold: alpha =")
    assert alpha == pytest.approx(table.columns["alpha"][0], abs=1e-6)
    tips = references.load("beyond", "lines_tips_alpha")
    found = numbers(said, "tip_mirror on the line mirror: alpha =")
    assert found == pytest.approx(tips.columns["alpha"].tolist(), abs=1e-6)
