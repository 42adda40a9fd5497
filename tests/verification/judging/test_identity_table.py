"""Each closed form of the table of identities is the one stated here, on made-up solutions.

The solutions are polynomials: a meridian whose columns all differ, and a trace whose work is integrated
exactly. Parameters are away from one, so that a factor in the wrong place shows.
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from weakforms.results import Branch, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.judging.consistency.identities import SHARP
from weakforms.verification.judging.consistency.identity_table import IDENTITIES

X = np.linspace(-0.4, 1.2, 161)
"""Coordinate of the meridian; zero is one of its points, and neither an end nor the middle."""
R = Polynomial([1.0, 0.5, -0.4])
Z = Polynomial([0.5, 1.0, 0.2])
LAM1 = Polynomial([1.2, 0.3, 0.1])
LAM2 = Polynomial([1.5, -0.2, 0.1])
T1 = Polynomial([0.9, 0.25, 0.3])
T2 = Polynomial([1.1, -0.35, 0.2])
SHARES = {
    "rho": R,
    "r": R,
    "eta": Z,
    "z": Z,
    "lam1": LAM1,
    "lam2": LAM2,
    "t1": T1,
    "t2": T2,
    "T1": T1,
    "T2": T2,
}
SHARES |= {
    "tension": T1,
    "sigma": T2,
    "f_k": Polynomial([-0.2, -0.6, 0.5]),
    "gw": Polynomial([1.3, -0.5, 0.6]),
}
FRONT = 0.333
FIRST, LAST, MIDDLE = X[0], X[-1], (X[0] + X[-1]) / 2
SPREAD = 1e-9


def swept(upper: float) -> float:
    """The integral of r^2 dz from the first point of the meridian."""
    whole = (R * R * Z.deriv()).integ()
    return whole(upper) - whole(FIRST)


def least(*columns: Polynomial, sign: float = 1.0) -> float:
    """The smallest value of polynomials of degree two on the meridian; the largest for the other sign."""
    places = [FIRST, LAST, *(c.deriv().roots()[0] for c in columns)]
    places = [x for x in places if FIRST <= x <= LAST]
    return sign * min(sign * c(x) for c in columns for x in places)


HEAVY = {"gw_max": least(SHARES["gw"], sign=-1), "gw_min": least(SHARES["gw"]), "r_max": least(R, sign=-1)}
STATES = {
    "circular": {
        "t0": Z(FIRST),
        "lam_pole": LAM1(FIRST),
        "lam1_rim": LAM1(LAST),
        "sigma_pole": T2(FIRST),
        "t_min": least(T1, T2),
        "V": -0.5 * swept(LAST),
        "rho_contact": R(FRONT),
    },
    "tube": {
        "lam1_mid": LAM1(FIRST),
        "lam2_mid": LAM2(0.0),
        "t1_mid": T1(FIRST),
        "t2_min": least(T2),
        "V": 0.5 * swept(LAST),
        "spring_max": -least(SHARES["f_k"]),
    },
    "tube_fold": {"lam1_mid": LAM1(FIRST), "t1_mid": T1(FIRST), "V": 0.5 * swept(LAST)},
    "diagram": {
        "lam1_mid": LAM1(FIRST),
        "t0": Z(FIRST),
        "lam_pole": LAM1(FIRST),
        "V": 0.5 * swept(LAST),
    },
    "hemisphere": HEAVY
    | {"V": 0.5 * swept(LAST), "N": T1(LAST), "z_pole": Z(FIRST), "lam_pole": LAM1(FIRST)},
    "wrinkled_tube": HEAVY | {"V": 0.5 * swept(LAST), "N": T1(FIRST)},
    "fluid_tube": {
        "T1_ring": T1(FIRST),
        "T2_ring": T2(FIRST),
        "r_mid": R(MIDDLE),
        "T1_mid": T1(MIDDLE),
        "T2_mid": T2(MIDDLE),
        "r_max": least(R, sign=-1),
        "r_front": R(FRONT),
        "zw": Z(FRONT),
        "V": np.pi * swept(FRONT),
    },
    "sphere": {"lam1": LAM1(FIRST), "lam2": LAM2(FIRST)},
    "infinite_tube": {"lam1": LAM1(FIRST), "lam2": LAM2(FIRST)},
    "homogeneous": {"lam1": LAM1(FIRST), "lam2": LAM2(FIRST)},
    "torus": {"r_out": R(FIRST), "r_in": R(LAST), "v": swept(LAST) / (2 * np.pi * 0.16)},
    "annulus": {
        "lam1_in": LAM1(FIRST),
        "lam1_out": LAM1(LAST),
        "gw_in": SHARES["gw"](FIRST),
        "gw_out": SHARES["gw"](LAST),
    },
}
"""Columns of a state by its meridian."""

PROFILES = {
    ("circular", "lam2"): lambda c: 1.3 * c["rho"] / c["X"],
    ("hemisphere", "gw"): lambda c: c["lam2"] * c["lam1"] ** 0.5,
    ("hemisphere", "lam2"): lambda c: c["r"] / np.sin(c["t"]),
    ("wrinkled_tube", "gw"): lambda c: c["lam2"] * c["lam1"] ** 0.5,
    ("wrinkled_tube", "lam2"): lambda c: c["r"],
    ("wrinkled_tube", "slope"): lambda c: R.deriv()(X) / Z.deriv()(X),
    ("fluid_tube", "lam2"): lambda c: c["r"],
    ("torus", "lam2"): lambda c: c["r"] / (1 + 0.4 * np.cos(c["t"])),
    ("annulus", "gw"): lambda c: c["lam2"] * c["lam1"] ** 0.5,
}
"""Columns of a meridian by its others."""

S = np.linspace(0.0, 1.0, 60)
LOAD, VOLUME, STRETCH = Polynomial([0.3, 1.0, 0.25]), Polynomial([1.5, 0.4, 0.8]), Polynomial([1.1, 0.7])
TRACES = {
    "circular": ("p", -VOLUME),
    "tube": ("p", -VOLUME),
    "torus": ("p", -VOLUME),
    "controls": ("p", -VOLUME),
    "membrane": ("p", -VOLUME),
    "rectangle": ("p", -VOLUME),
    "hemisphere": ("p", -VOLUME),
    "wrinkled_tube": ("p", -VOLUME),
    "fluid_tube": ("zw", -2.5 * VOLUME),
    "sphere": ("P", -(STRETCH**3) / 3),
    "infinite_tube": ("p", -VOLUME / 2),
}
"""Loads, and what the potential changes by along each."""
SLOPES = {
    "wrinkled_patch": ({"U": VOLUME, "U_e": VOLUME.deriv()}, {"U_e"}),
    "annulus": ({"U": VOLUME, "M": VOLUME.deriv()}, {"M"}),
}
CLOSED = {
    ("sphere", "lam1"): lambda c: c["lam"],
    ("sphere", "lam2"): lambda c: c["lam"],
    ("infinite_tube", "V"): lambda c: c["lam1"] * c["lam2"] ** 2,
    ("homogeneous", "lam1"): lambda c: c["lam"],
    ("torus", "virial"): lambda c: 3 * c["p"] * c["V"],
    ("torus", "Pi"): lambda c: c["U"] - c["p"] * c["V"],
    ("annulus", "U_edges"): lambda c: c["U"],
    ("annulus", "M_in"): lambda c: c["M"],
    ("annulus", "M_out"): lambda c: c["M"],
}
"""Columns of a trace by its others."""


def meridian(problem: str) -> dict[str, np.ndarray]:
    """The columns of the meridian; its coordinate comes first."""
    name = {"circular": "X", "hemisphere": "t", "torus": "t", "annulus": "R"}.get(problem, "Z")
    return {name: X} | {key: share(X) for key, share in SHARES.items()}


def solution(problem, profile, numbers=None, columns=None):
    """A solution with one state that was drawn at random, and a trace."""
    known = {"V": np.pi * swept(LAST), "X_contact": FRONT, "Z_front": FRONT, "zw": Z(FRONT)} | (numbers or {})
    quantities = {name: Quantity(float(value), SPREAD) for name, value in known.items()}
    state = State(
        {"u": 1.0}, "primary", quantities, (Field("profile", profile, dict.fromkeys(profile, SPREAD)),)
    )
    drawn = {"drawn": {"primary": {"points": [{"column": "u", "value": 1.0}]}}}
    spread = {name: np.full(len(values), 1e-12) for name, values in (columns or {}).items()}
    traces = [Branch("primary", "p", columns, spread)] if columns else []
    return Result(problem, {"beta": 1.3, "gamma": 2.5, "b": 0.4}, {}, drawn, {}, traces, states=[state])


def judged(problem: str, name: str, result: Result) -> bool:
    """Whether the identities of that name hold, sharply."""
    found = [item for i in IDENTITIES[problem] if i.name == name for item in i.look(result)]
    assert found
    return all(comparison.passed(SHARP) for *_, comparison in found)


@pytest.mark.parametrize(
    ("problem", "name"), [(p, name) for p, numbers in STATES.items() for name in numbers]
)
def test_a_number_of_a_state_is_that_of_its_meridian(problem, name):
    value = STATES[problem][name]
    assert judged(problem, name, solution(problem, meridian(problem), {name: value}))
    assert not judged(problem, name, solution(problem, meridian(problem), {name: 1.01 * value}))


@pytest.mark.parametrize(("problem", "name"), PROFILES)
def test_a_column_of_a_meridian_is_that_of_its_others(problem, name):
    columns = meridian(problem)
    with np.errstate(divide="ignore"):
        columns[name] = PROFILES[problem, name](columns)
    columns[name][~np.isfinite(columns[name])] = 0.0  # at the axis
    assert judged(problem, f"field_{name}", solution(problem, columns))
    columns[name] = 1.01 * columns[name]
    assert not judged(problem, f"field_{name}", solution(problem, columns))


@pytest.mark.parametrize("problem", TRACES)
def test_the_potential_changes_by_the_work_of_the_load(problem):
    load, weight = TRACES[problem]
    potential = (weight * LOAD.deriv()).integ()
    columns = {"V": VOLUME(S), "lam": STRETCH(S), "Pi": potential(S)} | {load: LOAD(S)}
    assert judged(problem, "work", solution(problem, meridian(problem), columns=columns))
    columns["Pi"] = 1.01 * columns["Pi"]
    assert not judged(problem, "work", solution(problem, meridian(problem), columns=columns))


@pytest.mark.parametrize(("load", "stress"), [("gam", "tau"), ("lam", "T_x"), ("kap", "M")])
def test_the_energy_of_a_sheet_changes_by_the_work_of_its_edges(load, stress):
    potential = (2.0 * VOLUME * LOAD.deriv()).integ()
    loading = {"gam": "shear", "lam": "strip", "kap": "bend"}[load]
    (held,) = (identity for identity in IDENTITIES["sheet"] if identity.over({"loading": loading}))
    for factor in (1.0, 1.01):
        result = solution(
            "sheet", {}, columns={stress: VOLUME(S), load: LOAD(S), "Pi": factor * potential(S)}
        )
        result.parameters["c"] = 2.0
        ((_, _, found),) = held.look(result)
        assert found.passed(SHARP) is (factor == 1.0)


@pytest.mark.parametrize("problem", SLOPES)
def test_a_column_is_the_slope_of_another(problem):
    given, names = SLOPES[problem]
    columns = {"e": S, "psi": S} | {name: column(S) for name, column in given.items()}
    for name in names:
        assert judged(problem, name, solution(problem, meridian(problem), columns=columns))
        wrong = columns | {name: 1.01 * columns[name]}
        assert not judged(problem, name, solution(problem, meridian(problem), columns=wrong))


@pytest.mark.parametrize(("problem", "name"), CLOSED)
def test_a_column_of_a_trace_is_that_of_its_others(problem, name):
    columns = {"lam": STRETCH(S), "lam1": LAM1(S), "lam2": LAM2(S), "U": VOLUME(S), "M": LOAD(S)}
    columns |= {"p": LOAD(S), "V": VOLUME(S)}
    columns |= {name: CLOSED[problem, name](columns)}
    same = {"lam1": LAM1(FIRST), "lam2": LAM2(FIRST)}
    assert judged(problem, name, solution(problem, meridian(problem), same, columns))
    columns[name] = 1.01 * columns[name]
    assert not judged(problem, name, solution(problem, meridian(problem), same, columns))


@pytest.mark.parametrize("stretches", [{"lam": STRETCH(S)}, {"lam1": LAM1(S), "lam2": LAM2(S)}])
def test_volume_and_tension_of_balloons_and_long_tubes_are_closed_forms(stretches):
    p, force = LOAD(S), 0.4
    if "lam" in stretches:
        volume, tension = 2 * stretches["lam"] ** 3 / 3, p * stretches["lam"] / 2
    else:
        volume, hoop = stretches["lam1"] * stretches["lam2"] ** 2 / 2, stretches["lam2"]
        tension = np.minimum(p * hoop, force / hoop + p * hoop / 2)
    right = {"p": p, **stretches, "V": volume, "t_min": tension}
    for name, column in (("volume", "V"), ("balance", "t_min")):
        for factor in (1.0, 1.01):
            result = solution("diagram", {}, columns=right | {column: factor * right[column]})
            result.parameters["force"] = force
            assert judged("diagram", name, result) is (factor == 1.0)


def test_a_column_that_should_be_positive_is_not_negative():
    columns = {name: STRETCH(S) for name in ("lam1", "lam2", "lam_across")}
    for problem, names in (("infinite_tube", ("lam1", "lam2")), ("homogeneous", tuple(columns))):
        assert judged(problem, "positive", solution(problem, meridian(problem), columns=columns))
        for name in names:
            bad = columns | {name: np.where(S[7] == S, -1e-6, columns[name])}
            assert not judged(problem, "positive", solution(problem, meridian(problem), columns=bad))


@pytest.mark.parametrize("problem", ["hemisphere", "wrinkled_tube"])
def test_the_potential_falls_with_the_level_by_the_weight_of_the_wetted_volume(problem):
    level, at = Z(FRONT) + np.linspace(-0.4, 0.6, 61), 24
    slope = -2.5 * 0.5 * swept(FRONT)

    def solved(factor: float) -> Result:
        potential = factor * slope * level + (level - level[at]) ** 2
        result = solution(problem, meridian(problem), columns={"zw": level, "Pi": potential})
        state = replace(result.states[0], at={"zw": float(level[at])})
        result.states = [state]
        result.numerics["drawn"]["primary"]["points"] = [{"column": "zw", "value": float(level[at])}]
        return result

    assert judged(problem, "rate", solved(1.0))
    assert not judged(problem, "rate", solved(1.01))


@pytest.mark.parametrize(("problem", "front"), [("hemisphere", "t_front"), ("wrinkled_tube", "Z_front")])
def test_zones_lie_between_fronts_at_which_the_function_is_one(problem, front):
    columns = meridian(problem)
    columns["gw"] = 1 + (X - 0.1) * (X - 0.7)
    numbers = {f"{front}_1": 0.1, f"{front}_2": 0.7, "wrinkled_fraction": 0.6 / (LAST - FIRST), "zw": 9.0}
    right = solution(problem, columns, numbers)
    if problem == "wrinkled_tube":
        del right.states[0].quantities["Z_front"]
    assert judged(problem, "wrinkled_fraction", right)
    assert judged(problem, f"one_at_{front}", right)
    wrong = solution(problem, columns, numbers | {f"{front}_2": 0.71, "wrinkled_fraction": 0.606 / 1.6})
    assert not judged(problem, "wrinkled_fraction", wrong)
    assert not judged(problem, f"one_at_{front}", wrong)


def test_the_ends_of_a_range_are_its_first_and_last_change_of_stability():
    result = solution("surface", meridian("surface"))
    result.special_points = [
        SpecialPoint("stability_change", "primary", "zw", {"zw": zw, "n": n}, {})
        for zw, n in ((1.5, 3.0), (2.5, 4.0), (3.5, 5.0))
    ]
    ends = {"lower": 1.5, "upper": 3.5, "n_lower": 3.0, "n_upper": 5.0}
    for name, value in ends.items():
        result.quantities = {name: Quantity(value)}
        assert judged("surface", f"{name} of the whole", result)
        result.quantities = {name: Quantity(1.01 * value)}
        assert not judged("surface", f"{name} of the whole", result)


def test_a_load_of_a_special_point_is_its_controls_value():
    result = solution("hemisphere", meridian("hemisphere"))
    for load, holds in ((2.5, True), (2.525, False)):
        point = SpecialPoint("limit_point", "primary", "zw", {"zw": 2.5, "load": load, "p": 1.0}, {})
        result.special_points = [point]
        assert judged("hemisphere", "load of special points", result) is holds
