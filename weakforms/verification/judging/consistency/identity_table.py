"""Which identities hold for the columns of which problem; scalings are those of the problems' ``scales``."""

from __future__ import annotations

from typing import Any

import numpy as np

from weakforms.results import Field, Result, State
from weakforms.verification.judging.consistency import quadrature
from weakforms.verification.judging.consistency.identities import (
    Columns,
    Given,
    Identity,
    equal,
    positive,
    slope,
    stable,
    work,
)
from weakforms.verification.judging.consistency.identity_profiles import (
    at_front,
    derived,
    enclosed,
    end,
    extreme,
    field,
    middle,
    one_at,
    rate,
    read,
    wetted,
    zone,
)

LARGEST, SMALLEST = np.argmax, np.argmin

PAPER_GAMMA = 1000.0 * 9.81 * 0.010**2 / (0.2111e6 * 0.1e-3)
"""Weight of the liquid of Papers 4 and 5 by their data: water, ``Ao`` = 1 cm, ``C1`` = 0.2111 MPa, 0.1 mm."""


def _free(given: Given) -> bool:
    return given.get("contact", "none") == "none"


def _in_contact(given: Given) -> bool:
    return not _free(given) and given.get("phase") != "peeling"


def _inflating(given: Given) -> bool:
    return _in_contact(given) and given.get("phase") != "deflation"


def _half(given: Given) -> bool:
    return _free(given) and given.get("extent", "half") == "half"


def _conserves(given: Given) -> bool:
    return given.get("phase") != "peeling"


def _of_paper(given: Given) -> bool:
    return "model" not in given


def _over(identity: Identity, over: Any) -> Identity:
    return Identity(identity.name, identity.statement, identity.look, over)


def _mooney_rivlin(lam1: np.ndarray, lam2: np.ndarray, ratio: float) -> tuple[np.ndarray, ...]:
    r"""Energy :math:`I_1 - 3 + \alpha(I_2 - 3)` of an incompressible sheet and its two derivatives."""
    third = 1 / (lam1 * lam2)
    energy = lam1**2 + lam2**2 + third**2 - 3
    energy = energy + ratio * (lam1**-2 + lam2**-2 + third**-2 - 3)
    first = 2 * (lam1 - third**2 / lam1) + 2 * ratio * (lam1 * lam2**2 - lam1**-3)
    second = 2 * (lam2 - third**2 / lam2) + 2 * ratio * (lam2 * lam1**2 - lam2**-3)
    return energy, first, second


def _cauchy(which: int) -> Any:
    """Cauchy resultants of that law: ``t1 = w_1/lam2``, ``t2 = w_2/lam1``."""

    def by(result: Result, _: State, c: Columns) -> np.ndarray:
        derivative = _mooney_rivlin(c["lam1"], c["lam2"], result.parameters["alpha"])[which]
        return derivative / c["lam2" if which == 1 else "lam1"]

    return by


def _hamiltonian(result: Result, _: State, c: Columns) -> np.ndarray:
    """First integral of the free tube."""
    energy, first, _second = _mooney_rivlin(c["lam1"], c["lam2"], result.parameters["alpha"])
    return energy - c["lam1"] * first


def _force(result: Result, state: State, c: Columns) -> np.ndarray:
    """Its other first integral in the middle, where the meridian runs along the axis."""
    _, first, _second = _mooney_rivlin(c["lam1"], c["lam2"], result.parameters["alpha"])
    at = np.where(np.arange(len(first)) == 0, 1.0, np.nan)
    p = state.quantities["p"].value
    return at * (np.sqrt(result.parameters["delta1"]) * first - p * c["rho"] ** 2 / 2)


def _tube_potential(result: Result, state: State, profile: Field) -> quadrature.Estimated:
    """Elastic energy of the half tube's profile less pressure times volume."""
    x, c = profile.columns["Z"], profile.columns
    q = {name: quantity.value for name, quantity in state.quantities.items()}
    delta1 = q.get("delta1", result.parameters.get("delta1"))
    energy, *_ = _mooney_rivlin(c["lam1"], c["lam2"], result.parameters["alpha"])
    stored, doubt = quadrature.integral(x, energy / np.sqrt(delta1), x)
    volume, more = quadrature.integral(x, c["rho"] ** 2 / 2, c["eta"])
    noise = 10 * max(profile.uncertainty[name] for name in ("lam1", "lam2", "rho")) * x[-1]
    return stored - q["p"] * volume, doubt + abs(q["p"]) * more + noise


