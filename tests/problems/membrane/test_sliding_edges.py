"""Problem ``membrane`` with edges that slide in a plane: loads, first states, and what is refused."""

import meshio
import numpy as np
import pytest
import shapes_of_gmsh as shapes
import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms import ConvergenceError, InputError, solve
from weakforms.problems.material_choice import Chosen, mooney_rivlin_of
from weakforms.problems.membrane.descent import least_energy
from weakforms.problems.membrane.files import from_file
from weakforms.problems.membrane.model import Body, MembraneModel
from weakforms.problems.membrane.shapes import airbag
from weakforms.solvers.equilibrium.state import State

KIRCHHOFF = Chosen("saint_venant_kirchhoff", (("shear", 1 / 2.8), ("poisson", 0.4)))
GIVEN = {"model": "saint_venant_kirchhoff", "shear": 1 / 2.8, "poisson": 0.4, "delta": 1, "w_end": 0.511}
COARSE = {"cells": 4, "levels": 2}
PRESSURE = 6.0128e-3


def quarter() -> dict[str, list[int]]:
    """The quarter of a sheet of a square airbag, its seam in two groups."""
    bottom, right, top, left = shapes.polygon([(0, 0), (1, 0), (1, 1), (0, 1)])
    return {"bottom": [bottom], "right": [right], "top": [top], "left": [left]}


def written(path, of, lift=0.0, groups=("left", "bottom", "seam")):
    """A built-in airbag as a file, lifted, with groups of these names."""
    edges = [of.mirrors["X"], of.mirrors["Y"], of.slides["Z"]]
    cells = [("triangle", of.cells), *(("line", e) for e in edges)]
    tags = [np.ones(len(of.cells), int), *(np.full(len(e), k + 2) for k, e in enumerate(edges))]
    mesh = meshio.Mesh(of.points + np.array([0, 0, lift]), cells)
    mesh.cell_data = {"gmsh:physical": tags, "gmsh:geometrical": tags}
    mesh.field_data = {name: np.array([k + 2, 1]) for k, name in enumerate(groups)}
    mesh.write(path, file_format="gmsh22")
    return str(path)


@pytest.mark.parametrize("law", [KIRCHHOFF, mooney_rivlin_of(0.1)], ids=["kirchhoff", "mooney_rivlin"])
def test_a_seam_bears_the_pressure_along_the_normals_and_no_other_load(tmp_path, law):
    """Of the potential, against its virtual work, for a seam at any height."""
    lifted = from_file(
        written(tmp_path / "bag.msh", airbag(3), lift=0.7), 1.0, [], ["left", "bottom"], ["seam"]
    )
    of = MembraneModel(MPI.COMM_SELF, Body(lifted, law, 1.0))
    system = of.system
    u = 0.1 * np.random.default_rng(0).standard_normal(system.size)
    u[system.bc_dofs] = 0.0
    deformed = ufl.dot(ufl.grad(of.membrane.position), ufl.Jacobian(of.mesh))
    reference = ufl.Jacobian(of.mesh)
    normal = ufl.cross(deformed[:, 0], deformed[:, 1]) / ufl.sqrt(ufl.det(reference.T * reference))
    pushed = fem.form(-ufl.inner(normal, ufl.TestFunction(of.space)) * of.dx)
    with system.at(State(u, system.initial.loads | {"p": 0.7})):
        found = system.load_derivative("p")
        wanted = fem.assemble_vector(pushed).array[: system.size].copy()
        tangent = system.tangent().copy()
    wanted[system.bc_dofs] = 0.0
    assert np.abs(found - wanted).max() < 1e-12 * np.abs(wanted).max()
    tangent.axpy(-1.0, tangent.copy().transpose())
    assert tangent.norm() < 1e-12 * system.matrix.norm()


