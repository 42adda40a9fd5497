"""Problem ``membrane``: meshes of users, their supports, and what is refused before anything is solved."""

import meshio
import numpy as np
import pytest
import shapes_of_gmsh as shapes

from weakforms import InputError, solve
from weakforms.cli import app
from weakforms.problems.membrane.files import from_file
from weakforms.problems.membrane.reference import boundary
from weakforms.problems.membrane.shapes import disk, square
from weakforms.terminal import guarded


def write(path, points, triangles):
    kind = {3: "triangle", 6: "triangle6"}[np.shape(triangles)[1]]
    meshio.Mesh(points, [(kind, triangles)]).write(path)
    return str(path)


@pytest.fixture
def sheet():
    given = square(3)
    return given.points.copy(), given.cells.copy()


def area(given):
    return np.linalg.norm(given.normals, axis=1).sum() / 2


# -- reading and refining ---------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".stl"])
def test_a_file_of_the_square_is_the_square(tmp_path, sheet, suffix):
    path = write(tmp_path / f"sheet{suffix}", *sheet)
    read = from_file(path, 1.0, [], [])
    assert len(read.cells) == len(sheet[1])
    assert area(read) == pytest.approx(4)
    assert len(read.held) == 24


def test_a_file_that_faces_down_is_turned_up(tmp_path, sheet):
    points, triangles = sheet
    read = from_file(write(tmp_path / "down.vtu", points, triangles[:, ::-1]), 1.0, [], [])
    assert (read.normals[:, 2] > 0).all()


def test_the_unit_divides_all_lengths(tmp_path, sheet):
    points, triangles = sheet
    read = from_file(write(tmp_path / "mm.vtu", 250.0 * points, triangles), 250.0, [], [])
    assert read.points == pytest.approx(points)


def test_the_size_of_a_sheet_does_not_depend_on_its_place(tmp_path, sheet):
    points, triangles = sheet
    far = from_file(
        write(tmp_path / "far.vtu", points + np.array([500.0, -300.0, 0.0]), triangles), 1.0, [], []
    )
    assert np.ptp(far.points, axis=0) == pytest.approx(np.ptp(points, axis=0))


def test_refinement_keeps_surface_supports_and_centre(tmp_path):
    path = shapes.written(tmp_path / "quarter.msh", shapes.quarter_disk, 0.4, order=2)
    coarse = from_file(str(path), 1.0, [], ["left", "bottom"])
    assert {*coarse.mirrors} == {"X", "Y"}
    assert coarse.points[coarse.centre] == pytest.approx([0, 0, 0])
    fine = coarse.refined().refined()
    assert len(fine.cells) == 16 * len(coarse.cells)
    assert (fine.normals[:, 2] > 0).all()
    assert fine.centre == coarse.centre
    assert len(fine.held) == 4 * len(coarse.held)
    rim = fine.points[np.unique(fine.held)]
    # The rim is that of the quadratic triangles, to their own accuracy on the circle.
    assert np.linalg.norm(rim, axis=1) == pytest.approx(1, abs=1e-3)
    for name, axis in (("X", 0), ("Y", 1)):
        assert np.abs(fine.points[np.unique(fine.mirrors[name]), axis]).max() < 1e-12
    open_edges = {tuple(edge) for edge in np.sort(boundary(fine.cells), axis=1).tolist()}
    ends = np.vstack([fine.held, *fine.mirrors.values()])
    assert {tuple(edge) for edge in np.sort(ends, axis=1).tolist()} == open_edges


@pytest.mark.parametrize("degree", [1, 2])
def test_a_refined_disk_has_the_nodes_of_the_same_surface(degree):
    coarse = disk(3, degree)
    fine = coarse.refined()
    assert len(np.unique(fine.cells)) == len(fine.points[np.unique(fine.cells)])
    assert {tuple(p) for p in coarse.points[:19].round(9)} <= {tuple(p) for p in fine.points.round(9)}
    if degree == 2:  # nodes on the edges lie on the parabolas of the coarse triangles, close to the circle
        rim = boundary(fine.cells)
        assert np.linalg.norm(fine.points[np.unique(rim)], axis=1) == pytest.approx(1, abs=2e-3)


# -- refusals ------------------------------------------------------------------------------------------


def duplicate_node(points, triangles):
    points = np.vstack([points, points[10]])
    cell = np.argmax((triangles == 10).any(axis=1))
    triangles[cell][triangles[cell] == 10] = len(points) - 1
    return points, triangles


