"""Problem ``surface``: a user's own triangles, what is refused, shapes for other programs."""

from xml.etree import ElementTree

import gmsh
import meshio
import numpy as np
import pytest
from mpi4py import MPI

import weakforms
from weakforms.api import prepare
from weakforms.cli import app
from weakforms.errors import InputError
from weakforms.problems.liquid_tube.bent.mesh import flat_sheet
from weakforms.problems.triangles.meshes import from_file, hemisphere, tube
from weakforms.shapes import shape_mesh, write_shape
from weakforms.terminal import guarded
from weakforms.verification.judging.surfaces import position

pytestmark = pytest.mark.paper5

TUBE = {"M": 1.5, "delta": 3.0, "Af": 0.4362, "c2": 0.01, "load_start": 0.5, "load_end": 4.0}
FEW = {"scan": 2, "shown": 1}


def write(path, points, triangles):
    meshio.Mesh(points, [("triangle", triangles)]).write(path)
    return path


@pytest.fixture
def rings():
    given = tube(8.0, 10, 12)
    return given.points.copy(), given.triangles.copy()


# -- files ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".stl"])
def test_a_file_of_the_tube_gives_the_tube(tmp_path, rings, suffix):
    """The same mesh by another method: cubic splines and SNES on all nodes, without periodic positions."""
    path = write(tmp_path / f"tube{suffix}", *rings)
    own = weakforms.solve("surface", meridional=10, circumferential=12, **TUBE, numerics=FEW).branch()
    read = weakforms.solve("surface", geometry=str(path), **TUBE, numerics=FEW)
    assert read.failures == []
    # An STL holds single precision.
    for name in ("V", "Pi", "r_max", "Lambda_1", "Lambda_2", "Lambda_3"):
        assert read.branch().columns[name] == pytest.approx(own.columns[name], rel=2e-6)
    assert read.branch().columns["n_negative"].tolist() == [0, 0, 0]


def test_normals_are_turned_outwards(tmp_path, rings):
    points, triangles = rings
    inwards = from_file(write(tmp_path / "in.vtu", points, triangles[:, ::-1]))
    assert (inwards.triangles == triangles).all()


def test_a_hemisphere_in_a_file(tmp_path):
    given = hemisphere(0.25)
    path = write(tmp_path / "bowl.msh", given.points, given.triangles)
    loads = {"load_start": -0.6, "load_end": -0.55, "gamma": 100 * 0.0464709}
    read = weakforms.solve("surface", geometry=str(path), **loads, numerics=FEW)
    own = weakforms.solve("surface", geometry="hemisphere", size=0.25, **loads, numerics=FEW)
    for name in ("V", "Lambda_1"):
        assert read.branch().columns[name] == pytest.approx(own.branch().columns[name], rel=1e-9)


def duplicate_node(points, triangles):
    points = np.vstack([points, points[40]])
    triangles[np.argmax(triangles == 40) // 3][triangles[np.argmax(triangles == 40) // 3] == 40] = (
        len(points) - 1
    )
    return points, triangles


def turned(points, triangles):
    triangles[30] = triangles[30][::-1]
    return points, triangles


def twice(points, triangles):
    return points, np.vstack([triangles, triangles[5]])


def fin(points, triangles):
    return np.vstack([points, [2.0, 0, 4.0]]), np.vstack([triangles, [50, 62, len(points)]])


def needle(points, triangles):
    a, b, _ = triangles[60]
    middle = (points[a] + points[b]) / 2
    return np.vstack([points, middle]), np.vstack([triangles, [a, b, len(points)]])


def hanging(points, triangles):
    a, b, c = triangles[60]
    middle = len(points)
    rest = np.delete(triangles, 60, axis=0)
    return np.vstack([points, (points[a] + points[b]) / 2]), np.vstack([rest, [a, middle, c], [middle, b, c]])


def closed(points, triangles):
    low, high = len(points), len(points) + 1
    ends = [[k, low, (k + 1) % 12] for k in range(12)] + [
        [120 + k, 120 + (k + 1) % 12, high] for k in range(12)
    ]
    return np.vstack([points, [0, 0, 0], [0, 0, 8]]), np.vstack([triangles, ends])


def two_parts(points, triangles):
    return np.vstack([points, points + np.array([5, 0, 0])]), np.vstack([triangles, triangles + len(points)])


def hole(points, triangles):
    return points, np.delete(triangles, [100, 101], axis=0)


def oblique(points, triangles):
    points[:, 2] += 0.2 * points[:, 0]
    return points, triangles


def oval(points, triangles):
    inner = (points[:, 2] > 0.1) & (points[:, 2] < 7.9)
    points[inner, 0] *= 1.4
    return points, triangles


def nan(points, triangles):
    points[7, 1] = np.nan
    return points, triangles


WRONG = {
    duplicate_node: "duplicate nodes",
    turned: "same direction",
    twice: "duplicate triangles",
    fin: "not a manifold",
    needle: "without area",
    hanging: "hangs on the edge",
    closed: "no edge to clamp",
    two_parts: "2 parts",
    hole: "3 edges",
    oblique: "not a circle about the z axis",
    oval: "not a surface of revolution",
    nan: "not a finite number",
}


@pytest.mark.parametrize("spoil", WRONG, ids=lambda f: f.__name__)
def test_files_that_hold_no_such_surface(tmp_path, rings, spoil, capsys):
    path = write(tmp_path / "wrong.vtu", *spoil(*rings))
    words = [
        "solve",
        "surface",
        "--set",
        f"geometry={path}",
        "--set",
        "load_start=0.5",
        "--set",
        "load_end=1",
    ]
    assert guarded(lambda: app(words, standalone_mode=False), False) == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert WRONG[spoil] in line
    assert "wrong.vtu" in line


