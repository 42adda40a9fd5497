"""Tables of paper 4 over the load: branches and fronts, of the figures and others.

Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import tables_states as paper4
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.material import Array, Membrane
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.registry import Builder

BRANCH_NOTES = (
    "Raised from the unloaded membrane at given loads. wrinkled_fraction and the extremes of gw have kinks "
    "where zones appear or vanish (table zone_events)."
)
FRONT_NOTES = (
    "Only loads with this number of fronts; where it changes is in table zone_events. A front stands where "
    "gw = 1; Z is the undeformed position. A front next to a disk may bound a sliver far thinner than any "
    "mesh."
)


def steps(stop: float, step: float, *more: float) -> Array:
    """0, step, ..., stop and some further loads, rising."""
    return np.unique(np.round(np.concatenate([np.arange(0, stop + step / 2, step), more]), 10))


FLUID = steps(16, 0.5, *paper4.ZW)
# Where the dry upper part becomes taut at once (M = 1.5, delta = 3), and the level of paper 5.
ABRUPT = np.unique(np.concatenate([FLUID, [5.73, 6.2, 6.3, 6.4, 6.45, 6.55, 6.6, 6.65, 6.7, 6.8, 6.9]]))
GAS = steps(0.55, 0.01, 0.005)
LOW = steps(0.2, 0.01, 0.001, 0.002, 0.003, 0.004, 0.005)  # case 2 on gas
SETS: dict[str, tuple[Membrane, Array, str]] = {}
for _delta in (2, 3):
    for _M in (0.5, 1.5):
        _loads = ABRUPT if (_M, _delta) == (1.5, 3) else FLUID
        SETS[f"fluid_M_{_M:g}_delta_{_delta}"] = (Membrane(_M, _delta), _loads, "figures 2 to 4")
    SETS[f"gas_M_0.5_delta_{_delta}"] = (Membrane(0.5, _delta, load="gas"), GAS, "figures 5 and 6")
    _m = Membrane(0.5, _delta, load="gas", energy="standard")
    SETS[f"standard_gas_M_0.5_delta_{_delta}"] = (_m, steps(0.55, 0.025), "figure 9")
for _M in (0.99, 1):
    SETS[f"fluid_M_{_M:g}_delta_2"] = (Membrane(_M, 2), FLUID[1:], "figure 7")
SETS["gas_M_1_delta_2"] = (Membrane(1, 2, load="gas"), steps(0.55, 0.025)[1:], "the section on gas")
for _Af in (0.4, 0.5):
    SETS[f"fluid_Af_{_Af:g}"] = (Membrane(0.5, 2, Af=_Af), FLUID, "figure 8")
SETS["gas_M_1_delta_2_Af_0.6"] = (
    Membrane(1, 2, Af=0.6, load="gas"),
    steps(0.3, 0.01),
    "the text on uniform thickness",
)
for _M, _delta in paper4.CASE2:
    _m = Membrane(_M, _delta, Af=1.0, load="gas")
    SETS[f"case2_gas_M_{_M:g}_delta_{_delta}"] = (_m, LOW, "figure 10(a)")
    SETS[f"case2_fluid_M_{_M:g}_delta_{_delta}"] = (
        Membrane(_M, _delta, Af=1.0),
        steps(12, 0.5),
        "figure 10(b)",
    )
SETS["case2_gas_M_0.9_delta_2"] = (Membrane(0.9, 2, Af=1.0, load="gas"), steps(0.2, 0.01), "figure 11")

OFF: list[tuple[Membrane, Array, tuple[float, ...]]] = [
    (Membrane(0.1, 2, load="gas"), steps(0.3, 0.01), (0.05, 0.2)),
    (Membrane(0.7, 4, 0.1, 5, load="gas"), steps(1.2, 0.05), (0.3, 1.0)),
    (Membrane(1.9, 1.25, 0.0, 12), steps(15, 0.5), (5, 10)),
    (Membrane(1.3, 1.5, 0.05, 10, 0.6), steps(15, 0.5), (4, 9)),
    (Membrane(0.8, 2.5, 0.02, 6, 0.5, "gas"), steps(0.8, 0.025), (0.1, 0.6)),
    (Membrane(1.7, 3, 0.0, 8, 1.0), steps(16, 0.5), (4, 12)),
    (Membrane(0.3, 2.5, 0.03, 8), steps(14, 0.5), (4.5, 9)),
]


def off_name(membrane: Membrane) -> str:
    """Name of a set that is not in the paper."""
    radius = "critical" if membrane.Af is None else f"{membrane.Af:g}"
    return (
        f"off_{membrane.load}_M_{membrane.M:g}_delta_{membrane.delta:g}_c2_{membrane.c2:g}"
        f"_L_{membrane.L:g}_Af_{radius}"
    )


def branch(name: str, membrane: Membrane, loads: Array, source: str) -> Table:
    """Scalars of the states at given loads."""
    found = [cas.solved(membrane, float(x)) for x in loads]
    columns = text.SERIES.keys(**{membrane.control: loads})
    for c in msr.SCALARS:
        columns.append(cas.agreed(name, c, *cas.stacked([x.scalar(c) for x in found]), text.COLUMNS[c]))
    return text.SERIES.table(
        name,
        f"Branch over the load: {text.described(membrane)}",
        source,
        text.given(membrane),
        columns,
        notes=BRANCH_NOTES,
        extra={"Af_value": membrane.radius, "zones_at_the_end": found[-1].zones},
    )


def fronts(name: str, membrane: Membrane, loads: Array, source: str) -> Table:
    """Positions of the fronts at loads that all have the same pattern of zones.

    Raises:
        RuntimeError: If the patterns differ.
    """
    found = [cas.solved(membrane, float(x)) for x in loads]
    zones = {x.zones for x in found}
    if len(zones) > 1:
        raise RuntimeError(f"table {name}: patterns {'; '.join(sorted(zones))}")
    columns = text.SERIES.keys(**{membrane.control: loads})
    pairs = cas.stacked([x.fronts for x in found])
    for i in range(pairs[0].fine.shape[1]):
        one = [cas.Pair(p.coarse[:, i], p.fine[:, i], np.asarray(p.floor)[:, i]) for p in pairs]
        columns.append(cas.agreed(name, f"Z_front_{i + 1}", *one, text.front(i + 1)))
    return text.SERIES.table(
        name,
        f"Fronts over the load: {text.described(membrane)}",
        source,
        text.given(membrane),
        columns,
        notes=FRONT_NOTES,
        extra={"Af_value": membrane.radius, "zones": zones.pop()},
    )


# Stretches of load with one pattern each: set, first load, last load, ending of the name.
STRETCHES = (
    ("fluid_M_0.5_delta_2", 0.5, 16, ""),
    ("fluid_M_0.5_delta_3", 0.5, 16, ""),
    ("fluid_M_1.5_delta_2", 0.5, 5, "_low"),
    ("fluid_M_1.5_delta_2", 5.5, 9, "_middle"),
    ("fluid_M_1.5_delta_2", 9.5, 16, "_high"),
    ("fluid_M_1.5_delta_3", 0.5, 16, ""),
    ("gas_M_0.5_delta_2", 0.005, 0.55, ""),
    ("gas_M_0.5_delta_3", 0.005, 0.55, ""),
    ("fluid_M_0.99_delta_2", 0.5, 14.5, ""),
    ("fluid_Af_0.4", 6.5, 16, ""),
    ("fluid_Af_0.5", 5, 16, ""),
    ("gas_M_1_delta_2_Af_0.6", 0.02, 0.3, ""),
    ("case2_gas_M_0.5_delta_2", 0, 0.003, ""),
    ("case2_fluid_M_0.5_delta_2", 0, 8.5, ""),
    ("case2_gas_M_0.3_delta_3", 0, 0.001, ""),
    ("case2_fluid_M_0.3_delta_3", 0, 10, ""),
)

TABLES: dict[str, Builder] = {
    name: partial(branch, name, membrane, loads, source) for name, (membrane, loads, source) in SETS.items()
}
for _set, _low, _high, _ending in STRETCHES:
    _m, _loads, _source = SETS[_set]
    _name = f"fronts_{_set}{_ending}"
    TABLES[_name] = partial(fronts, _name, _m, _loads[(_loads >= _low) & (_loads <= _high)], _source)
for _m, _loads, _levels in OFF:
    _name, _about = off_name(_m), "the equations at values that are not in the paper"
    TABLES[_name] = partial(branch, _name, _m, _loads, _about)
    for _x in _levels:
        _one = f"{_name}_{_m.control}_{_x:g}"
        TABLES[_one] = partial(paper4.state, _one, _m, _x, _about)
