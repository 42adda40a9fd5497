"""Tables of paper 5: the cylinder's states, eigenvalues and stability changes (figures 4 to 7)."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.collocation import lagrange
from reference_data.solvers.core.tables import Array, Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import text as wrinkled_text
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.waves.cylinder import FLUID, GAS, quadratic
from reference_data.solvers.paper5.waves.transfer import Transfer
from reference_data.solvers.registry import Builder

LEVELS = (1.5, 3.0, 4.5, 6.0, 6.6)
PRESSURES = (0.02, 0.05, 0.1, 0.2, 0.38)
FLUID_LOADS = (*(0.25 * k for k in range(23)), 5.73)
GAS_LOADS = (0.0, 0.005, *(0.01 * k for k in range(1, 7)), *(0.02 * k for k in range(4, 20)))
FLUID_N, GAS_N = (1, 20, 50), (1, 5, 15, 20)
MODE_SPLITS = (2, 3)  # of the elements, for a mode near an end: at 1 its meridional part is 1e-7 off
# wave number, then brackets of its stability changes
FLUID_CHANGES: dict[int, tuple[tuple[float, float], ...]] = {
    6: ((5.0, 5.5), (6.76, 6.8)),
    7: ((5.0, 5.25), (6.88, 6.9)),
    8: ((4.75, 5.0), (7.0, 7.25)),
    10: ((4.4, 4.75), (7.5, 7.75)),
    12: ((4.0, 4.3), (8.25, 8.75)),
    15: ((3.75, 4.0), (10.25, 10.5)),
    20: ((3.5, 3.75), (14.5, 14.75)),
    24: ((3.25, 3.5), (17.5, 18.0)),
    48: ((2.5, 2.75),),
    50: ((2.5, 2.75),),
    96: ((2.0, 2.25),),
    100: ((2.0, 2.25),),
}
GAS_CHANGES: dict[int, tuple[tuple[float, float], ...]] = {
    9: ((0.006, 0.009), (0.012, 0.0125)),
    10: ((0.006, 0.009), (0.021, 0.024)),
    12: ((0.006, 0.009), (0.07, 0.08)),
    15: ((0.003, 0.006), (0.18, 0.19)),
    20: ((0.003, 0.006), (0.41, 0.42)),
    24: ((0.003, 0.006),),
    48: ((0.001, 0.003),),
    50: ((0.001, 0.003),),
    96: ((0.0003, 0.003),),
    100: ((0.0003, 0.003),),
}


def wrinkling(name: str, membrane: Membrane, load: float) -> Table:
    """The wrinkling function along a state (figure 4)."""
    found = cas.solved(membrane, load)
    s, pairs = cas.profiles(found)
    columns = [
        *text.SERIES.keys(Z=s),
        cas.agreed(name, "gw", *pairs["gw"], text.COLUMNS["gw"]),
    ]
    fronts = cas.agreed(name, "Z_front", *found.fronts, wrinkled_text.front(1))
    return text.SERIES.table(
        name,
        f"Wrinkling function at {membrane.control} = {load:g}",
        f"figure 4({'a' if membrane.load == 'fluid' else 'b'}); the level is chosen here",
        text.cylinder(membrane.load) | {membrane.control: load},
        columns,
        notes="No row stands on a front. The method is that of the tables of paper 4 (states only).",
        extra={
            "zones": found.zones,
            "fronts": [float(x) for x in fronts.values],
            "fronts_uncertainty": fronts.uncertainty,
        },
    )


def modes(name: str, membrane: Membrane, n: int, loads: tuple[float, ...]) -> Table:
    """Three lowest eigenvalues against the load (figures 5 and 7)."""
    rows = [rel.cylinder(membrane, float(x)).lowest(n) for x in loads]
    columns = text.SERIES.keys(**{membrane.control: loads})
    columns += rel.spectra(name, rows)
    return text.SERIES.table(
        name,
        f"Three lowest eigenvalues of wave number {n} under {membrane.load}",
        f"figure {5 if membrane.load == 'fluid' else 7}",
        text.cylinder(membrane.load) | {"n": n},
        columns,
        extra=text.SCALES,
    )


def physical(u: Array, q: Array, w: Array, sine: Array, cosine: Array) -> Array:
    """Meridional, circumferential and normal components (columns)."""
    return np.stack([u * sine + w * cosine, q, u * cosine - w * sine], axis=1)


def mode(name: str, n: int, zw: float) -> Table:
    """The lowest mode along the meridian (figure 6)."""
    spectrum, solved = rel.cylinder(FLUID, zw), cas.solved(FLUID, zw)
    s = np.linspace(0, FLUID.L, cas.SAMPLES + 1)
    by_a, by_b = [], []
    for form in [quadratic(x, k) for x, k in zip(solved.tracked, MODE_SPLITS, strict=True)]:
        d = form.lowest(n, 1)[1][:, 0].reshape(-1, 3)
        edges, k = form.state.edges, form.degree
        e = np.clip(np.searchsorted(edges, s, side="right") - 1, 0, len(edges) - 2)
        rows = lagrange(form.nodes, (s - edges[e]) / np.diff(edges)[e])
        local = np.stack([d[j * k : j * k + k + 1] for j in range(len(edges) - 1)])[e]
        field = np.einsum("im,imc->ic", rows, local)
        base = np.einsum("im,imc->ic", lagrange(form.state.nodes, (s - edges[e]) / np.diff(edges)[e]),
                         form.state.y[e])  # fmt: skip
        by_a.append(physical(*field.T, np.sin(base[:, 3]), np.cos(base[:, 3])))
    for parts in spectrum.parts(n):
        ends, vector = Transfer(parts, n).mode()
        at = np.abs(ends[:, None] - s[1:-1]).argmin(axis=0)
        if np.abs(ends[at] - s[1:-1]).max() > 1e-12:
            raise RuntimeError(f"table {name}: a row is not an end of a part")
        where = np.abs(parts.s[:, None] - s[1:-1]).argmin(axis=0)
        tension = np.hypot(parts.y[where, 2], parts.y[where, 3])
        inner = physical(*vector[at].T, parts.y[where, 2] / tension, parts.y[where, 3] / tension)
        by_b.append(np.concatenate([np.zeros((1, 3)), inner, np.zeros((1, 3))]))
    signed = [x * np.sign(x[np.abs(x[:, 2]).argmax(), 2]) for x in (*by_a, *by_b)]
    about = {
        "meridional": "component along the meridian, (u r' + w z')/lam1",
        "circumferential": "component along the hoop, times sin n Theta",
        "normal": "component along the outward normal, (u z' - w r')/lam1",
    }
    columns = text.SERIES.keys(Z=s)
    for c, (column, meaning) in enumerate(about.items()):
        pairs = [Pair(x[:, c], y[:, c], 1e-9) for x, y in (signed[:2], signed[2:])]
        columns.append(cas.agreed(name, column, *pairs, ("unit mass", meaning)))
    value = spectrum.lowest(n, 1)[0].fine[0]
    return text.SERIES.table(
        name,
        f"Lowest mode of wave number {n} at zw = {zw:g}",
        "figure 6",
        text.cylinder("fluid") | {"n": n, "zw": zw},
        columns,
        notes="int H R (u^2 + q^2 + w^2) dS = 1; the normal component of largest size is positive. The "
        f"elements of (a) are cut into {MODE_SPLITS[0]} and {MODE_SPLITS[1]} parts.",
        extra=text.SCALES | {"Lambda": float(value), "zones": solved.zones},
    )


def changes(name: str, membrane: Membrane, sets: dict[int, tuple[tuple[float, float], ...]]) -> Table:
    """Loads where the lowest eigenvalue changes sign."""
    found = [
        rel.crossing(lambda x: rel.cylinder(membrane, x), n, *bracket)
        for n, brackets in sets.items()
        for bracket in brackets
    ]
    columns = rel.turning(name, found, membrane.control)
    alone = ", ".join(str(n) for n, brackets in sets.items() if len(brackets) == 1)
    end = "26.44, the largest level" if membrane.load == "fluid" else "0.555, the largest pressure"
    return text.SERIES.table(
        name,
        f"Loads where the lowest eigenvalue passes zero, {membrane.load}",
        "section 3.2 and figures 5 and 7",
        text.cylinder(membrane.load),
        columns,
        notes=f"Wave numbers {alone} stay unstable up to about {end} on the branch.",
        extra={"keys": ["n", "direction"], "slopes": [float(f"{x.slope:.6g}") for x in found]},
    )


TABLES: dict[str, Builder] = {}
for _x in LEVELS:
    TABLES[f"gw_fluid_zw_{_x:g}"] = partial(wrinkling, f"gw_fluid_zw_{_x:g}", FLUID, _x)
for _x in PRESSURES:
    TABLES[f"gw_gas_p_{_x:g}"] = partial(wrinkling, f"gw_gas_p_{_x:g}", GAS, _x)
for _n in FLUID_N:
    TABLES[f"modes_fluid_n_{_n}"] = partial(modes, f"modes_fluid_n_{_n}", FLUID, _n, FLUID_LOADS)
for _n in GAS_N:
    TABLES[f"modes_gas_n_{_n}"] = partial(modes, f"modes_gas_n_{_n}", GAS, _n, GAS_LOADS)
TABLES["mode_n_100_zw_3"] = partial(mode, "mode_n_100_zw_3", 100, 3.0)
TABLES["stability_changes_fluid"] = partial(changes, "stability_changes_fluid", FLUID, FLUID_CHANGES)
TABLES["stability_changes_gas"] = partial(changes, "stability_changes_gas", GAS, GAS_CHANGES)
