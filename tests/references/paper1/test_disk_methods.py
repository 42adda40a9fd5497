"""Reference codes of paper 1: strong form, both methods, the patch, its energy, the tables."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from committed_tables import assert_same_rows, assert_same_table, uncertainties

from reference_data.solvers.__main__ import main
from reference_data.solvers.core import continuity
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import differentiation
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import peeling as peel
from reference_data.solvers.paper1 import tables_checks as paper1_checks
from reference_data.solvers.paper1 import tables_contact as paper1_contact
from reference_data.solvers.paper1.cases import MR_1, Case
from reference_data.solvers.paper1.collocation import equations as dl
from reference_data.solvers.paper1.collocation import history as ch
from reference_data.solvers.paper1.collocation import radial as cr
from reference_data.solvers.paper1.collocation import rows as rc
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting import equations as sh
from reference_data.solvers.paper1.shooting import rows as rs
from reference_data.solvers.paper1.shooting import states as ss
from reference_data.solvers.paper1.shooting.radial import Radial

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "paper1"
TABLES = sorted(DATA.glob("*.toml"))
SMALL = Case(Disk(0.05, 1.3, 70.0, 0.4), 0.42, 3.4)  # not among the tables
FINE = cs.RESOLUTIONS[1]
STEP = 1e-30


def read(name: str, folder: Path = DATA) -> tuple[dict, dict[str, np.ndarray]]:
    lines = (folder / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    columns = dict(zip(lines[0].split(","), numbers.T, strict=True))
    return tomllib.loads((folder / f"{name}.toml").read_text()), columns


@pytest.fixture(scope="module")
def sliding():
    return dc.sliding_b(SMALL.disk, np.array([4.0]), 1)[0]


@pytest.fixture(scope="module")
def locked():
    """Front, inflation and deflated state of the small case."""
    x, states = dc.deflated_b(SMALL, np.array([1.0]), 1)
    return x, dc.inflation_b(SMALL, 1), states[-1]


# -- the strong form and where it comes from -----------------------------------------------------


def potential(batch: dl.Batch, moved: list[np.ndarray]) -> complex:
    """Phi of nodal (rho, eta) per zone, with springs in the zones that have them."""
    disk, total = batch.zones[0].disk, 0.0
    for d, zone in enumerate(batch.zones):
        mesh = zone.mesh
        x, stretch = dl.spread(*batch.edges(d), mesh.gauss)
        at = [(mesh.rule.value @ f[..., None])[..., 0] for f in moved[d]]
        scale = mesh.widths[:, None] * stretch
        q, w = ((mesh.rule.deriv @ f[..., None])[..., 0] / scale for f in moved[d])
        rho, eta = at
        density = x * mat.energy(np.sqrt(q * q + w * w), rho / x, disk.alpha) + batch.p[0] / 2 * rho * rho * w
        if zone.spring:
            density = density + disk.k / 2 * (eta - disk.l) ** 2 * rho * q
        total = total + np.sum(stretch * mesh.weights * density)
    return total


@pytest.mark.parametrize("mode", [1, 2, 3])
@pytest.mark.parametrize("component", [0, 1])
def test_potential_is_stationary(sliding, mode, component):
    """The first-order system follows from Phi with the springs of the flat substrate."""
    disk, moved = SMALL.disk, []
    for d, zone in enumerate(sliding.zones):
        x = dl.spread(*sliding.edges(d), zone.mesh.x)[0]
        bump = [np.sin(mode * np.pi * x / disk.length), np.cos((mode - 0.5) * np.pi * x / disk.length)]
        fields = [sliding.y[d][..., 0] + 0j, sliding.y[d][..., 1] + 0j]
        fields[component] += 1j * STEP * bump[component]
        moved.append(fields)
    assert abs(np.imag(potential(sliding, moved))) < 1e-11 * STEP


def test_appendix_functions_hold_along_a_collocation_solution(sliding):
    """The paper's appendix, v' = F1 and w' = F2, in contact and out of it.

    v and w are differentiated as polynomials of the other method's solution. Both formulas as printed, with 2
    pi in the numerators, are wrong by this factor.
    """
    disk = SMALL.disk
    for d, zone in enumerate(sliding.zones):
        left, right = (float(e[0]) for e in sliding.edges(d))
        for e in range(1, zone.mesh.elements):
            place = zone.mesh.x[e]
            x = dl.spread(np.array([left]), np.array([right]), place[None])[0][0, 0]
            rho, eta, l1, th = sliding.y[d][0, e].T
            rate = (differentiation(place) @ np.stack([x], axis=-1))[:, 0]
            v, w = l1 * np.cos(th) - rho / x, -l1 * np.sin(th)
            dv, dw = (differentiation(place) @ f / rate for f in (v, w))
            push = sliding.p[0] - (disk.k * (eta - disk.l) if zone.spring else 0)
            for i in range(2, len(x) - 2):
                load = push[i] if zone.spring else sliding.p[0]
                f1, f2 = sh.appendix(x[i], rho[i] / x[i], v[i], w[i], load, disk.alpha)
                assert f1 == pytest.approx(dv[i], abs=1e-7)
                assert f2 == pytest.approx(dw[i], abs=1e-7)


def test_pole_series_is_the_solution_next_to_the_pole():
    shot = ss.rising(SMALL.disk, sh.LEVELS[1], np.array([0.35]))[0]
    errors = []
    for x in (0.04, 0.02):
        series = sh.pole(shot.disk, shot.lam, shot.t0, shot.p, x, False)
        errors.append(np.abs(np.array(series) - shot.states([x])[-1][:4]))
    orders = np.log2(errors[0] / errors[1])
    assert np.all(np.abs(orders - [5, 4, 4, 3]) < 0.2)


# -- both methods --------------------------------------------------------------------------------


def agree(a: dict, b: dict, bound: float = 1e-9) -> None:
    for name, value in a.items():
        assert np.ravel(b[name])[0] == pytest.approx(value, abs=bound * max(1, abs(value))), name


@pytest.mark.parametrize("p", [1.5, 4.0])
def test_both_methods_find_the_same_sliding_state(p):
    shot, batch = dc.sliding_a(SMALL.disk, [p], 1)[0], dc.sliding_b(SMALL.disk, [p], 1)[0]
    agree(rs.shot_row(shot, iso=True), rc.sliding_rows(batch, iso=True))
    X = np.linspace(0, 1, 23)
    for name, values in rs.shot_profile(shot, X).items():
        assert np.abs(values - rc.sliding_profile(batch, X)[name]).max() < 1e-9, name


def test_both_methods_find_the_same_patch(locked):
    x, run, low = locked
    lam = float(run.onset.y[0][0, 0, 0, 2])
    edge = dc.deflated_a(SMALL, np.array([1.0]), 1)[0]
    agree(rs.edge_row(edge, lam), rc.patch_rows(low, run.history.patch(np.array([x])), lam))
    X = np.linspace(0, 1, 23)
    a = rs.edge_profile(dc.inflation_a(SMALL, 1), edge, X)
    for name, values in rc.patch_profile(low, run.history, x, X).items():
        assert np.abs(values - a[name]).max() < 1e-8, name


@pytest.fixture(scope="module")
def radial():
    """Model N up to a front near the pole."""
    return cr.Radial(SMALL.disk, FINE, dc.onset_b(SMALL.disk, 1), 0.16)


def test_both_methods_find_the_same_state_of_model_n(radial):
    x = 0.068  # the end of the sixth interval of the history
    run = Radial(dc.onset_a(SMALL.disk, 0), x)
    batch = radial.at(np.array([x]))
    agree(rs.front_row(run, run.at(x)), rc.radial_rows(batch, run.onset.lam), 1e-8)


# -- balances ------------------------------------------------------------------------------------


def rim_force(batch: dl.Batch) -> float:
    """Vertical force x W_1 sin th at the rim."""
    disk = batch.zones[-1].disk
    _, _, l1, th = batch.y[-1][0, -1, -1]
    return disk.length * mat.slope(l1, disk.beta, disk.alpha) * np.sin(th)


@pytest.mark.parametrize("kind", ["sliding", "inflation", "deflation", "radial"])
def test_gas_springs_and_rim_are_in_vertical_balance(kind, sliding, locked, radial):
    """p/2 - int k (eta - l) rho rho' dx = (x W_1 sin th) at the rim, for every kind of contact."""
    disk, (x, run, low) = SMALL.disk, locked
    if kind == "sliding":
        batch, x = sliding, float(sliding.scalars[0, 1])
        profile = lambda X: rc.sliding_profile(batch, X)  # noqa: E731
    elif kind == "radial":
        batch, x = radial.at(np.array([0.15])), 0.15
        profile = None
    else:
        batch = low if kind == "deflation" else run.at(x)
        profile = lambda X: rc.patch_profile(batch, run.history, x, X)  # noqa: E731
    nodes, weights = np.polynomial.legendre.leggauss(30)
    at, weight = x * (nodes + 1) / 2, x * weights / 2
    if profile is None:
        eta = dl.evaluate(batch, 0, 0, at)[:, 0]
        rho = at * radial.history.radius(at)
        pressed = disk.k * (eta - disk.l) * rho * radial.history.series(radial.history.g, at)
    else:
        found = profile(disk.beta * at)
        slope = differentiation(at) @ found["rho"]
        pressed = -found["sigma"] * found["rho"] * slope
    assert batch.p[0] / 2 - np.sum(weight * pressed) == pytest.approx(rim_force(batch), abs=1e-9)


