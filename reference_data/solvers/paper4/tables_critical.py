"""Tables of paper 4 that are roots: zone events, thresholds of wrinkling, limit loads.

Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Column, Table, last_digit, prescribed, round_up
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import events as evt
from reference_data.solvers.paper4 import limits as lim
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.events import Touch
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.registry import Builder

APPEARS, VANISHES, AT_END = 1, 2, 3
ROOTS = (
    "Root of the stationary value of gw - 1 (or of its value at the upper end) on the side where the zone "
    "does not exist, zones kept as they are. "
)


def disks(membranes: list[Membrane]) -> Column:
    """Column Af of radii, given or critical."""
    values = np.array([m.radius for m in membranes])
    return Column("Af", values, round_up(1e-13 + last_digit(values)), *text.COLUMNS["Af"])


def keys_of(membranes: list[Membrane]) -> list[Column]:
    """Columns M, delta, c2, L and Af."""
    named = {k: [getattr(m, k) for m in membranes] for k in ("M", "delta", "c2", "L")}
    return [*text.SERIES.keys(**named), disks(membranes)]


WATER, GAS1 = Membrane(1.5, 2), Membrane(0.5, 2, Af=1.0, load="gas")
EVENTS: list[tuple[int, Touch]] = [
    (APPEARS, Touch(WATER, 5.25, 2.9)),
    (VANISHES, Touch(WATER, 9.25, 6.7, maximum=False)),
    (VANISHES, Touch(GAS1, 0.0035, 4.2, maximum=False)),
    (VANISHES, Touch(Membrane(0.5, 2, Af=1.0), 8.75, 4.5, maximum=False)),
    (VANISHES, Touch(Membrane(0.3, 3, Af=1.0, load="gas"), 0.0015, 4.3, maximum=False)),
    (VANISHES, Touch(Membrane(0.3, 3, Af=1.0), 10.5, 4.5, maximum=False)),
    (APPEARS, Touch(Membrane(0.5, 2, Af=0.4), 6.0, 1.1)),
    (APPEARS, Touch(Membrane(0.5, 2, Af=0.5), 4.5, 0.7)),
    (AT_END, Touch(Membrane(0.99, 2), 15.0, 8.0, maximum=False)),
    (APPEARS, Touch(Membrane(1.0, 2, Af=0.6, load="gas"), 0.01, 4.0)),
    (APPEARS, Touch(Membrane(0.5, 2, Af=0.4, load="gas"), 0.04, 2.4)),
    (APPEARS, Touch(Membrane(1.9, 1.25, 0.0, 12), 3.5, 2.5)),
    (VANISHES, Touch(Membrane(1.9, 1.25, 0.0, 12), 13.0, 7.0, maximum=False)),
    (APPEARS, Touch(Membrane(1.3, 1.5, 0.05, 10, 0.6), 4.75, 2.6)),
]
found = cache(evt.find)


def rows(name: str, events: list[evt.Found], x: str, about: tuple[str, str]) -> list[Column]:
    """Columns of the parameter and of Z."""
    where = ("1/Ao", "material coordinate at which it happens")
    return [
        cas.agreed(name, x, *cas.stacked([e.x for e in events]), about),
        cas.agreed(name, "Z", *cas.stacked([e.s for e in events]), where),
    ]


def zone_events(name: str) -> Table:
    """Loads at which zones appear and disappear."""
    events = [found(t) for _, t in EVENTS]
    sets = list(dict.fromkeys(t.membrane for _, t in EVENTS))
    index = np.array([sets.index(t.membrane) for _, t in EVENTS], dtype=float)
    code = np.array([c for c, _ in EVENTS], dtype=float)
    about = ("p or zw", "gas pressure P Ao/(C1 h) where fluid = 0, fluid level over Ao where fluid = 1")
    what = (
        "1",
        "1: a taut zone appears inside a wrinkled one; 2: a wrinkled zone vanishes inside taut ones; "
        "3: the wrinkled zone at the upper end vanishes",
    )
    fluid = np.array([float(t.membrane.load == "fluid") for _, t in EVENTS])
    columns = [
        prescribed("set", index, ("1", "number of the set, from 0, as listed in sets")),
        prescribed("event", code, what),
        *rows(name, events, "load", about),
        *keys_of([t.membrane for _, t in EVENTS]),
        prescribed("fluid", fluid, ("1", "1 fluid, 0 gas")),
    ]
    return text.SERIES.table(
        name,
        "Where zones appear and vanish",
        "sections on case 1 and case 2",
        {},
        columns,
        notes=ROOTS
        + "Not in the table because it happens at zero load: with the critical radius a taut sliver stands "
        "at the thin end for every load above 0.",
        extra={"keys": ["set", "event"], "sets": [text.described(m) for m in sets]},
    )


def case2_vanishing(name: str) -> Table:
    """Loads at which the central wrinkled zone of case 2 disappears."""
    touches = sorted(
        (t for c, t in EVENTS if t.membrane.Af == 1.0 and c == VANISHES),
        key=lambda t: (t.membrane.M, t.membrane.delta, t.membrane.load == "fluid"),
    )
    events = [found(t) for t in touches]
    about = ("p or zw", "gas pressure P Ao/(C1 h) where fluid = 0, fluid level over Ao where fluid = 1")
    named = {k: [getattr(t.membrane, k) for t in touches] for k in ("M", "delta")}
    fluid = np.array([float(t.membrane.load == "fluid") for t in touches])
    columns = [
        *text.SERIES.keys(**named),
        prescribed("fluid", fluid, ("1", "1 fluid, 0 gas")),
        *rows(name, events, "load", about),
    ]
    return text.SERIES.table(
        name,
        "Loads above which the membrane of case 2 is taut everywhere",
        "section on case 2 and figure 10",
        {"c2": 0.01, "L": 8.0, "Af": 1.0},
        columns,
        notes=ROOTS,
        extra={"keys": ["M", "delta", "fluid"]},
    )


THRESHOLDS = (
    (1.5, 0.01, 8.0),
    (2.0, 0.0, 8.0),
    (2.0, 0.01, 5.0),
    (2.0, 0.01, 8.0),
    (2.0, 0.01, 10.0),
    (2.0, 0.1, 8.0),
    (3.0, 0.0, 8.0),
    (3.0, 0.01, 8.0),
    (3.0, 0.01, 10.0),
)


def threshold(delta: float, c2: float, length: float, upper: bool) -> Touch:
    """First guess for the threshold of M, by finite differences."""

    def membrane(M: float) -> Membrane:
        return Membrane(M, delta, c2, length, 1.0, "gas")

    low, high = (1.02, 1.95) if upper else (0.05, 0.98)
    rough = brentq(lambda M: fd.unloaded(membrane(M), cas.CELLS).gw.min() - 1, low, high, xtol=1e-4)
    base = round(rough + (-0.01 if upper else 0.01), 3)
    grid = fd.unloaded(membrane(base), cas.CELLS)
    near = float(grid.middle[0][np.argmin(grid.gw)])
    return Touch(membrane(base), base, near, maximum=False, parameter="M")


def thresholds(name: str) -> Table:
    """Thicknesses at which case 2 starts to wrinkle at zero load."""
    sets = [(*x, upper) for x in THRESHOLDS for upper in (False, True)]
    events = [evt.find(threshold(*x)) for x in sets]
    columns = text.SERIES.keys(**{k: [x[i] for x in sets] for i, k in enumerate(("delta", "c2", "L"))})
    columns.append(
        prescribed(
            "upper",
            np.array([float(x[3]) for x in sets]),
            ("1", "0: wrinkled for M below the value; 1: wrinkled for M above it"),
        )
    )
    columns += rows(name, events, "M", text.COLUMNS["M"])
    return text.SERIES.table(
        name,
        "Thickness at which case 2 begins to wrinkle at zero load",
        "section on case 2",
        {"Af": 1.0},
        columns,
        notes=ROOTS
        + "Printed: about 0.75 and 1.25 for delta = 2, 0.4 and 1.6 for delta = 3 (L = 8). Lower and upper "
        "are found apart, though mirror symmetry makes their sum 2.",
        extra={"keys": ["delta", "c2", "L", "upper"]},
    )


# Membrane, load to start from, step of V in search of the limit.
LIMITS: list[tuple[Membrane, float, float]] = [
    (Membrane(0.1, 2, load="gas"), 0.25, 1.0),
    (Membrane(0.3, 3, Af=1.0, load="gas"), 0.3, 2.0),
    (Membrane(0.5, 2, load="gas"), 0.55, 1.0),
    (Membrane(0.5, 3, load="gas"), 0.55, 2.0),
    (Membrane(0.8, 2.5, 0.02, 6, 0.5, "gas"), 0.8, 1.0),
    (Membrane(1.0, 2, load="gas"), 0.55, 1.0),
    (Membrane(0.3, 3, Af=1.0), 12.0, 1.0),
    (Membrane(0.5, 2), 16.0, 1.0),
    (Membrane(0.5, 3), 16.0, 2.0),
    (Membrane(1.3, 1.5, 0.05, 10, 0.6), 16.0, 1.0),
    (Membrane(1.5, 2), 16.0, 1.0),
    (Membrane(1.5, 3), 16.0, 1.0),
    (Membrane(1.7, 3, 0.0, 8, 1.0), 16.0, 1.0),
]


def limit_loads(name: str, load: str) -> Table:
    """First limit loads of gas or of fluid."""
    sets = [x for x in LIMITS if x[0].load == load]
    sets.sort(key=lambda x: (x[0].M, x[0].delta, x[0].c2, x[0].L, x[0].radius))
    limits = [lim.limit(*x) for x in sets]
    control = sets[0][0].control
    columns = keys_of([x[0] for x in sets])
    for key, column in (("load", control), ("V", "V"), ("r_max", "r_max")):
        pairs = cas.stacked([x.values[key] for x in limits])
        columns.append(cas.agreed(name, column, *pairs, text.COLUMNS[column]))
    common = {"gamma": sets[0][0].gamma} if load == "fluid" else {}
    rules = " and ".join(f"degree {r.degree} on elements up to {r.longest:g}" for r in lim.RULES)
    return text.SERIES.table(
        name,
        f"Limit loads under {load}",
        "the text on limit points",
        {"load": load} | common,
        columns,
        notes=(
            "First maximum of the load along the branch: root of d load/d V, the enclosed volume V being "
            "the control. V is raised step by step from the state at a load below, itself reached from the "
            f"unloaded membrane at given loads. Collocation of {rules} Ao long; twice the steps of shooting."
        ),
        extra={"keys": ["M", "delta", "c2", "L", "Af"], "critical": [x[0].Af is None for x in sets]},
    )


TABLES: dict[str, Builder] = {
    "zone_events": lambda: zone_events("zone_events"),
    "case2_vanishing": lambda: case2_vanishing("case2_vanishing"),
    "thresholds": lambda: thresholds("thresholds"),
    "limit_loads_gas": lambda: limit_loads("limit_loads_gas", "gas"),
    "limit_loads_fluid": lambda: limit_loads("limit_loads_fluid", "fluid"),
}
