"""The relaxed membrane on flat triangles: energy, stress and tangent of each state, loads, equilibria."""

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI
from scipy.linalg import eigh

from weakforms import solve
from weakforms.forms.relaxed_surface import Patch, full_energy, relaxed_energy, state
from weakforms.problems.triangles.branch import SurfaceRun
from weakforms.problems.triangles.meshes import Triangulation, hemisphere, hemisphere_in_columns, tube
from weakforms.problems.triangles.model import Body, SurfaceModel
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.lowest import Lowest

pytestmark = pytest.mark.paper5

C2 = 0.1
STRETCHES = {
    "taut": (1.6, 1.2, 1),
    "taut, one below 1": (2.0, 0.8, 1),
    "equal": (1.3, 1.3, 1),
    "nearly equal": (1.3, 1.3 + 1e-9, 1),
    "wrinkled along 1": (1.7, 0.5, 0),
    "wrinkled along 2": (0.5, 1.7, 0),
    "slack": (0.8, 0.9, -1),
    "slack, equal": (0.7, 0.7, -1),
}


def energy_by_stretches(a, b):
    """An independent copy of the table of states."""

    def full(x, y):
        return x**2 + y**2 + 1 / (x * y) ** 2 - 3 + C2 * (1 / x**2 + 1 / y**2 + (x * y) ** 2 - 3)

    a, b = max(a, b), min(a, b)
    if b > a**-0.5:
        return full(a, b)
    return full(a, a**-0.5) if a > 1 else 0.0


def rotation(seed):
    return np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]


def sheet():
    """Nine different triangles around one another in a tilted plane."""
    rng = np.random.default_rng(3)
    flat = np.array([(i, j) for j in range(4) for i in range(4)], float)
    inner = (flat > 0).all(axis=1) & (flat < 3).all(axis=1)
    flat[inner] += 0.3 * rng.uniform(-1, 1, (inner.sum(), 2))
    cells = [t for j in range(3) for i in range(3) for t in ((0, 1, 5), (0, 5, 4))]
    cells = np.array(
        [
            [n + 4 * j + i for n in t]
            for (j, i), t in zip(
                [(j, i) for j in range(3) for i in range(3) for _ in range(2)], cells, strict=True
            )
        ]
    )
    return flat, cells, inner


class Sheet:
    """Energy of a flat patch with nodes at any places."""

    def __init__(self, energy=relaxed_energy):
        self.flat, cells, self.inner = sheet()
        self.frame = rotation(1)[:, :2]
        given = Triangulation(self.flat @ self.frame.T, cells)
        mesh = given.mesh(MPI.COMM_SELF)
        space = fem.functionspace(mesh, basix.ufl.element("Lagrange", "triangle", 1, shape=(3,)))
        self.x = fem.Function(space)
        self.node = np.zeros(len(self.flat), dtype=int)
        self.node[space.dofmap.list] = mesh.geometry.input_global_indices[mesh.geometry.dofmap]
        c = Patch.of(self.x, mesh).cauchy_green()
        form = energy(c, C2) * ufl.dx(mesh, metadata={"quadrature_degree": 0})
        test, trial = ufl.TestFunction(space), ufl.TrialFunction(space)
        self.system = System(
            Formulation(
                self.x,
                ufl.derivative(form, self.x, test),
                {},
                [],
                ufl.inner(test, trial) * ufl.dx,
                {"W": form},
            )
        )
        self.state = fem.form(state(c) * ufl.dx(mesh))

    def at(self, positions):
        """The model lent to a state with its nodes at given positions."""
        return self.system.at(State(positions[self.node].ravel(), {}))

    def stretched(self, a, b):
        """Homogeneous principal stretches in directions oblique to the mesh, rotated in space."""
        turn = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
        gradient = rotation(2)[:, :2] @ turn @ np.diag([a, b]) @ turn.T
        return self.flat @ gradient.T


@pytest.fixture(scope="module")
def patch():
    return Sheet()


def slopes(function, u, steps=1e-6):
    out = []
    for i in range(len(u)):
        e = np.zeros(len(u))
        e[i] = steps
        out.append((function(u + e) - function(u - e)) / (2 * steps))
    return np.array(out)


@pytest.mark.parametrize("name", STRETCHES)
def test_patch_of_each_state(patch, name):
    """The energy follows the table of states; a patch stretched uniformly has no force inside."""
    a, b, expected = STRETCHES[name]
    with patch.at(patch.stretched(a, b)):
        assert patch.system.monitor("W") == pytest.approx(9 * energy_by_stretches(a, b), rel=1e-12, abs=1e-12)
        assert fem.assemble_scalar(patch.state) == pytest.approx(9 * expected, rel=1e-12)
        force = patch.system.residual().reshape(-1, 3)
    inner = patch.inner[patch.node]
    assert np.isfinite(force).all()
    assert np.abs(force[inner]).max() < 1e-12
    if expected >= 0:
        assert np.abs(force[~inner]).max() > 0.01


