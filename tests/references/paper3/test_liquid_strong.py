"""The second method for the bent fluid-loaded tube: balance of forces, and agreement of both methods."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.core.laws import law
from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.paper3 import modes, path, weak
from reference_data.solvers.paper3 import tables_secondary as secondary
from reference_data.solvers.paper3.bent import both_methods as both
from reference_data.solvers.paper3.bent import branch, states
from reference_data.solvers.paper3.bent import newton as galerkin
from reference_data.solvers.paper3.bent.equations import Grid
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.galerkin import Elements
from reference_data.solvers.paper3.strong import equations as strong
from reference_data.solvers.paper3.strong import states as balance
from reference_data.solvers.paper3.strong.net import Net

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "paper3"
TUBE = FluidTube(8, 2)
HOW = path.RESOLUTIONS[0]
GRID = Grid(Elements(7, 3, 6, 1.0), 10, 32)
NET = Net(4, 2, 11, 11)
OFFSET = 0.1
RNG = np.random.default_rng(4)


@pytest.fixture(scope="module")
def critical():
    line = path.Path(TUBE, HOW)
    state = modes.critical_point(line.reach(131.0, 2.0), HOW, 1).state
    return state, modes.galerkin_critical(state, HOW, 1)


@pytest.fixture(scope="module")
def pair(critical):
    """One state of the branch by both methods, each started from the axisymmetric state and its mode."""
    guess = branch.injected(critical[1], OFFSET, GRID)
    return galerkin.newton(guess, OFFSET), strong.newton(strong.taken(guess, NET), OFFSET)


def test_forces_of_both_methods_are_the_gradient_of_one_energy():
    """Cross products, the metric and complex steps of the energy give the same stress, up to rounding."""
    a, b = RNG.standard_normal((2, 20, 3))
    own, other = np.concatenate(strong.forces(a, b), -1), np.concatenate(weak.fluxes(a, b), -1)
    scale = np.abs(own).max(axis=-1, keepdims=True)
    assert np.abs((own - other) / scale).max() < 1e-12
    for j, e in enumerate(1e-30j * np.eye(6)):
        derivative = np.imag(weak.energy_density(a + e[:3], b + e[3:])) / 1e-30
        assert np.abs((own[:, j] - derivative) / scale[:, 0]).max() < 1e-12


def test_rates_are_the_derivative_of_the_forces():
    a, b = RNG.standard_normal((2, 5, 3))
    rates, h = strong.rates(a, b), 1e-30
    for j, e in enumerate(h * 1j * np.eye(6)):
        exact = np.imag(np.stack(strong.forces(a + e[:3], b + e[3:]), axis=1)) / h
        found = rates[:, :, :, j // 3, j % 3]
        assert np.abs(found - exact).max() < 1e-12 * np.abs(exact).max()


def test_principal_resultants_are_those_of_the_principal_stretches():
    a, b = RNG.standard_normal((2, 30, 3))
    lam1, lam2, t1, t2 = balance.principal(a, b)
    for found, expected in zip((lam1, lam2), weak.stretches(a, b), strict=True):
        assert found == pytest.approx(expected, rel=1e-11)
    for found, expected in zip((t1, t2), weak.resultants(lam1, lam2), strict=True):
        assert found == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("model", ["neo_hookean", "ogden", "gent", "arruda_boyce"])
def test_forces_of_any_law_by_both_methods_are_the_gradient_of_its_energy(model):
    """Singular values and the metric; for the neo-Hookean law also the closed forms."""
    own = law(model)
    a, b = (
        np.eye(3)[0] + 0.3 * RNG.standard_normal((20, 3)),
        np.eye(3)[1] + 0.3 * RNG.standard_normal((20, 3)),
    )
    one = np.concatenate(strong.forces(a, b, own), -1)
    assert one == pytest.approx(np.concatenate(weak.fluxes(a, b, own), -1), rel=1e-11, abs=1e-11)
    for j, e in enumerate(1e-30j * np.eye(6)):
        derivative = np.imag(weak.energy_density(a + e[:3], b + e[3:], own)) / 1e-30
        assert one[:, j] == pytest.approx(derivative, rel=1e-11, abs=1e-11)
    if model == "neo_hookean":
        assert one == pytest.approx(np.concatenate(strong.forces(a, b), -1), rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("model", ["neo_hookean", "ogden", "gent", "arruda_boyce"])
def test_rates_of_any_law_by_both_methods_are_the_same(model):
    own, none = law(model), np.zeros(5)
    a, b = np.eye(3)[0] + 0.3 * RNG.standard_normal((5, 3)), np.eye(3)[1] + 0.3 * RNG.standard_normal((5, 3))
    a[0], b[0] = (1.2, 0, 0), (0, 1.2, 0)  # equal stretches, where a quotient has a limit
    tangent = weak.tangent(a, b, none, none, own)[:, :6, :6]
    found = strong.rates(a, b, own).reshape(5, 6, 6)
    assert found == pytest.approx(tangent, rel=1e-9, abs=1e-9)


def test_matrix_is_the_derivative_of_the_balance(pair):
    state = pair[1]
    now = strong.Balance(state)
    net = state.net
    v = np.zeros_like(now.residual)
    v[1:-1] = RNG.standard_normal(v[1:-1].shape)
    product = np.zeros_like(v)
    for e, matrix in enumerate(now.matrix):
        at = slice(e * net.degree, (e + 1) * net.degree + 1)
        product[at] += (matrix @ v[at].ravel()).reshape(-1, now.unknowns)
    h, dv = 1e-7, strong.spread_out(state, v, now.keep)
    up, down = (strong.Balance(replace(state, x=state.x + k * h * dv), derivative=False) for k in (1, -1))
    assert np.abs((up.residual - down.residual) / (2 * h) - product).max() < 1e-5 * np.abs(product).max()
    up, down = (strong.Balance(replace(state, zw=state.zw + k * h), derivative=False) for k in (1, -1))
    assert (up.residual - down.residual) / (2 * h) == pytest.approx(now.by_level, abs=1e-6)


def test_both_methods_find_the_same_state(pair):
    first, second = states.quantities(pair[0]), balance.quantities(pair[1])
    for name, value in first.items():
        # what these coarse grids resolve; the tables' own differ by 1e-8 at most
        assert second[name] == pytest.approx(value, abs=2e-4 * max(1.0, abs(value))), name
    at, theta = np.linspace(0, TUBE.length, 9), np.linspace(0, np.pi, 5)
    assert np.abs(pair[0].evaluate(at, theta)[0] - pair[1].evaluate(at, theta)[0]).max() < 1e-4


def test_both_methods_find_the_same_eigenvalues(pair):
    first, second = states.stability(pair[0]), balance.stability(pair[1])
    for name, value in first.columns().items():
        assert second[name] == pytest.approx(value, abs=2e-4), name
    assert abs(second["rotation"]) < 1e-6


def test_a_wrong_load_or_force_does_not_agree(pair, monkeypatch):
    """The comparison notices a change of one percent in either method's physics."""
    right = balance.quantities(pair[1])
    lighter = replace(pair[1], tube=replace(TUBE, gamma=0.99 * TUBE.gamma))
    wrong = balance.quantities(strong.newton(lighter, OFFSET))
    assert abs(wrong["V"] - right["V"]) > 1e-2
    original = strong.forces
    monkeypatch.setattr(strong, "forces", lambda a, b, _: (original(a, b)[0], 1.01 * original(a, b)[1]))
    wrong = balance.quantities(strong.newton(pair[1], OFFSET))
    assert abs(wrong["V"] - right["V"]) > 1e-2


