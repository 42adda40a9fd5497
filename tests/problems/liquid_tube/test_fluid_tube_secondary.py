"""The secondary branch of the fluid-loaded tube: structure, stability, slopes, profiles, files of shapes."""

import json
from contextlib import nullcontext
from types import SimpleNamespace

import meshio
import numpy as np
import pytest
from mpi4py import MPI

from weakforms import ConvergenceError, InputError
from weakforms.problems import registry
from weakforms.problems.liquid_tube.bent.bifurcation_point import position
from weakforms.problems.liquid_tube.bent.branch import secondary_branch
from weakforms.problems.liquid_tube.bent.family import (
    THETAS,
    SecondaryFamily,
    free_surface,
    secondary_family,
)
from weakforms.problems.liquid_tube.bent.stability import SHIFT
from weakforms.problems.liquid_tube.bent.surface import SurfaceData
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.problems.problem import Requests, silent, validated
from weakforms.results import Field, Result
from weakforms.shapes import shape_mesh, shown_state, surface, write_shape
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.stability.spectra import Mode, Stability

pytestmark = pytest.mark.paper3
PROBLEM = registry.get("fluid_tube")
GAMMA, LENGTH = 0.116, 4.0
ZW = 7.6


@pytest.fixture(scope="module")
def family():
    parameters = validated(PROBLEM.parameters, {"secondary": True}, "fluid_tube")
    numerics = validated(
        PROBLEM.numerics,
        {"secondary_cells": 12, "secondary_degree": 4, "secondary_levels": 2, "secondary_end": 0.93},
        "numerics",
    )
    return secondary_family(parameters, numerics, MPI.COMM_SELF, silent)


@pytest.fixture(scope="module")
def state(family):
    return family.state("zw", ZW, 1, np.linspace(0, LENGTH, 17))


def test_level_and_volume_fall_and_one_eigenvalue_is_negative(family):
    columns = family.branch(with_uncertainty=False).columns
    assert family.failures == []
    assert np.all(np.diff(columns["zw"]) < 0)
    assert np.all(np.diff(columns["V"]) < 0)
    assert np.all(columns["n_negative"] == 1)
    assert np.all(columns["r_mid"][1:] > columns["r_mid_pi"][1:]), "the bulge is at Theta = 0"
    assert np.any(np.diff(columns["r_mid"]) < 0), "r_mid turns down before the end"
    assert columns["residual"].max() < 1e-8


def test_negative_eigenvalues_are_those_of_the_state_itself(family):
    fine = family.fine
    for point in family.levels[0].points[1::4]:
        (*_, last), (counted, *_) = family._solved_on_all(point)
        with fine.system.at(last.state):
            fine.solver.factor.update()
            assert fine.solver.factor.negative_count() == counted


def test_it_starts_at_the_axisymmetric_bifurcation(family):
    point = family.special_points()[0]
    begin = PrimaryBranch(MPI.COMM_SELF, 8.0, 2.0).bifurcation(np.linspace(0, LENGTH, 5))
    assert point.kind == "bifurcation_point"
    for name in ("zw", "V", "r_mid"):
        assert abs(point.values[name] - begin.values[name]) < 2 * point.uncertainty[name]
    extrapolated = family.fine.initial()["zw_extrapolated"]
    assert extrapolated == pytest.approx(point.values["zw"], abs=1e-6)


def test_initial_slopes_are_those_of_small_steps(family):
    point = family.special_points()[0]
    near, far = (family.fine.at_amplitude(a).values for a in (0.02, 0.03))
    assert point.values["dzw_dV"] > 0, "both fall"
    slope = (far["zw"] - near["zw"]) / (far["V"] - near["V"])
    assert slope == pytest.approx(point.values["dzw_dV"], rel=5e-3)
    radius = (near["r_mid"] - near["r_mid_pi"]) / 2
    ratio = (near["zw"] - point.values["zw"]) / radius**2
    assert ratio == pytest.approx(point.values["dzw_dr2"], rel=2e-2)
    mean = [(s["r_mid"] + s["r_mid_pi"]) / 2 for s in (near, far)]
    slope = (mean[1] - mean[0]) / (far["zw"] - near["zw"])
    assert slope == pytest.approx(point.values["dr_mean_dzw"], rel=2e-2)


def test_a_state_of_small_amplitude_is_approached_in_steps_where_a_guess_is_too_far_off():
    """On a short tube under a heavy liquid, Newton's method diverged at amplitudes of 0.08 and 0.1."""
    given = 2.365, 1.733, 1.635, 0.0
    primary = PrimaryBranch(MPI.COMM_SELF, *given)
    begin = primary.bifurcation(np.linspace(0, 2.365 / 1.733, 121))
    data = SurfaceData(*given, 6, 4, 4, front=free_surface(begin))
    branch = secondary_branch(MPI.COMM_SELF, data, primary, 0.1, 0.95)
    far = branch.at_amplitude(0.1)
    offset = branch.system.dot(branch._across, far.state.u - branch.bifurcation.state.u)
    assert offset == pytest.approx(0.1 * branch.size, rel=1e-3), "on a mesh that has moved a little"
    followed = branch.at("V", far.values["V"]).values
    for name in ("zw", "r_mid", "r_mid_pi"):
        assert far.values[name] == pytest.approx(followed[name], rel=1e-6)