@pytest.mark.parametrize("name", STRETCHES)
def test_force_and_tangent_by_differences(patch, name):
    a, b, _ = STRETCHES[name]
    start = patch.stretched(a, b) + 1e-3 * np.random.default_rng(5).normal(size=(16, 3))
    u = start[patch.node].ravel()

    def energy(v):
        with patch.system.at(State(v, {})):
            return patch.system.monitor("W")

    def force(v):
        with patch.system.at(State(v, {})):
            return patch.system.residual()

    assert slopes(energy, u) == pytest.approx(force(u), abs=1e-8)
    with patch.system.at(State(u, {})):
        tangent = patch.system.tangent()[:, :]
    assert np.isfinite(tangent).all()
    assert np.abs(tangent - tangent.T).max() < 1e-12
    assert slopes(force, u) == pytest.approx(tangent, abs=3e-7)


def test_the_energy_is_smooth_where_the_state_changes(patch):
    """Energy and stress are continuous at each boundary, the second derivative is not: the form is C1."""
    for a, b, along in (
        (1.5, 1.5**-0.5, (0, 1)),
        (1.5**-0.5, 1.5, (1, 0)),
        (1.0, 0.8, (1, 0)),
        (0.8, 1, (0, 1)),
    ):
        values, h = [], 1e-4
        for k in (-2, -1, 0, 1, 2):
            with patch.at(patch.stretched(a + k * h * along[0], b + k * h * along[1])):
                values.append(patch.system.monitor("W"))
        left, right = values[2] - values[1], values[3] - values[2]
        second = [(values[i - 1] - 2 * values[i] + values[i + 1]) / h**2 for i in (1, 3)]
        assert abs(right - left) / h < 0.02
        assert abs(second[1] - second[0]) > 1.0


def test_without_relaxation_compression_is_borne():
    full = Sheet(full_energy)
    with full.at(full.stretched(1.7, 0.5)):
        assert full.system.monitor("W") > 9 * energy_by_stretches(1.7, 0.5) + 1


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


# -- meshes --------------------------------------------------------------------------------------


@pytest.mark.parametrize("mirrored", [False, True])
def test_tube_of_triangles(mirrored):
    given = tube(8.0, 5, 7, mirrored)
    assert given.points.shape == (42, 3)
    assert given.triangles.shape == (70, 3)
    assert given.radius == pytest.approx(1.0)
    assert given.held.sum() == 14
    assert outward(given).min() > 0


def test_hemisphere_of_triangles():
    given = hemisphere(0.3)
    assert np.linalg.norm(given.points, axis=1) == pytest.approx(1.0)
    assert given.radius.min() < 1e-12
    assert given.points[given.held][:, 2] == pytest.approx(0.0, abs=1e-12)
    assert outward(given).min() > 0


def test_hemisphere_in_columns():
    """Every row is a ring, and a rotation by one column maps the mesh onto itself."""
    given = hemisphere_in_columns(5, 12)
    assert given.triangles.shape == (12 + 2 * 4 * 12, 3)
    assert np.linalg.norm(given.points, axis=1) == pytest.approx(1.0)
    assert given.radius[0] == 0
    assert given.points[given.held][:, 2] == pytest.approx(0.0, abs=1e-12)
    assert given.held.sum() == 12
    assert outward(given).min() > 0
    column = np.concatenate([[0], *(1 + 12 * i + (np.arange(12) + 1) % 12 for i in range(5))])
    turned = {tuple(sorted(column[t])) for t in given.triangles}
    assert turned == {tuple(sorted(t)) for t in given.triangles}
    assert len(turned) == len(given.triangles)
    angle = np.angle(np.exp(1j * (given.angle[column[1:]] - given.angle[1:])))
    assert angle == pytest.approx(2 * np.pi / 12)


def test_a_hemisphere_in_columns_has_the_state_of_an_unstructured_one():
    given = {"geometry": "hemisphere", "load_start": -0.6, "load_end": -0.65}
    quick = {"scan": 1, "shown": 1, "eigenvalues": 1}
    columns = solve("surface", **given, layout="columns", meridional=16, circumferential=48, numerics=quick)
    free = solve("surface", **given, size=0.1, numerics=quick)
    for name, apart in (("V", 5e-3), ("Lambda_1", 2e-2)):
        one, other = (result.branch()[name] for result in (columns, free))
        assert one == pytest.approx(other, rel=apart), name
    assert columns.quantities["triangles"].value == 48 + 2 * 15 * 48


def outward(given):
    """Normal of each triangle times the vector from the axis' middle, divided by its length."""
    corners = given.points[given.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    away = corners.mean(axis=1) * [1, 1, 0 if given.rings else 1]
    return np.einsum("ij,ij->i", normal, away) / np.linalg.norm(normal, axis=1)