def _bend(_: Result, state: State, profile: Field) -> quadrature.Estimated | None:
    """Curvature of the disk's meridian at the front, by polynomials through the points beyond it."""
    place = state.quantities["X_contact"].value if "X_contact" in state.quantities else 0.0
    x = profile.columns["X"]
    radii, heights = (quadrature.beyond(x, profile.columns[n], place, 2) for n in ("rho", "eta"))
    if place <= 0 or radii is None or heights is None:
        return None
    value, doubt = quadrature.spread(
        [
            (z1 * r2 - r1 * z2) / np.hypot(r1, z1) ** 3
            for (_, r1, r2), (_, z1, z2) in zip(radii, heights, strict=True)
        ]
    )
    noise = profile.uncertainty["rho"] + profile.uncertainty["eta"]
    return value, doubt + quadrature.gain(x, place, 2) * noise / np.hypot(radii[0][1], heights[0][1]) ** 2


def _balance(_: Result, state: State, profile: Field) -> quadrature.Estimated | None:
    """Minus the curvature of the tube's meridian at the front, by the balance ``t1 k1 + t2 k2 = p``."""
    place = state.quantities["Z_front"].value if "Z_front" in state.quantities else 0.0
    x, names = profile.columns["Z"], ("rho", "eta", "t1", "t2")
    sides = [quadrature.beyond(x, profile.columns[name], place, 1) for name in names]
    if place <= 0 or None in sides:
        return None
    p = state.quantities["p"].value
    return quadrature.spread(
        [
            (t2 * z1 / np.hypot(r1, z1) / r - p) / t1
            for (r, r1), (_, z1), (t1, _), (t2, _) in zip(*sides, strict=True)
        ]
    )


def _hoop(result: Result, state: State, c: Columns) -> np.ndarray:
    known = state.quantities.get("delta1")
    return c["rho"] / np.sqrt(result.parameters["delta1"] if known is None else known.value)


def _displacement(_: Result, __: State, profile: Field) -> quadrature.Estimated:
    return float(profile.columns["rho"][0]) - 1, profile.uncertainty["rho"]


def _directions(result: Result) -> int:
    """Directions in which a test piece is pulled by the same force."""
    return 2 if result.parameters["loading"] == "equibiaxial" else 1


def _gamma(result: Result) -> float:
    given = result.parameters.get("gamma")
    return PAPER_GAMMA if given is None else given


def _axial(result: Result, state: State, c: Columns) -> np.ndarray:
    """Axial force a reference angle: the tension's part along the axis less the pressure's on the section."""
    q = state.quantities
    pressure = q["p"].value if "p" in q else _gamma(result) * np.maximum(q["zw"].value - c["z"], 0.0)
    # A membrane that sags hangs down below its ring; where it turns the samples do not tell which way it
    # runs.
    steps = np.sign(np.diff(c["z"], prepend=2 * c["z"][0] - c["z"][1], append=2 * c["z"][-1] - c["z"][-2]))
    upwards = np.where(steps[1:] == steps[:-1], steps[1:], np.nan)
    return upwards * c["tension"] / np.hypot(1, c["slope"]) - pressure * c["r"] ** 2 / 2


def _sphere_tension(result: Result, _: State, c: Columns) -> np.ndarray:
    """Meridional tension a reference angle: the law at the stretches, or uniaxial where it is wrinkled."""
    lam2 = np.maximum(c["lam2"], c["lam1"] ** -0.5)
    return np.sin(c["t"]) * _mooney_rivlin(c["lam1"], lam2, result.parameters["c2"])[1]


SMALLEST_RESULTANT = "the smallest resultant is that of the profile"

