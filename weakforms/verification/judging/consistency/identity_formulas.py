"""Formulas of the identities: columns and profiles of a solution by others of the same solution."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from weakforms.results import Field, Result, State
from weakforms.verification.judging.bounds import compare
from weakforms.verification.judging.consistency import quadrature
from weakforms.verification.judging.consistency.identities import Columns, Found, Identity, equal

PAPER_GAMMA = 1000.0 * 9.81 * 0.010**2 / (0.2111e6 * 0.1e-3)
"""Weight of the liquid of Papers 4 and 5 by their data: water, ``Ao`` = 1 cm, ``C1`` = 0.2111 MPa, 0.1 mm."""


def mooney_rivlin(lam1: np.ndarray, lam2: np.ndarray, ratio: float) -> tuple[np.ndarray, ...]:
    r"""Energy :math:`I_1 - 3 + \alpha(I_2 - 3)` of an incompressible sheet and its two derivatives."""
    third = 1 / (lam1 * lam2)
    energy = lam1**2 + lam2**2 + third**2 - 3
    energy = energy + ratio * (lam1**-2 + lam2**-2 + third**-2 - 3)
    first = 2 * (lam1 - third**2 / lam1) + 2 * ratio * (lam1 * lam2**2 - lam1**-3)
    second = 2 * (lam2 - third**2 / lam2) + 2 * ratio * (lam2 * lam1**2 - lam2**-3)
    return energy, first, second


def cauchy_resultant(which: int) -> Any:
    """Cauchy resultants of that law: ``t1 = H w_1/lam2``, ``t2 = H w_2/lam1``."""

    def by(result: Result, _: State, c: Columns) -> np.ndarray:
        derivative = law_of(result, c)[which]
        return thickness(result, c) * derivative / c["lam2" if which == 1 else "lam1"]

    return by


def law_of(result: Result, c: Columns) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Energy of that law and its derivatives; a sheet that wrinkles is as wide as without hoop stress."""
    relaxed = result.parameters.get("energy") == "relaxed"
    lam2 = np.maximum(c["lam2"], c["lam1"] ** -0.5) if relaxed else c["lam2"]
    return mooney_rivlin(c["lam1"], lam2, result.parameters["alpha"])


def thickness(result: Result, c: Columns) -> np.ndarray | float:
    """Thickness over ``h`` along a profile: given as text, linear over the disk's radius, or uniform."""
    given = result.parameters
    if given.get("thickness") is not None:
        from weakforms.problems.meridian.thickness import Thickness  # needs UFL

        coordinate = next(name for name in ("X", "t", "Z") if name in c)
        others = {"L": given["L"]} if "L" in given else {}
        return Thickness(given["thickness"], coordinate, tuple(others)).at(c[coordinate], **others)
    if given.get("uneven") and "Z" in c:
        return 1 + given["uneven"] * 2 * c["Z"] / given["lf"]
    return given["M"] + 2 * (1 - given["M"]) * c["X"] if "M" in given and "X" in c else 1.0


def hamiltonian(result: Result, _: State, c: Columns) -> np.ndarray:
    """First integral of the free tube."""
    energy, first, _second = law_of(result, c)
    return energy - c["lam1"] * first


def axial_force(result: Result, state: State, c: Columns) -> np.ndarray:
    """Its other first integral in the middle, where the meridian runs along the axis."""
    _, first, _second = mooney_rivlin(c["lam1"], c["lam2"], result.parameters["alpha"])
    at = np.where(np.arange(len(first)) == 0, 1.0, np.nan)
    p = state.quantities["p"].value
    return at * (np.sqrt(prestretch(result, state)) * first - p * c["rho"] ** 2 / 2)


def tube_potential(result: Result, state: State, profile: Field) -> quadrature.Estimated:
    """Elastic energy of the half tube's profile less pressure times volume."""
    x, c = profile.columns["Z"], profile.columns
    q = {name: quantity.value for name, quantity in state.quantities.items()}
    delta1 = prestretch(result, state)
    energy, *_ = law_of(result, c)
    stored, doubt = quadrature.integral(x, energy / np.sqrt(delta1), x)
    volume, more = quadrature.integral(x, c["rho"] ** 2 / 2, c["eta"])
    noise = 10 * max(profile.uncertainty[name] for name in ("lam1", "lam2", "rho")) * x[-1]
    return stored - q["p"] * volume, doubt + abs(q["p"]) * more + noise


