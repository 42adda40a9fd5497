"""Formulas that both sides use, tested by a third, independent method (docs/common-formulas.md).

Each formula is compared with sums over flat triangles, springs and cones, or with differences of the function
whose derivative it is.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper1 import cases as disk_cases
from reference_data.solvers.paper1 import peeling as peel
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.collocation.equations import evaluate
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper2.substrate import Substrate
from reference_data.solvers.paper3 import modes, path
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper5.waves import bending as relaxed_bending
from reference_data.solvers.paper5.waves import koiter as relaxed_koiter
from weakforms.forms.loads import bed_potential, substrate_potential
from weakforms.forms.revolution import hoop_bending

TUBE = FluidTube(8, 2)
HOW = path.RESOLUTIONS[0]
VOLUME = 30.0  # partially filled


# -- energy release rate ------------------------------------------------------------------------------------


def cones(case, p, x, parts=4000):
    """Potential per 2 pi of a disk with a locked patch [0, x]: flat cones, columns of gas, and springs."""
    patch, batch = peel.states_b(case, p, np.array([x]), 1)
    history, disk = disk_cases.inflation_b(case, 1).history, case.disk
    inner, outer = x * np.linspace(0, 1, parts + 1), x + (disk.length - x) * np.linspace(0, 1, parts + 1)
    free = evaluate(batch, 0, 0, outer)
    fall = inner**2 * history.depth(inner)
    sheets = (
        (inner, inner * history.radius(inner), free[0, 1] + fall[-1] - fall, disk.k),
        (outer, free[:, 0], free[:, 1], 0.0),
    )
    total = 0.0
    for at, rho, eta, k in sheets:
        middle, radius, height = ((v[1:] + v[:-1]) / 2 for v in (at, rho, eta))
        width, step = np.diff(at), np.diff(rho)
        w = mat.energy(np.hypot(step, np.diff(eta)) / width, radius / middle, disk.alpha)
        column = -p * height + k / 2 * (height - disk.l) ** 2
        total += np.sum(w * middle * width) + np.sum(column * radius * step)
    return total, float(patch.rho[0] * np.hypot(patch.slope[0], patch.dip[0])), float(patch.rho[0])


def test_energy_release_is_what_a_sum_over_cones_loses():
    """Compare with a sum over single rings and a difference between two fronts, not with a closed form."""
    case = Case(Disk(0.05, 1.3, 70.0, 0.4), 0.42, 3.4)
    x, p, h = 0.2, 1.4, 0.002
    _, per, rho = cones(case, p, x)
    total = {k: cones(case, p, x + k * h)[0] for k in (-2, -1, 1, 2)}
    found = (8 * (total[1] - total[-1]) - (total[2] - total[-2])) / (12 * h) / per
    assert peel.rates_b(case, p, 1)(np.array([rho]))[0] == pytest.approx(found, rel=2e-7)


# -- the liquid's potential without a term at the free surface, and mass per reference area -----------------


def clipped(corners, level):
    """The parts of triangles (t, 3, 3) below a height, again as triangles."""
    order = np.argsort(corners[..., 2], axis=1)
    even = np.linalg.det(np.eye(3)[order]) > 0
    low, middle, high = (np.take_along_axis(corners, order[:, [i], None], 1)[:, 0] for i in range(3))
    kept = [np.stack([low, middle, high], 1)[high[:, 2] <= level]]
    turned = [even[high[:, 2] <= level]]

    def cut(a, b, rows):
        t = (level - a[rows, 2]) / (b[rows, 2] - a[rows, 2])
        return a[rows] + t[:, None] * (b[rows] - a[rows])

    one = (low[:, 2] < level) & (middle[:, 2] > level)
    kept.append(np.stack([low[one], cut(low, middle, one), cut(low, high, one)], 1))
    two = (middle[:, 2] <= level) & (high[:, 2] > level)
    kept.append(np.stack([low[two], middle[two], cut(middle, high, two)], 1))
    kept.append(np.stack([low[two], cut(middle, high, two), cut(low, high, two)], 1))
    turned += [even[one], even[two], even[two]]
    return np.concatenate(kept), np.where(np.concatenate(turned), 1, -1)


def total_potential(corners, reference, zw, gamma):
    """Strain energy of flat triangles minus the work of the liquid, by columns up to the level.

    A column of height h contributes int P dV = gamma h^2/2 per unit of its cross-section; the sign depends on
    whether the triangle faces up or down.
    """
    edges = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], -1)
    c = np.swapaxes(edges @ np.linalg.inv(reference), 1, 2) @ (edges @ np.linalg.inv(reference))
    area = np.linalg.det(reference) / 2
    strain = np.sum(area * (np.trace(c, axis1=1, axis2=2) + 1 / np.linalg.det(c) - 3) / 2)
    wet, sign = clipped(corners, zw)
    flat = np.cross(wet[:, 1] - wet[:, 0], wet[:, 2] - wet[:, 0])[:, 2] / 2 * sign
    depth = zw - wet[..., 2]
    mean = (np.sum(depth**2, 1) + np.sum(depth, 1) ** 2) / 12  # of the square over a triangle
    return strain - gamma * np.sum(flat * mean) / 2  # the corners turn inwards


@pytest.fixture(scope="module")
def shape():
    line = path.Path(TUBE, HOW)
    return path.galerkin(line.reach(VOLUME, 2.0), HOW)


def rayleigh(shape, family, cells, line_term=0.0):
    """Second difference of the triangulated body's potential along a mode over twice its kinetic energy."""
    value, nodal, _ = modes.galerkin_mode(shape, family)
    s, theta = np.linspace(0, TUBE.length, cells + 1), 2 * np.pi * np.arange(cells + 1) / cells
    base = shape.evaluate(s)[0]
    field = np.zeros((len(shape.x), 3))
    field[1:-1, list(family.fields)] = nodal
    u, beta, w = type(shape)(TUBE, shape.elements, field, shape.zw, shape.front).evaluate(s)[0].T
    wave, turn = np.cos(family.n * theta), np.sin(family.n * theta)
    r = base[:, [0]] + 0 * theta
    out, around = np.stack([np.cos(theta), np.sin(theta)], 0), np.stack([-np.sin(theta), np.cos(theta)], 0)

    def at(e):
        radial, tangential = r + e * np.outer(u, wave), e * np.outer(beta, turn)
        x, y = radial * out[0] + tangential * around[0], radial * out[1] + tangential * around[1]
        net = np.stack([x, y, base[:, [1]] + e * np.outer(w, wave)], -1)
        p, q, a, b = net[:-1, :-1], net[1:, :-1], net[1:, 1:], net[:-1, 1:]
        # both diagonals, half each: no direction is preferred
        corners = [np.stack(t, -2).reshape(-1, 3, 3) for t in ((p, q, a), (p, a, b), (p, q, b), (q, a, b))]
        return np.concatenate(corners)

    h, t = TUBE.length / cells, 2 * np.pi / cells
    flat = np.array([[[h, h], [0, t]], [[h, 0], [t, t]], [[h, 0], [0, t]], [[0, -h], [t, t]]])
    flat = np.repeat(flat, cells * cells, axis=0)
    step = 2e-3
    pi = [total_potential(at(k * step), flat, shape.zw, TUBE.gamma) / 2 for k in (-1, 0, 1)]
    moved = (at(1.0) - at(0.0)) @ np.eye(3)
    # lumped: a third of a triangle's reference area at each corner
    mass = np.sum(np.sum(moved**2, axis=(1, 2)) * np.abs(np.linalg.det(flat)) / 2 / 3) / 2
    return (pi[0] - 2 * pi[1] + pi[2]) / step**2 / mass + line_term / mass, value


