"""The fluid-loaded tube: forms as in the paper, branch, eigenvalues and critical points."""

import dolfinx.fem.petsc as fem_petsc
import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI
from scipy.linalg import eigh

from weakforms import InputError, solve
from weakforms.api import solve_requests
from weakforms.problems.liquid_tube.branch import FluidPath
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.problems.liquid_tube.model import TubeData
from weakforms.problems.problem import StateRequest
from weakforms.solvers.equilibrium.state import State

pytestmark = pytest.mark.paper3
GAMMA = 0.116
COARSE = {"cells": 32, "levels": 2}


def path(L=8.0, delta=2.0, cells=12, n_max=2, gamma=GAMMA):
    return FluidPath(MPI.COMM_SELF, TubeData(L, delta, gamma, 0.0, cells, 4), n_max)


@pytest.fixture(scope="module")
def short():
    return path()


@pytest.fixture(scope="module")
def partially_filled(short):
    solved = short.pieces[1].at("zw", 6.0)
    assert 0.3 < solved.state.loads["front"] < 0.9
    return solved


def dense(matrix):
    rows = range(matrix.getSize()[0])
    return matrix.getValues(rows, rows)


# -- forms -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("zw", [3.0, 6.0])
def test_tangent_is_the_residuals_derivative_and_symmetric(short, zw):
    system, state = short.model.system, short.pieces[1].at("zw", zw).state
    direction = np.random.default_rng(0).standard_normal(system.size)
    direction[system.bc_dofs] = 0.0
    h, sides = 1e-6, []
    for sign in (1, -1):
        with system.at(State(state.u + sign * h * direction, state.loads)):
            sides.append(system.residual())
    with system.at(state):
        matrix = system.tangent()
        product = system.multiply(matrix, direction)
        assert (sides[0] - sides[1]) / (2 * h) == pytest.approx(
            product, rel=1e-6, abs=1e-6 * abs(product).max()
        )
        values = dense(matrix)
        assert abs(values - values.T).max() < 1e-11 * abs(values).max()


def test_residual_is_the_potentials_gradient(short, partially_filled):
    # Where the front stays on the surface (no vertical displacement of x = 1) the potential holds no more.
    system, state = short.model.system, partially_filled.state
    space = system.unknown.function_space
    shapes = []
    for k in (1, 2):
        shape = fem.Function(space)
        shape.interpolate(lambda x, k=k: np.vstack([np.sin(k * np.pi * x[0] / 2), np.sin(k * np.pi * x[0])]))
        shapes.append(shape.x.array.copy())
    base, direction = state.u + 0.1 * shapes[0], shapes[1]
    h, values = 1e-5, []
    for sign in (1, -1):
        with system.at(State(base + sign * h * direction, state.loads)):
            values.append(system.monitor("Pi"))
    with system.at(State(base, state.loads)):
        slope = 2 * np.pi * system.dot(system.residual(), direction)
        assert abs(slope) > 0.01
        assert (values[0] - values[1]) / (2 * h) == pytest.approx(slope, rel=1e-6)


def typed_form(model, n, u, beta, w):
    """The quadratic form of the second variation, derived by hand, per pi (for n = 0 per 2 pi)."""
    jacobian = model._jacobian()
    at = model.surface()
    r, z = at.x[0], at.x[2]
    r_z, z_z = at.a[0], at.a[2]
    u_z, beta_z, w_z = (f.dx(0) / jacobian for f in (u, beta, w))
    lam1 = r_z**2 + z_z**2
    j0 = lam1 * r**2
    g11, g22 = 2 * (r_z * u_z + z_z * w_z), 2 * r * (u + n * beta)
    g12 = -r_z * (n * u + beta) - z_z * n * w + r * beta_z
    h11 = u_z**2 + w_z**2 + beta_z**2
    h22 = (u + n * beta) ** 2 + (n * u + beta) ** 2 + n**2 * w**2
    j1 = r**2 * g11 + lam1 * g22
    j2 = r**2 * h11 + lam1 * h22 + g11 * g22 - g12**2
    wet, gamma = model._wet(), model.q["gamma"]
    pressure = gamma * wet * (model.loads["zw"][1] - z)
    swelling = z_z * (u**2 + beta**2 + 2 * n * u * beta) - r_z * (u * w + 2 * n * beta * w)
    swelling += r * (u * w_z - w * u_z)
    density = h11 + h22 - j2 / j0**2 + j1**2 / j0**3 - pressure * swelling
    density += gamma * wet * w * (r * z_z * u - r * r_z * w)
    return density * jacobian * model.dx


