"""Bent states of the free tube: the surface, its crossing, the expansion there, branch, refusals."""

import numpy as np
import pytest
import ufl
from dolfinx import fem
from dolfinx import mesh as dmesh
from mpi4py import MPI
from scipy.interpolate import PPoly, make_interp_spline

from reference_data.solvers.beyond.bent_tube import energy, outside
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.mooney_rivlin import Tube as ReferenceTube
from weakforms import ConvergenceError, InputError, solve
from weakforms.problems.gas import Gas
from weakforms.problems.meridian.families import EVEN as WAVE_EVEN
from weakforms.problems.meridian.families import ODD as WAVE_ODD
from weakforms.problems.meridian.families import Wave
from weakforms.problems.meridian.sector import SectorMesh
from weakforms.problems.problem import Requests, Task
from weakforms.problems.tube.parameters import SecondaryNumerics, TubeParameters
from weakforms.problems.tube.problem import Tube
from weakforms.problems.tube.secondary.bent import AMPLITUDE
from weakforms.problems.tube.secondary.outside import CLASSES, TURNED, BentModes
from weakforms.problems.tube.secondary.surface import EVEN, ODD, TURNING, BentTube, Parities
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.support.least import Least
from weakforms.solvers.support.sampling import Sampler

pytestmark = pytest.mark.paper2
SURFACE = {"secondary_cells": 8, "secondary_around": 4, "secondary_degree": 4}
COARSE = {"cells": 32, "levels": 2, "step": 0.2, **SURFACE}
BENDING = {"alpha": 0.0, "lf": 10.0, "u_end": 0.8, "secondary": True, "secondary_n": 1}


@pytest.fixture(scope="module")
def families():
    given, numerics = TubeParameters(**BENDING), SecondaryNumerics(**COARSE)
    return Tube().families(Task(given, numerics, Requests(), MPI.COMM_SELF, lambda *_: None))


@pytest.fixture(scope="module")
def branch(families):
    return families["secondary"].fine


def quadratic(system, state, phi):
    """``φᵀ K φ`` at a state."""
    with system.at(state):
        return system.dot(phi, system.multiply(system.tangent(), phi))


def test_an_axisymmetric_state_is_that_of_the_meridian(families, branch):
    meridian = families["primary"].fine.at("u_max", 0.5)
    state, _ = ExtendedNewton(branch.system, ["p"]).solve(branch.crossed[0].state, [Held("u_max", 0.5)])
    surface = branch.solved(state)
    for name in ("p", "V", "Pi"):
        assert surface.values[name] == pytest.approx(meridian.values[name], rel=1e-5)
    assert abs(surface.values[AMPLITUDE]) < 1e-12


def test_the_surface_is_neutral_where_a_wave_of_the_meridian_is(families):
    there = [same[-1] for same in families["primary"].located("bifurcation_n1")]
    crossing = families["secondary"].special_points()[0]
    assert crossing.kind == "bifurcation_n1"
    for name in ("p", "V", "u_max"):
        assert abs(crossing.values[name] - there[0].values[name]) < crossing.uncertainty[name]


def test_the_gas_does_work_on_the_volume(branch):
    state, system, h = branch.points[-1].state, branch.system, 1e-4
    more, less = (State(state.u, {"p": state.loads["p"] + s * h}) for s in (1, -1))
    found = []
    for moved in (more, less):
        with system.at(moved):
            found.append(system.monitor("Pi"))
    assert (found[0] - found[1]) / (2 * h) == pytest.approx(-branch.points[-1].monitors["V"], rel=1e-9)


def test_the_potential_falls_along_the_branch_by_the_volume_times_the_pressure(branch):
    p, v, potential = (branch.over_points(name) for name in ("p", "V", "Pi"))
    work = np.diff(p) * (v[1:] + v[:-1]) / 2
    assert np.diff(potential) == pytest.approx(-work, rel=1e-2)


def test_the_coefficients_are_those_of_differences_of_the_second_variation(branch):
    system, e, h = branch.system, branch.expansion, 1e-2
    moved = [State(e.state.u + s * h * e.mode, e.state.loads) for s in (-1, 0, 1)]
    less, here, more = (quadratic(system, state, e.mode) for state in moved)
    with system.at(e.state):
        fourth = system.quartic(e.mode)
    assert fourth == pytest.approx((less - 2 * here + more) / h**2, rel=1e-3)
    assert abs(e.quadratic) < 1e-8 * abs(e.cubic)


