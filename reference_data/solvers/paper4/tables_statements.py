"""Tables of paper 4 for its statements: jumps at fronts, stretches, the accuracy of its scheme.

Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids 54 (2015) 1-10.
"""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.newton import secant
from reference_data.solvers.core.tables import Array, Column, Table, prescribed
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4 import jumps as jmp
from reference_data.solvers.paper4 import text
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.material import Membrane
from reference_data.solvers.paper4.methods import differences as fd
from reference_data.solvers.paper4.methods import measures as msr
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import shooting_newton as sho
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.registry import Builder


def gas(delta: float, M: float = 0.5) -> Membrane:
    """The membrane under gas, with disks of the critical radius."""
    return Membrane(M, delta, load="gas")


JUMPS: list[tuple[Membrane, float]] = [
    (Membrane(1.5, 2), 7.44),
    (Membrane(0.5, 2), 7.44),
    (Membrane(0.5, 3), 7.44),
    (Membrane(1.5, 3), 12.0),
    (gas(2), 0.2),
    (gas(2), 0.55),
    (gas(3), 0.55),
    (Membrane(0.99, 2), 4.5),
    (Membrane(0.5, 2, Af=0.4), 12.0),
    (Membrane(0.5, 2, Af=1.0, load="gas"), 0.0),
]


def front_jumps(name: str) -> Table:
    """Jumps at the fronts of some states."""
    states = [cas.solved(m, x) for m, x in JUMPS]
    a = [[jmp.of_state(x) for x in s.tracked] for s in states]
    b = [[jmp.of_shot(x) for x in s.shots] for s in states]
    positions = [s.fronts for s in states]
    count = [len(p[0].fine) for p in positions]

    def joined(parts: list[Array]) -> Array:
        return np.concatenate([np.atleast_1d(p) for p in parts])

    index = np.repeat(np.arange(len(states)), count).astype(float)
    number = joined([np.arange(1, n + 1) for n in count]).astype(float)
    fronts = [
        Pair(*(joined([getattr(p[i], k) for p in positions]) for k in ("coarse", "fine", "floor")))
        for i in (0, 1)
    ]
    about = {
        "jump_r2": ("1", "jump of r'' (of u''), upper minus lower side"),
        "jump_z2": ("1", "jump of z'' (of w''), upper minus lower side"),
        "jump_lam1": ("1", "jump of the slope of lam1, upper minus lower side"),
        "tan_phi": ("1", "r'/z', tangent of the angle of the meridian with the axis"),
    }
    columns = [
        prescribed("state", index, ("1", "number of the state, from 0, as listed in states")),
        prescribed("order", number, ("1", "1: lowest front")),
        cas.agreed(name, "Z", *fronts, ("1/Ao", "material coordinate of the front")),
    ]
    # the uncertainty of a front moves the point where slopes are compared
    shift = [f.floor for f in fronts]
    for key in jmp.NAMES:
        pairs = [
            Pair(*(joined([x[i][key] for x in side]) for i in (0, 1)), shift[j])
            for j, side in enumerate((a, b))
        ]
        columns.append(cas.agreed(name, key, *pairs, about[key]))
    return text.SERIES.table(
        name,
        "Jumps of the second derivatives at fronts",
        "the text on smoothness",
        {"c2": 0.01, "L": 8.0},
        columns,
        notes="Upper: the side of larger Z. (a) differentiates polynomials, (b) evaluates the equations.",
        extra={
            "keys": ["state", "order"],
            "states": [f"{m.control} = {x:g}: {text.described(m)}" for m, x in JUMPS],
        },
    )