def test_a_column_on_which_the_methods_differ_is_not_written():
    fine = np.array([1.0, 2.0])
    column = both.paired("t", "V", (fine + 1e-7, fine), (fine + 2e-7, fine + 1e-8))
    assert column.uncertainty >= 3e-7 + 1e-8
    with pytest.raises(DisagreementError, match="table t, column V"):
        both.paired("t", "V", (fine + 1e-7, fine), (fine + 1.1e-6, fine + 1e-6))


def test_nets_of_the_least_stretched_tubes_resolve_the_bend_over_the_lower_ring():
    """With six elements of degree 17 along the meridian the volume is 1.2e-7 off, and waves do not help."""
    tube = FluidTube(8, 1.5)
    shape = secondary.start(tube)[1]
    guess = branch.injected(shape, OFFSET, Grid(Elements(12, 0, 10, 1.0), 10, 36))
    volume = states.quantities(galerkin.newton(guess, OFFSET))["V"]
    few = [(wet, dry, degree, 12) for wet, dry, degree, _ in both.chosen(tube)]
    for sizes in (few, both.SLOPE_NETS):
        fine = both.balanced(guess, OFFSET, sizes)[1]
        assert balance.quantities(fine)["V"] == pytest.approx(volume, abs=2e-9)


def test_extrapolation_that_does_not_converge_is_not_written():
    full, fewer, least = (np.array([1.0, 2.0]) + e for e in (1e-9, 1e-8, 5e-8))
    assert secondary.remainder("t", full, fewer, least) == pytest.approx(9e-9)
    with pytest.raises(RuntimeError, match="t: a state more changes it by"):
        secondary.remainder("t", full, fewer, np.array([1.0, 2.0]) + 2e-8)