def meridional_curvature(_: Result, state: State, profile: Field) -> quadrature.Estimated | None:
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


def curvature_by_balance(_: Result, state: State, profile: Field) -> quadrature.Estimated | None:
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


def prestretch(result: Result, state: State) -> float:
    """``delta1`` of a tube's state: a parameter, or an unknown along a fold line."""
    known = state.quantities.get("delta1")
    return result.parameters["delta1"] if known is None else known.value


def hoop_stretch(result: Result, state: State, c: Columns) -> np.ndarray:
    """Hoop stretch of the tube: the radius over the one before the pre-stretch."""
    return c["rho"] / np.sqrt(prestretch(result, state))


def middle_displacement(_: Result, __: State, profile: Field) -> quadrature.Estimated:
    """Displacement of the tube's middle by its radius."""
    return float(profile.columns["rho"][0]) - 1, profile.uncertainty["rho"]


def directions(result: Result) -> int:
    """Directions in which a test piece is pulled by the same force."""
    return 2 if result.parameters["loading"] == "equibiaxial" else 1


def weight_of(result: Result) -> float:
    """Weight of the liquid: the parameter ``gamma``, or that of the papers' data."""
    given = result.parameters.get("gamma")
    return PAPER_GAMMA if given is None else given


def pressure_on(result: Result, state: State, c: Columns) -> np.ndarray | float:
    """Pressure of the gas, or of the liquid at the heights of a profile."""
    q = state.quantities
    return q["p"].value if "p" in q else weight_of(result) * np.maximum(q["zw"].value - c["z"], 0.0)


def axial_under_liquid(result: Result, state: State, c: Columns) -> np.ndarray:
    """Axial force a reference angle: the tension's part along the axis less the pressure's on the section."""
    # A membrane that sags hangs down below its ring; where it turns the samples do not tell which way it
    # runs.
    steps = np.sign(np.diff(c["z"], prepend=2 * c["z"][0] - c["z"][1], append=2 * c["z"][-1] - c["z"][-2]))
    upwards = np.where(steps[1:] == steps[:-1], steps[1:], np.nan)
    return upwards * c["tension"] / np.hypot(1, c["slope"]) - pressure_on(result, state, c) * c["r"] ** 2 / 2


def sphere_tension(result: Result, _: State, c: Columns) -> np.ndarray:
    """Meridional tension a reference angle: the law at the stretches, or uniaxial where it is wrinkled."""
    lam2 = np.maximum(c["lam2"], c["lam1"] ** -0.5)
    return thickness(result, c) * np.sin(c["t"]) * mooney_rivlin(c["lam1"], lam2, result.parameters["c2"])[1]


