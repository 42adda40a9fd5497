"""A coarsest mesh with other special points than the finer ones, and laws of bounded force that give way."""

from types import SimpleNamespace

import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError
from weakforms.solvers.stability import surface_family
from weakforms.solvers.stability.modal import ModalBranch
from weakforms.solvers.stability.surface_family import STEPS, SurfaceBranch, SurfaceFamily


def mesh(*kinds):
    """A stand-in for a branch on one mesh, with special points of some kinds."""
    points = [SimpleNamespace(kind=kind, values={}) for kind in kinds]
    return SimpleNamespace(
        special=lambda: points, tell_apart=lambda: False, points=[], ended="the law gives way", stalled=None
    )


def ending(after):
    """A stand-in with a limit point a number of steps beyond its end, at the second of its points."""
    told = mesh()
    told.points, told.ended = [1, 2], None
    told.go_on = lambda: told.points.append(0)
    told.special = lambda: mesh("limit_point").special() if len(told.points) >= 2 + after else []
    return told


def family(*levels):
    told = SurfaceFamily.__new__(SurfaceFamily)
    told.levels, told.warnings, told._samplers = list(levels), [], {(0, b""): "of the coarsest mesh"}
    return told


def test_a_coarsest_mesh_that_differs_is_left_out_and_named():
    coarse, fine = mesh("bifurcation_point"), mesh("limit_point")
    told = family(coarse, fine, fine)
    assert [point.kind for (point, _) in told._locate()] == ["limit_point"]
    assert told.levels == [fine, fine]
    assert not told._samplers
    (warning,) = told.warnings
    assert warning.startswith("special points and states are those of the 2 finest meshes; with the coarsest")
    assert warning.endswith("raise cells")


def test_all_meshes_that_agree_are_kept():
    told = family(*[mesh("limit_point")] * 3)
    assert [len(same) for same in told._locate()] == [3]
    assert not told.warnings


def test_a_special_point_beyond_the_end_on_some_meshes_is_located_there():
    told = family(mesh("limit_point"), mid := ending(STEPS), mesh("limit_point"))
    assert [len(same) for same in told._locate()] == [3]
    assert len(mid.points) == 2 + STEPS
    told = family(mid := ending(STEPS + 1), mesh("limit_point"))
    with pytest.raises(ConvergenceError, match="depend on the mesh"):
        told._locate()
    assert mid.points == [1, 2]


def test_a_crossing_in_the_own_class_is_located_before_points_are_added(monkeypatch):
    """The search of the other classes adds points, which move the places of the crossings."""
    told = SurfaceBranch.__new__(SurfaceBranch)
    told.points = [
        SimpleNamespace(n_negative=count, name=name) for count, name in zip((0, 0, 1), "abc", strict=True)
    ]
    told._limits, told.modes = [], SimpleNamespace(wave_numbers=())
    told._arclength = lambda i, solved: solved.values["between"]
    asked = []

    def added(branch):
        branch.points.insert(1, SimpleNamespace(n_negative=0, name="new"))
        return []

    class Located:
        def __init__(self, branch, i):
            asked.append(branch.points[i].name + branch.points[i + 1].name)

        def located(self):
            return surface_family.Solved({"between": 0.5}, None)

    monkeypatch.setattr(ModalBranch, "_placed", added)
    monkeypatch.setattr(surface_family, "Crossing", Located)
    assert [at for at, _ in told._placed()] == [0.5]
    assert asked == ["bc"]


def test_finer_meshes_that_differ_too_are_refused():
    """Two meshes must agree: one alone has no uncertainty."""
    levels = [mesh("bifurcation_point"), mesh("limit_point"), mesh()]
    told = family(*levels)
    with pytest.raises(ConvergenceError, match=r"depend on the mesh, coarse to fine: \[{'bifurcation_point"):
        told._locate()
    assert told.levels == levels
    assert not told.warnings


@pytest.mark.parametrize(
    ("problem", "given"),
    [
        ("rectangle", {"delta": 2.7, "c": 1.5, "load": "gas"}),
        pytest.param("membrane", {"delta": 2.7}, marks=pytest.mark.slow),
    ],
)
def test_a_branch_ends_where_the_law_hardly_resists_more_stretch(problem, given):
    """At equal stretches Varga's law has ``lam w,11 = 0.02 w,1`` for ``lam^3 = 101``."""
    end = {"w_end": 4.0, "numerics": {"cells": 8, "levels": 2}}
    found = solve(problem, model="varga", shear=2.0, **given, **end)
    assert not found.failures
    (absent,) = found.absent
    assert absent.what == "rest of branch primary"
    assert "lower w_end" in absent.reason
    assert 0.3 < found.branch()["w_c"][-1] < 4.0
    if problem == "rectangle":
        assert 4.0 < found.branch()["lam1_c"][-1] < 1.1 * 101 ** (1 / 3)
