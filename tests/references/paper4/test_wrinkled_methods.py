"""Reference codes of paper 4: its relaxed energy, its two solvers, and physical identities."""

from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.tables import DisagreementError
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import events as evt
from reference_data.solvers.paper4 import jumps as jmp
from reference_data.solvers.paper4 import limits as lim
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import collocation as col
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting as shoot
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.shooting_measures import Reading

pytestmark = pytest.mark.paper4
STEP = 1e-30
WATER, GAS = Membrane(1.5, 2), Membrane(0.5, 2, load="gas")
CASE2 = Membrane(0.5, 2, Af=1.0, load="gas")
THREE_FRONTS = (WATER, 7.44)
STATES = [
    THREE_FRONTS,
    (Membrane(0.5, 3), 10.0),
    (GAS, 0.45),
    (CASE2, 0.002),
    (Membrane(1.3, 1.5, 0.05, 10, 0.6), 9.0),
    (replace(GAS, energy="standard"), 0.05),
]


def relaxed(l1, c2):
    """W_r, written out."""
    return l1**2 + 2 / l1 - 3 + c2 * (2 * l1 + 1 / l1**2 - 3)


@cache
def tracked(membrane: Membrane, load: float) -> col.State:
    return cas.solved(membrane, load).tracked[1]


@pytest.mark.parametrize(
    ("first", "fronts", "words"),
    [(True, 0, "gw>1"), (False, 1, "gw<1 gw>1"), (True, 2, "gw>1 gw<1 gw>1"), (False, 2, "gw<1 gw>1 gw<1")],
)
def test_zones_of_the_full_energy_are_one_more_than_their_fronts(first, fronts, words):
    measures = SimpleNamespace(first=first, fronts=[0.0] * fronts)
    solved = SimpleNamespace(membrane=SimpleNamespace(energy="standard"), measured=([None, measures], []))
    assert cas.Solved.zones.fget(solved) == words


@pytest.mark.parametrize("c2", [0.0, 0.01, 0.4])
@pytest.mark.parametrize("l1", [1.05, 1.8, 4.0])
def test_relaxed_energy_and_its_derivatives(c2, l1):
    """Uniaxial tension: energy, slope and curvature of the full energy along l2 = l1^(-1/2)."""
    natural, h = l1**-0.5, 1j * STEP
    assert relaxed(l1, c2) == pytest.approx(mat.energy(l1, natural, c2), rel=1e-13)
    assert wri.relaxed_slope(l1, c2) == pytest.approx(mat.slope(l1, natural, c2), rel=1e-13)
    assert mat.slope(natural, l1, c2) == pytest.approx(0, abs=1e-13)
    w11, w12, w22 = (
        mat.curvature(l1, natural, c2),
        mat.mixed(l1, natural, c2),
        mat.curvature(natural, l1, c2),
    )
    assert wri.relaxed_curvature(l1, c2) == pytest.approx(w11 - w12**2 / w22, rel=1e-13)
    assert np.imag(relaxed(l1 + h, c2)) / STEP == pytest.approx(wri.relaxed_slope(l1, c2), rel=1e-13)


@pytest.mark.parametrize("M", [0.1, 0.5, 0.99, 1.0, 1.5])
@pytest.mark.parametrize("delta", [1.25, 2, 3])
def test_critical_radius_by_two_ways(M, delta):
    membrane = Membrane(M, delta, 0.03)
    assert wri.critical_radius(membrane) == pytest.approx(wri.critical_radius_by_parts(membrane), abs=1e-13)
    assert wri.critical_radius(membrane) == pytest.approx(wri.critical_radius(replace(membrane, L=3.0)))


def test_fluid_weight_is_the_papers():
    assert pytest.approx(0.0464709, abs=5e-8) == wri.GAMMA


@pytest.mark.parametrize(("membrane", "load"), STATES)
def test_both_methods_find_the_same_state(membrane, load):
    state = cas.solved(membrane, load)
    _, pairs = cas.profiles(state)
    for name, (a, b) in pairs.items():
        gap = np.abs(a.fine - b.fine)
        assert np.all(gap <= np.hypot(a.uncertainty, b.uncertainty)), name
        assert gap.max() < 1e-11, name
    for a, b in (state.fronts, *(state.scalar(name) for name in msr.SCALARS)):
        assert np.all(np.abs(a.fine - b.fine) < 1e-10)
        assert np.all(np.maximum(a.uncertainty, b.uncertainty) < 1e-7)


def test_the_pattern_of_figure_4_is_found_by_all_three():
    state = cas.solved(*THREE_FRONTS)
    assert state.zones == "wrinkled taut wrinkled taut"
    untracked = cas.grid_at(*THREE_FRONTS).fronts
    assert len(untracked) == len(state.shots[1].shot.fronts) == 3
    assert np.abs(untracked - tracked(*THREE_FRONTS).pattern.fronts).max() < 2e-3


