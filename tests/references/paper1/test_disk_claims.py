"""The claims of paper 1 about its curves, tested on the reference tables."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1.cases import MR_1, MR_2, NH_1, NH_2

DATA = Path(__file__).resolve().parents[3] / "reference_data" / "paper1"
PANELS = {
    "fig11a": (1.2, 1.4, 1.6, 2.2, 2.4),
    "fig11b": (1.2, 1.4, 1.6, 2.2, 2.4),
    "fig12a": (1.4, 1.6, 1.8, 2.3, 2.7),
    "fig12b": (2.4, 3.2, 3.8, 4.2, 5.6),
}


def about(name: str) -> dict:
    return tomllib.loads((DATA / f"{name}.toml").read_text())


def read(name: str) -> dict[str, np.ndarray]:
    lines = (DATA / f"{name}.csv").read_text().splitlines()
    numbers = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    return dict(zip(lines[0].split(","), numbers.T, strict=True))


def onset(case: dc.Case) -> float:
    table, d = read("disk_contact_onset"), case.disk
    row = (table["alpha"] == d.alpha) & (table["beta"] == d.beta) & (table["l"] == d.l)
    return float(table["p"][row][0])


def profiles(*heads: str) -> list[str]:
    return sorted(p.stem for h in heads for p in DATA.glob(f"{h}_*.csv"))


# -- free and frictionless -----------------------------------------------------------------------


def test_zone_of_equal_stretches_is_smallest_at_first_contact():
    t, first = read("fig07b_iso"), onset(MR_1)
    assert np.all(np.diff(t["X_iso"][t["p"] < first]) < 0)
    assert np.all(np.diff(t["X_iso"][t["p"] > first]) > 0)
    at = t["p"][np.argmin(t["X_iso"])]
    assert abs(at - first) < 0.02
    small = t["p"] <= 0.02  # X_iso goes like p^(-1/3)
    assert np.ptp((t["X_iso"] * t["p"] ** (1 / 3))[small]) < 1e-4 * 0.04


@pytest.mark.parametrize("alpha", [0.0, 0.1])
def test_prestretched_membranes_start_linearly(alpha):
    t = read(f"free_alpha_{alpha:g}_beta_2")
    slope, square = t["p"][:4] / t["t0"][:4], t["t0"][:4] ** 2
    limit = np.polynomial.polynomial.polyfit(square, slope, 3)[0]
    assert limit == pytest.approx(8 * (1 - 2.0**-6) * (1 + 4 * alpha), rel=1e-6)


def test_unstretched_membranes_start_with_the_cube():
    t = read("small_t0")
    assert np.ptp(t["p_per_t0_cubed"] / (1 + t["alpha"])) < 1e-8


def test_limit_points_tend_to_those_of_a_soap_film():
    t = read("free_limit_points")
    assert np.all(t["alpha"] == 0)
    for column, limit in (("p", 4.0), ("t0", 1.0)):
        gap = np.abs(t[column] - limit)
        assert np.all(np.diff(gap) < 0)
        assert gap[-1] < 1e-6
    # lambda_pole = 2 beta: the sphere's cap of a constant tension doubles the stretch at its pole
    assert t["lam_pole"][-1] / t["beta"][-1] == pytest.approx(2, abs=1e-6)
    assert np.all(t["p"] < 4.0)  # figure 6(a) at p = 4 lies above them


@pytest.mark.parametrize("case", dc.PAPER, ids=lambda c: c.label)
def test_contact_zone_grows(case):
    t = read(f"frictionless_{case.label}")
    # an unstretched neo-Hookean membrane balloons beyond p = 7.5 or so and draws its contact edge back
    rows = t["p"] <= 7.0
    for column in ("t0", "rho_contact", "X_contact", "lam_pole"):
        assert np.all(np.diff(t[column][rows]) > 0), column
    assert t["p"][0] > onset(case)


@pytest.mark.parametrize(("name", "bound"), [("fig03a_p_4.83", 0.013), ("fig03a_p_7.1", 0.02)])
def test_stretches_in_frictionless_contact_differ_by_a_hundredth(name, bound):
    t, front = read(name), about(name)["parameters"]["X_front"]
    gap = np.abs(t["lam1"] - t["lam2"])[t["X"] < front]
    assert 0.01 < gap.max() < bound


@pytest.mark.parametrize("letter", ["a", "b"])
def test_frictionless_paths_diverge_without_inflexion(letter):
    t = read(f"paths_fig03{letter}")
    for X in (0.1, 0.3, 0.5, 0.7, 0.9):
        rho, eta = t[f"rho_{X:g}"], t[f"eta_{X:g}"]
        assert np.all(np.diff(rho) > 0)
        assert np.all(np.diff(np.diff(eta) / np.diff(rho)) < 0)
    case = (MR_1, MR_2)["ab".index(letter)]
    slip = read(f"frictionless_{case.label}")
    for X in (0.1, 0.2, 0.3, 0.4):  # neighbours in contact move apart
        touching = t["p"] > np.interp(X + 0.1, slip["X_contact"], slip["p"])
        assert touching.sum() > 3
        assert np.all(np.diff((t[f"rho_{X + 0.1:.1g}"] - t[f"rho_{X:g}"])[touching]) > 0)


def bulging(case: dc.Case) -> float:
    """Pressure at which the membrane is vertical at the rim in frictionless contact."""
    p = np.arange(np.ceil(onset(case) * 10) / 10 + 0.1, 9.6, 0.1)
    states = dc.sliding_b(case.disk, p, 0)
    upright = [float(s.y[-1][0, -1, -1, 3]) > np.pi / 2 for s in states]
    return float(p[upright.index(True)])


def test_unstretched_membrane_bulges_first_and_touches_first():
    assert bulging(MR_1) < bulging(MR_2)
    assert onset(MR_1) < onset(MR_2)
    assert onset(NH_1) < onset(NH_2)
    assert onset(NH_1) < onset(MR_1)
    assert onset(NH_2) < onset(MR_2)


@pytest.mark.parametrize("name", profiles("fig03a", "fig03b", "fig04b", "fig05a", "fig05b", "fig08"))
def test_ends_of_a_profile(name):
    t, beta = read(name), about(name)["parameters"]["beta"]
    assert t["lam2"][-1] == pytest.approx(beta, abs=1e-10)
    assert t["lam1"][0] == pytest.approx(t["lam2"][0], abs=1e-10)
    assert (t["rho"][0], t["rho"][-1], t["eta"][-1]) == pytest.approx((0, 1, 0), abs=1e-10)


EVERY = profiles("fig03a", "fig03b", "fig04a", "fig04b", "fig05a", "fig05b", "fig06a", "fig06b", "fig10c")


@pytest.mark.parametrize("name", EVERY)
def test_no_wrinkles_in_any_printed_state(name):
    t = read(name)
    assert t["t1"].min() > 0
    assert t["t2"].min() > 0


# -- adhesive inflation --------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["fig04a_p_3.477", "fig04b_p_8.49", "fig08_p_3.26", "fig10b_p_3.726"])
def test_locked_patch_keeps_the_stretch_of_first_contact(name):
    t, given = read(name), about(name)["parameters"]
    inside = t["X"] < given["X_front"]
    first = read("disk_contact_onset")
    row = (first["alpha"] == given["alpha"]) & (first["beta"] == given["beta"]) & (first["l"] == given["l"])
    assert t["lam1"][0] == pytest.approx(first["lam_pole"][row][0], abs=1e-10)
    assert np.all(np.diff(t["lam1"][inside]) > 0)
    # of beta = 2, lambda2 first falls next to the pole, by 5e-6
    fall = np.min(np.minimum.accumulate(t["lam2"][inside]) - t["lam2"][0])
    assert fall == 0 if given["beta"] == 1 else -1e-5 < fall < -1e-6
    assert np.all(np.diff(t["lam2"][inside & (t["X"] > 0.05)]) > 0)


@pytest.mark.parametrize("letter", ["a", "b"])
def test_points_in_the_patch_move_vertically(letter):
    t, fronts = read(f"paths_fig04{letter}"), read(f"adhesive_alpha_0.1_beta_{'12'['ab'.index(letter)]}")
    for X in (0.1, 0.2, 0.3):
        p = np.interp(X, fronts["X_contact"], fronts["p"])
        stuck = t["p"] > p + 0.1
        assert stuck.sum() > 2
        assert np.ptp(t[f"rho_{X:g}"][stuck]) < 1e-10
        assert np.all(np.diff(t[f"eta_{X:g}"][stuck]) > 0)


@pytest.mark.parametrize(
    ("letter", "points", "outer"), [("a", (0.4, 0.5, 0.6), (0.7, 0.8, 0.9)), ("b", (0.6, 0.7), (0.8, 0.9))]
)
def test_paths_near_the_patch_have_an_inflexion(letter, points, outer):
    """The slope falls, then rises; farther out it only falls up to the last printed pressure."""
    t = read(f"paths_fig04{letter}")

    def bends(X: float) -> np.ndarray:
        return np.sign(np.diff(np.diff(t[f"eta_{X:g}"]) / np.diff(t[f"rho_{X:g}"])))

    for X in points:
        signs = bends(X)
        assert (signs[0], signs[-1]) == (-1, 1)
        assert np.count_nonzero(np.diff(signs)) == 1
    for X in outer:
        assert np.all(bends(X) == -1)


@pytest.mark.parametrize("case", dc.PAPER, ids=lambda c: c.label)
def test_locked_indentation_is_deeper(case):
    head = "fig06a" if case.disk.alpha == 0 else "fig06b"
    slip, stick = (f"{head}_{word}_beta_{case.disk.beta:g}" for word in ("frictionless", "adhesive"))
    a, b = read(slip), read(stick)
    X_a, X_b = (about(n)["parameters"]["X_front"] for n in (slip, stick))
    assert b["eta"][0] > a["eta"][0]
    assert -b["sigma"][0] > -a["sigma"][0]
    assert -b["sigma"][0] / X_b > -a["sigma"][0] / X_a
    rho_a, rho_b = (np.interp(x, t["X"], t["rho"]) for x, t in ((X_a, a), (X_b, b)))
    assert rho_b < rho_a
    # the slope at the edge itself is smaller
    edge = [np.diff(t["sigma"][t["X"] < x])[-1] for x, t in ((X_a, a), (X_b, b))]
    assert edge[1] < edge[0]


@pytest.mark.parametrize("case", [MR_1, MR_2], ids=lambda c: c.label)
def test_model_n_indents_a_little_less_than_frictionless_contact(case):
    slip, radial = read(f"frictionless_{case.label}"), read(f"adhesive_radial_{case.label}")
    lock = read(f"adhesive_{case.label}")
    p = radial["p"][(radial["p"] > slip["p"][3]) & (radial["p"] < slip["p"][-1])]
    at = {
        n: make_interp_spline(t["p"], t["t0"], k=3)(p)
        for n, t in (("slip", slip), ("n", radial), ("r", lock))
    }
    assert np.all(at["slip"] - at["n"] > 1e-5)
    assert np.all(at["slip"] - at["n"] < 6e-3)
    assert np.all(at["r"] > at["slip"])


# -- adhesive deflation --------------------------------------------------------------------------


@pytest.mark.parametrize("case", dc.PAPER, ids=lambda c: c.label)
def test_deflation_starts_where_inflation_ended(case):
    t = read(f"deflation_{case.label}")
    assert t["p"][-1] == case.p_end
    assert t["lam1_contact_outer"][-1] == pytest.approx(t["lam1_contact"][-1], abs=1e-9)
    assert np.all(t["lam1_contact_outer"][:-1] < t["lam1_contact"][:-1])
    assert np.all(np.diff(t["t0"]) > 0)
    assert np.ptp(t["sigma_contact"] - t["sigma_pole"]) < 1e-9  # the patch moves as a rigid body
    assert np.all(t["sigma_contact"][:-1] > 0)
    assert t["sigma_pole"][-1] < 0


def test_patch_of_the_unstretched_membrane_is_all_in_tension_at_last():
    t = read("deflation_alpha_0.1_beta_1")
    assert np.all(t["sigma_pole"][t["p"] <= 1.0] > 0)
    assert np.all(t["sigma_pole"][t["p"] >= 1.4] < 0)
    low, high = read("fig10c_p_0.4"), read("fig05a_p_3.2")
    X_f = about("fig10c_p_0.4")["parameters"]["X_front"]
    assert np.all(low["sigma"][low["X"] < X_f] > 0)
    signs = np.sign(high["sigma"][high["X"] < X_f])
    assert signs[-1] > 0 > signs[0]
    assert np.count_nonzero(np.diff(signs)) == 1


def test_free_part_stops_bulging_between_the_printed_pressures():
    t = read("curvature_change")
    row = (t["alpha"] == 0.1) & (t["beta"] == 1)
    assert 1.4 < t["p"][row][0] < 2.4
    assert np.all(t["p"] < t["p_end"])


# -- peeling -------------------------------------------------------------------------------------


@pytest.mark.parametrize("head", PANELS)
def test_curves_above_first_contact_rise_from_zero(head):
    starts = read("release_start")
    above = []
    for p in PANELS[head]:
        given, t = about(f"{head}_p_{p:g}")["parameters"], read(f"{head}_p_{p:g}")
        if p < given["p_contact"]:
            continue
        above.append(p)
        row = np.ones(len(starts["p"]), dtype=bool)
        for key in ("alpha", "beta", "k", "p"):
            row &= starts[key] == given[key]
        rho = float(starts["rho_contact"][row][0])
        assert np.all(np.diff(t["G"]) > 0)
        assert t["rho_contact"][0] > rho
        # zero with zero slope: G/(rho - rho_0) tends to zero linearly
        quotient = t["G"] / (t["rho_contact"] - rho)
        near = t["rho_contact"] - rho < 0.09
        limit = np.polynomial.polynomial.polyfit(t["rho_contact"][near] - rho, quotient[near], 2)[0]
        assert abs(limit) < 0.02 * quotient[near].max()
    assert tuple(above) == PANELS[head][-1 if head == "fig12b" else -2 :]


def pulls(alpha: float, beta: float, k: float) -> dict[str, np.ndarray]:
    t = read("pull_off")
    row = (t["alpha"] == alpha) & (t["beta"] == beta) & (t["k"] == k) & (t["l"] == 0.5)
    return {c: v[row] for c, v in t.items()}


@pytest.mark.parametrize(
    ("head", "keys"), zip(PANELS, [(0, 1, 50), (0.1, 1, 50), (0.1, 1, 100), (0.1, 2, 50)], strict=True)
)
def test_pull_off_moves_outwards_as_the_pressure_falls(head, keys):
    q = pulls(*keys)
    assert tuple(q["p"]) == tuple(p for p in PANELS[head] if p in q["p"])
    assert len(q["p"]) == (4 if head == "fig12b" else 3)
    assert np.all(np.diff(q["rho_contact"]) < 0)
    assert np.all(np.diff(q["G"]) < 0)
    for p, least, rho in zip(q["p"], q["G"], q["rho_contact"], strict=True):
        t = read(f"{head}_p_{p:g}")
        assert least <= t["G"].min()
        assert least == pytest.approx(t["G"].min(), rel=0.02)
        assert t["rho_contact"][0] < rho < t["rho_contact"][-1]


@pytest.mark.parametrize(
    ("more", "less", "pressures"),
    [("fig11b", "fig11a", (1.2, 1.4, 1.6)), ("fig12a", "fig11b", (1.4, 1.6))],
)
def test_stiffer_material_and_substrate_release_more(more, less, pressures):
    for p in pressures:
        a, b = read(f"{more}_p_{p:g}"), read(f"{less}_p_{p:g}")
        assert np.array_equal(a["rho_contact"], b["rho_contact"])
        assert np.all(a["G"] > b["G"])


def test_prestretch_releases_more():
    """At equal p the curves of beta = 2 are farther below their pressure of first contact."""
    stretched, flat = read("fig12b_p_2.4"), read("fig11b_p_2.4")
    rows = np.isin(stretched["rho_contact"], flat["rho_contact"])
    assert np.all(stretched["G"][rows] > flat["G"])
    one, two = pulls(0.1, 1, 50), pulls(0.1, 2, 50)
    ratio = [q["p"] / onset(case) for q, case in ((one, MR_1), (two, MR_2))]
    both = (ratio[0] >= ratio[1].min()) & (ratio[0] <= ratio[1].max())
    assert both.any()
    for column in ("rho_contact", "G"):
        assert np.all(np.interp(ratio[0][both], ratio[1], two[column]) > one[column][both])


# -- the scheme of the paper ---------------------------------------------------------------------


def test_freezing_scheme_is_of_first_order():
    t = read("freezing_scheme")
    assert t["delta_t"][0] == 0
    error = t["p"][1:] - t["p"][0]
    assert np.all(error > 0)
    assert np.log2(error[1:] / error[:-1]) == pytest.approx([1, 1, 1], abs=0.05)
    assert t["p"][-1] / t["p"][0] - 1 == pytest.approx(0.026, abs=0.001)  # delta_t = 0.01
    assert abs(about("freezing_scheme")["extrapolated_minus_continuous"]) < 2e-5