def test_what_newton_leaves_is_far_below_what_is_allowed_for(pair, monkeypatch):
    """``LEFT`` compares with the same states after iterations until steps are a hundred times smaller."""
    monkeypatch.setattr(galerkin, "CONVERGED", 2e-12)
    monkeypatch.setattr(strong, "CONVERGED", 2e-12)
    further = galerkin.newton(pair[0], OFFSET), strong.newton(pair[1], OFFSET)
    for of, before, after in zip((states, balance), pair, further, strict=True):
        for name, value in of.quantities(before).items():
            assert of.quantities(after)[name] == pytest.approx(value, abs=both.LEFT * max(1.0, abs(value))), (
                name
            )


def test_volume_is_that_of_a_triangulated_body(pair):
    """Volume without a flux: tetrahedra from the origin over flat triangles, and a cone under the lid."""
    bent, found = pair[1], []
    for n in (48, 96):
        theta = np.linspace(0, np.pi, n + 1)
        edge, _ = bent.front_at(theta)
        x, _, _ = bent.evaluate(np.linspace(0, 1, 2 * n + 1)[:, None] * edge, theta)
        rim = x[-1]
        lid = np.sum(rim[:-1, 0] * rim[1:, 1] - rim[1:, 0] * rim[:-1, 1]) / 2
        found.append(2 * (tetrahedra(x) + bent.zw * lid / 3))
    body = (4 * found[1] - found[0]) / 3  # flat triangles err by the square of their size
    assert balance.integrals(bent)[0] == pytest.approx(body, rel=1e-6)
    assert states.integrals(pair[0])[0] == pytest.approx(body, rel=1e-5)


def tetrahedra(x):
    """Signed volume between the origin and the triangles of a net of points (i, j, 3)."""
    p, q, r, s = x[:-1, :-1], x[1:, :-1], x[1:, 1:], x[:-1, 1:]
    corners = np.stack([p, s, r], -2), np.stack([p, r, q], -2)
    return sum(float(np.sum(np.linalg.det(c))) for c in corners) / 6


@pytest.mark.slow
def test_tables_of_the_branch_are_made_by_both_methods(monkeypatch):
    """The programs of the tables of branch and slopes, on coarse grids, agree with the stored tables."""
    monkeypatch.setattr(secondary, "LEVELS", {TUBE: (7.85, 7.89)})
    monkeypatch.setattr(branch, "GRIDS", ((6, 3, 6, 9), (7, 3, 6, 11), (8, 3, 7, 12), (8, 3, 8, 12)))
    monkeypatch.setattr(both, "STEEP_NETS", ((4, 3, 10, 10), (5, 3, 11, 12)))
    monkeypatch.setattr(both, "SLOPE_NETS", ((5, 3, 10, 8), (6, 3, 11, 10)))
    monkeypatch.setattr(secondary, "SLOPE_OFFSETS", np.array([0.04, 0.06, 0.08]))
    monkeypatch.setattr(secondary, "SLOPE_GRIDS", ((6, 3, 7, 8), (7, 3, 8, 10)))
    for cached in (branch.grid, secondary.start, secondary.followed, secondary.on_levels):
        cached.cache_clear()
    try:
        made = secondary.curve("c", TUBE), secondary.slopes("s")
    finally:
        for cached in (branch.grid, secondary.start, secondary.followed, secondary.on_levels):
            cached.cache_clear()
    for table, name, rows in zip(made, ("secondary_L_8_delta_2", "secondary_slopes"), (2, 1), strict=True):
        lines = (DATA / f"{name}.csv").read_text().splitlines()
        stored = [dict(zip(lines[0].split(","), map(float, x.split(",")), strict=True)) for x in lines[1:]]
        key = "zw" if rows == 2 else "delta"
        for column in table.columns:
            wanted = next(c for c in table.columns if c.name == key).values
            known = [r[column.name] for z in wanted for r in stored if r[key] == z and r.get("L", 8) == 8]
            assert np.abs(column.values - known).max() <= column.uncertainty + 1e-11, column.name
            assert column.name in ("zw", "L", "delta") or "largest_difference_of_methods" in column.extra