def meridional_slope(_: Result, __: State, ___: Columns, r: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Meridional stretch by the derivatives of the meridian."""
    return np.hypot(r, z)


def axial_by_slopes(result: Result, state: State, c: Columns, _: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Axial force a reference angle, with the direction of the meridian by derivatives."""
    return c["tension"] * z / c["lam1"] - pressure_on(result, state, c) * c["r"] ** 2 / 2


def maxwell() -> Identity:
    """At Maxwell's pressure the potential of both phases is that of the branch there."""

    def look(result: Result) -> Iterator[Found]:
        branch, known = result.branches[0], result.quantities
        v, pi = (np.asarray(branch.columns[name], float) for name in ("V", "Pi"))
        for phase in ("thin", "thick") if "Pi_maxwell" in known else ():
            there = known[f"lam1_{phase}"].value * known[f"lam2_{phase}"].value ** 2
            if v[0] <= there <= v[-1] and np.all(np.diff(v) > 0):
                expected, doubt = quadrature.value_at(v, pi, there)
                own = known["Pi_maxwell"]
                size = max(abs(expected), 0.02)
                yield "Pi_maxwell", phase, compare(own.value, own.uncertainty, expected, doubt, size)

    return Identity("Pi_maxwell", "Pi_maxwell is the potential of both phases", look)


def stability_change(result: Result, which: int, name: str) -> float | None:
    """A number of the first change of stability (0) or of the last one (-1); ``None`` without any."""
    found = [p for p in result.special_points if p.kind == "stability_change"]
    return found[which].values[name] if found else None


def times_grid(result: Result, each: int, ends: int) -> float | None:
    """So many times the rectangles, or the nodes, of a tube's grid."""
    given = result.parameters
    if given["geometry"] != "tube":
        return None
    return each * (given["meridional"] + ends) * given["circumferential"]


def change_direction(result: Result) -> Iterator[Found]:
    """More negative eigenvalues after a change than before it, or fewer; one of two signs on its sides."""
    for point in result.special_points:
        if point.kind == "stability_change":
            wrong = not point.values["Lambda_1"] < 0 < point.values["Lambda_1_stable"]
            yield "Lambda_1_stable", point.kind, compare(float(wrong), 0.0, 0.0, 0.0, 1.0)
            columns = result.branch(point.branch).columns
            after = int(np.searchsorted(columns["zw"], point.values["zw"]))
            count = columns["n_negative"][after - 1 : after + 1]
            # Several changes may lie between two points of the walk.
            if len(count) == 2 and (count[0] == 0) != (count[1] == 0):
                expected = float(np.sign(count[1] - count[0]))
                yield "direction", point.kind, compare(point.values["direction"], 0.0, expected, 0.0, 1.0)


def surface_shape(result: Result) -> Iterator[Found]:
    """Height and largest radius of a surface of triangles, and the largest displacement of its mode."""
    for state in result.states:
        for shape in (f for f in state.fields if f.name == "surface"):
            c = shape.columns
            given = result.parameters
            numbers = {
                "z": (c["z"].max(), given["delta"] * given["L"]),
                "r_max": (state.quantities["r_max"].value, float(np.hypot(c["x"], c["y"]).max())),
                "mode": (1.0, float(np.sqrt(c["u_x"] ** 2 + c["u_y"] ** 2 + c["u_z"] ** 2).max())),
            }
            for name, (here, there) in numbers.items():
                yield name, str(state.at), compare(here, 0.0, there, 1e-12 * there, there)


def inside_of_front(result: Result, state: State, _: Field) -> quadrature.Estimated:
    """Part of the area of an annulus inside of its front."""
    a, front = result.parameters["a"], state.quantities["R_front"]
    return (front.value**2 - a**2) / (1 - a**2), 2 * (front.uncertainty or 0.0) / (1 - a**2)


def ring(result: Result, c: Columns) -> np.ndarray:
    """Distance of the points of a stress-free torus from its axis."""
    return 1 + result.parameters["b"] * np.cos(c["t"])


def swelling(result: Result, state: State, _: Field) -> quadrature.Estimated:
    """Volume of a torus over that without stress."""
    without, volume = 2 * np.pi**2 * result.parameters["b"] ** 2, state.quantities["V"]
    return volume.value / without, (volume.uncertainty or 0.0) / without


def of_uniform(name: str, column: str, statement: str, other: Callable[[Columns], np.ndarray]) -> Identity:
    """A column of balloons and long tubes by the others and by the parameters."""

    def look(result: Result) -> Iterator[Found]:
        given = result.parameters
        yield from equal(column, statement, lambda columns: other({**given, **columns})).look(result)

    return Identity(name, statement, look)


def uniform_volume(c: Columns) -> np.ndarray:
    """``2 lam^3/3`` of a balloon, ``lam1 lam2^2/2`` of a tube of unit length at rest, over ``2 pi``."""
    return 2 * c["lam"] ** 3 / 3 if "lam" in c else c["lam1"] * c["lam2"] ** 2 / 2


def uniform_tension(c: Columns) -> np.ndarray:
    """The least resultant that balances pressure, and the force of free ends."""
    if "lam" in c:
        return c["p"] * c["lam"] / 2
    return np.minimum(c["p"] * c["lam2"], (c["force"] + c["p"] * c["lam2"] ** 2 / 2) / c["lam2"])