@pytest.mark.parametrize("n", [1, 2, 5])
@pytest.mark.parametrize("where", ["zw", "bifurcation"])
def test_automatic_second_variation_is_the_one_derived_by_hand(short, n, where):
    piece = short.pieces[1] if where == "zw" else short.pieces[2]
    state = piece.at("V", 20.0 if where == "zw" else 90.0).state
    model = short.model
    with model.system.at(state):
        variation = short.modes.variation(n)
        q = fem.Function(variation.unknown.function_space)
        q.x.array[:] = np.random.default_rng(n).standard_normal(len(q.x.array))
        q.x.array[variation.bc_dofs] = 0.0
        by_hand = fem.assemble_scalar(fem.form(typed_form(model, n, *q)))
        product = variation.multiply(variation.tangent(), q.x.array)
        assert variation.dot(q.x.array, product) == pytest.approx(by_hand, rel=1e-10)


def without_rings(variation):
    """The operator without conditions at the rings."""
    form = ufl.derivative(variation.formulation.residual, variation.unknown, variation.trial)
    matrix = fem_petsc.assemble_matrix(fem.form(form))
    matrix.assemble()
    return dense(matrix)


def test_rigid_displacements_cost_nothing(short, partially_filled):
    model = short.model
    with model.system.at(partially_filled.state):
        waves = short.modes.variation(1)
        sideways = np.tile([1.0, -1.0, 0.0], waves.size // 3)
        inside = np.setdiff1d(np.arange(waves.size), waves.bc_dofs)
        stiffness = without_rings(waves)
        assert abs((stiffness @ sideways)[inside]).max() < 1e-10 * abs(stiffness).max()
        torsion = model.torsion
        turned = 1 + model.unknown.x.array[::2]  # beta = r: a rotation about the axis
        stiffness = without_rings(torsion)
        inside = np.setdiff1d(np.arange(torsion.size), torsion.bc_dofs)
        assert abs((stiffness @ turned)[inside]).max() < 1e-10 * abs(stiffness).max()


# -- eigenvalues -----------------------------------------------------------------------------------


def lowest(variation, count=1):
    variation.tangent()
    free = np.setdiff1d(np.arange(variation.size), variation.bc_dofs)
    k, m = (dense(matrix)[np.ix_(free, free)] for matrix in (variation.matrix, variation.mass))
    return eigh((k + k.T) / 2, m, eigvals_only=True)[:count], k, m, free


@pytest.mark.parametrize("n", [0, 1, 2])
def test_eigenvalues_are_those_of_the_dense_problem(short, partially_filled, n):
    with short.model.system.at(partially_filled.state):
        variation = short.modes.variation(n)
        assert variation.spectrum().eigenvalues[0] == pytest.approx(lowest(variation)[0][0], rel=1e-9)


def test_zero_waves_are_the_axisymmetric_space_and_torsion(short, partially_filled):
    model = short.model
    with model.system.at(partially_filled.state):
        model.wave_number.value = 0
        both = lowest(model.waves, 6)[0]
        apart = np.sort(np.concatenate([lowest(v, 6)[0] for v in (model.axial, model.torsion)]))[:6]
        assert both == pytest.approx(apart, rel=1e-9)


@pytest.mark.parametrize("V", [20.0, 90.0, 125.0])
def test_volume_control_is_a_term_of_rank_one_or_a_constraint(short, V):
    piece = next(p for p in short.pieces[1:] if p.points[-1].monitors["V"] > V)
    solved = piece.at("V", V)
    system, axial = short.model.system, short.model.axial
    with system.at(solved.state):
        _, k, m, free = lowest(axial)
        d = -system.load_derivative("zw")[free] / GAMMA  # per radian
        if solved.state.loads["high"]:
            basis = np.linalg.svd(d[None, :])[2][1:].T
            expected = eigh(basis.T @ k @ basis, basis.T @ m @ basis, eigvals_only=True)[0]
        else:
            area = np.pi * system.monitor("r_front") ** 2
            expected = eigh(k + 2 * np.pi * GAMMA / area * np.outer(d, d), m, eigvals_only=True)[0]
        assert solved.values["LambdaV_n0"] == pytest.approx(expected, rel=1e-8)
        assert expected > 0


# -- the branch ------------------------------------------------------------------------------------


def test_pieces_follow_one_another(short):
    assert [len(p.points) > 1 for p in short.pieces] == [False, True, True, True]
    for before, after in zip(short.pieces, short.pieces[1:], strict=False):
        end, start = before.points[-1], after.points[0]
        assert end.state.loads["zw"] == pytest.approx(start.state.loads["zw"], abs=2e-3)
        assert end.monitors["Pi"] == pytest.approx(start.monitors["Pi"], abs=2e-2)
    volumes = [point.monitors["V"] for piece in short.pieces for point in piece.points]
    assert np.all(np.diff(volumes) > 0)


def test_a_slender_tube_never_fills():
    slender = path(24.0, 2.0)
    assert len(slender.pieces) == 2
    kinds = [(s.kind, s.values.get("n")) for piece in slender.pieces for s in piece.special()]
    assert kinds[:2] == [("limit_point", None), ("bifurcation_point", 1.0)]


def test_level_and_volume_are_work_conjugate(short):
    piece, h = short.pieces[1], 1e-4
    energies = [piece.at("zw", 6.0 + s * h).values["Pi"] for s in (1, -1)]
    assert (energies[0] - energies[1]) / (2 * h) == pytest.approx(
        -GAMMA * piece.at("zw", 6.0).values["V"], rel=1e-7
    )


def test_critical_points_have_a_zero_eigenvalue_of_their_family(short):
    found = [solved for piece in short.pieces for solved in piece.special()]
    assert [s.kind for s in found] == ["limit_point", "bifurcation_point", "bifurcation_point"]
    limit, first, second = found
    assert abs(limit.values["Lambda_n0"]) < 1e-9
    assert abs(first.values["Lambda_n1"]) < 1e-9
    assert abs(second.values["Lambda_n2"]) < 1e-9
    highest = max(p.state.loads["zw"] for p in short.pieces[2].points)
    assert highest == pytest.approx(limit.state.loads["zw"], abs=1e-12)


def test_levels_just_below_the_highest_are_met_twice(short):
    (limit,) = (s for piece in short.pieces for s in piece.special() if s.kind == "limit_point")
    level = limit.state.loads["zw"] - 1e-7
    piece = short.pieces[2]
    assert len(piece.crossings("zw", level)) == 2
    below, past = (piece.at("zw", level, crossing).values["V"] for crossing in (1, 2))
    assert below < limit.values["V"] < past
    assert past - below < 0.1


def test_the_membrane_keeps_its_first_integral(short):
    points = np.linspace(0, 4, 41)
    spreads = []
    for branch in (short, path(cells=24)):
        state = branch.pieces[2].at("V", 100.0).state
        lam1, t1, h = branch.sampled(state, points, ("lam1", "T1", "H"))
        spreads.append(np.ptp(h))
        assert abs(t1[0] - t1[-1]) < 1e-3 * abs(t1[0])
        assert abs(lam1[0] - lam1[-1]) < 1e-3
    assert spreads[1] < spreads[0] / 8 < 1e-3


def test_a_dry_tube_is_no_cylinder():
    result = solve("fluid_tube", L=24, delta=2, at={"zw": 0.0}, numerics=COARSE)
    values = result.states[0].quantities
    assert values["V"].value == 0.0
    assert 2**-0.5 - 5e-3 < values["r_mid"].value < 2**-0.5
    assert values["LambdaV_n0"].value == pytest.approx(values["Lambda_n0"].value)


def test_states_are_found_at_any_column():
    wanted = [("zw", 8.2), ("V", 30.0), ("r_mid", 1.5), ("Lambda_n1", 0.3), ("r_front", 0.9)]
    requests = [*(StateRequest(name, value) for name, value in wanted), StateRequest("zw", 8.2, crossing=2)]
    given = {"L": 8, "delta": 2, "n_max": 1}
    *states, after = solve_requests("fluid_tube", given, COARSE, requests, branch_uncertainty=False).states
    for state, (name, value) in zip(states, wanted, strict=True):
        assert state.quantities[name].value == pytest.approx(value, abs=1e-9)
    assert after.quantities["zw"].value == pytest.approx(8.2, abs=1e-9)
    assert after.quantities["n_negative"].value == 1


def test_states_and_modes_can_be_read_by_others():
    points = np.linspace(0, 4, 81)
    state = PrimaryBranch(MPI.COMM_SELF, 8.0, 2.0, cells=12, degree=4).bifurcation(points)
    assert state.r[[0, -1]] == pytest.approx(1.0, abs=1e-12)
    assert state.z[[0, -1]] == pytest.approx([0.0, 8.0], abs=1e-12)
    assert state.mode[:, [0, -1]] == pytest.approx(0.0, abs=1e-12)
    norm = np.sum(state.mode**2) * (points[1] - points[0])
    assert norm == pytest.approx(1.0, rel=1e-2)
    assert state.mode[0].max() > abs(state.mode[0].min())


@pytest.mark.parametrize(("L", "delta", "gamma"), [(24.0, 1.1, 0.116), (8.0, 7.0, 0.05), (16.0, 1.1, 0.05)])
def test_branches_off_the_paper_converge(L, delta, gamma):
    branch = path(L, delta, gamma=gamma)
    assert all(piece.stalled is None for piece in branch.pieces)
    kinds = {solved.kind for piece in branch.pieces for solved in piece.special()}
    assert "limit_point" in kinds


# -- bad input -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"delta": 1.0}, "delta = 1.0: input should be greater than 1"),
        ({"gamma": 0.0}, "gamma = 0.0: input should be greater than 0"),
        ({"n_max": 9}, "n_max = 9: input should be less than or equal to 6"),
        ({"at": {"zw": -1.0}}, "zw = -1 is below the tube"),
        (
            {"delta": 9.0, "secondary": True},
            "delta = 9 is too large for secondary = true; allowed: .* up to 8",
        ),
        (
            {"model": "varga", "secondary": True},
            "the force of model = 'varga' is bounded, .*; allowed with this law: secondary = false",
        ),
        ({"at": {"Lambda_n5": 0.1}}, "n up to n_max = 3"),
        ({"at": {"zw": 7.3}, "branch": "secondary"}, "secondary = true"),
    ],
)
def test_bad_input_is_refused_before_anything_is_solved(given, message):
    with pytest.raises(InputError, match=message.replace("+", r"\+")):
        solve("fluid_tube", **given)


def test_a_level_above_the_highest_is_refused_with_the_range():
    with pytest.raises(InputError, match=r"zw = 8.5 is not taken .* ranges over \[0, 8.37"):
        solve("fluid_tube", n_max=1, at={"zw": 8.5}, numerics={"cells": 16, "levels": 2})