def test_level_and_volume_are_work_conjugate_along_the_branch(family):
    h = 1e-3
    before, here, after = (family.levels[0].at("zw", ZW + s * h).values for s in (-1, 0, 1))
    assert (after["Pi"] - before["Pi"]) / (2 * h) == pytest.approx(-GAMMA * here["V"], rel=1e-4)


def test_the_turn_of_the_pattern_is_a_zero_eigenvalue(state):
    values = {name: q.value for name, q in state.quantities.items()}
    assert abs(values["Lambda_rotation"]) < 1e-3 * values["Lambda_breaking"]
    assert values["n_negative"] == 1
    assert values["Lambda_1"] < 0 < values["Lambda_2"] < values["Lambda_3"]
    assert values["n_negative_breaking"] == 0


def test_the_turns_zero_is_no_negative_eigenvalue_whatever_its_sign(family):
    """The zero of the turn may be negative by rounding: it is identified by its vector, not counted."""
    solved, stability = family.levels[0].at("zw", ZW), family.levels[0].stability
    values = stability.spectra(solved.state)
    between = values["Lambda_breaking"] / 2
    assert stability.breaks.about(solved.state, between, 1)[1] == 1, "nothing but the turn"
    assert stability.breaks.about(solved.state, -SHIFT, 1)[1] == 0
    for sign in (-1, 1):  # the sign that round-off would give it
        stability.breaks = Turned(stability.model.breaking, sign * 1e-9)
        assert stability.spectra(solved.state)["n_negative_breaking"] == 0
        assert stability.spectra(solved.state)["Lambda_rotation"] == sign * 1e-9
    stability.breaks = Turned(stability.model.breaking, -5e-3)
    with pytest.raises(ConvergenceError, match="is not a zero mode"):
        stability.spectra(solved.state)
    stability.breaks = Stability(stability.model.breaking)


class Turned(Stability):
    """The same with another value of the eigenvalue next to zero."""

    def __init__(self, system, value):
        super().__init__(system)
        self.value = value

    def about(self, state, target, count):  # noqa: D102
        modes, below = super().about(state, target, count)
        nearest = min(modes, key=lambda mode: abs(mode.eigenvalue))
        return [Mode(self.value, m.vector) if m is nearest else m for m in modes], below


def test_an_instability_that_breaks_the_symmetry_is_counted(family):
    """Axisymmetric states past the bifurcation have a negative eigenvalue, which is not the turn's zero."""
    level = family.fine
    points = np.linspace(0, LENGTH, 121)
    state = PrimaryBranch(MPI.COMM_SELF, 8.0, 2.0).at("V", 140.0, points)
    guess = level.model.state_of(position(state), {"zw": state.values["zw"]})
    found, _ = ExtendedNewton(level.model.system).solve(guess)
    _, below = level.stability.breaks.about(found, -1e-4, 3)
    assert below == 1
    with pytest.raises(ConvergenceError, match="is not a zero mode"):
        level.stability.spectra(found)


def test_points_of_a_curve_are_not_judged_for_stability(family):
    plain = family.state("zw", ZW)
    assert "Lambda_1" not in plain.quantities
    assert plain.fields == ()


def test_the_negative_eigenvalue_stays_under_volume_control(state):
    values = {name: q.value for name, q in state.quantities.items()}
    assert values["n_negative_V"] == 1
    assert values["Lambda_1"] < values["LambdaV_1"] < 0, "the constraint stiffens"


def test_profile_lies_on_the_plane_of_symmetry_and_on_the_rings(state):
    columns = state.fields[0].columns
    on = np.isclose(columns["Theta"], 0) | np.isclose(columns["Theta"], np.pi)
    assert abs(columns["y"][on]).max() < 1e-12
    ring = columns["Z"] == 0
    assert columns["x"][ring] == pytest.approx(np.cos(THETAS), abs=1e-3)
    assert columns["z"][ring] == pytest.approx(np.zeros(len(THETAS)), abs=1e-12)
    assert np.all(columns["lam1"] >= columns["lam2"])
    assert columns["T2"].min() > 0
    assert state.quantities["z_min"].value < -0.5 < 0, "it hangs below the lower ring"
    quarter = np.isclose(columns["Z"], LENGTH / 4)
    for side, theta in (("0", 0.0), ("pi", np.pi)):
        row = quarter & np.isclose(columns["Theta"], theta)
        for name in ("x", "z"):
            read = state.quantities[f"{name}_quarter_{side}"].value
            assert columns[name][row][0] == pytest.approx(read, abs=1e-9)


def test_a_state_is_found_at_any_column(family):
    wanted = family.levels[0].at("r_mid_pi", 1.7).values
    assert wanted["r_mid_pi"] == pytest.approx(1.7, abs=1e-10)
    assert family.levels[0].at("zw", wanted["zw"]).values["V"] == pytest.approx(wanted["V"], rel=1e-9)


