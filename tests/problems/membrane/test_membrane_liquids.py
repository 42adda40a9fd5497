"""Problem ``membrane`` under a liquid: its load, balances, thresholds, counts, and what is refused."""

import meshio
import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI
from scipy.special import jn_zeros

from weakforms import InputError, solve
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.membrane.files import from_file
from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.problems.membrane.reference import Reference
from weakforms.problems.membrane.shapes import airbag, disk, square
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.state import State

ALPHA, DELTA, GAMMA = 0.1, 1.1, 3.0
STRESS = 2 * (1 - DELTA**-6) * (1 + ALPHA * DELTA**2)
COARSE = {"cells": 4, "levels": 2}
TILT = 0.4
TILTED = np.array([np.sin(TILT), 0, np.cos(TILT)])
"""The vertical of a tilted weight."""


def model(reference, **given):
    return MembraneModel(
        MPI.COMM_SELF, Body(reference, mooney_rivlin_of(ALPHA), load="liquid", **{"gamma": GAMMA} | given)
    )


def shaken(of, level, seed=0):
    """A state far from equilibrium, with all supports."""
    u = 0.1 * np.random.default_rng(seed).standard_normal(of.system.size)
    u[of.system.bc_dofs] = 0.0
    return State(u, of.system.initial.loads | {"zw": level})


def bowl():
    """A bowl whose held edge lies in no plane."""
    given = disk(3, 2)
    points = given.points.copy()
    points[:, 2] = 0.5 * (points[:, 0] ** 2 - 1) + 0.3 * points[:, 1] ** 2 + 0.1 * points[:, 0]
    return Reference(points, given.cells, given.held, {})


def rollers():
    """A quarter of a flat sheet at any height, one side held, the other one sliding in its plane."""
    given = airbag(3)
    seam = given.slides["Z"]
    side = (given.points[seam, 0] == 1).all(axis=1)
    points = given.points + np.array([0, 0, 0.7])
    return Reference(points, given.cells, seam[side], given.mirrors, slides={"Z": seam[~side]})


def mirrored():
    """Half of a bowl, beside its plane of symmetry that is vertical whatever the tilt."""
    given = airbag(3)
    edges = np.vstack([given.slides["Z"], given.mirrors["X"]])
    points = given.points.copy()
    points[:, 2] = 0.4 * points[:, 0] ** 2 + 0.2 * points[:, 1] ** 2 - 0.3 * points[:, 0]
    return Reference(points, given.cells, edges, {"Y": given.mirrors["Y"]})


def written(path, points, cells, **groups):
    """A file with groups of edges."""
    kind = "triangle6" if cells.shape[1] == 6 else "triangle"
    blocks = [(kind, cells[:, [0, 1, 2, 5, 3, 4][: cells.shape[1]]]), *(("line", e) for e in groups.values())]
    tags = [np.full(len(block), k + 1) for k, (_, block) in enumerate(blocks)]
    mesh = meshio.Mesh(points, blocks, cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags})
    mesh.field_data = {name: np.array([k + 2, 1]) for k, name in enumerate(groups)}
    mesh.write(path, file_format="gmsh22")
    return str(path)


@pytest.mark.parametrize(("shape", "tilt"), [(bowl, 0.0), (rollers, 0.0), (bowl, TILT), (mirrored, TILT)])
@pytest.mark.parametrize("degree", [1, 2])
def test_the_load_is_a_pressure_against_the_normals_with_any_supports(shape, tilt, degree):
    """Of the potential, against its virtual work: edges that move in their plane bear no load."""
    of = model(shape(), degree=degree, tilt=tilt)
    at, test, level = of.membrane, ufl.TestFunction(of.space), 3.0
    exact = ufl.Measure("dx", of.mesh, metadata={"quadrature_degree": 12})
    height = at.position[0] * TILTED[0] + at.position[2] * TILTED[2] if tilt else at.position[2]
    pushed = fem.form(GAMMA * (level - height) * ufl.dot(at.normal, test) * exact)
    derived = fem.form(ufl.derivative(at.load * exact, of.unknown, test))
    with of.system.at(shaken(of, level)):
        wanted, found = (fem.assemble_vector(form).array for form in (pushed, derived))
        skew = of.system.tangent().copy()
    for vector in (wanted, found):
        vector[of.system.bc_dofs] = 0.0
    assert np.abs(found - wanted).max() < 1e-12 * np.abs(wanted).max()
    skew.axpy(-1.0, skew.copy().transpose())
    assert skew.norm() < 1e-12 * of.system.matrix.norm()


