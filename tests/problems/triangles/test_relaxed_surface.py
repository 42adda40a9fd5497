"""The relaxed membrane on triangles: loads of gas and liquid, equilibria and their eigenvalues."""

import numpy as np
import pytest
from mpi4py import MPI
from scipy.linalg import eigh

from weakforms.problems.triangles.branch import SurfaceRun
from weakforms.problems.triangles.meshes import tube
from weakforms.problems.triangles.model import Body, SurfaceModel
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.stability.lowest import Lowest

pytestmark = pytest.mark.paper5


# -- loads ---------------------------------------------------------------------------------------


def body(**given):
    return Body(tube(8.0, 6, 8), **{"M": 1.5, "delta": 3.0, "Af": 0.4362, "c2": 0.01, "gamma": 0.3} | given)


@pytest.fixture(scope="module")
def model():
    return SurfaceModel(MPI.COMM_SELF, body())


def test_volume_of_the_polyhedron(model):
    with model.system.at(State(model.owned_of(model.body.triangles.points), {"p": 0.0, "zw": 0.0})):
        octagon = 8 * np.sin(np.pi / 8) * np.cos(np.pi / 8)
        assert model.system.monitor("V") == pytest.approx(8 * octagon, rel=1e-13)


@pytest.mark.parametrize("given", [{}, {"rule": 2}, {"rule": 3}, {"rule": 4}])
@pytest.mark.parametrize("loads", [{"p": 0.4, "zw": 0.0}, {"p": 0.0, "zw": 11.3}])
def test_the_load_has_this_derivative(given, loads):
    """Tangent and force of gas and of a liquid whose level cuts triangles agree with differences."""
    model = SurfaceModel(MPI.COMM_SELF, body(**given))
    system, rng = model.system, np.random.default_rng(7)
    u = system.initial.u + 0.02 * rng.normal(size=system.size)
    u[system.bc_dofs] = system.initial.u[system.bc_dofs]
    v = rng.normal(size=system.size)
    v[system.bc_dofs] = 0
    forces = []
    for e in (-1e-6, 1e-6):
        with system.at(State(u + e * v, loads)):
            forces.append(system.residual())
    with system.at(State(u, loads)):
        tangent = system.tangent()[:, :]
        assert np.abs(tangent - tangent.T).max() < 1e-11
        assert (forces[1] - forces[0]) / 2e-6 == pytest.approx(tangent @ v, abs=2e-6)


def test_gas_presses_along_the_normal():
    """The virtual work of a gas is the difference of the volume, exactly for a polyhedron."""
    model = SurfaceModel(MPI.COMM_SELF, body(gamma=0.0))
    system, rng = model.system, np.random.default_rng(9)
    u, v = system.initial.u, rng.normal(size=system.size)
    v[system.bc_dofs] = 0
    work, volume = [], []
    for p in (0.0, 1.0):
        with system.at(State(u, {"p": p, "zw": 0.0})):
            work.append(system.residual() @ v)
    for e in (-1e-5, 1e-5):
        with system.at(State(u + e * v, system.initial.loads)):
            volume.append(system.monitor("V"))
    assert work[1] - work[0] == pytest.approx(-(volume[1] - volume[0]) / 2e-5, rel=1e-8)


def test_liquid_presses_below_its_level_only(model):
    system, level = model.system, 10.0
    forces = []
    for zw in (0.0, level):
        with system.at(State(system.initial.u, {"p": 0.0, "zw": zw})):
            forces.append(model.nodal(system.residual()))
    size = np.linalg.norm(forces[1] - forces[0], axis=1)
    z, held = model.nodal(system.initial.u)[:, 2], model.body.triangles.held
    ring = 1.1 * np.ptp(z) / 6  # a node feels the triangles around it
    assert np.all(size[z > level + ring] == 0)
    assert np.all(size[(z < level - ring) & ~held] > 1e-3)


