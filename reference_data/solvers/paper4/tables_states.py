"""Tables of paper 4: critical radii, and the states of figures 2 to 11.

Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10. The levels of most curves are
not printed; those chosen here are named in each table.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.registry import Builder

PROFILE_NOTES = (
    "Z is the undeformed position s = Z/Ao, not the height. No row stands on a front. The values at "
    "the two disks are those of the material points clamped there."
)
TABLE2 = tuple((M, delta) for M in (0.1, 0.5, 0.9, 0.99, 1.0, 1.5) for delta in (2.0, 3.0))


def table2(name: str) -> Table:
    """Largest radius of the disks for which the stretched membrane is wholly wrinkled."""
    membranes = [Membrane(M, delta) for M, delta in TABLE2]
    a = np.array([wri.critical_radius(m) for m in membranes])
    b = np.array([wri.critical_radius_by_parts(m) for m in membranes])
    pairs = cas.Pair(a, a), cas.Pair(b, b)
    columns = [
        *text.SERIES.keys(M=[m.M for m in membranes], delta=[m.delta for m in membranes]),
        cas.agreed(name, "Af_critical", *pairs, text.COLUMNS["Af_critical"]),
    ]
    return text.SERIES.table(
        name,
        "Critical radius of the disks",
        "Table 2",
        {"c2": 0.01},
        columns,
        method=(
            "Root N of mean lam1 = delta with eta W_r'(lam1) = N, then lam1^(-1/2) at the thin end: "
            "(a) the mean by Gauss-Legendre sums over s, 80 points; (b) by parts, adaptive integration "
            "over the stretch. In the uncertainties collocation stands for (a), shooting for (b)."
        ),
        grid="80 Gauss points",
        tolerance="roots to rounding",
        notes=(
            "M and 2 - M give the same value; so does every L. Printed: 0.5568 (M = 0.5, 1.5, delta = 2), "
            "0.4362 (0.5, 3), 0.7046 (0.99, 2), 0.7071 (1, 2); the first is cut off, not rounded."
        ),
        extra={"keys": ["M", "delta"]},
    )


def state(name: str, membrane: Membrane, load: float, source: str) -> Table:
    """Profile of one state."""
    found = cas.solved(membrane, float(load))
    s, pairs = cas.profiles(found)
    columns = text.SERIES.keys(Z=s)
    columns += [cas.agreed(name, c, *pair, text.COLUMNS[c]) for c, pair in pairs.items()]
    fronts = cas.agreed(name, "Z_front", *found.fronts, text.front(1))
    measured = found.measured[0][1]
    return text.SERIES.table(
        name,
        f"State at {membrane.control} = {load:g}: {text.described(membrane)}",
        source,
        text.given(membrane) | {membrane.control: float(load)},
        columns,
        notes=PROFILE_NOTES,
        extra={
            "Af_value": membrane.radius,
            "zones": found.zones,
            "fronts": [float(x) for x in fronts.values],
            "fronts_uncertainty": fronts.uncertainty,
            "r_max": measured.scalars["r_max"],
            "V": measured.scalars["V"],
        },
    )


ZW = (0, 3, 4.5, 6, 7.44, 10, 12, 16)
GAS = (0, 0.05, 0.1, 0.2, 0.35, 0.45, 0.55)
CASE2 = ((0.5, 2), (0.3, 3))
STATES: list[tuple[str, Membrane, float, str]] = []


def _add(name: str, membrane: Membrane, load: float, source: str) -> None:
    STATES.append((name, membrane, load, source))


for _fig, _delta in (("fig02", 2), ("fig03", 3)):
    for _M in (0.5, 1.5):
        for _x in ZW:
            _about = f"figures {int(_fig[3:])} and 4" + ("" if _x == 7.44 else "; the level is chosen here")
            _add(f"{_fig}_M_{_M:g}_zw_{_x:g}", Membrane(_M, _delta), _x, _about)
for _delta in (2, 3):
    for _x in GAS:
        _about = "figures 5 and 6" + ("" if _x == 0.55 else "; the level is chosen here")
        _add(f"fig05_delta_{_delta}_p_{_x:g}", Membrane(0.5, _delta, load="gas"), _x, _about)
    for _x in GAS:
        _m = Membrane(0.5, _delta, load="gas", energy="standard")
        _add(f"fig09_delta_{_delta}_p_{_x:g}", _m, _x, "figure 9; the level is chosen here")
for _M in (0.99, 1):
    _add(f"fig07_M_{_M:g}_zw_4.5", Membrane(_M, 2), 4.5, "figure 7")
for _Af in (0.4, 0.5):
    for _x in (4.5, 12):
        _add(
            f"fig08_Af_{_Af:g}_zw_{_x:g}", Membrane(0.5, 2, Af=_Af), _x, "figure 8; the level is chosen here"
        )
for _M, _delta in CASE2:
    for _x in (0, 0.001, 0.002, 0.005, 0.05, 0.2):
        _m = Membrane(_M, _delta, Af=1.0, load="gas")
        _add(f"fig10a_delta_{_delta}_p_{_x:g}", _m, _x, "figure 10(a); the level is chosen here")
    for _x in (2, 4, 6, 8, 12):
        _m = Membrane(_M, _delta, Af=1.0)
        _add(f"fig10b_delta_{_delta}_zw_{_x:g}", _m, _x, "figure 10(b); the level is chosen here")
for _x in (0, 0.05, 0.1, 0.2):
    _m = Membrane(0.9, 2, Af=1.0, load="gas")
    _add(f"fig11_p_{_x:g}", _m, _x, "figure 11; the level is chosen here")

TABLES: dict[str, Builder] = {"table2": lambda: table2("table2")}
TABLES |= {name: partial(state, name, *rest) for name, *rest in STATES}