@pytest.mark.parametrize("level", [0.2, 3.0])
@pytest.mark.parametrize(("shape", "tilt"), [(bowl, 0.0), (rollers, 0.0), (bowl, TILT)])
def test_the_level_derives_the_liquid(shape, tilt, level):
    """DPi/dzw + gamma V_f is that of the reference surface, at any displacement, wet or partly wet."""
    of = model(shape(), tilt=tilt)
    left, h = [], 1e-6
    for seed in (0, 1):
        values = []
        for zw in (level - h, level, level + h):
            with of.system.at(shaken(of, zw, seed)):
                values.append(of.system.monitors())
        left.append((values[2]["Pi"] - values[0]["Pi"]) / (2 * h) + GAMMA * values[1]["V_f"])
    assert left[0] == pytest.approx(left[1], rel=1e-7)


@pytest.mark.parametrize("degree", [1, 2])
@pytest.mark.parametrize(
    ("shape", "tilt"), [(bowl, 0.0), (lambda: square(3), 0.0), (bowl, TILT), (lambda: square(3), TILT)]
)
def test_the_supports_bear_the_liquid(shape, tilt, degree):
    """The sum of all vertical nodal forces is the weight of the liquid between vertical walls, exactly."""
    of = model(shape(), degree=degree, tilt=tilt)
    forces = fem.form(of.system.formulation.residual)
    with of.system.at(shaken(of, 0.05)):
        nodal = fem.assemble_vector(forces).array.reshape(-1, 3)
        total = (nodal @ TILTED if tilt else nodal[:, 2]).sum()
        held = of.system.monitor("V_f")
    assert total == pytest.approx(GAMMA * held, rel=1e-11)


@pytest.mark.parametrize(
    ("of", "square_of_wave"),
    [(lambda: disk(8, 2), jn_zeros(0, 1)[0] ** 2), (lambda: square(8), np.pi**2 / 2)],
    ids=["disk", "square"],
)
def test_a_flat_sheet_ponds_at_the_closed_form(of, square_of_wave):
    """Gamma delta^2 = S k^2, k of the first wave of a drum, to the accuracy of the mesh."""
    critical = STRESS / DELTA**2 * square_of_wave
    for side, count in ((-1, 0), (1, 1)):
        flat = model(of(), gamma=critical * (1 + side * 4e-4))
        with flat.system.at(State(0 * flat.system.initial.u, flat.system.initial.loads | {"zw": 1e-300})):
            factor = Factorization(flat.system)
            factor.update()
            assert factor.negative_count() == count


@pytest.mark.slow
def test_the_square_under_a_liquid_is_that_of_rectangle():
    """The same triangles by another model, without its symmetry: the same numbers and points to round-off."""
    given = {"alpha": 0.0, "gamma": 5.0, "w_end": 0.9, "at": {"w_c": 0.5}, "numerics": COARSE}
    own = solve("membrane", mesh="square", load="liquid", **given)
    other = solve("rectangle", symmetry="full", **given)
    pairs = [(own.states[0].quantities, other.states[0].quantities)]
    for name in ("zw", "V_f", "Pi", "U", "S_least"):
        assert pairs[0][0][name].value == pytest.approx(pairs[0][1][name].value, rel=1e-9), name
    assert own.states[0].quantities["n_held"].value == other.states[0].quantities["n_held"].value
    assert len(own.points("limit_point")) == 2
    for one, two in zip(own.points("limit_point"), other.points("limit_point"), strict=True):
        for name in ("zw", "V_f", "w_c"):
            assert one.values[name] == pytest.approx(two.values[name], rel=1e-6), name


