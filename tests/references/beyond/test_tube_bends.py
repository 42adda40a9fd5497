"""Waves around the tube by two methods: closed forms, agreement, and disagreement that is refused."""

import csv
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from reference_data.solvers.beyond import tables_tube_bends as bends
from reference_data.solvers.beyond.tube_waves import ritz, strong
from reference_data.solvers.beyond.tube_waves.family import EVEN, FAMILIES, ODD, Family
from reference_data.solvers.core.collocation import Mesh
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import DisagreementError

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "beyond"
TUBE = Tube(0.1, 1.3, 5.0)
BENDS = Family(1, EVEN)


@pytest.fixture(scope="module")
def pair():
    """A state of one volume by both methods."""
    basis = ritz.Basis(8, 10)
    start = ritz.solve(ritz.guess(TUBE, basis, 0.3), u_max=0.3)
    volume = 1.5 * start.volume
    return ritz.solve(start, volume), strong.states(TUBE, np.array([volume]))[0]


def test_both_methods_find_the_same_state(pair):
    a, b = pair
    assert (a.p, a.u_max) == pytest.approx((b.p, b.u_max), abs=1e-10)
    assert ritz.least_hoop(a)[0] == pytest.approx(strong.least_hoop(b)[0], abs=1e-8)
    assert ritz.rate(a) == pytest.approx(strong.rate(b), rel=1e-7)


def test_the_energys_gradient_is_its_derivative():
    rng = np.random.default_rng(1)
    x, a, b = rng.standard_normal((3, 3, 1)) + np.array(
        [[[1.0], [0], [0]], [[0], [0], [1.5]], [[0], [2.0], [0]]]
    )
    h, whole = 1e-6, np.concatenate([x, a, b])

    def density(v):
        x, a, b = v[:3], v[3:6], v[6:]
        c = b / TUBE.r0
        g, h, k = (a * a).sum(0), (c * c).sum(0), (a * c).sum(0)
        t, j = g + h, g * h - k * k
        w = t + 1 / j - 3 + TUBE.alpha * (t / j + j - 3)
        return float((TUBE.r0 * w - 0.7 / 3 * (x * ritz.cross(b, a)).sum(0))[0])

    found = np.concatenate(ritz.gradient(TUBE, 0.7, x, a, b))[:, 0]
    for i in range(9):
        step = np.zeros((9, 1))
        step[i] = h
        assert (density(whole + step) - density(whole - step)) / (2 * h) == pytest.approx(
            found[i], rel=1e-6, abs=1e-7
        )


@pytest.mark.parametrize("family", [Family(1, EVEN), Family(2, ODD), Family(0, ODD)], ids=str)
def test_forces_are_derivatives_of_the_energy(pair, family):
    """A wave that vanishes at both ends: the work of its forces (b) is its quadratic form (a)."""
    a, b = pair
    k, _ = ritz.matrices(a, family)
    x, length = a.basis.nodes, TUBE.length
    shapes = x * (1 - x) * np.array([np.cos(1.3 * x), np.sin(2 * x) + 0.3, np.cos(x) - 0.2])
    if not family.n:
        shapes[1] = 0
    form = shapes.ravel() @ k @ shapes.ravel()
    points, w, phi, dphi = a.basis.rule
    y = b.zones[0].mesh.evaluate(b.y[0], points)
    base = y[:, 0], y[:, 2], y[:, 3]
    q, slope = shapes @ phi.T, shapes @ dphi.T / length
    m, rest = strong.forces(TUBE, family.n, b.p, base, q, slope)
    work = np.sum(w * length * (m * slope + rest * q).sum(0))
    assert form == pytest.approx(work * (1 if family.n else 2), rel=1e-8)


def test_a_translation_has_no_energy(pair):
    a, _ = pair
    k, _ = ritz.matrices(a, BENDS)
    size = len(a.r)
    moved = np.concatenate([np.ones(size), -np.ones(size), np.zeros(size)])
    assert abs(moved @ k @ moved) < 1e-9
    q, zero = np.array([[1.0], [-1.0], [0.0]]), np.zeros((3, 1))
    base = np.array([1.4]), np.array([1.5]), np.array([0.3])
    m, rest = strong.forces(TUBE, 1, 0.9, base, q, zero)
    assert np.abs(m).max() < 1e-13
    assert np.abs(rest).max() < 1e-13