# -- shapes ----------------------------------------------------------------------------------------


def enclosed(points, triangles):
    """Volume between a lateral surface and its disks at ``z = 0`` and ``z = 8``, normals outwards."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6 + np.pi * 8 / 3


def test_the_uncertainty_of_a_field_is_that_of_the_region(state):
    """One for each row; even on these coarse meshes the best places are far better than the worst ones."""
    field = state.fields[0]
    for name in ("x", "lam1", "lam2", "T1"):
        spread = field.uncertainty[name]
        assert spread.shape == field.columns["Z"].shape
        assert 0 < spread.min() < spread.max() / 5


def test_shape_files_hold_the_whole_surface(state, tmp_path):
    field = state.fields[0]
    write_shape(tmp_path / "bent.vtu", field)
    write_shape(tmp_path / "bent.stl", field)
    read = meshio.read(tmp_path / "bent.vtu")
    assert {"T1", "T2", "Z", "Theta"} <= set(read.point_data)
    assert read.points[:, 1].min() == pytest.approx(-read.points[:, 1].max(), rel=1e-12)
    solid = meshio.read(tmp_path / "bent.stl")
    volume = enclosed(solid.points, solid.cells_dict["triangle"])
    # The level is just below the upper ring: what is not filled is less than what the facets cut off.
    assert volume == pytest.approx(state.quantities["V"].value, rel=0.03)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bent.stl", "bent.vtu"]


def test_the_state_shown_is_chosen_by_branch_and_number(state):
    result = Result("fluid_tube", {}, {}, {}, {}, states=[state])
    assert shown_state(result) is shown_state(result, "secondary", 1) is state
    with pytest.raises(InputError, match="has 0 states with a profile on the primary branch"):
        shown_state(result, "primary")


def test_a_meridian_is_revolved():
    z = np.linspace(0, 2, 5)
    points, data = surface(Field("profile", {"Z": z, "r": 1 + 0 * z, "z": z, "T1": z}))
    assert np.hypot(points[..., 0], points[..., 1]) == pytest.approx(1)
    assert data["T1"][:, 0] == pytest.approx(z)
    mesh = shape_mesh(Field("profile", {"Z": z, "rho": 1 + 0 * z, "eta": z}))
    assert len(mesh.cells_dict["quad"]) == 4 * (points.shape[1] - 1)


@pytest.mark.parametrize(
    ("name", "columns", "words"),
    [
        ("a.ply", {"r": [1.0], "z": [0.0]}, "must end in .vtu, .xdmf, .stl"),
        ("a.vtu", {"p": [1.0]}, "is not a surface"),
        ("no/where/a.vtu", {"r": [1.0, 1.0], "z": [0.0, 1.0]}, "cannot write"),
    ],
)
def test_a_shape_that_cannot_be_written_is_refused(name, columns, words, tmp_path):
    field = Field("profile", {k: np.array(v) for k, v in columns.items()})
    with pytest.raises(InputError, match=words):
        write_shape(tmp_path / name, field)


# -- requests --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("numerics", "words"),
    [
        ({"secondary_cells": 20}, "secondary_cells must be a multiple of 24"),
        ({"secondary_end": 0.5}, "secondary_end"),
        ({"secondary_around": 10}, "secondary_around must be a multiple of 8"),
    ],
)
def test_bad_numerics_are_refused(numerics, words):
    with pytest.raises(InputError, match=words):
        validated(PROBLEM.numerics, numerics, "fluid_tube numerics")


def test_eigenvalues_cannot_be_prescribed():
    from weakforms.problems.problem import StateRequest

    parameters = validated(PROBLEM.parameters, {"secondary": True}, "fluid_tube")
    requests = Requests((StateRequest("Lambda_2", 0.1, branch="secondary"),))
    with pytest.raises(InputError, match="cannot ask for a state at 'Lambda_2'"):
        PROBLEM.check(parameters, requests)


def test_states_are_plain_numbers(state):
    assert json.loads(json.dumps(state.to_json()))["branch"] == "secondary"


@pytest.mark.parametrize(
    ("stiffened", "counts", "found"), [(None, [1, 7], 1), (None, [2, 1], 1), ((1, 2), [1, 3], 3)]
)
def test_a_count_that_differs_between_meshes_is_taken_at_the_state_itself(stiffened, counts, found):
    """The last factor of Newton's method serves only if it agrees with the coarsest mesh and is regular."""
    factor = SimpleNamespace(stiffened=stiffened, seen=counts[0])
    factor.negative_count = lambda: factor.seen
    factor.update = lambda: setattr(factor, "seen", counts[1])
    fine = SimpleNamespace(
        solver=SimpleNamespace(factor=factor), system=SimpleNamespace(at=lambda _: nullcontext())
    )
    point = SimpleNamespace(n_negative=1)
    assert SecondaryFamily._negative_count(SimpleNamespace(fine=fine), point, None) == found


def test_every_number_of_a_state_is_described(state):
    assert {"Lambda_1", "Lambda_3", "V"} <= state.quantities.keys()
    assert state.quantities.keys() - PROBLEM.scales.keys() <= {"n_negative"}