def test_solved_states_leave_the_expansion_with_the_fourth_power(branch):
    e, solver = branch.expansion, ExtendedNewton(branch.system, ["p"])
    left = []
    for amplitude in (0.1, 0.2):
        state, _ = solver.solve(e.predicted(amplitude), [Held(AMPLITUDE, amplitude)])
        left.append(state.loads["p"] - e.predicted(amplitude).loads["p"])
    assert left[1] / left[0] == pytest.approx(16, abs=0.5)


def test_bent_states_are_stable_if_the_volume_is_held(families):
    columns = families["secondary"].branch().columns
    assert set(columns["n_negative"]) == {1}
    assert set(columns["n_negative_volume"]) == {0}


def test_a_bent_state_is_stable_against_all_displacements_if_its_volume_is_held(families):
    columns = families["secondary"].branch(with_uncertainty=False).columns
    outside = sum(columns[f"n_negative_{name}"] for name in ("even_odd", "odd_even", "odd_odd"))
    assert set(outside) == {0}
    assert columns["n_negative_all"] == pytest.approx(columns["n_negative"])
    assert columns["n_negative_all_volume"] == pytest.approx(columns["n_negative_volume"])


def test_without_its_rotation_a_tube_has_one_negative_eigenvalue_less_or_none(branch):
    modes, found = branch.modes, set()
    for point in branch.points[1::3]:
        with branch.system.at(point.state):
            count, rotation = modes.turned()
            whole = modes.variation(TURNED).negative_count()
        assert abs(rotation) < 1e-4
        assert whole == count + (rotation < 0)
        found.add(rotation < 0)
    assert True in found  # the inertia of the matrix alone would be wrong