def test_front_of_inflation_is_smooth_and_without_release(locked):
    """lambda1 and slope are continuous at the moving front, hence G = 0 there."""
    x, run, _ = locked
    patch = run.history.patch(np.array([x]))
    _, _, l1, th = run.at(x).y[0][0, 0, 0]
    assert l1 * np.cos(th) == pytest.approx(patch.slope[0], abs=1e-10)
    assert l1 * np.sin(th) == pytest.approx(patch.dip[0], abs=1e-10)
    p = float(run.at(x).p[0])
    assert abs(peel.rates_b(SMALL, p, 1)(patch.rho)[0]) < 1e-12


def test_history_forgets_how_it_began():
    onset = dc.onset_a(SMALL.disk, 0)
    rows = []
    for first in (2e-3, 1.2e-2):
        run = dc.sh.Inflation(replace(onset, how=replace(onset.how, first=first)), 0.25)
        rows.append(run.at(0.25))
    assert rows[0].p == pytest.approx(rows[1].p, abs=1e-7)
    assert rows[0].patch.rho == pytest.approx(rows[1].patch.rho, abs=1e-8)


# -- energy release rate -------------------------------------------------------------------------


def test_closed_form_is_the_derivative_of_the_potential():
    """Central differences of Pi converge to G with order 2, one-sided ones with order 1."""
    x, p = np.array([0.2]), 1.4
    patch, _ = peel.states_b(SMALL, p, x, 1)
    rate = peel.rates_b(SMALL, p, 1)(patch.rho)[0]
    at = {}
    for h in (-0.01, -0.005, 0.0, 0.005, 0.01):
        there, batch = peel.states_b(SMALL, p, x + h, 1)
        at[h] = ch.potential(batch, there)[0]
    per = patch.rho[0] * np.hypot(patch.slope[0], patch.dip[0])
    central = [(at[h] - at[-h]) / (2 * h * per) - rate for h in (0.01, 0.005)]
    backward = [(at[0.0] - at[-h]) / (h * per) - rate for h in (0.01, 0.005)]
    assert np.log2(central[0] / central[1]) == pytest.approx(2, abs=0.05)
    assert np.log2(backward[0] / backward[1]) == pytest.approx(1, abs=0.05)
    assert abs(peel.quotient(SMALL, p, x, 1)[0] - rate) < 1e-8
    assert peel.rates_a(SMALL, p, 1)(patch.rho)[0] == pytest.approx(rate, abs=1e-9)