SIZES = 48, 96


@pytest.mark.parametrize("name", ["Lambda_n0", "Lambda_n1", "Lambda_n2"])
def test_eigenvalues_are_those_of_a_triangulated_body(shape, name):
    """Triangles have errors of second order: two sizes give the limit, to 1 % of their difference."""
    assert shape.elements.dry
    coarse, fine = (rayleigh(shape, modes.FAMILIES[name], n)[0] for n in SIZES)
    value = rayleigh(shape, modes.FAMILIES[name], 4)[1]
    assert abs((4 * fine - coarse) / 3 - value) < 1e-2 * abs(fine - coarse)


def test_a_term_at_the_free_surface_would_be_seen(shape):
    """The terms lost by differentiating the printed potential twice are far above the allowed error."""
    family = modes.FAMILIES["Lambda_n0"]
    _, nodal, _ = modes.galerkin_mode(shape, family)
    w = nodal[shape.elements.wet * shape.elements.degree - 1, -1]
    term = 2 * np.pi * TUBE.gamma * shape.surface_radius**2 * w**2 / 2
    with_it, without = (rayleigh(shape, family, SIZES[0], t)[0] for t in (term, 0.0))
    allowed = 1e-2 * abs(without - rayleigh(shape, family, SIZES[1])[0])
    assert abs(with_it - without) > 100 * allowed


# -- springs on the current radius, and on the projected area ------------------------------------------------


def test_a_spring_on_the_current_radius_is_a_sum_of_springs():
    """Sum over rings of springs on a cylinder, one ring for each cone of the deformed meridian."""
    k, s = 20.0, 1.3
    t = np.linspace(0, 1, 20001)
    rho, eta = 1.5 + 0.2 * np.sin(2 * t), t + 0.1 * t**2
    middle, height = (rho[1:] + rho[:-1]) / 2, np.diff(eta)
    springs = np.sum(k / 2 * (middle - s) ** 2 * 2 * np.pi * middle * height) / (2 * np.pi)
    slope = np.gradient(eta, t)
    density = substrate_potential(rho, slope, k, s, 1.0)
    assert np.trapezoid(density, t) == pytest.approx(springs, rel=1e-8)
    # the reference's effective pressure: moving the meridian changes the energy as it changes a volume
    push = Substrate(k, s)

    def energy_and_volume(a, b):
        m, h = (a[1:] + a[:-1]) / 2, np.diff(b)
        return np.array([np.sum(k / 2 * (m - s) ** 2 * m * h), np.sum(m * m * h) / 2])

    # outside a volume of revolution nothing moves: a bump, first in the radius, then along the axis
    bump = np.exp(-(((t - 0.4) / 0.002) ** 2))
    at = int(np.argmax(bump))
    for move in ((1e-30j * bump, 0.0), (0.0, 1e-30j * bump)):
        energy, volume = energy_and_volume(rho + move[0], eta + move[1]).imag
        assert energy / volume == pytest.approx(-push.push(rho[at], 0.0), rel=1e-4)