def turned(points, triangles):
    triangles[7] = triangles[7][::-1]
    return points, triangles


def turned_over(points, triangles):
    centre = triangles[8, 2]  # pushed beyond the side of its square
    points[centre, 0] += 0.6
    return points, triangles


def hanging(points, triangles):
    a, b, c = triangles[41]
    rest = np.delete(triangles, 41, axis=0)
    n = len(points)
    return np.vstack([points, (points[a] + points[b]) / 2]), np.vstack([rest, [a, n, c], [n, b, c]])


def needle(points, triangles):
    a, b, _ = triangles[60]
    return np.vstack([points, (points[a] + points[b]) / 2]), np.vstack([triangles, [a, b, len(points)]])


def two_parts(points, triangles):
    return np.vstack([points, points + np.array([3.0, 0, 0])]), np.vstack(
        [triangles, triangles + len(points)]
    )


def closed(points, triangles):
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
    return corners, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])


def millimetres(points, triangles):
    return 1000 * points, triangles


def metres(points, triangles):
    return points / 1000, triangles


def nan(points, triangles):
    points[3, 1] = np.nan
    return points, triangles


def one(points, triangles):
    return np.eye(3)[:, :2] @ np.eye(2, 3), np.array([[0, 1, 2]])


def no_such_node(points, triangles):
    triangles[3, 2] = 100_000
    return points, triangles


def one_place(points, triangles):
    return 0 * points, triangles


WRONG = {
    one: "every corner of a triangle is held",
    no_such_node: "a triangle with node 100000; its nodes are 0 to 84",
    one_place: "all its nodes are at one point",
    duplicate_node: "1 duplicate nodes, the first at (",
    turned: "same direction in both their triangles, the first at (",
    turned_over: "turned over, the first at (",
    hanging: "hangs on the edge from (",
    needle: "without area, the first at (",
    two_parts: "2 parts that are not connected",
    closed: "no edge is held",
    millimetres: "is 1000 times unit = 1; allowed: 0.1 to 10",
    metres: "is 0.001 times unit = 1; allowed: 0.1 to 10",
    nan: "not a finite number",
}


@pytest.mark.parametrize("spoil", WRONG, ids=lambda f: f.__name__)
def test_meshes_that_are_refused(tmp_path, sheet, spoil, capsys):
    path = write(tmp_path / "wrong.vtu", *spoil(*sheet))
    words = ["solve", "membrane", f"mesh={path}", "--out", str(tmp_path / "r.json")]
    assert guarded(lambda: app(words, standalone_mode=False), False) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert WRONG[spoil] in line
    assert "wrong.vtu" in line
    assert not (tmp_path / "r.json").exists()


def test_curved_triangles_turned_inside_out(tmp_path):
    given = disk(3, 2)
    points, cells = given.points.copy(), given.cells.copy()
    points[cells[0, 5]] += [0.5, 0.3, 0]
    path = write(tmp_path / "curved.vtu", points, cells[:, [0, 1, 2, 5, 3, 4]])
    with pytest.raises(InputError, match="curved triangles are turned inside out at a node"):
        from_file(path, 1.0, [], [])


def test_groups_and_supports_that_are_refused(tmp_path):
    holed = str(shapes.written(tmp_path / "hole.msh", lambda: shapes.round_sheet(True), 0.4))
    for given, words in (
        ({"held": "rim"}, "neither held nor on a mirror, the first at .*groups of this file: rim, hole"),
        ({"held": "rim,hoel"}, "no group of edges is called 'hoel'"),
        ({"mirror": "rim"}, "lies in the plane of the flat sheet"),
        ({"held": "rim,hole", "mirror": "hole"}, "group 'hole' is both in held and in mirror"),
    ):
        with pytest.raises(InputError, match=words):
            solve("membrane", mesh=holed, **given)
    ball = str(shapes.written(tmp_path / "round.msh", shapes.octant, 0.5))
    with pytest.raises(InputError, match="neither held nor on a mirror"):
        solve("membrane", mesh=ball, mirror="x", held="y")


def test_a_group_that_joins_nodes_of_no_common_triangle(tmp_path, sheet):
    points, triangles = sheet
    across = np.array([[triangles[0, 0], triangles[-1, 2]]])
    edges = np.array([[triangles[0, 0], triangles[0, 1]]])
    for lines, words in (
        (across, "group '7' has edges that are edges of no triangle"),
        (edges, "are neither"),
    ):
        tags = [np.ones(len(triangles), int), np.full(1, 7)]
        cells = [("triangle", triangles), ("line", lines)]
        mesh = meshio.Mesh(points, cells, cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags})
        mesh.write(tmp_path / "lines.msh", file_format="gmsh22")
        with pytest.raises(InputError, match=words):
            from_file(str(tmp_path / "lines.msh"), 1.0, ["7"], [])