def test_other_files(tmp_path, rings):
    quads = tmp_path / "quads.vtu"
    meshio.Mesh(rings[0], [("quad", np.array([[0, 1, 13, 12]]))]).write(quads)
    text = tmp_path / "text.msh"
    text.write_text("no mesh")
    for path, what in (
        (quads, "cells of type quad"),
        (text, "cannot be read"),
        (tmp_path / "none.stl", "no such file"),
    ):
        with pytest.raises(InputError, match=what):
            from_file(path)


# -- parameters ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "what"),
    [
        ({"circumferential": 2}, "cannot close; allowed: 3 to 2000"),
        ({"meridional": 1}, "meridional = 1"),
        ({"geometry": "surface.obj"}, "'tube', 'hemisphere' or a file"),
        ({"degree": 2}, "degree = 2"),
        ({"load_start": -0.1}, "allowed with this geometry: 0 to 100"),
        ({"load_start": 3, "load_end": 3}, "they must differ"),
        ({"geometry": "hemisphere", "M": 1.2}, "M = 1.2 has no meaning"),
        ({"geometry": "hemisphere", "load": "gas"}, "hangs full of fluid"),
        ({"geometry": "hemisphere", "load_start": -0.3}, "allowed with this geometry: -1.05 to -0.48"),
        ({"geometry": "a.stl"}, "a file needs load_start and load_end"),
        ({"geometry": "a.stl", "load_start": 0, "load_end": 1}, "no such file"),
        ({"rule": 5}, "rule = 5"),
        ({"size": 2.0}, "size = 2.0"),
    ],
)
def test_bad_input_is_refused_before_anything_is_solved(given, what):
    with pytest.raises(InputError, match=what):
        prepare("surface", given, {}, ())


@pytest.mark.parametrize(("at", "what"), [(("p", 0.1), "the load is zw"), (("V", 20.0), "cannot ask")])
def test_states_nobody_can_solve_for(at, what):
    with pytest.raises(InputError, match=what):
        prepare("surface", {}, {}, (at,))


# -- results -------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def solved():
    return weakforms.solve(
        "surface", meridional=8, circumferential=10, load_end=4.0, numerics=FEW, at=[("zw", 2.25)]
    )


def test_result(solved):
    assert solved.failures == []
    assert solved.special_points == []
    state = solved.states[0]
    assert state.quantities["zw"].value == 2.25
    assert state.quantities["residual"].value < 1e-10
    assert weakforms.results.Result.from_json(solved.to_json()).branch().columns["zw"][0] == 0.5


def test_gas_has_its_own_column():
    found = weakforms.solve(
        "surface", meridional=6, circumferential=8, load="gas", load_end=0.1, numerics=FEW
    )
    columns = found.branch().columns
    assert columns["p"].tolist() == [0.0, 0.05, 0.1]
    assert (np.diff(columns["V"]) > 0).all()


def test_the_shape_closes_and_shows_its_mode(solved):
    nodes, triangles = solved.states[0].fields
    x, y, _z = position(nodes)
    assert x.shape == (9, 11)
    assert (x[:, 0], y[:, 0]) == (pytest.approx(x[:, -1]), pytest.approx(y[:, -1]))
    moved = np.array(position(nodes, 0.5)) - np.array(position(nodes))
    assert np.linalg.norm(moved, axis=0).max() == pytest.approx(0.5)
    mesh = shape_mesh(nodes, triangles)
    corners = mesh.points[mesh.cells_dict["triangle"]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert len(corners) == 160
    assert (np.sum(normal[:, :2] * corners.mean(axis=1)[:, :2], axis=1) > 0).all()


def test_the_width_at_a_node_is_the_mean_of_the_triangles_around(solved):
    nodes, triangles = (field.columns for field in solved.states[0].fields)
    corners = np.column_stack([triangles[name] for name in "abc"]).astype(int)
    width = triangles["lam2"] * np.sqrt(triangles["lam1"])
    inside = np.flatnonzero((nodes["Theta"] > 1e-6) & (nodes["Theta"] < 6.28))  # once in the table
    mean = [width[(corners == node).any(axis=1)].mean() for node in inside]
    assert len(inside) == 9 * 9
    assert nodes["gw"][inside] == pytest.approx(mean, rel=1e-13)
    seam = nodes["gw"].reshape(9, 11)
    assert seam[:, 0].tolist() == seam[:, -1].tolist()


def test_making_a_mesh_says_nothing(capfd):
    """Only the result's JSON goes to standard output; gmsh writes there unless it is told not to."""
    assert not gmsh.isInitialized()
    hemisphere(0.5)
    flat_sheet(MPI.COMM_SELF, np.linspace(0, 1, 4), 3)
    assert capfd.readouterr().out == ""


def test_shapes_for_other_tools(solved, tmp_path):
    fields = solved.states[0].fields
    for suffix in (".vtu", ".stl", ".xdmf"):
        write_shape(tmp_path / f"shape{suffix}", *fields)
    assert len(meshio.read(tmp_path / "shape.stl").cells_dict["triangle"]) == 160
    read = meshio.read(tmp_path / "shape.vtu")
    assert set(read.cell_data) == {"lam1", "lam2", "state"}
    tree = ElementTree.parse(tmp_path / "shape.xdmf")
    numbers = tree.find(".//Geometry/DataItem").text.split()
    assert np.array(numbers, float).reshape(-1, 3) == pytest.approx(read.points)
    assert tree.find(".//Topology").attrib["NumberOfElements"] == "160"
    centres = [item.attrib["Center"] for item in tree.iter("Attribute")]
    assert centres.count("Cell") == 3
