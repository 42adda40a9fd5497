"""The scripts of ``examples/gallery``: they run, print numbers that the references have, and draw."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

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