def test_the_liquid_folds_where_its_count_changes():
    """Neo-Hookean under a light liquid: the level has a limit first, then the liquid itself."""
    given = {"alpha": 0.0, "gamma": 1.0, "w_end": 1.75, "numerics": {"cells": 6, "levels": 2}}
    found = solve("membrane", mesh="square", load="liquid", **given)
    level, amount = found.special_points
    assert (level.kind, amount.kind) == ("limit_point", "volume_fold")
    branch = found.branch()
    w, past = branch["w_c"], 1e-9
    assert (branch["n_negative"] == (w > level.values["w_c"] + past)).all()
    unstable = w > amount.values["w_c"]
    assert unstable.any()
    assert (branch["n_held"] == unstable).all()


def test_gas_of_a_given_volume_stays_stable_past_the_limit_pressure():
    found = solve("membrane", alpha=0.0, w_end=1.4, numerics={"cells": 8, "levels": 2})
    (limit,) = found.special_points
    branch = found.branch()
    assert (branch["n_negative"] == (branch["V"] > limit.values["V"] * (1 + 1e-9))).all()
    assert branch["n_negative"].any()
    assert not branch["n_held"].any()


@pytest.mark.slow
def test_a_bowl_of_a_file_holds_the_liquid_on_its_upper_side(tmp_path):
    """Whatever the orientation in the file, and wherever the surface lies."""
    of = bowl()
    given = {"load": "liquid", "w_end": 0.31, "at": {"w_c": 0.3}, "numerics": {"levels": 2}}
    found = []
    for name, cells, lift in (("up", of.cells, 0.0), ("down", of.cells[:, [0, 2, 1, 3, 5, 4]], 0.7)):
        path = written(tmp_path / f"{name}.msh", of.points + np.array([0, 0, lift]), cells)
        (state,) = solve("membrane", mesh=path, **given).states
        found.append({n: state.quantities[n].value for n in ("zw", "V_f", "Pi", "U")})
        found[-1]["zw"] -= lift
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    assert found[0]["V_f"] > 0


def test_a_tilted_weight_is_a_surface_turned_the_other_way(tmp_path):
    """One body, turned as a whole, has the same numbers: of a bowl that is wet in part, and of a disk."""
    angle = 20.0
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[c, 0, -s], [0, 1, 0], [s, 0, c]])  # takes the vertical to Z
    for name, of, tilts in (("bowl", bowl(), (angle, 0.0)), ("disk", disk(4, 2), (angle + 5, 5.0))):
        found = []
        for tilt, motion in zip(tilts, (np.eye(3), turn), strict=True):
            path = written(tmp_path / f"{name}{tilt:g}.msh", of.points @ motion.T, of.cells)
            given = {"load": "liquid", "gamma": 3.0, "w_end": 0.31, "at": {"w_c": 0.3}, "tilt": tilt}
            (state,) = solve("membrane", mesh=path, **given, numerics={"levels": 2}).states
            found.append({n: state.quantities[n].value for n in ("zw", "V_f", "Pi", "U", "w_max")})
        assert found[0] == pytest.approx(found[1], rel=1e-9)
        assert found[0]["w_max"] > 0.3 + 1e-3  # the tilt is seen