def stretch_change(name: str) -> Table:
    """Largest relative changes of the stretches from zero pressure."""
    s = np.linspace(0, 8, cas.SAMPLES + 1)
    sets = [(delta, p) for delta in (2.0, 3.0) for p in (0.1, 0.2, 0.3)]

    def largest(values: list[dict[str, Array]], zero: list[dict[str, Array]], c: str) -> Pair:
        return Pair(*(np.array(np.max(np.abs(v[c] / o[c] - 1))) for v, o in zip(values, zero, strict=True)))

    def by_both(delta: float, p: float) -> tuple[list[dict[str, Array]], list[dict[str, Array]]]:
        state = cas.solved(gas(delta), p)
        every = [sho.SEGMENTS * n // cas.SAMPLES for n in cas.STEPS]
        shots = [smsr.profile(x, e) for x, e in zip(state.shots, every, strict=True)]
        return [msr.profile(x, s) for x in state.tracked], shots

    columns = [
        *text.SERIES.keys(delta=np.array([x[0] for x in sets]), p=np.array([x[1] for x in sets])),
    ]
    both = [(by_both(*x), by_both(x[0], 0.0)) for x in sets]
    for c, column in (("lam2", "hoop_change"), ("lam1", "meridional_change")):
        pairs = [(largest(v[0], o[0], c), largest(v[1], o[1], c)) for v, o in both]
        about = ("1", f"largest |{c}(p)/{c}(0) - 1| over Z = 0, 0.05, ..., 8")
        columns.append(cas.agreed(name, column, *cas.stacked(pairs), about))
    return text.SERIES.table(
        name,
        "Change of the stretches with pressure",
        "section on gas, the text on stretches",
        {"M": 0.5, "c2": 0.01, "L": 8.0, "Af": "critical", "load": "gas"},
        columns,
        extra={"keys": ["delta", "p"]},
    )


def r_max_crossing(name: str) -> Table:
    """Pressure at which the membrane with larger pre-stretch becomes wider."""
    here = [[sta.from_grid(cas.grid_at(gas(d), 0.42), sta.RULES[0]) for d in (2, 3)] for _ in sta.RULES]

    def gap_of(i: int, p: float) -> float:
        out = []
        for j in (0, 1):
            guess = sta.moved_to(here[i][j], sta.RULES[i]) if here[i][j].rule != sta.RULES[i] else here[i][j]
            here[i][j] = sta.polished(guess, "load", p)
            out.append(msr.measures(here[i][j]).scalars["r_max"])
        return out[0] - out[1]

    (coarse, _), (p, slope) = (
        secant(lambda x, i=i: gap_of(i, x), 0.42, 0.421) for i in range(len(sta.RULES))
    )
    gaps = []
    for x in (p, p + 1e-3):
        pair = [cas.Solved(gas(d), x).scalar("r_max")[1] for d in (2, 3)]
        gaps.append(Pair(pair[0].coarse - pair[1].coarse, pair[0].fine - pair[1].fine))
    ends = [(getattr(gaps[0], k), getattr(gaps[1], k)) for k in ("coarse", "fine")]
    shot = [p - g0 * 1e-3 / (g1 - g0) for g0, g1 in ends]
    floor = cas.ROUNDING / abs(slope)
    pairs = Pair(np.array([coarse]), np.array([p]), floor), Pair(*(np.array([float(x)]) for x in shot), floor)
    radius = cas.Solved(gas(2), p).scalar("r_max")
    columns = [
        cas.agreed(name, "p", *pairs, text.COLUMNS["p"]),
        cas.agreed(name, "r_max", *cas.stacked([radius]), text.COLUMNS["r_max"]),
    ]
    return text.SERIES.table(
        name,
        "Pressure at which delta = 2 and delta = 3 have the same largest radius",
        "section on gas, the text on pre-stretch",
        {"M": 0.5, "c2": 0.01, "L": 8.0, "Af": "critical", "load": "gas"},
        columns,
        notes="Below it the membrane of smaller pre-stretch is the wider one.",
    )


CELLS = (100, 200, 400, 800, 1600)


def fd_scheme(name: str, membrane: Membrane, load: float) -> Table:
    """Errors of the paper's scheme on uniform grids."""
    exact = cas.solved(membrane, load)
    state, fronts = exact.tracked[1], exact.measured[0][1].fronts
    rows = []
    for n in CELLS:
        grid = fd.walk(fd.unloaded(membrane, n), load)
        if len(grid.fronts) != len(fronts):
            raise RuntimeError(f"table {name}: {n} intervals have fronts at {grid.fronts}")
        nodes = sta.evaluate(state, np.linspace(0, membrane.L, n + 1))
        s = grid.middle[0]
        at = sta.wrinkling(membrane, s, sta.evaluate(state, s)) + 1
        gaps = grid.r - nodes[:, 0], grid.z - nodes[:, 1], grid.gw - at, grid.fronts - fronts
        rows.append([float(np.max(np.abs(g))) for g in gaps])
    about = {
        "error_r": "largest error of r at the nodes",
        "error_z": "largest error of z at the nodes",
        "error_gw": "largest error of gw at the mid-points",
        "error_front": "largest error of a front",
    }
    columns = [prescribed("n", np.array(CELLS, float), ("1", "number of intervals"))]
    for (key, meaning), values in zip(about.items(), np.array(rows).T, strict=True):
        columns.append(Column(key, values, 5e-10, ("1/Ao", "1")[key == "error_gw"], meaning))
    return text.SERIES.table(
        name,
        f"Accuracy of the untracked scheme at {membrane.control} = {load:g}: {text.described(membrane)}",
        "the solution method of the paper",
        text.given(membrane) | {membrane.control: load},
        columns,
        method=(
            "Central differences with the Heaviside form of the energy, Newton's method, held against the "
            "tracked collocation of the other tables. The uncertainty is what remains of Newton's last step; "
            "the errors themselves are those of the scheme."
        ),
        grid="uniform",
        tolerance="last step of Newton's method below 1e-10",
        extra={"zones": exact.zones},
    )


TABLES: dict[str, Builder] = {
    "front_jumps": lambda: front_jumps("front_jumps"),
    "stretch_change": lambda: stretch_change("stretch_change"),
    "r_max_crossing": lambda: r_max_crossing("r_max_crossing"),
    "fd_scheme_fluid": lambda: fd_scheme("fd_scheme_fluid", Membrane(1.5, 2), 7.44),
    "fd_scheme_gas": lambda: fd_scheme("fd_scheme_gas", gas(2), 0.2),
}
