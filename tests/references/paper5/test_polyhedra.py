"""The polyhedral cylinder of paper 5: the reduced matrices agree with the whole mesh, coded again."""

from dataclasses import replace

import numpy as np
import pytest

from reference_data.solvers.core.tables import Array
from reference_data.solvers.paper5 import bloch as blo
from reference_data.solvers.paper5 import bloch_metric as met
from reference_data.solvers.paper5.waves.cylinder import FLUID

pytestmark = pytest.mark.paper5
STEP = 1e-30
LEVEL = 6.6  # wrinkled below, taut above


MESHES = [
    blo.Polyhedron(FLUID, 8, 6),
    blo.Polyhedron(FLUID, 8, 7, rule="inside", flipped=True),
    blo.Polyhedron(FLUID, 8, 6, potential="volume", rule="edges"),
    blo.Polyhedron(FLUID, 6, 8, rule="centroid", arc=True),
]


def whole(mesh: blo.Polyhedron, nodes: Array) -> tuple[Array, Array, Array, Array]:
    """Positions (N_S + 1, N_C, 3), corners of all triangles, their inverse edges and volumes."""
    turns = [np.linalg.matrix_power(mesh.turn, k) for k in range(mesh.sectors)]
    x = np.stack([nodes @ t.T for t in turns], axis=1)
    ring, sector = mesh.corners
    inverse, area, thick = mesh.reference
    corners = np.concatenate([ring * mesh.sectors + (sector + k) % mesh.sectors for k in range(mesh.sectors)])
    repeat = lambda a: np.concatenate([a] * mesh.sectors)  # noqa: E731
    return x.reshape(-1, 3), corners, repeat(inverse), repeat(area * thick)


def gradient(mesh: blo.Polyhedron, x: Array, corners: Array, inverse: Array, volume: Array) -> Array:
    """Gradient of the total energy over all nodes, from the invariants of C; x may be complex."""
    at = x[corners]
    f = np.stack([at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]], axis=-1) @ inverse
    c = np.einsum("tia,tib->tab", f, f)
    t, d = c[:, 0, 0] + c[:, 1, 1], c[:, 0, 0] * c[:, 1, 1] - c[:, 0, 1] ** 2
    x1 = t / 2 + np.sqrt(t * t / 4 - d)
    a = FLUID.c2
    tense = np.real(d * (t - x1)) > 1
    ft, fd = 1 + a / d, -1 / d**2 + a * (1 - t / d**2)
    slope = 1 - x1**-1.5 + a * (x1**-0.5 - x1**-2)
    by_t = np.where(tense, ft, slope * x1 / (2 * x1 - t))  # d x1/d t and d x1/d d of the larger root
    by_d = np.where(tense, fd, -slope / (2 * x1 - t))
    adjugate = np.stack([c[:, 1, 1], -c[:, 0, 1], -c[:, 0, 1], c[:, 0, 0]], axis=-1).reshape(-1, 2, 2)
    stress = 2 * f @ (by_t[:, None, None] * np.eye(2) + by_d[:, None, None] * adjugate)
    shape = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
    local = np.einsum("t,tia,tna->tni", volume, stress, shape @ inverse)
    local = local + mesh.load_gradient(at, LEVEL)
    out = np.zeros_like(x)
    np.add.at(out, corners, local)
    return out


@pytest.mark.parametrize("mesh", MESHES)
def test_reduced_matrices_hold_the_spectrum_of_the_whole_mesh(mesh):
    found = blo.newton(mesh, blo.from_profile(mesh, LEVEL), LEVEL)
    x, *rest = whole(mesh, found.nodes)
    inner = np.arange(mesh.sectors, mesh.sectors * mesh.rings)
    assert np.abs(gradient(mesh, x, *rest)[inner]).max() < 1e-11
    columns = []
    for node in inner:
        for c in range(3):
            bumped = x.astype(complex)
            bumped[node, c] += 1j * STEP
            columns.append(np.imag(gradient(mesh, bumped, *rest))[inner].ravel() / STEP)
    full = np.array(columns)
    assert np.abs(full - full.T).max() < 1e-10 * np.abs(full).max()
    reduced = [np.linalg.eigvalsh(found.dense(n)) for n in range(mesh.sectors)]
    assert np.sort(np.concatenate(reduced)) == pytest.approx(np.linalg.eigvalsh(full), abs=1e-9)


def load_energy(mesh: blo.Polyhedron, x: Array) -> complex:
    """Energy of the liquid on a sector's triangles."""
    points = blo.RULES[mesh.rule]
    at = np.einsum("qn,tnc->tqc", points, x)
    depth = np.where(np.real(at[..., 2]) < LEVEL, LEVEL - at[..., 2], 0)
    normal = -np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]) / 2
    if mesh.potential == "area":
        return np.sum(FLUID.gamma * depth**2 / 2 * normal[:, None, 2]) / len(points)
    flux = np.einsum("tqc,tc->tq", at[..., :2], normal[:, :2])
    return -np.sum(FLUID.gamma * depth * flux / 2) / len(points)


