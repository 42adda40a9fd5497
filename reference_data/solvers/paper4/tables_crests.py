"""Tables of paper 4 on the crests of the gas-loaded membrane.

Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10, section on gas.
"""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.tables import Array, Table, prescribed
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import events as evt
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.events import Touch
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.tables_statements import gas
from reference_data.solvers.registry import Builder

CRESTS = (
    (0.5, 2, (0.3, 0.43, 0.45, 0.47, 0.5, 0.55)),
    (0.5, 3, (0.3, 0.33, 0.35, 0.38, 0.4, 0.55)),
    (1, 2, (0.3,)),
)


def crests(name: str) -> Table:
    """Crests and troughs of the radius under gas."""
    cells: list[tuple[float, ...]] = []
    a: list[list[tuple[float, ...]]] = []
    b: list[list[tuple[float, ...]]] = []
    floors: list[float] = []
    for M, delta, pressures in CRESTS:
        for p in pressures:
            state = cas.solved(gas(delta, M), p)
            places = [turns(m) for m in (*state.measured[0], *state.measured[1])]
            if len({len(x) for x in places}) > 1:
                raise RuntimeError(f"table {name}: crests at p = {p:g}: {places}")
            for i in range(len(places[0])):
                cells.append((float(M), float(delta), p, i + 1.0, places[1][i][1]))
                at = [x[i][0] for x in places]
                tracked = [sta.evaluate(s, np.array(x)) for s, x in zip(state.tracked, at[:2], strict=True)]
                shot = [value_at(s, x) for s, x in zip(state.shots, at[2:], strict=True)]
                a.append([(x, y[1], y[0]) for x, y in zip(at[:2], tracked, strict=True)])
                b.append([(x, y[1], y[0]) for x, y in zip(at[2:], shot, strict=True)])
                l1, bend = tracked[1][2], bend_at(state.tracked[1], at[1])
                floors.append(float(l1 * evt.NOISE / abs(bend)))
    keys = np.array(cells).T
    labels = {
        "M": text.COLUMNS["M"],
        "delta": text.COLUMNS["delta"],
        "p": text.COLUMNS["p"],
        "order": ("1", "from the lower end, from 1"),
        "crest": ("1", "1: local maximum of r; 0: local minimum (trough)"),
    }
    columns = [prescribed(k, v, labels[k]) for k, v in zip(labels, keys, strict=True)]
    for i, key in enumerate(("Z", "z", "r")):
        floor = np.array(floors) * (0.0 if key == "r" else 1.0)
        pairs = [Pair(*(np.array([x[j][i] for x in side]) for j in (0, 1)), floor) for side in (a, b)]
        columns.append(cas.agreed(name, key, *pairs, text.COLUMNS[key]))
    return text.SERIES.table(
        name,
        "Crests and troughs of the inflated membrane",
        "section on gas, the text on crests",
        {"c2": 0.01, "L": 8.0, "Af": "critical", "load": "gas"},
        columns,
        notes="Height over the total one is z/(delta L). The window of two crests is in table crest_window.",
        extra={"keys": ["M", "delta", "p", "order"]},
    )


def turns(m: msr.Measures) -> list[tuple[float, float]]:
    """Crests (1) and troughs (0) from the lower end."""
    return sorted([(float(s), 1.0) for s in m.crests] + [(float(s), 0.0) for s in m.troughs])


def value_at(found: sho.Solution, s: float) -> Array:
    """(r, z, A, F, V) of a shot at a position."""
    return smsr.inside(found.shot, *smsr.located(found.shot, np.array([s])))[1][0]


def bend_at(state: sta.State, s: float) -> float:
    """Derivative of the slope angle at a position."""
    slope = state.mesh.slope(state.y[..., 3])
    return float(np.interp(s, state.s.ravel(), slope.ravel()))


WINDOW = (
    (2.0, 1.0, Touch(gas(2), 0.41, 2.47, "inclination", maximum=False)),
    (2.0, 2.0, Touch(gas(2), 0.515, 5.0, "inclination", maximum=True)),
    (3.0, 1.0, Touch(gas(3), 0.305, 2.35, "inclination", maximum=False)),
    (3.0, 2.0, Touch(gas(3), 0.406, 5.06, "inclination", maximum=True)),
)


def crest_window(name: str) -> Table:
    """Pressures between which there are two crests and a trough."""
    events = [evt.find(t) for _, _, t in WINDOW]
    where = ("1/Ao", "material coordinate at which crest and trough meet")
    columns = [
        *text.SERIES.keys(delta=np.array([x[0] for x in WINDOW])),
        prescribed(
            "event",
            np.array([x[1] for x in WINDOW]),
            ("1", "1: crest and trough appear in the thin half; 2: trough and crest of the thick half merge"),
        ),
        cas.agreed(name, "p", *cas.stacked([e.x for e in events]), text.COLUMNS["p"]),
        cas.agreed(name, "Z", *cas.stacked([e.s for e in events]), where),
    ]
    return text.SERIES.table(
        name,
        "Window of pressures with two crests",
        "section on gas, the text on crests",
        {"M": 0.5, "c2": 0.01, "L": 8.0, "Af": "critical", "load": "gas"},
        columns,
        notes="Root of the stationary value of the meridian's inclination.",
        extra={"keys": ["delta", "event"]},
    )


TABLES: dict[str, Builder] = {
    "crests": lambda: crests("crests"),
    "crest_window": lambda: crest_window("crest_window"),
}
