"""Tables of closed forms, some up to a root: balloons, long tubes, test pieces of every law."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.closed_form import bodies as body
from reference_data.solvers.core.laws import BUILDERS, CONSTANTS, law
from reference_data.solvers.core.tables import Column, DisagreementError, Series, Table
from reference_data.solvers.core.two_estimates import both
from reference_data.solvers.registry import Builder

METHOD = (
    "(a) equilibrium and its derivatives from derivatives of the law worked out by hand; (b) the same from "
    "the energy alone, differentiated by contour integrals; critical points by scan and Brent's method, "
    "merging ones by Newton's (P' = P'' = 0), coexisting states by equal potentials (a) and equal areas (b)."
)
ABOUT = {
    "order": ("1", "1: first limit point met along the branch, 2: second"),
    "P": ("p r_o/(S h_o)", "pressure of the balloon"),
    "lam": ("1", "stretch"),
    "p": ("P R_o/(S h_o)", "pressure of the tube"),
    "lam1": ("1", "axial stretch"),
    "lam2": ("1", "hoop stretch"),
    "T": ("over S", "nominal stress"),
    "p_maxwell": ("P R_o/(S h_o)", "pressure at which two states have the same potential"),
    "lam1_thin": ("1", "axial stretch of the thin state"),
    "lam2_thin": ("1", "hoop stretch of the thin state"),
    "lam1_thick": ("1", "axial stretch of the thick state"),
    "lam2_thick": ("1", "hoop stretch of the thick state"),
}
LOOSE = (2e-10, 2e-9)
"""Uncertainties of merging points, which use second derivatives by differences."""
FLAT = (1e-11, 2e-9)
"""Uncertainties of stretches at limit points, where the pressure is stationary."""

SPHERE_END = 4.0
LIMITED = {"saint_venant_kirchhoff": 1.6, "harmonic": 2.0}
"""Stretches up to which uniaxial tests of compressible laws are tabulated; the tests end soon after."""
MERGES = {
    "mooney_rivlin": ("alpha", (0.2, 1.8)),
    "gent": ("jm", (18.0, 1.9)),
    "arruda_boyce": ("links", (5.3, 1.6)),
}
TUBES = {"mooney_rivlin": {"alpha": 0.1}, "ogden": {}, "gent": {}, "arruda_boyce": {}}
TUBE_END = {"mooney_rivlin": 6.0, "ogden": 9.0, "gent": 6.0, "arruda_boyce": 6.0}


SERIES = Series(
    "closed_form", "Patil (2016), chapter 3; Ogden (1972) for balloons", ABOUT, METHOD, "none", "rounding"
)


def make(name: str, title: str, model: str, columns: list[Column], constants: dict[str, float]) -> Table:
    """A table with the documentation common to all of them."""
    return SERIES.table(name, title, "", {"model": model, **constants}, columns)


def columns_of(
    name: str,
    names: tuple[str, ...],
    first: list[tuple[float, ...]],
    second: list[tuple[float, ...]],
    levels: dict[str, tuple[float, float]],
) -> list[Column]:
    """Columns from rows computed twice.

    Raises:
        DisagreementError: If the two have different numbers of rows.
    """
    if len(first) != len(second):
        raise DisagreementError(f"table {name}: {len(first)} points against {len(second)}")
    return [
        both(name, n, ABOUT[n], [r[i] for r in first], [r[i] for r in second], **_level(levels, n))
        for i, n in enumerate(names)
    ]


def _level(levels: dict[str, tuple[float, float]], name: str) -> dict[str, tuple[float, float]]:
    return {"levels": levels[name]} if name in levels else {}


def ordered(count: int) -> list[Column]:
    """The column with the number of the limit point."""
    return SERIES.keys(order=np.arange(1, count + 1))


def sphere_curve(name: str, model: str) -> Table:
    """Pressure of a balloon over its stretch."""
    lam = np.round(np.arange(1.05, SPHERE_END, 0.05), 10)
    one, other = body.by_hand(law(model)), body.by_contour(law(model))
    values = both(
        name, "P", ABOUT["P"], [body.balloon(one, x) for x in lam], [body.balloon(other, x) for x in lam]
    )
    columns = [*SERIES.keys(lam=lam), values]
    return make(name, f"Balloon of {model}: pressure over stretch", model, columns, CONSTANTS[model])


def sphere_limits(name: str, model: str) -> Table:
    """Limit points of a balloon."""
    one, other = body.by_hand(law(model)), body.by_contour(law(model))
    first, second = body.balloon_limits(one, SPHERE_END), body.balloon_limits(other, SPHERE_END)
    columns = [*ordered(len(first)), *columns_of(name, ("P", "lam"), first, second, {"lam": FLAT})]
    return make(name, f"Balloon of {model}: limit points", model, columns, CONSTANTS[model])


def sphere_merge(name: str, model: str) -> Table:
    """The constant of a law at which the limit points of a balloon merge."""
    constant, guess = MERGES[model]
    first = body.balloon_merge(lambda c: body.by_hand(law(model, **{constant: c})), guess)
    second = body.balloon_merge_from_energy(lambda c: law(model, **{constant: c}).energy, guess)
    ABOUT[constant] = ("1", f"constant {constant} of the law")
    names = (constant, "P", "lam")
    columns = columns_of(name, names, [first], [second], dict.fromkeys(names, LOOSE))
    return make(name, f"Balloon of {model}: merging limit points", model, columns, CONSTANTS[model])


def tube_limits(name: str, model: str) -> Table:
    """Limit points of a long tube with closed ends."""
    material = law(model, **TUBES[model])
    first = body.tube_limits(body.by_hand(material), TUBE_END[model])
    second = body.tube_limits(body.by_contour(material), TUBE_END[model])
    levels = {"lam1": FLAT, "lam2": FLAT}
    columns = [*ordered(len(first)), *columns_of(name, ("p", "lam1", "lam2"), first, second, levels)]
    return make(name, f"Long tube of {model}: limit points", model, columns, CONSTANTS[model] | TUBES[model])


def tube_maxwell(name: str, model: str) -> Table:
    """Coexisting states of a long tube with closed ends."""
    material = law(model, **TUBES[model])
    hand = body.by_hand(material)
    turns = [row[2] for row in body.tube_limits(hand, TUBE_END[model])]
    first = body.tube_maxwell(hand, turns, TUBE_END[model])
    second = body.tube_maxwell_by_area(hand, turns, TUBE_END[model])
    names = ("p_maxwell", "lam1_thin", "lam2_thin", "lam1_thick", "lam2_thick")
    columns = columns_of(name, names, [first], [second], dict.fromkeys(names, (1e-11, 1e-9)))
    return make(
        name, f"Long tube of {model}: Maxwell pressure", model, columns, CONSTANTS[model] | TUBES[model]
    )


def coupon(name: str, model: str, loading: str) -> Table:
    """Nominal stress of a test piece over its stretch."""
    material = law(model)
    end = LIMITED.get(model, 4.0)
    lam = np.round(np.arange(1.1, end, 0.1), 10)
    one, other = (
        [body.nominal(material, loading, x, d) for x in lam]
        for d in (body.by_hand(material), body.by_contour(material))
    )
    columns = [*SERIES.keys(lam=lam), both(name, "T", ABOUT["T"], one, other)]
    return make(name, f"{loading} test of {model}", model, columns, CONSTANTS[model])


WITH_LIMITS = tuple(m for m in BUILDERS if m != "saint_venant_kirchhoff")
"""Laws whose balloons have limit points."""
LOADINGS = ("uniaxial", "equibiaxial", "pure_shear")

TABLES: dict[str, Builder] = {}
for _m in BUILDERS:
    TABLES[f"sphere_{_m}"] = partial(sphere_curve, f"sphere_{_m}", _m)
    for _loading in LOADINGS:
        _name = f"{_loading}_{_m}"
        TABLES[_name] = partial(coupon, _name, _m, _loading)
for _m in WITH_LIMITS:
    TABLES[f"sphere_limits_{_m}"] = partial(sphere_limits, f"sphere_limits_{_m}", _m)
for _m in MERGES:
    TABLES[f"sphere_merge_{_m}"] = partial(sphere_merge, f"sphere_merge_{_m}", _m)
for _m in TUBES:
    TABLES[f"infinite_tube_limits_{_m}"] = partial(tube_limits, f"infinite_tube_limits_{_m}", _m)
for _m in ("ogden", "gent", "arruda_boyce"):
    TABLES[f"infinite_tube_maxwell_{_m}"] = partial(tube_maxwell, f"infinite_tube_maxwell_{_m}", _m)