def test_the_coarse_methods_bracket_the_same_point(monkeypatch):
    """The neo-Hookean tube of length 6 bends where the table says, on coarser meshes."""
    tube = Tube(0.0, 1.0, 6.0)
    monkeypatch.setattr(strong, "MESHES", (Mesh.graded(8, 8, 2.0), Mesh.graded(10, 10, 2.0)))
    basis = ritz.Basis(6, 8)
    low, high = 4.8, 5.2
    b = strong.states(tube, np.array([3.0, 4.0, low]))[-1]
    a = ritz.states(tube, basis, np.array([3.0, 4.0, low]))[-1]
    by_a = ritz.root(a, lambda s: ritz.eigenvalue(s, BENDS, 0), low, high)
    _, by_b = strong.roots(b, lambda s: strong.determinant(s, BENDS), low, high)
    about = tomllib.loads((DATA / "tube_waves.toml").read_text())
    head, *rows = csv.reader((DATA / "tube_waves.csv").read_text().splitlines())
    row = next(
        dict(zip(head, map(float, r), strict=True)) for r in rows if r[:3] == ["0", "1", "6"] and r[4] == "1"
    )
    assert by_a.p == pytest.approx(row["p"], abs=1e-7)
    assert by_b.p == pytest.approx(row["p"], abs=1e-8)
    assert about["columns"]["p"]["uncertainty"] < 1e-8


def test_points_that_one_method_misses_are_refused(monkeypatch):
    tube = Tube(0.0, 1.0, 6.0)
    monkeypatch.setattr(
        bends, "search", lambda _: bends.Search(np.array([1.0, 2.0]), [None, None], [None, None])
    )
    counts, values = np.array([0, 1]), np.array([1.0, 2.0])
    with pytest.raises(DisagreementError, match="find points between different neighbours"):
        bends.located(tube, (counts, values), lambda _: None, lambda _: 0.0)


def test_a_limit_point_is_where_the_rate_of_the_pressure_changes_its_sign(monkeypatch):
    """A rate between 0 and 1 is one of a rising pressure; the same holds for compression."""
    rates = [2.0, 0.5, -0.5]
    monkeypatch.setattr(bends, "search", lambda _: bends.Search(np.arange(3.0), rates, rates))
    monkeypatch.setattr(bends, "located", lambda tube, signs, *_: signs)
    for module in (ritz, strong):
        monkeypatch.setattr(module, "rate", lambda rate: rate)
        monkeypatch.setattr(module, "least_hoop", lambda least: (least, 0.0))
    for points in (bends.limits, bends.onsets):
        counts, values = points.__wrapped__(Tube(0.0, 1.0, 6.0))
        assert (counts.tolist(), values.tolist()) == ([0, 0, 1], rates)


def test_families_are_named_once():
    assert len(set(FAMILIES)) == len(FAMILIES) == 5
    assert all(sorted((*f.zero, *f.free)) == [0, 1, 2] for f in FAMILIES)


@pytest.mark.parametrize("name", ["tube_waves", "tube_waves_limits", "tube_waves_wrinkling"])
def test_the_tables_speak_of_each_tube_that_is_searched(name):
    with (DATA / f"{name}.csv").open(encoding="utf-8") as stream:
        found = {
            (float(row["alpha"]), float(row["delta1"]), float(row["lf"])) for row in csv.DictReader(stream)
        }
    notes = tomllib.loads((DATA / f"{name}.toml").read_text("utf-8"))["notes"]
    without = re.findall(r"\(([\d.]+), ([\d.]+), ([\d.]+)\)", notes.partition("None for")[2])
    assert found | {tuple(map(float, numbers)) for numbers in without} == {
        (t.alpha, t.delta1, t.lf) for t in bends.TUBES
    }