def test_a_bed_of_springs_is_a_sum_over_the_plan():
    """Sum over columns above the projection of a deformed disk."""
    k, plane = 50.0, 0.5
    t = np.linspace(0, 1, 20001)
    rho, eta = t + 0.1 * np.sin(t), 0.9 - 0.3 * t**2
    plan = np.pi * np.diff(rho**2)
    gap = (eta[1:] + eta[:-1]) / 2 - plane
    springs = np.sum(k / 2 * gap**2 * plan) / (2 * np.pi)
    assert np.trapezoid(bed_potential(rho, np.gradient(rho, t), eta - plane, k, 1.0), t) == pytest.approx(
        springs, rel=1e-7
    )


# -- incremental curvatures ----------------------------------------------------------------------------------


def fundamental(e, n, theta, base, parts):
    """Second fundamental form (11, 22, 12) of the surface moved by e times a wave, from its derivatives."""
    (r, r_s, r_ss), (_, z_s, z_ss) = base
    (u, u_s, u_ss), (q, q_s, q_ss), (w, w_s, w_ss) = parts
    c, s = np.cos(n * theta), np.sin(n * theta)
    er, et = np.array([np.cos(theta), np.sin(theta), 0]), np.array([-np.sin(theta), np.cos(theta), 0])
    ez = np.array([0, 0, 1.0])

    def along(a, b, d):  # a derivative in S of a e_r + b e_theta + d e_z
        return a * er + b * et + d * ez

    one = along(r_s + e * u_s * c, e * q_s * s, z_s + e * w_s * c)
    one_one = along(r_ss + e * u_ss * c, e * q_ss * s, z_ss + e * w_ss * c)
    radial, across = r + e * u * c, e * q * s
    two = along(-e * n * u * s - across, radial + e * n * q * c, -e * n * w * s)
    two_two = along(
        -e * n * n * u * c - 2 * e * n * q * c - radial,
        -2 * e * n * u * s - e * n * n * q * s - across,
        -e * n * n * w * c,
    )
    one_two = along(-e * n * u_s * s - e * q_s * s, r_s + e * u_s * c + e * n * q_s * c, -e * n * w_s * s)
    normal = np.cross(two, one)
    normal = normal / np.sqrt(np.sum(normal * normal))
    return np.array([np.sum(normal * v) for v in (one_one, two_two, one_two)])


@pytest.mark.parametrize("n", [0.0, 1.0, 3.0, 10.0])
def test_incremental_curvatures_are_the_change_of_the_surfaces_own(n):
    """Complex steps of the moved surface's second fundamental form, without a formula for its change."""
    rng = np.random.default_rng(int(n))
    base, parts = rng.uniform(0.5, 1.5, (2, 3)), rng.standard_normal((3, 3))
    (r, r_s, r_ss), (_, z_s, z_ss) = base
    angle = 0.3
    change = np.imag(fundamental(1e-30j, n, 0.0, base, parts)) / 1e-30
    twist = np.imag(fundamental(1e-30j, n, angle, base, parts))[2] / 1e-30
    surface = SimpleNamespace(x=(r, 0, 0), a=(r_s, 0, z_s))
    assert hoop_bending(surface, tuple(parts[:, 0]), tuple(parts[:, 1]), n) == pytest.approx(
        change[1], rel=1e-11
    )
    j = np.hypot(r_s, z_s)
    at = {"r": r, "dr": r_s, "dz": z_s, "j": j, "dj": (r_s * r_ss + z_s * z_ss) / j, "R": 1.0}
    k11, k22, k12 = (
        float(form[0] @ parts.ravel())
        for form in relaxed_koiter.curvatures({k: np.array([v]) for k, v in at.items()}, n)
    )
    assert k22 == pytest.approx(change[1], rel=1e-11)
    assert k11 == pytest.approx(change[0], rel=1e-11)
    assert k12 * np.sin(n * angle) == pytest.approx(twist, rel=1e-11)
    one = {
        k: np.full((1, 1), v)
        for k, v in (("r", r), ("dr", r_s), ("dz", z_s), ("l1", j), ("R", 1.0), ("H", 1.0))
    }
    form = SimpleNamespace(s=np.zeros((1, 1)), assembled=lambda x: x[0, 0], **one)
    y = parts[:, :2].ravel()
    assert y @ relaxed_bending.Bent(form).extra(n) @ y == pytest.approx(change[1] ** 2, rel=1e-11)
