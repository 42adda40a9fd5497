"""The relaxed membrane on a flat patch of triangles: energy, stress and tangent of each state."""

import basix.ufl
import numpy as np
import pytest
import ufl
from dolfinx import fem
from mpi4py import MPI

from weakforms.forms.relaxed_surface import Patch, full_energy, relaxed_energy, state
from weakforms.problems.triangles.meshes import Triangulation
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.equilibrium.system import System

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
