"""Tables of the wrinkled cylinder with laws other than Mooney-Rivlin, by the codes of papers 4 and 5.

The codes accept a law instead of C2/C1. They use its derivatives where the membrane is taut, the derivatives
of ``w(l, l^(-1/2))`` where it is wrinkled, and for waves the derivatives with respect to the metric
(``law_metric``).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

import numpy as np

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.tables import Column, Table, prescribed
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import events as evt
from reference_data.solvers.paper4 import limits as lim
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4 import tables_critical as critical
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.events import Touch
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text as relaxed_text
from reference_data.solvers.registry import Builder

MODELS = ("ogden", "gent", "arruda_boyce")
RADII = tuple((M, delta) for M in (0.5, 0.9, 1.0) for delta in (2.0, 3.0))
NEAR: dict[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "ogden": ((4.1, 2.37), (7.0, 5.54)),
    "gent": ((5.25, 2.84), (8.45, 6.43)),
    "arruda_boyce": ((5.25, 2.85), (8.5, 6.4)),
}
"""Guesses for level and position at which a taut zone opens in the filled tube, and the wrinkled one
closes."""
LIMITS = {"ogden": (0.3, 0.5), "gent": (0.6, 1.0), "arruda_boyce": (0.6, 1.0)}
"""First pressure and step of the volume of the search for the limit load."""
WAVES: dict[str, tuple[tuple[int, tuple[float, float]], ...]] = {
    "ogden": ((10, (3.15, 3.3)), (10, (5.68, 5.8)), (20, (2.5, 2.65)), (20, (10.8, 11.1))),
    "gent": ((10, (4.6, 4.7)), (10, (7.4, 7.5)), (20, (3.65, 3.75)), (20, (13.2, 13.35))),
    "arruda_boyce": ((10, (4.65, 4.665)), (10, (7.52, 7.535)), (20, (3.71, 3.725)), (20, (13.6, 13.62))),
}
"""Wave numbers, and ranges of levels in which waves appear or disappear."""


@cache
def material(model: str) -> object:
    """A law with the constants of the tables; always the same object, because it is a key of kept states."""
    return law(model)


def membrane(model: str, M: float, delta: float, af: float | None = None, load: str = "fluid") -> Membrane:
    """A cylinder of length 8."""
    return Membrane(M, delta, material(model), 8.0, af, load)


def made(name: str, title: str, model: str, given: dict[str, object], columns: list[Column], **more: object):  # noqa: ANN201
    """A table with the documentation common to all of them."""
    facts = {"model": model, **CONSTANTS[model], "L": 8.0, **given}
    about = replace(text.SERIES, paper="materials")
    return about.table(name, f"{title}, {model}", "the problem with another law", facts, columns, **more)


def radii(name: str, model: str) -> Table:
    """Critical radii of the disks."""
    found = [membrane(model, *x) for x in RADII]
    a = np.array([wri.critical_radius(m) for m in found])
    b = np.array([wri.critical_radius_by_parts(m) for m in found])
    columns = [
        *text.SERIES.keys(M=np.array([x[0] for x in RADII]), delta=np.array([x[1] for x in RADII])),
        cas.agreed(name, "Af_critical", Pair(a, a), Pair(b, b), text.COLUMNS["Af_critical"]),
    ]
    method = (
        "Root N of mean lam1 = delta with eta W_r'(lam1) = N, then lam1^(-1/2) at the thin end: (a) the mean "
        "by Gauss-Legendre sums; (b) by parts, adaptive integration over the stretch."
    )
    return made(name, "Critical radius of the disks", model, {}, columns, method=method)


def threshold(name: str, model: str) -> Table:
    """Thickness ratio below which the unloaded tube of case 2 wrinkles, delta = 2."""
    found = evt.find(critical.threshold(2.0, material(model), 8.0, upper=False))
    columns = text.SERIES.keys(delta=[2.0])
    columns += critical.rows(name, [found], "M", text.COLUMNS["M"])
    title = "Thickness at which case 2 begins to wrinkle at zero load"
    return made(name, title, model, {"Af": 1.0}, columns, notes=critical.ROOTS)


def events(name: str, model: str) -> Table:
    """Levels at which a taut zone opens, and the wrinkled one closes, M = 1.5 and delta = 2."""
    tube = membrane(model, 1.5, 2.0)
    found = [
        evt.find(Touch(tube, *NEAR[model][0])),
        evt.find(Touch(tube, *NEAR[model][1], maximum=False)),
    ]
    about = ("1", "1: a taut zone opens inside a wrinkled one; -1: a wrinkled zone closes inside taut ones")
    columns = [
        prescribed("state", np.array([1.0, -1.0]), about),
        *critical.rows(name, found, "zw", text.COLUMNS["zw"]),
    ]
    facts = {"M": 1.5, "delta": 2.0, "Af": "critical", "load": "fluid", "gamma": tube.gamma}
    return made(name, "Where zones open and close", model, facts, columns, notes=critical.ROOTS)


def limits(name: str, model: str) -> Table:
    """The first limit pressure of the tube filled with gas, M = 0.5 and delta = 2."""
    found = lim.limit(membrane(model, 0.5, 2.0, load="gas"), *LIMITS[model])
    columns = [prescribed("order", np.ones(1), ("1", "1: first limit point met"))]
    for key, column in (("load", "p"), ("V", "V"), ("r_max", "r_max")):
        pairs = cas.stacked([found.values[key]])
        columns.append(cas.agreed(name, column, *pairs, text.COLUMNS[column]))
    facts = {"M": 0.5, "delta": 2.0, "Af": "critical", "load": "gas"}
    return made(name, "Limit load under gas", model, facts, columns)


def waves(name: str, model: str) -> Table:
    """Levels at which waves around the axis set in and vanish, the tube of paper 5."""
    tube = membrane(model, 1.5, 3.0, 0.4362)
    found = [rel.crossing(lambda x: rel.cylinder(tube, x), n, *bracket) for n, bracket in WAVES[model]]
    columns = rel.turning(name, found, "zw")
    facts = {"M": 1.5, "delta": 3.0, "Af": 0.4362, "load": "fluid", "gamma": tube.gamma}
    more = {"method": relaxed_text.METHOD, "grid": relaxed_text.CYLINDER_GRID}
    return made(name, "Where waves around the axis set in and vanish", model, facts, columns, **more)


TABLES: dict[str, Builder] = {}
for _m in MODELS:
    for _kind, _build in (
        ("radii", radii),
        ("threshold", threshold),
        ("events", events),
        ("limits", limits),
        ("waves", waves),
    ):
        TABLES[f"wrinkled_{_kind}_{_m}"] = partial(_build, f"wrinkled_{_kind}_{_m}", _m)
