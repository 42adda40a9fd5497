"""``weakforms shape``: deformed shapes from a stored result."""

import meshio
import numpy as np
import pytest

from weakforms.cli import app
from weakforms.results import Field, Quantity, Result, State
from weakforms.results.io import dumps
from weakforms.shapes import shape_mesh
from weakforms.terminal import guarded

pytestmark = pytest.mark.paper3


@pytest.fixture
def stored(tmp_path):
    z = np.linspace(0, 2, 5)
    field = Field("profile", {"Z": z, "r": 1 + z * (2 - z), "z": z}, {"Z": 0.0, "r": 0.0, "z": 0.0})
    state = State({"V": 1.0}, "primary", {"V": Quantity(1.0, 0.0)}, (field,))
    names = ("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git")
    provenance = dict.fromkeys(names, "") | {"ranks": 1, "wall_s": 0.0}
    result = Result("fluid_tube", {}, {}, {}, provenance, states=[state])
    path = tmp_path / "result.json"
    path.write_text(dumps(result.to_json()))
    return path


def call(*words):
    return guarded(lambda: app([str(word) for word in words], standalone_mode=False), False)


def test_writes_a_shape(stored, tmp_path):
    assert call("shape", stored, tmp_path / "tube.vtu") in (0, None)
    mesh = meshio.read(tmp_path / "tube.vtu")
    assert np.hypot(*mesh.points[:, :2].T).max() == pytest.approx(2.0)


def test_a_flat_sheet_that_is_turned_in_its_plane_is_a_surface():
    """As of ``annulus``: each circle is turned by its own angle."""
    field = Field(
        "profile", {"R": np.array([0.4, 1.0]), "r": np.array([0.5, 1.1]), "turn": np.array([0.3, 0.0])}
    )
    mesh = shape_mesh(field)
    inner = mesh.points[: len(mesh.points) // 2]
    assert np.hypot(*inner[:, :2].T) == pytest.approx(0.5)
    assert inner[0] == pytest.approx([0.5 * np.cos(0.3), 0.5 * np.sin(0.3), 0.0])
    assert mesh.points[len(inner)] == pytest.approx([1.1, 0.0, 0.0])
    assert {"R", "turn", "Theta"} <= set(mesh.point_data)


@pytest.mark.parametrize(
    "more", [("tube.obj",), ("tube.vtu", "--branch", "secondary"), ("tube.stl", "--state", "2")]
)
def test_refuses_what_cannot_be_shown(stored, tmp_path, more, capsys):
    name, *options = more
    assert call("shape", stored, tmp_path / name, *options) == 2
    assert not (tmp_path / name).exists()
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