def potential(state: col.State, r: np.ndarray, z: np.ndarray) -> complex:
    """Pi = int (eta W - P-potential) ds of nodal radii and heights, computed from the energies only."""
    membrane, rule = state.membrane, state.mesh.rule
    width = np.diff(state.edges)[:, None]
    dr, dz = ((x @ rule.deriv.T) / width for x in (r, z))
    r, z, s = r @ rule.value.T, z @ rule.value.T, state.edges[:-1, None] + width * rule.points
    l1 = np.sqrt(dr * dr + dz * dz)
    tense = np.real(r * r * l1) > 1
    energy = np.where(tense, mat.energy(l1, r, membrane.c2), relaxed(l1, membrane.c2))
    if membrane.load == "gas":
        pressure = state.load
    else:
        depth = state.load - z
        pressure = membrane.gamma * np.where(np.real(depth) > 0, depth, 0)
    return np.sum(width * rule.weights * (membrane.eta(s) * energy - pressure * r * r * dz / 2))


@pytest.mark.parametrize(("membrane", "load"), STATES[:5])
def test_total_potential_is_stationary(membrane, load):
    """The strong forms follow from Pi with the energies of the table of states."""
    state = tracked(membrane, load)
    r, z, x = state.y[..., 0], state.y[..., 1], state.s / membrane.L
    scale = abs(np.imag(potential(state, r + 1j * STEP * (1 + 0 * x), z))) / STEP
    for k in range(1, 6):
        bump = 1j * STEP * np.sin(k * np.pi * x)
        assert abs(np.imag(potential(state, r + bump, z))) < 1e-9 * STEP * max(1.0, scale)
        assert abs(np.imag(potential(state, r, z + bump))) < 1e-9 * STEP * max(1.0, scale)


@pytest.mark.parametrize(("membrane", "load"), STATES)
def test_first_integrals(membrane, load):
    """Tension constant in wrinkled zones, axial force N cos b - p r^2/2 along gas, cones in dry zones."""
    state = tracked(membrane, load)
    values = msr.profile(state, state.s.ravel())
    r, b = values["r"], state.y[..., 3].ravel()
    tension = values["tension"].reshape(state.s.shape)
    # the flags of a zone's last node are those of the next zone, but stresses are continuous
    for zone, (tense, wet) in enumerate(zip(state.pattern.tense, state.pattern.wet, strict=True)):
        inside = tension[state.zone == zone]
        if not tense:
            assert np.ptp(inside) < 1e-11 * inside.max()
        if not tense and not wet:
            assert np.ptp(state.y[state.zone == zone][..., 3]) < 1e-11
    if membrane.load == "gas":
        force = values["tension"] * np.cos(b) - load * r * r / 2
        assert np.ptp(force) < 1e-11 * force.max()


@pytest.mark.parametrize(("membrane", "load"), [(GAS, 0.3), (CASE2, 0.002)])
def test_gas_solutions_are_mirrored(membrane, load):
    state, other = tracked(membrane, load), tracked(replace(membrane, M=2 - membrane.M), load)
    s = np.linspace(0, membrane.L, 41)
    here, there = sta.evaluate(state, s), sta.evaluate(other, membrane.L - s)
    assert np.abs(here[:, 0] - there[:, 0]).max() < 1e-11
    assert np.abs(here[:, 1] + there[:, 1] - membrane.delta * membrane.L).max() < 1e-11
    assert np.abs(state.pattern.fronts - (membrane.L - other.pattern.fronts)[::-1]).max() < 1e-10


@pytest.mark.parametrize(("membrane", "load"), [THREE_FRONTS, (GAS, 0.45), (CASE2, 0.002)])
def test_jumps_at_fronts(membrane, load):
    """Second derivatives jump in the ratio r'/z'; lam1' jumps by W12/W11 times a wrinkled slope."""
    state = tracked(membrane, load)
    jumps = jmp.of_state(state)
    assert np.all(np.abs(jumps["jump_z2"]) > 1e-4)
    assert jumps["jump_r2"] == pytest.approx(jumps["jump_z2"] * jumps["tan_phi"], abs=1e-9)
    assert np.all(np.abs(jumps["jump_r2"]) < 0.15 * np.abs(jumps["jump_z2"]))
    l1 = state.y[..., 2]
    slope, excess = state.mesh.slope(l1), state.mesh.slope(state.y[..., 0] - l1**-0.5)
    last = np.cumsum(state.counts)[:-1]
    for n, kind, lower in zip(last, state.pattern.kinds, state.pattern.tense[:-1], strict=True):
        if kind == "front":
            r, _, stretch, _ = state.y[n, 0]
            factor = mat.mixed(stretch, r, membrane.c2) / mat.curvature(stretch, r, membrane.c2)
            wrinkled, tense = ((n, 0), (n - 1, -1)) if lower else ((n - 1, -1), (n, 0))
            assert slope[wrinkled] - slope[tense] == pytest.approx(factor * excess[wrinkled], abs=1e-9)


