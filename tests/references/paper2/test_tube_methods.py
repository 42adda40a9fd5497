"""Both reference codes of the freely inflated tube, and the tables written by them."""

import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from committed_tables import assert_same_rows, assert_same_table, uncertainties

from reference_data.solvers.__main__ import main
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2 import ftim, tables_free
from reference_data.solvers.paper2.collocation import critical as tube_collocation_critical
from reference_data.solvers.paper2.collocation import equations as tube_collocation
from reference_data.solvers.paper2.collocation.equations import Zone, solve
from reference_data.solvers.paper2.differences import branch as tube_fd_branch
from reference_data.solvers.paper2.differences import critical as tube_fd_critical
from reference_data.solvers.paper2.differences import equations as tube_fd

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT / "reference_data"
STEP = 1e-30
MESH = tube_collocation_critical.MESHES[-1]


def read(path: Path) -> tuple[dict, dict[str, np.ndarray]]:
    """Documentation and columns of a table, given its TOML file."""
    lines = path.with_suffix(".csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    columns = dict(zip(lines[0].split(","), numbers.T, strict=True))
    return tomllib.loads(path.read_text()), columns


def collocation_state(tube: Tube, u: float) -> tube_collocation.State:
    return tube_collocation_critical.start(tube, MESH, "u_max", u)


def fd_states(tube: Tube, u: float) -> list[tuple[np.ndarray, float]]:
    first = tube_fd.first_guess(tube, tube_fd.Grid(tube_fd_branch.GRIDS[0]), u)
    return tube_fd_branch.on_three_grids(tube, first, tube_fd.at_control("u_max", u))


def substrate_like(rho, p):
    """A smooth pressure that depends on the radius, as contact will."""
    return p - 3 * (rho - 1) - rho * rho / 7


def test_finite_difference_jacobian_is_exact():
    tube, grid = Tube(0.1, 1.2, 6.0), tube_fd.Grid(12)
    y, p = tube_fd.first_guess(tube, grid, 0.3)
    y = y + 0.01 * np.random.default_rng(1).standard_normal(len(y))
    exact = np.empty((len(y), len(y)))
    for j in range(len(y)):
        bumped = y.astype(complex)
        bumped[j] += 1j * STEP
        exact[:, j] = np.imag(tube_fd.residual(tube, grid, bumped, p, substrate_like)) / STEP
    analytic = tube_fd.jacobian(tube, grid, y, p, substrate_like).toarray()
    assert np.abs(analytic - exact).max() < 1e-13 * np.abs(exact).max() * len(y)


def test_finite_differences_converge_with_order_two():
    tube = Tube(0.1, 1.0, 6.0)
    pairs = zip(tube_fd_branch.GRIDS, fd_states(tube, 0.8), strict=True)
    raw = [tube_fd_branch.quantities(tube, tube_fd.Grid(n), s) for n, s in pairs]
    for name in ("p", "lam1_mid", "t1_mid", "V"):
        limit = tube_fd_branch.richardson(*(r[name] for r in raw))
        assert float(limit.order) == pytest.approx(2, abs=2e-3), name


@pytest.mark.parametrize(("alpha", "delta1"), [(0.0, 1.0), (0.1, 1.0), (0.1, 1.5)])
def test_both_methods_find_the_same_state(alpha, delta1):
    tube, z = Tube(alpha, delta1, 6.0), np.array([0.0, 0.7, 1.9, 2.95, 3.0])
    states, state = fd_states(tube, 0.8), collocation_state(tube, 0.8)
    p = tube_fd_branch.richardson(*(s[1] for s in states))
    assert abs(p.value - state.p) <= p.uncertainty + 1e-12
    limit = tube_fd_branch.profiles(tube, states, z)
    for name, values in tube_collocation_critical.profile(state, z).items():
        gap = np.abs(limit[name].value - values)
        assert np.all(gap <= limit[name].uncertainty + 1e-12), name
        assert gap.max() < 1e-10, name


def test_both_methods_take_a_pressure_that_depends_on_the_radius():
    tube = Tube(0.1, 1.5, 6.0)
    start = collocation_state(tube, 0.3)
    springy = replace(start, zones=(Zone(MESH, spring=True),), substrate=SimpleNamespace(push=substrate_like))
    state = solve(springy, u_max=0.3)
    values = []
    for n in tube_fd_branch.GRIDS:
        grid = tube_fd.Grid(n)
        guess, condition = tube_fd.first_guess(tube, grid, 0.3), tube_fd.at_control("u_max", 0.3)
        values.append(tube_fd.newton(tube, grid, guess, condition, substrate_like)[1])
    limit = tube_fd_branch.richardson(*values)
    assert abs(limit.value - state.p) <= limit.uncertainty + 1e-12
    assert abs(state.p - start.p) > 0.1  # the extra term is felt


@pytest.mark.parametrize("u", [0.05, 0.8, 3.0])
def test_first_integrals_are_constant(u):
    """Axial force r0 w_1 cos b - p rho^2/2 and w - lambda1 w_1 are constant along the tube."""
    tube = Tube(0.1, 1.0, 6.0)
    steps = np.arange(0.3, u + 0.01, 0.1) if u > 0.3 else np.array([u])
    state = tube_collocation_critical.branch(tube, MESH, "u_max", steps).states[-1]
    rho, _, l1, b, _ = np.moveaxis(state.y[0], -1, 0)
    w1 = mat.slope(l1, rho / tube.r0, tube.alpha)
    force = tube.r0 * w1 * np.cos(b) - state.p * rho**2 / 2
    hamiltonian = mat.energy(l1, rho / tube.r0, tube.alpha) - l1 * w1
    for integral, size in ((force, np.abs(w1).max()), (hamiltonian, np.abs(l1 * w1).max())):
        assert np.ptp(integral) < 1e-11 * size


@pytest.mark.parametrize(("alpha", "delta1"), [(0.1, 1.0), (0.2, 3.0)])
def test_total_potential_is_stationary(alpha, delta1):
    """Both strong forms follow from Pi = int (r0 w - p rho^2 eta'/2) dz."""
    tube = Tube(alpha, delta1, 6.0)
    state, mesh = collocation_state(tube, 0.7), MESH
    width = mesh.widths[:, None] * tube.length
    rho, eta = state.y[0][..., 0], state.y[0][..., 1]

    def potential(rho, eta) -> complex:
        slope, axial = ((mesh.rule.deriv @ f[..., None])[..., 0] / width for f in (rho, eta))
        at = (mesh.rule.value @ rho[..., None])[..., 0]
        l1 = np.sqrt(slope * slope + axial * axial)
        density = tube.r0 * mat.energy(l1, at / tube.r0, tube.alpha)
        return np.sum(tube.length * mesh.weights * (density - state.p * at * at * axial / 2))

    x, step = mesh.x, 1j * STEP
    for k in range(1, 5):
        by_rho = potential(rho + step * np.cos((k - 0.5) * np.pi * x), eta)
        by_eta = potential(rho, eta + step * np.sin(k * np.pi * x))
        assert abs(np.imag(by_rho)) < 1e-11 * STEP
        assert abs(np.imag(by_eta)) < 1e-11 * STEP


def test_volume_and_displacement_control_meet_the_same_state():
    tube, mesh = Tube(0.1, 1.0, 6.0), tube_collocation_critical.MESHES[0]
    state = solve(tube_collocation_critical.first_guess(tube, mesh, 0.4), u_max=0.4)
    again = tube_collocation_critical.start(tube, mesh, "V", state.volume)
    assert again.p == pytest.approx(state.p, abs=1e-11)


def test_taylor_derivatives_along_the_branch():
    """dp/du agrees with the difference quotient of p, and d2p/du2 with the quotient of dp/du."""
    tube, mesh, h = Tube(0.0, 1.0, 6.0), tube_collocation_critical.MESHES[0], 1e-4
    found = tube_collocation_critical.branch(tube, mesh, "u_max", 0.8 + h * np.arange(-1, 2))
    rates = [tube_collocation.slopes(s, "u_max") for s in found.states]
    p = found.columns["p"]
    assert rates[1][0] == pytest.approx((p[2] - p[0]) / (2 * h), rel=1e-6)
    assert rates[1][1] == pytest.approx((rates[2][0] - rates[0][0]) / (2 * h), rel=1e-6)


def test_limit_point_is_singular_and_stationary():
    """At the root of the extended system the smallest singular value is zero and p is stationary."""
    tube, grid = Tube(0.1, 1.0, 6.0), tube_fd.Grid(100)
    trace = tube_fd_branch.Trace(tube, grid).run(1.6)
    state = tube_fd_critical.limit_point(tube, grid, next(trace.turning_points()))
    core = tube_fd.jacobian(tube, grid, *state, mat.plain_pressure).toarray()
    values = np.linalg.svd(core, compute_uv=False)
    assert values[-1] < 1e-10 * values[-2]
    h, u = 1e-3, state[0][0] - 1
    far_left, left, right, far_right = (
        tube_fd.newton(tube, grid, state, tube_fd.at_control("u_max", u + k * h))[1] for k in (-2, -1, 1, 2)
    )
    assert max(left, right) < state[1]
    slope = (8 * (right - left) - (far_right - far_left)) / (12 * h)
    assert abs(slope) < 1e-9


def test_fictitious_time_integration_reaches_the_newton_root():
    tube, grid = Tube(0.1, 1.0, 6.0), tube_fd.Grid(20)
    run, _ = ftim.solve(tube, grid, 1.5, variant=3)
    assert run.converged
    assert np.abs(run.state - ftim.newton_state(tube, grid, 1.5)[:-2]).max() < 1e-10
    assert run.evaluations == 4 * run.steps


def slow(*names: str) -> list:
    return [pytest.param(name, marks=pytest.mark.slow) for name in names]


@pytest.mark.parametrize(
    "name", ["fig04_p_1.9", "long_tube", *slow("fig02b_delta1_1.5", "limit_points_alpha_0.1")]
)
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(DATA / "paper2" / f"{name}.toml")
    new_about, new = read(tmp_path / "paper2" / f"{name}.toml")
    assert_same_table(new, committed, about, uncertainties(new_about))
    # the remaining documentation may differ only where rounding errors are reported
    for key in ("title", "source", "type", "method", "grid", "abscissa", "regenerate"):
        assert new_about[key] == about[key]


def partly(name: str, rows: Callable[[dict], np.ndarray], *args: object) -> None:
    """Assert that a table's builder finds some of its rows with other arguments behind the name."""
    builder = tables_free.TABLES[name]
    table = builder.func(name, *args)
    about, committed = read(DATA / "paper2" / f"{name}.toml")
    new, sizes = ({c.name: getattr(c, key) for c in table.columns} for key in ("values", "uncertainty"))
    assert_same_rows(new, committed, about, sizes, rows(committed))
    assert (table.title, table.source) == (about["title"], about["source"])


def test_first_half_of_a_curve_equals_the_committed_one():
    name = "fig02b_delta1_1.5"
    _, tube, _, source = tables_free.TABLES[name].args
    partly(name, lambda found: found["u_max"] < 2 + 1e-9, tube, 2.0, source)


def test_limit_points_next_to_where_they_merge_equal_the_committed_ones():
    """Of the last tube that has two, which are the most sensitive, and the first that has none."""
    name = "limit_points_alpha_0.1"
    _, tubes, keys, source = tables_free.TABLES[name].args
    chosen = [t for t in tubes if t.delta1 in (1.15, 1.2)]
    partly(name, lambda found: found["delta1"] == 1.15, chosen, keys, source)