def test_the_rotation_of_the_pattern_needs_no_energy(branch):
    system, point = branch.system, branch.points[len(branch.points) // 2]
    variation = branch.modes.variation(TURNED)
    with system.at(point.state):
        dual, _ = variation.monitor_gradient(TURNING, ())
        variation.factor.update()
        turn = variation.factor.solve(dual)
        # It is the derivative of the position around the axis, also where no degree of freedom is.
        q = fem.Function(branch.modes.model.space)
        q.x.array[:] = turn / np.sqrt(variation.dot(turn, variation.mass_times(turn)))
        x = branch.modes.model.unknown
        both = fem.assemble_scalar(fem.form(ufl.inner(q, x.dx(1)) * ufl.dx))
        alone = fem.assemble_scalar(fem.form(ufl.inner(x.dx(1), x.dx(1)) * ufl.dx))
    assert abs(both) / np.sqrt(np.pi * alone) == pytest.approx(1, rel=1e-3)


@pytest.mark.parametrize("parities", [Parities(EVEN, EVEN, ODD), TURNED, Parities(ODD, ODD, ODD)])
def test_classes_of_a_round_tube_are_families_of_waves(families, branch, parities):
    """The lowest eigenvalues of a class at an axisymmetric state, by those of the meridian."""
    meridian = families["primary"].fine
    middle = WAVE_EVEN if parities.middle == EVEN else WAVE_ODD
    state, _ = ExtendedNewton(branch.system, ["p"]).solve(branch.crossed[0].state, [Held("u_max", 0.5)])
    with meridian.system.at(meridian.at("u_max", 0.5).state):
        waves = range(parities.first == ODD or parities.middle == EVEN, 4)
        each = [meridian.modes.variation(Wave(n, middle)).spectrum(1).eigenvalues[0] for n in waves]
    with branch.system.at(state):
        found = branch.modes.variation(parities).spectrum(1).eigenvalues[0]
    assert found == pytest.approx(min(each), rel=2e-3)


@pytest.mark.slow
def test_a_tube_that_bends_after_it_could_be_oval_has_an_oval_mode_of_each_class():
    """The counts are those of the ordinary tube: one of n = 2, even, whose sine and cosine part."""
    given = {"delta1": 2.0, "lf": 3.0, "u_end": 1.3, "n": (0, 2)}
    found = solve("tube", **BENDING | given, numerics=COARSE)
    columns, ordinary = found.branch("secondary").columns, found.branch("primary").columns
    assert ordinary["n_negative_n2"][-1] == 1
    names = ("even_odd", "odd_even", "odd_odd", "volume")
    assert [int(columns[f"n_negative_{name}"][1]) for name in names] == [0, 1, 0, 1]
    assert columns["n_negative_all_volume"][1] == 2
    assert columns["wrinkled"][1] == 0


def test_of_a_compressed_tube_counts_that_depend_on_the_mesh_are_left_out(families, monkeypatch):
    family, (coarse, fine) = families["secondary"], families["secondary"].levels
    for flag in (0, 1):
        for k, level in enumerate((coarse, fine)):
            row = {"n_negative_volume": 0, "n_negative_odd_odd": k, "wrinkled": flag}
            monkeypatch.setattr(level, "counted", lambda _state, row=row: row)
        if flag:
            found = family.state("V", 6.1).quantities
            assert found["n_negative_volume"].value == 0
            assert "n_negative_odd_odd" not in found
        else:
            with pytest.raises(ConvergenceError, match="depends on the mesh"):
                family.state("V", 6.1)


@pytest.mark.slow  # as the claim on resultants of beyond.bent_tube
def test_where_the_branch_begins_the_smallest_resultant_is_that_of_the_meridian():
    fine = COARSE | {"secondary_cells": 32, "secondary_degree": 6}
    found = solve("tube", **BENDING, numerics=fine)
    first, second = (point for point in found.special_points if point.kind == "bifurcation_n1")
    left = abs(first.values["t_min"] - second.values["t_min"])
    assert left < first.uncertainty["t_min"] + second.uncertainty["t_min"] < 2e-3


def test_no_place_has_a_smaller_resultant(branch):
    """The smallest one is at the disk, between the plane of bending and the axis normal to it."""
    state, model = branch.at("V", 6.2), branch.modes.model
    places = np.array([(z, theta) for z in np.linspace(0, 5, 41) for theta in np.linspace(0, np.pi, 181)])
    with branch.system.at(state.state):
        found = Sampler(model.unknown, model.principal_resultants(), places)()
    least = min(values.min() for values in found.values())
    z, theta = places[np.argmin(found["second"])]
    assert z == 5
    assert 0.3 < theta < np.pi - 0.3
    assert least - 1e-3 < state.values["t_min"] <= least


def test_a_state_whose_meshes_do_not_agree_that_it_is_wrinkled_does_not_say_so(families, monkeypatch):
    family, (coarse, fine) = families["secondary"], families["secondary"].levels
    given = fine.counted
    monkeypatch.setattr(coarse, "counted", lambda state: given(fine.points[3].state) | {"wrinkled": 0})
    assert family.state("V", 6.1).quantities["wrinkled"].value == 0
    monkeypatch.setattr(coarse, "counted", lambda state: given(fine.points[3].state) | {"wrinkled": 1})
    assert "wrinkled" not in family.state("V", 6.1).quantities


def test_the_smallest_value_on_cells_is_found_between_nodes():
    mesh = dmesh.create_unit_square(MPI.COMM_SELF, 3, 2, dmesh.CellType.quadrilateral)
    unknown = fem.Function(fem.functionspace(mesh, ("Lagrange", 2, (3,))))
    x, y = ufl.SpatialCoordinate(mesh)
    bowl = (x - 0.47) ** 2 + 2 * (y - 0.81) ** 2 + (x - 0.47) * (y - 0.81) - 0.3
    nothing = unknown[0]
    assert Least(unknown, {"a": bowl + nothing, "b": nothing})() == pytest.approx(-0.3, abs=1e-14)
    assert Least(unknown, {"b": nothing + x - 2 * y})() == pytest.approx(-2, abs=1e-13)


def test_a_profile_has_both_meridians_of_the_plane_of_bending(families):
    state = families["secondary"].state("V", 6.2, profile=np.linspace(0, 5, 11))
    columns = state.fields[0].columns
    assert columns["Z"].tolist() == [*np.linspace(0, 5, 11)] * 2
    outer, inner = columns["rho"][:11], columns["rho"][11:]
    assert outer[0] - inner[0] == pytest.approx(2 * state.quantities[AMPLITUDE].value, rel=0.05)
    assert (outer[-1], inner[-1]) == pytest.approx((1.0, 1.0), abs=1e-12)


OVAL = {"delta1": 2.0, "lf": 3.0, "u_end": 1.3, "secondary_n": 2}


def test_an_oval_tube_loses_its_stability_to_waves_that_alternate():
    found = solve("tube", **BENDING | OVAL, numerics=COARSE)
    columns = found.branch("secondary").columns
    assert found.special_points[-1].values["p_2"] == pytest.approx(-0.893059, rel=1e-4)
    assert columns["n_negative_alternating"][:4].tolist() == [0, 0, 1, 1]
    for name, own in (("all", "n_negative"), ("all_volume", "n_negative_volume")):
        assert (columns[f"n_negative_{name}"] - columns[own] == columns["n_negative_alternating"]).all()


ROUND = {(EVEN, EVEN): (False, False), (ODD, ODD): (True, False)}
TURNS = {(EVEN, ODD): (False, True), (ODD, EVEN): (True, True)}


def test_eigenvalues_of_all_classes_are_those_of_another_code():
    """An oval state by Fourier series and polynomials, and by finite elements; three of each class."""
    tube = ReferenceTube(0.0, 2.0, 3.0)
    state = energy.beside(tube, energy.Series(2, 6, Basis(6, 8)), (2.5, 2.7), 0, 0.1)
    state = energy.solve(state, "V", 2.63)
    given, numerics = TubeParameters(**BENDING | OVAL), SecondaryNumerics(**COARSE | {"secondary_degree": 5})
    task = Task(given, numerics, Requests(), MPI.COMM_SELF, lambda *_: None)
    oval = Tube().families(task)["secondary"].fine
    at = oval.at("V", 2.63)
    assert at.values["p"] == pytest.approx(state.p, rel=1e-6)
    for (first, last), (odd, alternating) in (ROUND | TURNS).items():
        for middle in (EVEN, ODD):
            theirs = outside.eigenvalues(state, odd, middle == ODD, alternating)[:3]
            with oval.system.at(at.state):
                ours = oval.modes.variation(Parities(first, last, middle)).spectrum(3).eigenvalues[:3]
            assert ours == pytest.approx(theirs, rel=1e-4, abs=1e-6)


def test_with_a_reservoir_a_given_mass_of_gas_has_a_fold():
    """Where ``(V + V_r) dp/dV + p + p_atm`` is zero along the branch without one, counts change there."""
    found = solve("tube", **BENDING | {"V_r": 60.0}, numerics=COARSE)
    (fold,) = found.points("mass_fold")
    columns = found.branch("secondary").columns
    v, p = columns["V"][1:], columns["p"][1:]
    mass = make_interp_spline(v, (p + 1.0) * (v + 60.0), 5)
    (at,) = PPoly.from_spline(mass.derivative()).roots(extrapolate=False)
    assert fold.branch == "secondary"
    assert fold.values["V"] == pytest.approx(at, rel=1e-4)
    assert fold.values["m"] == pytest.approx(float(mass(at)), rel=1e-8)
    unstable = columns["V"] > fold.values["V"]
    for name in ("n_negative_mass", "n_negative_all_mass"):
        assert np.array_equal(columns[name], np.where(unstable, 1, 0))


def test_waves_for_which_the_classes_are_not_all_displacements_have_no_total():
    model = BentTube(MPI.COMM_SELF, TubeParameters(**BENDING).material, 1.0, 3.0, 3, SectorMesh(4, 2, 2, 0.0))
    modes = BentModes(model, Gas(1.0, 1.0, 0.0))
    with model.system.at(State(model.system.initial.u, {"p": 0.5})):
        assert sorted(modes.counts()) == sorted(["n_negative_volume", "n_negative_mass", *CLASSES])


def test_a_rotation_that_is_no_zero_mode_is_refused(branch, monkeypatch):
    monkeypatch.setattr("weakforms.problems.tube.secondary.outside.LIKENESS", 1.1)
    words = r"is not a zero mode, overlap 1\.00: raise secondary_cells"
    with branch.system.at(branch.points[3].state), pytest.raises(ConvergenceError, match=words):
        branch.modes.turned()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"extent": "full"}, "set extent = 'half', or secondary_n = 0"),
        ({"contact": "frictionless"}, "set contact = 'none'"),
    ],
)
def test_bent_states_of_other_tubes_are_refused(given, message):
    with pytest.raises(InputError, match=message):
        solve("tube", **BENDING | given)


def test_a_wave_number_without_a_point_is_absent():
    found = solve("tube", **BENDING | {"secondary_n": 2}, numerics=COARSE)
    assert [branch.name for branch in found.branches] == ["primary"]
    assert "no point at which even waves of n = 2 are neutral" in found.absent[0].reason


def test_the_stability_that_comes_with_it():
    assert TubeParameters(**BENDING).stability == (1,)
    assert TubeParameters(**BENDING, n=(0, 2)).stability == (1, 0, 2)