def test_thickness_is_linear_between_the_ends():
    ends = np.array([[1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [0.0, 4.0, 8.0]])
    assert body(M=1.5).thickness(ends) == pytest.approx([1.5, 1.0, 0.5])


# -- equilibria ----------------------------------------------------------------------------------


def test_wrinkled_cylinder_of_uniform_thickness_is_exact(model):
    """Without load ``r = Af`` and ``z = delta S`` on any mesh: the patch test of the wrinkled tube."""
    even = SurfaceModel(MPI.COMM_SELF, body(M=1.0))
    x = even.body.triangles.points * [0.4362, 0.4362, 3.0]
    with even.system.at(State(even.owned_of(x), {"p": 0.0, "zw": 0.0})):
        assert np.abs(even.system.residual()).max() < 1e-12


@pytest.mark.parametrize(
    ("width", "length", "expected"), [(1.1, 1.0, {1.0}), (0.6, 1.3, {0.0, 1.0}), (0.5, 0.6, {-1.0})]
)
def test_stretches_and_states_of_triangles_are_those_of_their_corners(model, width, length, expected):
    """From the edges of each triangle by linear algebra, at a tube that was narrowed or widened unevenly."""
    given = model.body.triangles
    x = given.points * np.array([width, width, length]) * (1 + 0.3 * given.points[:, 2:] / 8)
    with model.system.at(State(model.owned_of(x), {"p": 0.0, "zw": 0.0})):
        found = model.by_triangle()
    squares = []
    for nodes in given.triangles:
        before, after = (np.diff(points[nodes], axis=0) for points in (given.points, x))
        squares.append(np.linalg.eigvals(np.linalg.solve(before @ before.T, after @ after.T)).real)
    small, large = np.sqrt(np.sort(squares, axis=1)).T
    assert found["lam1"] == pytest.approx(large, abs=1e-9)
    assert found["lam2"] == pytest.approx(small, abs=1e-9)
    states = np.where(small * np.sqrt(large) > 1, 1.0, np.where(large > 1, 0.0, -1.0))
    assert found["state"].tolist() == states.tolist()
    assert set(states) == expected


@pytest.fixture(scope="module")
def unstable():
    """A tube with 48 columns of triangles that becomes unstable at a level inside the range."""
    given = {"M": 1.5, "delta": 3.0, "Af": 0.4362, "c2": 0.01, "gamma": 0.0464709}
    runs = [
        SurfaceRun(
            SurfaceModel(MPI.COMM_SELF, Body(tube(8.0, 12, 48, m), **given)), "zw", {"p": 0.0, "zw": 0.5}
        )
        for m in (False, True)
    ]
    for run in runs:
        for level in (0.5, 3.0, 5.0, 6.0):
            run.at(level)
    return runs


def test_ring_periodic_equilibrium_is_one_of_the_whole(unstable):
    for run in unstable:
        point = run.at(6.0)
        assert point.residual < 1e-10
        assert point.departure == 0.0
        radius = np.hypot(*run.model.nodal(point.state.u)[:, :2].T).reshape(13, 48)
        assert np.ptp(radius, axis=1).max() < 1e-12


def test_the_other_diagonal_is_the_mirror_image(unstable):
    first, second = (run.columns(run.at(6.0), 3) for run in unstable)
    for name in ("V", "Pi", "r_max", "n_negative", "Lambda_1", "Lambda_2", "Lambda_3"):
        assert second[name] == pytest.approx(first[name], rel=1e-9)


def test_inertia_counts_what_waves_count(unstable):
    """The whole tangent has as many negative eigenvalues as its blocks by wave number together."""
    run = unstable[0]
    point = run.at(6.0)
    assert point.n_negative > 0
    given, around = run.model.body.triangles, 48
    order = np.argsort(run.model.node)
    with run.system.at(point.state):
        tangent = run.system.tangent()[:, :]
    tangent = tangent.reshape(len(order), 3, -1, 3)[order][:, :, order]
    c, s = np.cos(given.angle), np.sin(given.angle)
    zero, one = np.zeros_like(c), np.ones_like(c)
    frame = np.array([[c, -s, zero], [s, c, zero], [zero, zero, one]]).transpose(2, 0, 1)
    local = np.einsum("iab,iajc,jcd->ibjd", frame, tangent, frame)
    free = slice(1, 12)
    rings = local.reshape(13, around, 3, 13, around, 3)[free, :, :, free]
    # Of (ring, column, component, ring', column', component') the first column; the others follow by turning.
    first = rings[:, 0].transpose(0, 1, 2, 4, 3).reshape(33, 33, around)
    count = {}
    for n in range(around):
        block = first @ np.exp(2j * np.pi * n * np.arange(around) / around)
        assert np.abs(block - block.conj().T).max() < 1e-10
        count[n] = int(np.sum(np.linalg.eigvalsh(block) < 0))
    assert sum(count.values()) == point.n_negative
    waves = run.waves(run.lowest_mode(point).vector)
    assert count[waves] > 0
    assert abs(waves - around / 4) <= 3


def test_lowest_eigenvalues_with_all_their_copies(unstable):
    """Comparison with a dense solver: a Krylov method may find only one of two equal eigenvalues."""
    run = unstable[0]
    point = run.at(6.0)
    with run.system.at(point.state):
        free = np.setdiff1d(np.arange(run.system.size), run.system.bc_dofs)
        dense = [m[:, :][np.ix_(free, free)] for m in (run.system.tangent(), run.system.mass)]
        expected = eigh(*dense, eigvals_only=True, subset_by_index=[0, 5])
        found = [mode.eigenvalue for mode in Lowest(run.system)(point.state, 6)]
        assert found == pytest.approx(expected, rel=1e-9)
        assert found[0] == pytest.approx(found[1], rel=1e-9)