IDENTITIES: dict[str, tuple[Identity, ...]] = {
    "circular": (
        _over(work("p", lambda _, c: -c["V"]), _conserves),
        # In peeling the front is among the freedoms counted, and the eigenvalues are those at a held front.
        _over(stable(), lambda given: given.get("phase") != "peeling"),
        field("lam2", "lam2 = rho beta/X", lambda r, _, c: c["rho"] * r.parameters["beta"] / c["X"]),
        read("t0", "height of the pole", end("eta", 0)),
        read("lam_pole", "stretch of the pole", end("lam1", 0)),
        read("lam1_rim", "stretch of the rim", end("lam1", -1)),
        read("sigma_pole", "contact stress of the pole", end("sigma", 0)),
        read("t_min", SMALLEST_RESULTANT, extreme(SMALLEST, "t1", "t2"), _free),
        read("V", "volume below the profile", enclosed("rho", "eta", -0.5), _free),
        read("rho_contact", "radius of the profile at the front", at_front("X_contact", "rho")),
        read("kappa", "curvature of the profile outside the front", _bend),
        _over(field("t1", "t1 is that of the law at the stretches", _cauchy(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", _cauchy(2)), _of_paper),
    ),
    "tube": (
        work("p", lambda _, c: -c["V"]),
        stable(),
        read("u_max", "displacement of the middle", _displacement, _half),
        read("lam1_mid", "meridional stretch of the middle", end("lam1", 0), _half),
        read("lam2_mid", "hoop stretch of the middle", end("lam2", 0)),
        field("lam2", "lam2 = rho/sqrt(delta1)", _hoop),
        read("t1_mid", "resultant of the middle", end("t1", 0), _half),
        read("t2_min", SMALLEST_RESULTANT, extreme(SMALLEST, "t2"), _in_contact),
        read("V", "volume within the profile", enclosed("rho", "eta", 0.5), _half),
        read("spring_max", "largest of the springs", extreme(SMALLEST, "f_k", factor=-1.0), _inflating),
        read("kappa", "curvature by the balance of the free part at the front", _balance),
        read("Pi", "potential of the profile", _tube_potential, lambda g: _half(g) and _of_paper(g)),
        _over(field("t1", "t1 is that of the law at the stretches", _cauchy(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", _cauchy(2)), _of_paper),
        _over(field("H", "H = w - lam1 w_1", _hamiltonian), lambda g: _of_paper(g) and _free(g)),
        _over(field("F_axial", "axial force at the middle", _force), lambda g: _of_paper(g) and _half(g)),
    ),
    "tube_fold": (
        read("u_max", "displacement of the middle", _displacement),
        field("lam2", "lam2 = rho/sqrt(delta1)", _hoop),
        read("lam1_mid", "meridional stretch of the middle", end("lam1", 0)),
        read("t1_mid", "resultant of the middle", end("t1", 0)),
        read("V", "volume within the profile", enclosed("rho", "eta", 0.5)),
        read("Pi", "potential of the profile", _tube_potential, _of_paper),
        _over(field("t1", "t1 is that of the law at the stretches", _cauchy(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", _cauchy(2)), _of_paper),
    ),
    "hemisphere": (
        stable(),
        rate("zw", wetted("r", "z", 0.5), _gamma),
        read("V", "volume within the profile", enclosed("r", "z", 0.5)),
        read("N", "tension at the equator", end("tension", -1)),
        read("z_pole", "height of the pole", end("z", 0)),
        read("lam_pole", "stretch of the pole", end("lam1", 0)),
        read("r_max", "largest radius of the profile", extreme(LARGEST, "r")),
        read("gw_max", "largest value of the profile's gw", extreme(LARGEST, "gw")),
        read("gw_min", "smallest value of the profile's gw", extreme(SMALLEST, "gw")),
        read("wrinkled_fraction", "zones between the fronts where gw < 1", zone("t_front")),
        field("gw", "gw = lam2 sqrt(lam1)", lambda _, __, c: c["lam2"] * np.sqrt(c["lam1"])),
        field("lam2", "lam2 = r/sin t", lambda _, __, c: c["r"] / np.sin(c["t"])),
        derived("lam1", "lam1 is the slope of the profile", np.hypot, "r", "z"),
        one_at("t_front", "gw"),
        _over(field("tension", "tension is that of the law at the stretches", _sphere_tension), _of_paper),
    ),
    "wrinkled_tube": (
        stable(),
        _over(work("p", lambda _, c: -c["V"]), lambda given: given.get("load") == "gas"),
        _over(rate("zw", wetted("r", "z", 0.5), _gamma), lambda given: given.get("load", "fluid") == "fluid"),
        read("V", "volume within the profile", enclosed("r", "z", 0.5)),
        read("N", "tension at the lower end", end("tension", 0)),
        read("r_max", "largest radius of the profile", extreme(LARGEST, "r")),
        read("gw_max", "largest value of the profile's gw", extreme(LARGEST, "gw")),
        read("gw_min", "smallest value of the profile's gw", extreme(SMALLEST, "gw")),
        read("wrinkled_fraction", "zones between the fronts where gw < 1", zone("Z_front")),
        field("gw", "gw = lam2 sqrt(lam1)", lambda _, __, c: c["lam2"] * np.sqrt(c["lam1"])),
        field("lam2", "lam2 = r over the undeformed radius", lambda _, __, c: c["r"]),
        _over(field("axial", "axial = N cos(phi) - P r^2/2", _axial), lambda given: "load_end" not in given),
        derived("lam1", "lam1 is the slope of the profile", np.hypot, "r", "z"),
        derived("slope", "slope is dr/dz of the profile", np.divide, "r", "z"),
        one_at("Z_front", "gw"),
    ),
    "fluid_tube": (
        work("zw", lambda result, c: -result.parameters["gamma"] * c["V"]),
        read("T1_ring", "tension at the ring", end("T1", 0)),
        read("T2_ring", "hoop tension at the ring", end("T2", 0)),
        read("r_mid", "radius of the middle", middle("r")),
        read("T1_mid", "tension of the middle", middle("T1")),
        read("T2_mid", "hoop tension of the middle", middle("T2")),
        derived("lam1", "lam1 is the slope of the profile", np.hypot, "r", "z"),
        read("r_max", "largest radius of the profile", extreme(LARGEST, "r")),
        read("r_front", "radius of the profile at the free surface", at_front("Z_front", "r", kink=False)),
        read("zw", "height of the profile at the free surface", at_front("Z_front", "z", kink=False)),
        read("V", "volume of the liquid in the profile", wetted("r", "z", np.pi)),
        field("lam2", "lam2 = r", lambda _, __, c: c["r"]),
    ),
    "sphere": (
        _over(work("P", lambda _, c: -(c["lam"] ** 3) / 3), lambda given: not given.get("vary")),
        equal("lam1", "both stretches are one", lambda c: c["lam"]),
        equal("lam2", "both stretches are one", lambda c: c["lam"]),
        read("lam1", "the profile's stretch", end("lam1", 0)),
        read("lam2", "the profile's stretch", end("lam2", 0)),
        stable(),
    ),
    "infinite_tube": (
        work("p", lambda _, c: -c["V"] / 2),
        positive("lam1", "lam2"),
        read("lam1", "the profile's stretch", end("lam1", 0)),
        read("lam2", "the profile's stretch", end("lam2", 0)),
        equal("V", "volume of the cylinder", lambda c: c["lam1"] * c["lam2"] ** 2),
        stable(),
    ),
    "homogeneous": (
        work("T", lambda result, c: -_directions(result) * c["lam"]),
        equal("lam1", "the stretch along the piece", lambda c: c["lam"]),
        read("lam1", "the profile's stretch", end("lam1", 0)),
        read("lam2", "the profile's stretch", end("lam2", 0)),
        positive("lam1", "lam2", "lam_across"),
        stable(),
    ),
    "wrinkled_patch": (slope("U", "e", "U_e"), slope("W", "e", "W_e"), slope("W_e", "e", "W_ee")),
}
"""By problem; each verdict of a case's solution states all that apply."""