QUARTER_TURNS = {"XY": [0, 1, 2], "YZ": [2, 0, 1], "XZ": [1, 2, 0]}


@pytest.mark.parametrize("plane", QUARTER_TURNS)
def test_the_mirror_of_a_flat_sheet_is_the_plane_that_cuts_it(tmp_path, plane):
    """Of a sheet in the plane ``X = 0`` a straight edge has two constant coordinates, and ``X`` is one."""
    file = shapes.written(tmp_path / "flat.msh", shapes.quarter_disk, 0.4)
    mesh = meshio.read(file)
    mesh.points = mesh.points[:, QUARTER_TURNS[plane]]
    mesh.write(tmp_path / "turned.msh", file_format="gmsh")
    read = from_file(str(tmp_path / "turned.msh"), 1.0, [], ["left", "bottom"])
    assert {*read.mirrors} == {*plane}


def test_edges_that_are_no_mirrors(tmp_path):
    def crossed():
        """A square with a line of edges across it, and a notch beyond one of its sides."""
        sides = shapes.polygon([(0, 0), (1, 0), (1, 1), (0, 1), (-0.5, 0.5), (0, 0.5)])
        return {"axis": [sides[5]], "rim": sides[:5]}

    def divided():
        geo = shapes.gmsh.model.geo
        points = [geo.addPoint(x, y, 0) for x, y in ((-1, 0), (0, 0), (1, 0), (1, 1), (0, 1), (-1, 1))]
        rim = [geo.addLine(points[i], points[(i + 1) % 6]) for i in range(6)]
        middle = geo.addLine(points[1], points[4])
        for loop in ([rim[0], middle, rim[4], rim[5]], [rim[1], rim[2], rim[3], -middle]):
            geo.addPlaneSurface([geo.addCurveLoop(loop)])
        geo.synchronize()
        return {"rim": rim, "middle": [middle]}

    for draw, name, words in (
        (crossed, "axis", "nodes on both sides of the mirror X = 0 of group 'axis', such as at \\(-0.5, 0.5"),
        (divided, "middle", "group 'middle' of mirror is inside of the surface at \\(0, "),
    ):
        path = shapes.written(tmp_path / f"{name}.msh", draw, 0.5)
        with pytest.raises(InputError, match=words):
            from_file(str(path), 1.0, [], [name])


def test_parameters_of_files_have_no_effect_on_shapes_without_a_file():
    from weakforms.problems.membrane.parameters import MembraneParameters

    for mesh in ("disk", "square"):
        (said,) = MembraneParameters(mesh=mesh, unit=2.0).without_effect()
        assert said == "unit = 2.0 has no effect here; it needs mesh = FILE"
    assert MembraneParameters(mesh="part.msh", unit=2.0).without_effect() == []


def test_other_files(tmp_path, sheet):
    quads, text, empty = tmp_path / "quads.vtu", tmp_path / "text.msh", tmp_path / "empty.msh"
    empty.touch()
    meshio.Mesh(sheet[0], [("quad", np.array([[0, 1, 8, 7]]))]).write(quads)
    text.write_text("no mesh")
    for path, what in (
        (quads, "cells of type quad"),
        (text, "cannot be read"),
        (empty, "is an empty file"),
        (tmp_path / "none.stl", "no such file"),
        ("part.step", "'disk', 'square', 'airbag', 'tube' or a file ending in .msh, .vtu, .stl is required"),
    ):
        with pytest.raises(InputError, match=what):
            solve("membrane", mesh=str(path))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"delta": 0.9}, "delta = 0.9: input should be greater than or equal to 1"),
        ({"model": "harmonic"}, "model = 'harmonic'; allowed: "),
        ({"at": {"f_w": 0.1}}, "cannot ask for a state at 'f_w'"),
        ({"numerics": {"degree": 3}}, "degree = 3: input should be less than or equal to 2"),
        ({"unit": 0}, "unit = 0: input should be greater than 0"),
    ],
)
def test_bad_parameters_are_one_line(given, words):
    with pytest.raises(InputError) as refused:
        solve("membrane", **given)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)
