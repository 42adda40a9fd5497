"""The independent reference codes: material laws, two solvers, and the tables written by them."""

import ast
import hashlib
import subprocess
import sys
import tomllib
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_table

from reference_data.solvers.__main__ import main
from reference_data.solvers.core import collocation as tube_collocation
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core import tables
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2 import ftim
from reference_data.solvers.paper2.collocation import critical as tube_collocation_critical
from reference_data.solvers.paper2.differences import branch as tube_fd_branch
from reference_data.solvers.paper2.differences import critical as tube_fd_critical
from reference_data.solvers.paper2.differences import equations as tube_fd
from reference_data.solvers.registry import tables as registered

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "reference_data"
EVERY = sorted(DATA.glob("*/*.toml"))
TOMLS = sorted(DATA.glob("paper*/*.toml"))
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


def derive(f, *args) -> float:
    """Derivative with respect to the argument that carries the imaginary step."""
    return np.imag(f(*args)) / STEP


@pytest.mark.parametrize("alpha", [0.0, 0.1, 0.37])
@pytest.mark.parametrize(("l1", "l2"), [(1.3, 0.9), (0.7, 2.1), (3.0, 4.0)])
def test_constitutive_derivatives_against_complex_step(alpha, l1, l2):
    h = 1j * STEP
    assert mat.slope(l1, l2, alpha) == pytest.approx(derive(mat.energy, l1 + h, l2, alpha), 1e-13)
    assert mat.slope(l2, l1, alpha) == pytest.approx(derive(mat.energy, l1, l2 + h, alpha), 1e-13)
    assert mat.curvature(l1, l2, alpha) == pytest.approx(derive(mat.slope, l1 + h, l2, alpha), 1e-13)
    assert mat.mixed(l1, l2, alpha) == pytest.approx(derive(mat.slope, l1, l2 + h, alpha), 1e-13)


def test_energy_is_that_of_an_incompressible_mooney_rivlin_sheet():
    l1, l2, alpha = 1.7, 0.8, 0.1
    squares = np.array([l1, l2, 1 / (l1 * l2)]) ** 2
    invariants = squares.sum(), (squares.prod() / squares).sum()
    expected = invariants[0] - 3 + alpha * (invariants[1] - 3)
    assert mat.energy(l1, l2, alpha) == pytest.approx(expected, rel=1e-14)


def test_stress_resultants_vanish_as_they_should_in_uniaxial_tension():
    tube = Tube(0.1, 1.5, 6.0)
    t1, t2 = mat.resultants(tube.delta1, 1 / tube.r0, tube.alpha)
    assert t2 == pytest.approx(0, abs=1e-14)
    assert t1 > 0


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
    state, _ = tube_collocation.newton(start, "u_max", 0.3, substrate_like)
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
    rho, _, l1, b = np.moveaxis(state.y, -1, 0)
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
    rho, eta = state.y[..., 0], state.y[..., 1]

    def potential(rho, eta) -> complex:
        slope, axial = ((mesh.deriv @ f[..., None])[..., 0] / width for f in (rho, eta))
        at = (mesh.value @ rho[..., None])[..., 0]
        l1 = np.sqrt(slope * slope + axial * axial)
        density = tube.r0 * mat.energy(l1, at / tube.r0, tube.alpha)
        return np.sum(width * mesh.weights * (density - state.p * at * at * axial / 2))

    x, step = mesh.x, 1j * STEP
    for k in range(1, 5):
        by_rho = potential(rho + step * np.cos((k - 0.5) * np.pi * x), eta)
        by_eta = potential(rho, eta + step * np.sin(k * np.pi * x))
        assert abs(np.imag(by_rho)) < 1e-11 * STEP
        assert abs(np.imag(by_eta)) < 1e-11 * STEP


def test_volume_and_displacement_control_meet_the_same_state():
    tube, mesh = Tube(0.1, 1.0, 6.0), tube_collocation_critical.MESHES[0]
    state, system = tube_collocation.newton(tube_collocation.first_guess(tube, mesh, 0.4), "u_max", 0.4)
    again = tube_collocation_critical.start(tube, mesh, "V", system.volume)
    assert again.p == pytest.approx(state.p, abs=1e-11)