def test_edges_that_move_in_no_vertical_plane_are_refused_under_a_tilted_weight(tmp_path):
    of = airbag(3)
    groups = {"left": of.mirrors["X"], "bottom": of.mirrors["Y"], "seam": of.slides["Z"]}
    path = written(tmp_path / "quarter.msh", of.points, of.cells, **groups)
    given = {"mesh": path, "load": "liquid", "tilt": 10.0}
    with pytest.raises(InputError, match="move in a plane X = constant, which is not vertical"):
        solve("membrane", mirror="left,bottom", **given)
    with pytest.raises(InputError, match="move in a plane Z = constant, which is not vertical"):
        solve("membrane", mirror="bottom", slide="seam", **given)


def test_a_sheet_on_rollers_sinks_under_a_liquid(tmp_path):
    """One side held, the other one sliding: it begins at a level, and its potential is a minimum."""
    of = rollers()
    groups = {"left": of.mirrors["X"], "bottom": of.mirrors["Y"], "side": of.held, "seam": of.slides["Z"]}
    path = written(tmp_path / "rollers.msh", of.points, of.cells, **groups)
    given = {"mirror": "left,bottom", "slide": "seam", "load": "liquid", "w_end": 0.5}
    found = solve("membrane", mesh=path, **given, numerics={"levels": 2, "p_start": 0.5})
    assert found.failures == []
    branch = found.branch()
    assert branch["zw"][0] == pytest.approx(0.7 + 0.5)
    assert (np.diff(branch["V_f"]) > 0).all()
    assert not branch["n_negative"].any()


def test_edges_that_move_at_two_heights_are_refused(tmp_path):
    """A quarter of a tube between a plane of symmetry and a plane in which its other end slides."""
    across, up = (np.linspace(0, 1, n) for n in (5, 4))
    angle, z = (part.ravel() for part in np.meshgrid(np.pi / 2 * across, up))
    points = np.column_stack([np.cos(angle), np.sin(angle), z])
    at = np.arange(20).reshape(4, 5)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    cells = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    lines = {"low": at[0], "high": at[-1], "x": at[:, -1], "y": at[:, 0]}
    groups = {name: np.column_stack([nodes[:-1], nodes[1:]]) for name, nodes in lines.items()}
    path = written(tmp_path / "tube.msh", points, cells, **groups)
    told = "mirror lie in Z = 0, edges of slide in Z = 1; a load on edges that move at two heights has no"
    with pytest.raises(InputError, match=told):
        from_file(path, 1.0, [], ["x", "y", "low"], ["high"])
    given = {"mesh": path, "load": "liquid", "delta": 1}
    with pytest.raises(InputError, match="a horizontal plane is no plane of symmetry of a liquid"):
        solve("membrane", mirror="x,y,low", held="high", **given)
    with pytest.raises(InputError, match=r"span a horizontal area of .* no side of it is the upper one"):
        solve("membrane", mirror="x,y", held="low,high", **given)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"mesh": "airbag", "delta": 1},
            "no edge of mesh = airbag is held; allowed: a surface with held edges",
        ),
        ({"gamma": 0.0}, "gamma = 0.0: input should be greater than 0"),
        ({"gamma": 31.0}, "gamma = 31.0: input should be less than or equal to 30"),
        ({"mesh": "tube", "delta": 1}, "a horizontal plane is no plane of symmetry of a liquid"),
        ({"tilt": 81.0}, "tilt = 81.0: input should be less than or equal to 80"),
        ({"load": "oil"}, "load = 'oil'"),
        ({"model": "varga", "gamma": 2.0}, "gamma = 2: the force of model = 'varga' is bounded"),
        ({"model": "varga", "delta": 2.5}, "delta = 2.5: the force of model = 'varga' is bounded"),
        ({"at": {"p": 0.1}}, "with load = 'liquid' there is no p; allowed: zw, V_f"),
        ({"load": "gas", "at": {"zw": 0.1}}, "with load = 'gas' there is no zw; allowed: p, V"),
    ],
)
def test_bad_input_is_one_line(given, words):
    with pytest.raises(InputError) as refused:
        solve("membrane", **{"load": "liquid"} | given)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)