@pytest.mark.parametrize("mesh", MESHES)
def test_load_gradient(mesh):
    x = mesh.points(blo.from_profile(mesh, LEVEL))
    exact = mesh.load_gradient(x, LEVEL)
    for t, k, c in ((0, 0, 0), (1, 2, 1), (3, 1, 2), (8, 0, 2)):
        bumped = x.astype(complex)
        bumped[t, k, c] += 1j * STEP
        assert exact[t, k, c] == pytest.approx(
            np.imag(load_energy(mesh, bumped)) / STEP, rel=1e-11, abs=1e-13
        )


@pytest.mark.parametrize(
    ("rings", "sectors", "lower", "upper"),
    [(120, 48, 5.14, 6.81), (80, 96, 4.03, 9.81)],
)
def test_printed_ranges(rings, sectors, lower, upper):
    """Unstable just inside and stable just outside the printed ends (each rounded to a hundredth)."""
    mesh = blo.Polyhedron(FLUID, rings, sectors)
    for inside, outside in ((lower + 0.006, lower - 0.006), (upper - 0.006, upper + 0.006)):
        for level, unstable in ((inside, True), (outside, False)):
            found = blo.newton(mesh, blo.from_profile(mesh, level), level)
            assert bool(found.unstable()) == unstable


def test_critical_wave_number_is_a_quarter_of_the_sectors():
    mesh = blo.Polyhedron(FLUID, 60, 48)
    found = blo.newton(mesh, blo.from_profile(mesh, 5.2), 5.2).unstable()
    assert found
    assert all(abs(n - 48 / 4) < 5 for n in found)
    other = blo.newton(replace(mesh, flipped=True), blo.from_profile(mesh, 5.2), 5.2).unstable()
    assert other == found


OTHERS = [
    *MESHES,
    blo.Polyhedron(FLUID, 8, 6, rule="nodes"),
    blo.Polyhedron(FLUID, 8, 6, rule="nodes", potential="volume"),
]


def bent_rings(mesh: blo.Polyhedron) -> Array:
    """Rings' nodes off equilibrium, turned and shifted, wrinkled and taut, wet and dry."""
    rng = np.random.default_rng(2)
    nodes = blo.from_profile(mesh, LEVEL)
    return nodes + 0.03 * rng.standard_normal(nodes.shape)


@pytest.mark.parametrize("mesh", OTHERS)
def test_both_codes_have_the_same_energy(mesh):
    """Elastic part and load apart, gradient and second derivative, at positions that are no equilibrium."""
    sector, nodes = met.Sector(mesh), bent_rings(mesh)
    # by corners, in an order of triangles of each code's own: sums over rings compare
    x, y = mesh.points(nodes), sector.corners(nodes)
    elastic, hessian = mesh.elastic(x)
    own, bend = sector.elastic(y)
    liquid = mesh.load_gradient(x, LEVEL)
    other, _ = sector.load(y, LEVEL)
    for first, second in (
        (elastic.reshape(-1, 3, 3), np.einsum("an,tai->tni", met.EDGES, own)),
        (liquid, other),
    ):
        assert np.abs(second).max() > 0.01
        assert ringwise(mesh.corners[0], first) == pytest.approx(ringwise(sector.ring, second), abs=1e-12)
    traces = np.einsum("tkk->t", hessian), np.einsum("an,taibi,bn->t", met.EDGES, bend, met.EDGES)
    assert np.sort(traces[0]) == pytest.approx(np.sort(traces[1]), rel=1e-12)
    gradient, local = mesh.local(nodes, LEVEL)
    force, bands = sector.assembled(nodes, LEVEL)
    assert force == pytest.approx(mesh.residual(gradient), abs=1e-12)
    assert bands == pytest.approx(mesh.bands(local), abs=1e-11)


def ringwise(ring: Array, values: Array) -> Array:
    """Lengths of the sums of (triangles, corners, 3) over the corners on each ring and triangles there."""
    out = np.zeros((ring.max() + 1, 1))
    np.add.at(out, ring, np.sum(values**2, axis=-1, keepdims=True))
    return out


def test_both_codes_find_the_same_end():
    mesh = blo.Polyhedron(FLUID, 60, 48)
    start = blo.from_profile(mesh, 5.14)
    found, n = met.change(met.Sector(mesh), start, 5.142, 5.144, 1e-9)
    assert found == pytest.approx(5.14293044537, abs=2e-9)
    assert n == 11
    for level, unstable in ((found - 2e-9, []), (found + 2e-9, [n])):
        assert blo.newton(mesh, start, level).unstable() == unstable


def test_no_change_is_found_where_there_is_none():
    mesh = blo.Polyhedron(FLUID, 60, 48)
    start = blo.from_profile(mesh, 5.14)
    for ends in ((5.130, 5.140), (5.144, 5.142)):
        with pytest.raises(RuntimeError, match="no change of stability"):
            met.change(met.Sector(mesh), start, *ends, 1e-9)


def test_a_slack_triangle_stores_no_energy():
    """Squared stretches 0.9 and 0.8: the relaxed energy is zero there with all its derivatives."""
    t, d = np.array([1.7]), np.array([0.72])
    assert np.concatenate(met.invariants(t, d, FLUID.c2)) == pytest.approx(np.zeros(5), abs=0)