def test_taylor_derivatives_along_the_branch():
    """dp/du agrees with the difference quotient of p, and d2p/du2 with the quotient of dp/du."""
    tube, mesh, h = Tube(0.0, 1.0, 6.0), tube_collocation_critical.MESHES[0], 1e-4
    found = tube_collocation_critical.branch(tube, mesh, "u_max", 0.8 + h * np.arange(-1, 2))
    state, system = tube_collocation.newton(found.states[1], "u_max", 0.8)
    p1, p2 = tube_collocation.derivatives(state, system, "u_max")
    assert p1 == pytest.approx((found.columns["p"][2] - found.columns["p"][0]) / (2 * h), rel=1e-6)
    assert p2 == pytest.approx((found.rate[2] - found.rate[0]) / (2 * h), rel=1e-6)


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


@pytest.mark.parametrize("name", ["fig02b_delta1_1.5", "fig04_p_1.9", "limit_points_alpha_0.1", "long_tube"])
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(DATA / "paper2" / f"{name}.toml")
    new_about, new = read(tmp_path / "paper2" / f"{name}.toml")
    assert_same_table(new, committed, about)
    # the remaining documentation may differ only where rounding errors are reported
    for key in ("title", "source", "type", "method", "grid", "abscissa", "regenerate"):
        assert new_about[key] == about[key]


def test_every_table_is_committed_and_listed(capsys):
    assert main(["--list"]) == 0
    listed = {line.split()[1] for line in capsys.readouterr().out.splitlines()}
    assert {p.stem for p in EVERY} == set(registered()) == listed


@pytest.mark.parametrize("path", EVERY, ids=lambda p: p.stem)
def test_committed_table_is_whole(path):
    about, columns = read(path)
    data = path.with_suffix(".csv").read_bytes()
    assert about["sha256"] == hashlib.sha256(data).hexdigest()
    assert about["type"] in {"exact", "independent", "printed", "other-code"}
    assert about["regenerate"] == f"python -m reference_data.solvers {path.stem}"
    assert list(columns) == list(about["columns"])
    assert b"\r" not in data
    assert b"e" not in data.split(b"\n", 1)[1]
    for column in about["columns"].values():
        assert column["uncertainty"] >= 0
        assert column["meaning"]
        assert column["scaling"]


@pytest.mark.parametrize("path", TOMLS, ids=lambda p: p.stem)
def test_table_of_a_paper_is_in_order_and_sharp(path):
    about, columns = read(path)
    keys = about.get("keys", [about["abscissa"]])
    rows = list(zip(*(columns[k] for k in keys), strict=True))
    assert keys[0] == about["abscissa"]
    if len(keys) == 1:
        assert all(a < b for a, b in pairwise(rows)) or all(a > b for a, b in pairwise(rows))
    assert len(set(rows)) == len(rows)
    for name, column in about["columns"].items():
        # Constrained inflation and papers 3 and 5 have bounds of their own: test_reference_contact,
        # _paper3_tables, _paper5_tables.
        own = "contact" in about["parameters"] or "kind" in about["columns"]
        own |= path.parent.name in ("paper3", "paper5")
        if not own and not path.stem.startswith("ftim_"):
            assert column["uncertainty"] < 1e-9 * max(1.0, np.abs(columns[name]).max())


def test_disagreement_names_table_column_and_row():
    good, off = np.array([1.0, 2.0, 3.0]), np.array([1.0, 2.001, 3.0])
    small = np.full(3, 1e-9)
    a, b = (tube_collocation_critical.Resolved(v, small) for v in (good, off))
    with pytest.raises(tables.DisagreementError, match=r"table T, column p, row 1:"):
        tables.agreed("T", "p", a, b, ("1", "pressure"))


def test_numbers_are_plain_decimals():
    assert tables.plain(0.1) == "0.1"
    assert tables.plain(-1e-7 / 3) == "-0.0000000333333333333"
    assert tables.plain(12345.6789012345) == "12345.6789012"
    assert tables.plain(0.0) == "0"


@pytest.mark.parametrize("arguments", [["fig99"], ["fig02a_delta1_1", "fig99"], []])
def test_bad_request_is_one_line_and_status_two(arguments, tmp_path):
    command = [sys.executable, "-m", "reference_data.solvers", *arguments, "--out", str(tmp_path)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("path", sorted(DATA.rglob("*.py")), ids=lambda p: p.stem)
def test_reference_side_imports_nothing_of_the_other(path):
    allowed = {"numpy", "scipy", "reference_data"} | sys.stdlib_module_names
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            names = [node.module]
        else:
            continue
        assert {n.split(".")[0] for n in names} <= allowed
