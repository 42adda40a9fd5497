"""Reference codes for contact: both methods, the conditions at the front, and the committed tables."""

import tomllib
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from committed_tables import assert_same_table, uncertainties

from reference_data.solvers.__main__ import main
from reference_data.solvers.core import continuity
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2 import ftim
from reference_data.solvers.paper2 import tables_contact_checks as paper2_contact_checks
from reference_data.solvers.paper2.collocation import critical as tube_collocation_critical
from reference_data.solvers.paper2.collocation import history as hist
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.equations import State, places, problem, profile
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import deflation as defl
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.differences import history as fdh
from reference_data.solvers.paper2.substrate import Substrate, forces

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "paper2"
STEP = 1e-30
TUBE, SUBSTRATE = Tube(0.1, 1.0, 6.0), Substrate(20.0, 1.3)
HOW = replace(st.RESOLUTIONS[0], terms=18)
P = 2.0


def read(path: Path) -> tuple[dict, dict[str, np.ndarray]]:
    lines = path.with_name(f"{path.name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    columns = dict(zip(lines[0].split(","), numbers.T, strict=True))
    return tomllib.loads(path.with_name(f"{path.name}.toml").read_text()), columns


@pytest.fixture(scope="module")
def smooth():
    """A frictionless state."""
    first = st.touch(TUBE, SUBSTRATE, HOW.free)
    return st.frictionless(first, HOW, np.array([P]))[0]


@pytest.fixture(scope="module")
def glued():
    """A state of adhesive inflation."""
    return hist.Inflation(TUBE, SUBSTRATE, HOW, 3.0)


@pytest.fixture(scope="module")
def lowered(glued):
    """A state of adhesive deflation to p = 1 with a bilateral spring."""
    return hist.bilateral(glued.at(3.0), np.array([2.5, 2.0, 1.5, 1.0]))[-1]


def either_side(state: State) -> tuple[np.ndarray, np.ndarray]:
    z = state.fronts[-1:]
    return profile(state, z, -1)[0, :4], profile(state, z, 1)[0, :4]


def pulls(state: State, values: np.ndarray) -> tuple[float, float]:
    """Radial and axial membrane force."""
    rho, _, l1, b = values
    return forces(state.tube, rho, l1, l1 * np.sin(b), l1 * np.cos(b))


@pytest.mark.parametrize("p", [1.45, P])
def test_both_methods_find_the_same_frictionless_state(p):
    first = st.touch(TUBE, SUBSTRATE, HOW.free)
    by_collocation = st.summary(st.frictionless(first, HOW, np.array([p]))[0])
    states = cfd.on_grids(cfd.walk(TUBE, SUBSTRATE, np.array([p]))[0])
    raw = [cfd.summary(s) for s in states]
    for name, value in by_collocation.items():
        limit = cfd.extrapolated([r[name] for r in raw], (2, 3, 4))
        assert abs(limit.value - value) <= limit.uncertainty + 1e-10, name
        assert abs(limit.value - value) < 1e-9, name
        if name not in ("p", "u_max", "lam2_mid"):
            assert float(limit.order) == pytest.approx(2, abs=0.02), name


def test_newton_matrix_is_the_derivative_of_the_residual(glued):
    """Of a state with a stuck and a free zone, p given and the front unknown."""
    state, h, rng = glued.at(P), 1e-6, np.random.default_rng(2)
    held = problem(state, p=P, rho=SUBSTRATE.s)
    way = [rng.standard_normal(y.shape) for y in state.y]
    for values in way:  # elements share their ends
        values[1:, 0] = values[:-1, -1]
    by_c = rng.standard_normal(len(state.c))
    found = []
    for sign in (h, -h):
        moved = tuple(y + sign * d for y, d in zip(state.y, way, strict=True))
        found.append(held.linearised(moved, state.c + sign * by_c))
    defects = [(a - b) / (2 * h) for a, b in zip(found[0].defects, found[1].defects, strict=True)]
    missed = (found[0].missed - found[1].missed) / (2 * h)
    seen, seen_c = held.linearised(state.y, state.c).solve(defects, missed)
    assert np.abs(seen_c + by_c).max() < 1e-5
    for a, b in zip(seen, way, strict=True):
        assert np.abs(a + b).max() < 1e-5


def test_frictionless_front(smooth):
    state = smooth
    inner, outer = either_side(state)
    assert inner[0] == pytest.approx(SUBSTRATE.s, abs=1e-13)
    assert np.abs(inner - outer).max() < 1e-12
    assert np.abs(np.subtract(pulls(state, inner), pulls(state, outer))).max() < 1e-12


def test_adhesive_front_of_a_growing_patch_carries_no_line_force(glued):
    state = glued.at(P)
    inner, outer = either_side(state)
    assert np.abs(inner[:2] - [SUBSTRATE.s, outer[1]]).max() < 1e-12
    assert np.abs(np.subtract(pulls(state, inner), pulls(state, outer))).max() < 1e-5
    assert st.at_edge(state)["line_force"] < 1e-5
    assert abs(hist.slope_defect(state)) < 1e-6  # truncation of the series, here a short one


def test_adhesive_front_in_deflation(lowered):
    state = lowered
    inner, outer = either_side(state)
    radial, axial = np.subtract(pulls(state, inner), pulls(state, outer))
    assert abs(radial) < 1e-12
    assert inner[0] < SUBSTRATE.s
    edge, gap = st.at_edge(state), inner[0] - SUBSTRATE.s
    assert edge["line_force_membrane"] * inner[0] == pytest.approx(axial, rel=1e-12)
    spring = SUBSTRATE.k * inner[0] * gap**2 / 2
    assert edge["line_force"] * inner[0] == pytest.approx(axial + spring, rel=1e-12)


def potential(state: State, rho: list, eta: list) -> complex:
    """Pi = int [r0 w - p rho^2 eta'/2 + (k/2) chi rho (rho - s)^2 eta'] dz, zone by zone."""
    total = 0.0
    for (left, right), zone, r, e in zip(state.bounds, state.zones, rho, eta, strict=True):
        mesh = zone.mesh
        width = mesh.widths[:, None] * (right - left)
        slope, axial = ((mesh.rule.deriv @ f[..., None])[..., 0] / width for f in (r, e))
        at = (mesh.rule.value @ r[..., None])[..., 0]
        l1 = np.sqrt(slope * slope + axial * axial)
        density = state.tube.r0 * mat.energy(l1, at / state.tube.r0, state.tube.alpha)
        density = density - state.p * at * at * axial / 2
        gap = at - state.substrate.s
        density = density + zone.spring * state.substrate.k / 2 * at * gap * gap * axial
        total = total + np.sum((right - left) * mesh.weights * density)
    return total


@pytest.mark.parametrize("which", ["smooth", "glued", "lowered"])
def test_total_potential_is_stationary(which, request):
    """The energy is stationary: for all variations without friction, with eta fixed in a stuck patch."""
    given = request.getfixturevalue(which)
    state = given.at(P) if which == "glued" else given
    length, front = state.tube.length, float(state.fronts[0])
    nodes, rho, eta = [], [], []
    for (left, right), zone, y in zip(state.bounds, state.zones, state.y, strict=True):
        z = places(zone.mesh, left, right)
        nodes.append(z)
        rho.append(y[..., 0])
        eta.append(state.history.position(z) if zone.stuck else y[..., 1])
    stuck = state.zones[0].stuck
    for k in range(1, 4):
        by_rho = [
            r + 1j * STEP * np.cos((k - 0.5) * np.pi * z / length) for r, z in zip(rho, nodes, strict=True)
        ]
        assert abs(np.imag(potential(state, by_rho, eta))) < 1e-8 * STEP
        if stuck:
            sine = [0 * nodes[0], np.sin(k * np.pi * (nodes[1] - front) / (length - front))]
        else:
            sine = [np.sin(k * np.pi * z / length) for z in nodes]
        by_eta = [e + 1j * STEP * v for e, v in zip(eta, sine, strict=True)]
        assert abs(np.imag(potential(state, rho, by_eta))) < 1e-8 * STEP


def test_first_integrals_hold_across_the_frictionless_front(smooth):
    """F = r0 w_1 cos b - g(rho) and H = w - lambda1 w_1 are constant along the tube."""
    state = smooth
    axial, energy = [], []
    for zone, y in zip(state.zones, state.y, strict=True):
        rho, _, l1, b, _ = np.moveaxis(y, -1, 0)
        w1 = mat.slope(l1, rho / TUBE.r0, TUBE.alpha)
        axial.append((TUBE.r0 * w1 * np.cos(b) - SUBSTRATE.potential(rho, P, zone.spring)).ravel())
        energy.append((mat.energy(l1, rho / TUBE.r0, TUBE.alpha) - l1 * w1).ravel())
    assert np.ptp(np.concatenate(axial)) < 1e-11
    assert np.ptp(np.concatenate(energy)) < 1e-11


def test_without_a_spring_frictionless_contact_is_free_inflation():
    state = tube_collocation_critical.start(TUBE, HOW.free, "u_max", 0.36)
    nothing = Substrate(0.0, 1.3)
    again = st.frictionless(st.touch(TUBE, nothing, HOW.free), HOW, np.array([state.p]))[0]
    assert st.summary(again)["u_max"] == pytest.approx(0.36, abs=1e-11)


def test_lam1_at_the_middle_is_frozen_at_first_touch(glued, lowered):
    first = float(glued.first.y[0][0, 0, 2])
    for system in (glued.at(1.6), glued.at(3.0), lowered):
        assert st.summary(system)["lam1_mid"] == pytest.approx(first, abs=1e-13)


def test_front_following_is_of_first_order(glued):
    wanted = st.summary(glued.at(P))
    error = []
    for n in (100, 200, 400):
        run = defl.followed(TUBE, SUBSTRATE, n, 3.0)
        x, low = run.position(P)
        weights = fdb.lagrange_at(np.arange(low, low + 6, dtype=float), x)
        rows = [fdh.summary(run.glued, run.states[i], i) for i in range(low, low + 6)]
        seen = {c: sum(w * r[c] for w, r in zip(weights, rows, strict=True)) for c in wanted}
        error.append([abs(seen[c] - wanted[c]) for c in ("contact_length", "V")])
    orders = np.log2(np.array(error)[:-1] / np.array(error)[1:])
    assert np.all(np.abs(orders - 1) < 0.15)
    assert np.all(np.array(error)[-1] < 1e-3)


@pytest.mark.parametrize("spring", ["bilateral", "unilateral"])
def test_both_methods_find_the_same_deflation(glued, spring):
    grids, p = (100, 200, 400), np.array([2.5, 2.0, 1.6])
    start = glued.at(3.0)
    if spring == "bilateral":
        system = hist.bilateral(start, p)[-1]
    else:
        system = hist.unilateral(start, HOW, p, step=0.05)[-1]
    expected = st.summary(system) | st.at_edge(system)
    states = [defl.deflation(defl.fitted(TUBE, SUBSTRATE, n, 3.0), p, spring)[-1] for n in grids]
    raw = [defl.summary(s) for s in states]
    for name, bound in (("u_max", 1e-7), ("line_force", 1e-4), ("t1_mid", 1e-6), ("kappa", 1e-4)):
        limit = cfd.extrapolated([r[name] for r in raw], (1, 2))
        assert abs(limit.value - expected[name]) < bound, name
    assert len(system.zones) == (2 if spring == "bilateral" else 3)


def test_unilateral_spring_lets_go_of_all_of_the_tube(glued):
    start = glued.at(3.0)
    last = hist.unilateral(start, HOW, np.array([1.5, 1.4, 1.2]), step=0.05)[-1]
    assert len(last.zones) == 2
    assert not any(zone.spring for zone in last.zones)
    assert last.y[0][0, 0, 0] < SUBSTRATE.s
    edge = st.at_edge(last)
    assert edge["line_force"] == pytest.approx(edge["line_force_membrane"], rel=1e-12)


def test_table_one_is_measured(smooth, glued, lowered):
    jumps = [paper2_contact_checks.relative_jumps(state) for state in (smooth, lowered)]
    measured = [[continuity.first_jump(jump[f]) for f in continuity.FIELDS] for jump in jumps]
    assert measured == [[3, 3, 3, 3, 3, 3], [1, 1, 0, 1, 0, 0]]


def test_fictitious_time_integration_in_contact():
    def pressure(rho, p):
        return np.where(np.real(rho) > SUBSTRATE.s, SUBSTRATE.push(rho, p), p + 0 * rho)

    grid = fd.Grid(20)
    run, _ = ftim.solve(TUBE, grid, P, variant=3, pressure=pressure, height=0.34)
    assert run.converged
    assert np.abs(run.state - ftim.newton_state(TUBE, grid, P, pressure, 0.34)[:-2]).max() < 1e-10


@pytest.mark.parametrize("name", ["contact_onset", "fig07a_p_2"])
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(DATA / name)
    new_about, new = read(tmp_path / "paper2" / name)
    assert_same_table(new, committed, about, uncertainties(new_about))
    assert new_about["parameters"].keys() == about["parameters"].keys()


LIMITS = {
    "u_max": 1e-7,
    "contact_length": 1e-6,
    "Z_front": 1e-6,
    "line_force": 1e-5,
    "line_force_membrane": 1e-5,
    "traction_front": 1e-5,
    "traction_max": 1e-5,
    "spring_max": 1e-5,
    "f_t": 1e-5,
    "f_k": 1e-5,
    "kappa": 1e-5,
}


@pytest.mark.parametrize(
    "path",
    sorted(p for h in ("fig0[6-9]", "fig1", "off_contact") for p in DATA.glob(f"{h}*.toml")),
    ids=lambda p: p.stem,
)
def test_contact_table_is_sharp_and_says_what_it_is(path):
    about, columns = read(path.with_suffix(""))
    given = about["parameters"]
    assert given["contact"] in ("frictionless", "adhesive")
    assert given["phase"] in ("inflation", "deflation")
    assert ("spring" in given) == (given["phase"] == "deflation")
    assert {"alpha", "delta1", "lf", "k", "s", "p_end"} <= given.keys()
    for name, column in about["columns"].items():
        bound = 1e-8 if given["contact"] == "frictionless" else LIMITS.get(name, 1e-7)
        if given.get("spring") == "unilateral" and name in ("traction_max", "t2_min"):
            bound *= 10  # next to p_end the lifted strip is as narrow as a few finite-difference cells
        assert column["uncertainty"] <= bound, name
    if "Z" in columns:
        assert np.abs(columns["Z"] - given["Z_front"]).min() > 0.02


@pytest.mark.parametrize(
    "case", ["alpha_0_delta1_1", "alpha_0_delta1_2", "alpha_0.1_delta1_1", "alpha_0.1_delta1_2"]
)
def test_inflation_and_deflation_meet_at_the_highest_pressure(case):
    _, up = read(DATA / f"fig06b_{case}")
    for spring in ("bilateral", "unilateral"):
        about, down = read(DATA / f"fig06b_deflation_{spring}_{case}")
        assert up["p"][-1] == down["p"][-1] == about["parameters"]["p_end"]
        assert down["line_force"][-1] < 1e-7
        for column in ("u_max", "t1_mid", "lam1_mid"):
            assert abs(up[column][-1] - down[column][-1]) < 1e-8
    _, bilateral = read(DATA / f"fig06b_deflation_bilateral_{case}")
    assert np.all(np.diff(bilateral["line_force"]) < 0)
    assert np.all(bilateral["t2_min"] > 0)
    assert bilateral["u_max"][0] > 0.2
    assert bilateral["kappa"][0] > 0 > bilateral["kappa"][-1]


@pytest.mark.parametrize(("spring", "force"), [("bilateral", -2.0 * (-0.3 + 0.09 / 2)), ("unilateral", 0.0)])
def test_a_unilateral_spring_does_not_push_at_the_edge_of_the_patch(spring, force, monkeypatch):
    """The membrane is at rho = 1 there, inside of a substrate at s = 1.3 with k = 2."""
    y = np.array([1.4, 0.0, 1.0, 1.0, 1.0, 2.0])  # rho and eta of two nodes, and two further unknowns
    upright = np.zeros(2), np.ones(2)
    monkeypatch.setattr(defl.his, "tractions", lambda *_: np.zeros(2))
    monkeypatch.setattr(defl.fd, "node_slopes", lambda *_: upright)
    monkeypatch.setattr(defl.his, "inner_slopes", lambda *_: (0.0, 1.0, None))
    glued = SimpleNamespace(substrate=SimpleNamespace(s=1.3, k=2.0), tube=None, grid=None)
    state = SimpleNamespace(glued=glued, y=y, front=1, gap=np.array([0.1, 0.0]), spring=spring, p=1.0)
    _, f_k = defl.tractions(state)
    assert f_k == pytest.approx([-2.0 * (0.1 + 0.01 / 2.8), force])
