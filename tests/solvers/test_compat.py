"""What differs between releases of dolfinx is chosen by the release."""

from types import SimpleNamespace

import pytest

from weakforms.solvers.support import compat

OLD, NEW = [(0, 9)], [(0, 10), (0, 11)]


@pytest.fixture(params=OLD + NEW, ids=str)
def old(request, monkeypatch):
    """Whether the release is an old one."""
    monkeypatch.setattr(compat, "version", lambda: request.param)
    return request.param in OLD


def test_meshes_of_gmsh_are_read_by_the_module_of_the_release(old, monkeypatch):
    asked = []

    def imported(name):
        return SimpleNamespace(
            model_to_mesh=lambda *given, **more: (asked.append((name, given, more)), "tags")
        )

    monkeypatch.setattr(compat, "import_module", imported)
    compat.mesh_from_gmsh("model", "comm", 0, 2)
    assert asked == [("dolfinx.io.gmshio" if old else "dolfinx.io.gmsh", ("model", "comm", 0), {"gdim": 2})]


def test_points_of_a_mesh_come_before_or_after_its_element(old, monkeypatch):
    monkeypatch.setattr(compat.dmesh, "create_mesh", lambda *given: given)
    made = compat.create_mesh("comm", "cells", "points", "element")
    assert made == ("comm", "cells", *(("points", "element") if old else ("element", "points")))


def test_interpolation_points_are_a_method_or_a_property():
    assert compat.interpolation_points(SimpleNamespace(interpolation_points=lambda: [1])) == [1]
    assert compat.interpolation_points(SimpleNamespace(interpolation_points=[2])) == [2]
