"""Tables of paper 2, free inflation: curves, limit points, fold line, cusp and profiles.

Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282, figures 2-5.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Estimate, Table, agreed, steps
from reference_data.solvers.paper2 import text
from reference_data.solvers.paper2.collocation import critical as col
from reference_data.solvers.paper2.common import U_STOP, first_limits, given, limit_pair, stacked
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import critical as fdc
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.registry import Builder


def curve(name: str, tube: Tube, u_stop: float, source: str) -> Table:
    """One branch over u_max."""
    targets = steps(0.05, u_stop, 0.05)
    trace = fdb.Trace(tube, fd.Grid(fdb.GRIDS[0])).run(u_stop)
    if np.any(np.diff(trace.column("u_max")) <= 0):
        raise RuntimeError(f"table {name}: u_max does not rise monotonically along the branch")
    a, b = fdb.curve(tube, "u_max", targets), col.curve(tube, "u_max", targets)
    columns = text.SERIES.keys(u_max=targets)
    columns += [agreed(name, c, a[c], b[c], text.COLUMNS[c]) for c in ("p", "lam1_mid", "t1_mid", "V")]
    title = f"Free inflation, alpha = {tube.alpha:g}, delta1 = {tube.delta1:g}, lf = {tube.lf:g}"
    return text.SERIES.table(name, title, source, given(tube), columns, notes=text.CURVE_NOTES)


def limits(name: str, tubes: list[Tube], keys: tuple[str, ...], source: str) -> Table:
    """Limit points of several tubes."""
    rows: list[tuple[Tube, int]] = []
    a: list[Estimate] = []
    b: list[Estimate] = []
    none = []
    for tube in tubes:
        by_fd, by_collocation = limit_pair(name, tube)
        rows += [(tube, order + 1) for order in range(len(by_fd))]
        a, b = a + by_fd, b + by_collocation
        if not by_fd:
            none.append(f"(alpha, delta1, lf) = ({tube.alpha:g}, {tube.delta1:g}, {tube.lf:g})")
    named = {k: [getattr(t, k) for t, _ in rows] for k in keys} | {"order": [o for _, o in rows]}
    columns = text.SERIES.keys(**named) + stacked(name, ("p", "u_max"), a, b)
    missing = f" Searched without finding any: {'; '.join(none)}." if none else ""
    common = {k: v for k, v in given(tubes[0]).items() if k not in keys and k != "delta1"}
    return text.SERIES.table(
        name,
        "Limit points of the pressure in free inflation",
        source,
        common | {"u_max_searched": U_STOP},
        columns,
        notes=text.LIMIT_NOTES + missing,
        extra={"keys": [*keys, "order"]},
    )


def fold_line(name: str) -> Table:
    """Figure 3(b): limit points in the (delta1, p) plane, followed over u_max."""
    tube = Tube(0.1, 1.0, 6.0)
    by_fd, by_collocation, _ = first_limits(tube)
    targets = steps(1.1, 2.45, 0.025)
    raw_a = []
    for n, state in zip(fdb.GRIDS, by_fd, strict=True):
        here, grid, line = tube, fd.Grid(n), []
        for u in targets:
            here, state = fdc.fold_at(here, grid, state, float(u))  # noqa: PLW2901
            line.append([here.delta1, state[1]])
        raw_a.append(np.array(line).T)
    raw_b = []
    for state in by_collocation:
        line = []
        for u in targets:
            state = col.fold_at(state, float(u))  # noqa: PLW2901
            line.append([state.tube.delta1, state.p])
        raw_b.append(np.array(line).T)
    columns = text.SERIES.keys(u_max=targets)
    for i, c in enumerate(("delta1", "p")):
        a = fdb.richardson(*(raw[i] for raw in raw_a))
        b = col.resolved(*(raw[i] for raw in raw_b))
        columns.append(agreed(name, c, a, b, text.COLUMNS[c]))
    parameters = {"alpha": tube.alpha, "lf": tube.lf}
    return text.SERIES.table(name, "Fold line, alpha = 0.1, lf = 6", "figure 3(b)", parameters, columns)


CUSP_U_STOP = 8.0
CUSP_SETS = ((0.05, 6.0), (0.1, 4.0), (0.1, 6.0), (0.1, 8.0), (0.15, 6.0), (0.2, 6.0), (0.2, 8.0))


def cusps(name: str) -> Table:
    """Cusps in which the two limit points merge as delta1 grows."""
    rows, a, b, absent = [], [], [], []
    for alpha, lf in CUSP_SETS:
        tube = Tube(alpha, 1.0, lf)
        by_fd, by_collocation, count = first_limits(tube, CUSP_U_STOP)
        if count < 2:
            absent.append(f"({alpha:g}, {lf:g}): {count} limit point(s) at delta1 = 1")
            continue
        top = fdc.fold_top(tube, fd.Grid(fdb.GRIDS[0]), by_fd[0])
        points = [fdc.cusp(top[0], fd.Grid(fdb.GRIDS[0]), top[1])]
        for n in fdb.GRIDS[1:]:
            coarser = fd.Grid(len(points[-1][1][0]) // 2 - 1)
            guess = fdb.refined(points[-1][1], coarser, fd.Grid(n))
            points.append(fdc.cusp(points[-1][0], fd.Grid(n), guess))
        rows.append((alpha, lf))
        a.append(fdb.richardson(*(np.array([t.delta1, p, y[0] - 1]) for t, (y, p) in points)))
        ends = [col.cusp(col.fold_top(state)) for state in by_collocation]
        b.append(col.resolved(*([s.tube.delta1, s.p, s.u_max] for s in ends)))
    columns = text.SERIES.keys(alpha=[r[0] for r in rows], lf=[r[1] for r in rows])
    columns += stacked(name, ("delta1", "p", "u_max"), a, b)
    notes = f"{text.CUSP_NOTES} Not in the table, as (alpha, lf): {'; '.join(absent)}."
    parameters = {"u_max_searched": CUSP_U_STOP}
    extra = {"keys": ["alpha", "lf"]}
    title, source = "Cusps of the fold line", "figure 3(b)"
    return text.SERIES.table(name, title, source, parameters, columns, notes=notes, extra=extra)


def state_profile(name: str, tube: Tube, p: float | None, source: str) -> Table:
    """Profile at the first crossing of a pressure, or at the first limit point (None)."""
    z_plot = steps(0.0, tube.lf / 2, tube.lf / 80)
    if p is None:
        by_fd, by_collocation, _ = first_limits(tube)
        where = "the first limit point"
    else:
        guess = fdb.Trace(tube, fd.Grid(fdb.GRIDS[0])).run(U_STOP).near("p", p)
        by_fd = fdb.on_three_grids(tube, guess, fdb.condition_for("p", p))
        found = col.branch(tube, col.MESHES[-1], "u_max", steps(0.05, U_STOP, 0.05))
        by_collocation = col.state_at_pressure(found, p)
        where = f"p = {p:g}, first crossing along the branch"
    a = fdb.profiles(tube, by_fd, z_plot)
    raw = [col.profile(s, z_plot) for s in by_collocation]
    columns = text.SERIES.keys(Z=z_plot)
    for c in ("rho", "eta", "lam1", "lam2", "t1", "t2"):
        b = col.resolved(*(r[c] for r in raw))
        columns.append(agreed(name, c, a[c], b, text.COLUMNS[c]))
    state = by_collocation[-1]
    at = {"p": float(state.p), "u_max": state.u_max}
    title = f"Profile, alpha = {tube.alpha:g}, delta1 = {tube.delta1:g}, lf = {tube.lf:g}, {where}"
    return text.SERIES.table(name, title, source, given(tube) | at, columns)


OFF = (
    Tube(0.0, 1.0, 4.0),
    Tube(0.0, 2.5, 10.0),
    Tube(0.05, 1.3, 6.0),
    Tube(0.1, 1.05, 10.0),
    Tube(0.2, 1.0, 6.0),
    Tube(0.2, 3.0, 8.0),
)


def _limit_tables() -> dict[str, Builder]:
    """Tables of limit points."""
    out: dict[str, Builder] = {}
    for alpha, deltas in (
        (0.0, (1, 1.5, 1.6, 1.65, 1.7, 1.75, 2)),
        (0.1, (1, 1.1, 1.15, 1.2, 1.5, 2)),
    ):
        name = f"limit_points_alpha_{alpha:g}"
        tubes = [Tube(alpha, float(d), 6.0) for d in deltas]
        out[name] = partial(limits, name, tubes, ("delta1",), "figures 2 and 3")
    name, keys = "limit_points_off", ("alpha", "delta1", "lf")
    out[name] = partial(limits, name, list(OFF), keys, "the problem of figure 2 at other data")
    return out


def _curve_tables() -> dict[str, Builder]:
    """Tables over u_max."""
    out: dict[str, Builder] = {}
    for figure, alpha, deltas, stop in (
        ("2a", 0.0, (1, 1.5, 2), 4.0),
        ("2b", 0.1, (1, 1.5, 2), 4.0),
        ("3a", 0.1, (1, 1.1, 1.15, 1.2), 5.0),
    ):
        for d in deltas:
            name = f"fig0{figure}_delta1_{d:g}"
            tube, source = Tube(alpha, float(d), 6.0), f"figure {figure[0]}({figure[1]})"
            out[name] = partial(curve, name, tube, stop, source)
    for tube in OFF:
        name = f"off_alpha_{tube.alpha:g}_delta1_{tube.delta1:g}_lf_{tube.lf:g}"
        out[name] = partial(curve, name, tube, 4.0, "the problem of figure 2 at other data")
    return out


def _profile_tables() -> dict[str, Builder]:
    """Tables over Z."""
    out: dict[str, Builder] = {}
    for p in (0.5, 1, 1.5, 1.9):
        name = f"fig04_p_{p:g}"
        out[name] = partial(state_profile, name, Tube(0.1, 1.0, 6.0), float(p), "figure 4")
    name = "fig04_limit_1"
    out[name] = partial(state_profile, name, Tube(0.1, 1.0, 6.0), None, "figure 4")
    for d in (1, 1.5):
        for p in (1.5, 1.9):
            name = f"fig05_delta1_{d:g}_p_{p:g}"
            out[name] = partial(state_profile, name, Tube(0.1, float(d), 6.0), p, "figure 5")
    return out


TABLES: dict[str, Builder] = {
    **_curve_tables(),
    **_limit_tables(),
    "fig03b": partial(fold_line, "fig03b"),
    "cusp": partial(cusps, "cusp"),
    **_profile_tables(),
}