def test_newtons_matrix_is_exact():
    """The slope d load/d V of the bordered system agrees with differences of V, with free fronts."""
    membrane, load = THREE_FRONTS
    state = col.newton(tracked(membrane, load), "load", load)
    h = 1e-3
    v = [col.newton(state, "load", load + k * h).volume for k in (-2, -1, 1, 2)]
    slope = (8 * (v[2] - v[1]) - (v[3] - v[0])) / (12 * h)
    assert state.rate("V") == pytest.approx(1 / slope, rel=1e-8)
    shot = cas.solved(membrane, load).shots[0]
    turned = cas.sho.solve(membrane, shot.starts, load, "V", shot.volume, 5)
    assert turned.rate == pytest.approx(1 / slope, rel=1e-8)


def test_wrong_zones_are_mended():
    """The taut pattern and one with a zone too many lead to the same state."""
    membrane, load = THREE_FRONTS
    right = tracked(membrane, load)
    surface = right.pattern.surface
    tense = col.Pattern((0.0, surface, 8.0), ("surface",), (True, True), (True, False))
    more = replace(
        right.pattern,
        breaks=(*right.pattern.breaks[:-1], 7.9, 8.0),
        kinds=(*right.pattern.kinds, "front"),
        tense=(*right.pattern.tense, False),
        wet=(*right.pattern.wet, False),
    )
    for pattern in (tense, more):
        found = sta.polished(sta.rebuilt(right, pattern, sta.RULES[1]), "load", load)
        assert found.pattern.fronts == pytest.approx(right.pattern.fronts, abs=1e-10)


def test_an_event_lies_between_its_patterns():
    """The two taut zones merge: four zones just below the level, two just above."""
    event = evt.find(evt.Touch(WATER, 9.25, 6.7, maximum=False))
    level = float(event.x[0].fine)
    assert level == pytest.approx(float(event.x[1].fine), abs=1e-9)
    below, above = tracked(WATER, level - 1e-3), tracked(WATER, level + 1e-3)
    assert (len(below.pattern.fronts), len(above.pattern.fronts)) == (3, 1)
    gap = below.pattern.fronts[1:]
    assert gap[0] < float(event.s[0].fine) < gap[1]


def test_limit_pressure_is_a_maximum():
    found = lim.limit(Membrane(0.5, 3, load="gas"), 0.55, 2.0)
    (load, other), (v, _) = found.values["load"], found.values["V"]
    assert abs(load.fine - other.fine) < 1e-11
    guess = sta.from_grid(cas.grid_at(found.membrane, 0.55), sta.RULES[0])
    state = sta.polished(guess, "load", 0.55)
    passed = []
    for target in np.linspace(state.volume, float(v.fine) + 1, 9)[1:]:
        state = sta.polished(state, "V", float(target))
        passed.append(state.load)
    assert max(passed) < load.fine
    assert max(passed) > load.fine - 1e-3


@pytest.mark.parametrize("membrane", [GAS, Membrane(0.5, 3)])
def test_the_papers_scheme_is_of_second_order(membrane):
    load = 0.2 if membrane.load == "gas" else 7.44
    state = tracked(membrane, load)
    errors = []
    for n in (200, 400, 800):
        grid = fd.walk(fd.unloaded(membrane, n), load)
        errors.append(np.abs(grid.r - sta.evaluate(state, np.linspace(0, 8, n + 1))[:, 0]).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.5)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.5)


def test_standard_energy_leaves_no_cylinder():
    state = tracked(replace(GAS, energy="standard"), 0.0)
    assert state.y[..., 0].max() > GAS.radius + 0.2
    assert np.all(np.abs(state.y[[0, -1], [0, -1], 3]) > 0.02)
    cylinder = tracked(GAS, 0.0)
    assert np.ptp(cylinder.y[..., 0]) < 1e-12
    assert np.abs(cylinder.y[..., 3]).max() < 1e-12


@pytest.mark.parametrize("fault", ["hoop", "load"])
def test_a_fault_in_one_method_is_noticed(fault, monkeypatch):
    """With a wrong W_2 or a wrong weight of the liquid in shooting, no table is written."""
    if fault == "hoop":
        exact = mat.slope
        monkeypatch.setattr(
            shoot.mat, "slope", lambda a, b, c: exact(a, b, c) * np.where(np.real(a) < np.real(b), 1.001, 1.0)
        )
        pair = cas.Solved(*THREE_FRONTS).shots[1].volume
        monkeypatch.undo()
    else:
        pair = cas.Solved(replace(WATER, gamma=wri.GAMMA * 1.0001), 7.44).shots[1].volume
    right, _ = cas.solved(*THREE_FRONTS).scalar("V")
    wrong = cas.Pair(np.array([pair]), np.array([pair]))
    row = cas.Pair(np.array([right.coarse]), np.array([right.fine]))
    with pytest.raises(DisagreementError, match=r"table T, column V, row 0"):
        cas.agreed("T", "V", row, wrong, ("1", "volume"))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_sign_that_changes_between_two_parts_of_a_shot_has_the_direction_of_the_change(sign):
    parts = SimpleNamespace(s=np.array([0.0, 1.0]), h=np.ones(2), parts=[0, 1])
    first, last = sign * np.array([-5.0, 1.0]), sign * np.array([-4.0, 2.0])
    assert Reading.zeros(parts, first, last, None) == [(1.0, 0, 1.0, sign)]