def test_release_does_not_depend_on_the_largest_radius_reached():
    far = replace(SMALL, reach=0.46)
    rho = np.array([0.25])
    assert peel.rates_b(far, 1.4, 1)(rho)[0] == pytest.approx(peel.rates_b(SMALL, 1.4, 1)(rho)[0], abs=1e-9)


# -- tables --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name",
    [
        pytest.param("frictionless_alpha_0.1_beta_2", marks=pytest.mark.slow),
        *("fig05a_p_2.4", "fig11b_p_2.4"),
    ],
)
def test_regenerated_table_equals_the_committed_one(name, tmp_path):
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(name)
    new_about, new = read(name, tmp_path / "paper1")
    assert_same_table(new, committed, about, uncertainties(new_about))


def test_first_rows_of_frictionless_contact_equal_the_committed_ones(monkeypatch, tmp_path):
    name, stop = "frictionless_alpha_0.1_beta_2", 6.0
    monkeypatch.setitem(paper1_contact.HIGHEST, "alpha_0.1_beta_2", stop)
    assert main([name, "--out", str(tmp_path)]) == 0
    about, committed = read(name)
    new_about, new = read(name, tmp_path / "paper1")
    assert len(new["p"]) > 10
    assert_same_rows(new, committed, about, uncertainties(new_about), committed["p"] < stop + 1e-9)


LIMITS = {"G": 1e-9, "X_iso": 5e-8, "t1": 1e-8, "t2": 1e-8, "jump": 1.0, "below": 1.0}


@pytest.mark.parametrize("path", TABLES, ids=lambda p: p.stem)
def test_table_is_sharp_and_says_what_it_is(path):
    about, columns = read(path.stem)
    given = about["parameters"]
    assert given["contact"] in ("none", "frictionless", "adhesive")
    keys = set(about.get("keys", [])) | set(given)
    if path.stem not in ("free_limit_points", "small_t0") and not path.stem.startswith(("free", "off_free")):
        assert {"alpha", "beta"} <= keys
    for name, column in about["columns"].items():
        bound = LIMITS.get(name, 1e-9) * max(1.0, np.abs(columns[name]).max())
        assert column["uncertainty"] <= bound, name
    if "X_front" in given:
        assert np.abs(columns["X"] - given["X_front"]).min() > 2e-3
    if "alpha" in given and given["contact"] == "adhesive" and path.stem != "continuity_orders":
        assert given["adhesion"] in ("locked", "radial")
    if given.get("phase") == "deflation" and "keys" not in about:
        assert given["p_end"] > 0


def test_orders_of_continuity_are_measured():
    found = {kind: paper1_checks.jumps(kind, p, 1) for kind, p in paper1_checks.KINDS}
    first = {
        kind: [next((k for k in range(4) if jump[c][k] > continuity.JUMP), 4) for c in ("lam1", "lam2")]
        for kind, jump in found.items()
    }
    assert first == {"frictionless": [3, 3], "inflation": [1, 2], "deflation": [0, 1]}


def test_a_front_out_of_reach_is_refused():
    with pytest.raises(ValueError, match="does not reach"):
        dc.edge_b(MR_1, 40.0, 0)
    with pytest.raises(ValueError, match="does not reach"):
        dc.edge_b(MR_1, 1.0, 0)