def test_the_seam_moves_in_its_plane_only():
    of = MembraneModel(MPI.COMM_SELF, Body(airbag(2), KIRCHHOFF, 1.0))
    place = of.space.tabulate_dof_coordinates()[: of.system.size // 3]
    fixed = np.zeros(of.system.size, bool)
    fixed[of.system.bc_dofs] = True
    x, y = place[:, :2].T.round(9)
    wanted = np.column_stack([x == 0, y == 0, (x == 1) | (y == 1)])
    assert (fixed.reshape(-1, 3) == wanted).all()


def test_the_first_state_is_a_minimum_from_any_guess():
    """Its forces balance; the minima of two guesses differ in their wrinkles only."""
    of = MembraneModel(MPI.COMM_SELF, Body(airbag(4), KIRCHHOFF, 1.0))
    system = of.system
    loads = system.initial.loads | {"p": PRESSURE}
    found = [least_energy(system, State(of.raised(height), loads)) for height in (0.3, 0.5)]
    values = []
    for state in found:
        with system.at(state):
            assert np.abs(system.residual()).max() < 1e-9 * PRESSURE
            values.append(system.monitors())
    assert values[0]["Pi"] == pytest.approx(values[1]["Pi"], rel=1e-3)
    assert values[0]["w_c"] == pytest.approx(0.510, abs=3e-3)


def test_a_minimum_that_is_not_reached_is_an_error(monkeypatch):
    monkeypatch.setattr("weakforms.problems.membrane.descent.MOST", 3)
    with pytest.raises(ConvergenceError, match=r"no first state.*has not reached its minimum after 3 steps"):
        solve("membrane", mesh="airbag", **GIVEN, at={"p": PRESSURE}, numerics=COARSE)


def test_a_file_has_the_numbers_of_the_built_in_quarter(tmp_path):
    """Wherever the plane of the seam is."""
    numerics = {"levels": 2, "degree": 1}
    path = written(tmp_path / "bag.msh", airbag(4), lift=0.7)
    groups = {"mirror": "left,bottom", "slide": "seam"}
    file = solve("membrane", mesh=path, **groups, **GIVEN, at={"p": PRESSURE}, numerics=numerics)
    own = solve(
        "membrane",
        mesh="airbag",
        **GIVEN,
        at={"p": PRESSURE},
        numerics={"cells": 4, "degree": 1, "levels": 2},
    )
    (one,), (other,) = file.states, own.states
    assert file.failures == own.failures == []
    # The file is the coarsest mesh; its meshes have no centres of squares in common with the built-in ones.
    for name, close in (("w_c", 5e-3), ("V", 2e-2), ("Pi", 2e-2), ("u_far", 0.1)):
        assert one.quantities[name].value == pytest.approx(other.quantities[name].value, rel=close), name


def test_an_edge_that_slides_beside_a_held_one_lowers_the_energy(tmp_path):
    """At one pressure the least potential energy of a sheet with fewer supports is lower."""
    bag = str(shapes.written(tmp_path / "quarter.msh", quarter, 0.5))
    numerics = {"levels": 2, "degree": 1, "p_start": 1.0}
    given = {"delta": 1.05, "w_end": 0.6, "at": {"p": 1.3}, "alpha": 0, "numerics": numerics}
    least = []
    for slide in ("", "top"):
        found = solve("membrane", mesh=bag, mirror="left,bottom", slide=slide, **given)
        assert found.failures == []
        least.append(found.states[0].quantities["Pi"].value)
    assert least[1] < least[0] < 0.0


def test_rubber_inflates_between_sliding_edges():
    """Another law, with large strains, and the work of the gas."""
    nodes = 0.75 + 0.05 * np.cos(np.pi * np.arange(6, -1, -1) / 6)
    given = {"alpha": 0.1, "delta": 1, "w_end": 0.82, "at": [("w_c", float(w)) for w in nodes]}
    found = solve("membrane", mesh="airbag", **given, numerics={**COARSE, "p_start": 0.5})
    assert found.failures == []
    p, volume, energy = ([s.quantities[n].value for s in found.states] for n in ("p", "V", "U"))
    rate = np.polynomial.Chebyshev.fit(nodes, p, 6) * np.polynomial.Chebyshev.fit(nodes, volume, 6).deriv()
    work = rate.integ()
    assert work(nodes[-1]) - work(nodes[0]) == pytest.approx(energy[-1] - energy[0], rel=1e-3)


# -- what is refused -----------------------------------------------------------------------------------


def test_supports_that_are_refused(tmp_path):
    bag = str(shapes.written(tmp_path / "quarter.msh", quarter, 0.5))
    ball = str(shapes.written(tmp_path / "ball.msh", shapes.octant, 0.5))
    supports = {"mirror": "left,bottom", "slide": "right,top"}
    for mesh, given, words in (
        (bag, {**supports, "delta": 1.1}, "delta = 1.1: no edge is held.*allowed: delta = 1"),
        (bag, {"slide": "right,top,left,bottom", "delta": 1}, "it may move as a rigid body"),
        (bag, {"mirror": "left", "slide": "right,top,bottom", "delta": 1}, "it may move as a rigid body"),
        (bag, {**supports, "held": "top"}, "group 'top' is both in held and in slide"),
        (bag, {"mirror": "left,bottom,top", "slide": "right,top"}, "both in mirror and in slide"),
        (bag, {"held": "top", "slide": "right"}, "nor do they slide: a pressure"),
        (bag, {**supports, "slide": "right,tpo"}, "no group of edges is called 'tpo'"),
        (ball, {"slide": "rim", "delta": 1}, "no group of edges is called 'rim'"),
    ):
        with pytest.raises(InputError, match=words):
            solve("membrane", mesh=mesh, **given)
    with pytest.raises(InputError, match="energy = 'full' loses its ellipticity"):
        solve("membrane", mesh="airbag", **GIVEN, energy="full")
    with pytest.raises(InputError, match=r"delta = 1\.1: no edge is held"):
        solve("membrane", mesh="airbag")


def test_edges_that_slide_in_no_plane_or_in_two(tmp_path):
    of = airbag(2)
    bent = of.points.copy()
    bent[:, 2] = 0.2 * bent[:, 0] * bent[:, 1]
    skew = type(of)(bent, of.cells, of.held, of.mirrors, slides=of.slides)
    path = written(tmp_path / "bent.msh", skew)
    with pytest.raises(InputError, match="group 'seam' of slide lies in no plane"):
        from_file(path, 1.0, [], ["left", "bottom"], ["seam"])
    step = of.points.copy()
    step[:, 2] = 0.2 * step[:, 0]
    edges = of.slides["Z"]
    right = (of.points[edges, 0] == 1).all(axis=1)
    left = type(of)(
        step, of.cells, of.held, {"X": edges[right], "Y": of.mirrors["Y"]}, slides={"Z": of.mirrors["X"]}
    )
    path = written(tmp_path / "step.msh", left, groups=("right", "bottom", "left"))
    with pytest.raises(InputError, match="lies in another plane Z = constant"):
        from_file(path, 1.0, [], ["bottom"], ["right", "left"])


def test_a_pressure_below_the_first_one_is_not_on_the_branch():
    with pytest.raises(InputError, match=r"p = 0\.001"):
        solve("membrane", mesh="airbag", **GIVEN, at={"p": 1e-3}, numerics={**COARSE, "degree": 1})
