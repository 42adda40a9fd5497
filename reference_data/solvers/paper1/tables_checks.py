"""Further tables of paper 1: freezing scheme, orders of continuity, change of curvature.

Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262, sections 3.2, 5 and 6.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core import continuity as con
from reference_data.solvers.core.collocation import differentiation, lagrange
from reference_data.solvers.core.newton import Secants
from reference_data.solvers.core.tables import Table, prescribed, steps
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import freezing, text
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.collocation import history as ch
from reference_data.solvers.paper1.collocation import rows as rc
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.collocation.equations import Array
from reference_data.solvers.paper1.shooting import history as sh
from reference_data.solvers.paper1.shooting import rows as rs
from reference_data.solvers.paper1.tables_profiles import drawn_b
from reference_data.solvers.registry import Builder

TOP = 0.57  # pole height of the results of the freezing scheme
STEPS = (7, 14, 28, 56)
KINDS = (("frictionless", 5.0), ("inflation", 3.2), ("deflation", 2.4))
NODES = (np.cos(np.pi * (2 * np.arange(10) + 1) / 20)[::-1] + 1) / 2
WIDTH = 0.08  # in X, length of the interval next to the front


def continuous(case: Case) -> tuple[list[float], list[float]]:
    """Pressure at the pole height TOP in the limit of small steps, by both methods."""
    ends = 0.1 / case.disk.beta, case.reach / case.disk.beta
    a, b = [], []
    for i in dc.BOTH:
        up = dc.inflation_a(case, i)
        a.append(up.at(brentq(lambda x: up.at(x).t0 - TOP, *ends, xtol=1e-15, rtol=1e-14)).p)  # noqa: B023
        run = dc.inflation_b(case, i)
        depth = lambda x: float(run.history.patch(np.array([x])).depth[0])  # noqa: B023, E731
        x = brentq(lambda s: case.disk.l + depth(s) - TOP, *ends, xtol=1e-15, rtol=1e-14)  # noqa: B023
        b.append(float(run.at(x).p[0]))
    return a, b


def freezing_scheme(name: str) -> Table:
    """Pressure at a pole height by the time-discrete scheme, over its step."""
    case = dc.MR_1
    disk = case.disk
    counts = STEPS[::-1]
    a, b = continuous(case)
    side_a = [
        np.array([a[i], *(freezing.shooting(dc.onset_a(disk, i), TOP, n) for n in counts)]) for i in dc.BOTH
    ]
    side_b = []
    for i in dc.BOTH:
        onset, how = dc.onset_b(disk, i), cs.RESOLUTIONS[i]
        side_b.append(np.array([b[i], *(freezing.collocation(disk, how, onset, TOP, n) for n in counts)]))
    delta = np.array([0.0, *((TOP - disk.l) / n for n in counts)])
    about = ("R_f", "step of the pole height; 0: the continuous limit, computed as such")
    error = side_b[1][1:] - b[1]
    orders = np.log2(error[1:] / error[:-1])
    limit = float(np.polynomial.polynomial.polyfit(delta[1:], side_b[1][1:], len(counts) - 1)[0])
    return dc.table(
        name,
        f"Time-discrete freezing scheme at t0 = {TOP:g}, {case.title}",
        "the algorithm of section 3.2",
        disk.parameters | {"contact": "adhesive", "adhesion": "locked", "phase": "inflation", "t0": TOP},
        [
            prescribed("delta_t", delta, about),
            dc.column(name, "p", side_a, side_b, text.COLUMNS["p"]),
        ],
        notes=(
            f"{text.LOCKED} Rows with delta_t > 0 raise the pole by delta_t from first contact, let a ring "
            "slide into contact and freeze it. The error is of first order."
        ),
        model="locked",
        extra={
            "observed_orders": [round(float(o), 3) for o in orders],
            "extrapolated_p": round(limit, 7),
            "extrapolated_minus_continuous": float(f"{limit - b[1]:.1e}"),
        },
    )


def one_sided(call: Callable[[Array], dict[str, Array]], front: float, side: int) -> dict[str, Array]:
    """Derivatives by X at the front, from the left (-1) or right (1), by field."""
    X = front + side * WIDTH * (NODES if side > 0 else NODES[::-1])
    profile, at = call(X), lagrange(X, np.array([front]))
    return {c: con.derivatives(differentiation(X), profile[c]) @ at[0] for c in con.FIELDS}


def jumps(kind: str, p: float, i: int) -> dict[str, Array]:
    """Jump of each derivative over the larger of its two one-sided values."""
    front, call = drawn_b(dc.MR_1, kind, np.array([p]), i)[0]
    return con.relative(*(one_sided(call, front, side) for side in (-1, 1)))


def continuity(name: str) -> Table:
    """Order of the first derivative that jumps at the contact edge."""
    kinds = {k: lambda at=at: tuple(jumps(*at, i) for i in dc.BOTH) for k, at in enumerate(KINDS, 2)}
    columns = con.columns(name, kinds, "X", "2 frictionless, 3 adhesive inflation, 4 adhesive deflation")
    pressures = {f"p_{kind}": p for kind, p in KINDS}
    return dc.table(
        name,
        f"Orders of continuity at the contact edge, {dc.MR_1.title}",
        "the statements of section 6 on continuity",
        dc.MR_1.disk.parameters
        | {"contact": "adhesive", "p_end": dc.MR_1.p_end, "threshold": con.JUMP}
        | pressures,
        columns,
        method=(
            "One-sided derivatives at the edge of polynomials through ten Chebyshev points on either side "
            "of it, from collocation at two resolutions."
        ),
        extra={"keys": ["kind", "field"]},
    )


def bend_a(case: Case, i: int) -> dict[str, float]:
    """Deflation state of vanishing curvature by shooting."""
    p = steps(0.2, case.p_end, 0.2)[::-1]
    edges = dc.deflated_a(case, p[p < case.p_end], i)
    value = lambda e: rs.edge_row(e, 1.0)["curvature"]  # noqa: E731
    j = next(j for j, e in enumerate(edges) if value(e) < 0)
    there = lambda q: sh.deflated(edges[j], q, Secants())  # noqa: E731
    return rs.edge_row(
        there(brentq(lambda q: value(there(q)), edges[j].p, edges[j - 1].p, xtol=1e-14, rtol=1e-13)), 1.0
    )


def bend_b(case: Case, i: int) -> dict[str, Array]:
    """The same by collocation."""
    p = steps(0.2, case.p_end, 0.2)[::-1]
    x, states = dc.deflated_b(case, p[p < case.p_end], i)
    run = dc.inflation_b(case, i)
    patch = run.history.patch(np.array([x]))
    value = lambda s: float(rc.patch_rows(s, patch, 1.0)["curvature"][0])  # noqa: E731
    j = next(j for j, s in enumerate(states) if value(s) < 0)
    there = lambda q: ch.deflated(case.disk, run.how, patch, states[j], np.array([q]))  # noqa: E731
    low, high = float(states[j].p[0]), float(states[j - 1].p[0])
    root = brentq(lambda q: value(there(q)), low, high, xtol=1e-14, rtol=1e-13)
    return rc.patch_rows(there(root), patch, 1.0)


def curvature_change(name: str) -> Table:
    """Pressure at which the free part stops bulging at the contact edge, in deflation."""
    cases = sorted(dc.PAPER, key=lambda c: (c.disk.alpha, c.disk.beta))
    a = [dc.rows_of([bend_a(case, i) for case in cases]) for i in dc.BOTH]
    b = [dc.rows_of([bend_b(case, i) for case in cases]) for i in dc.BOTH]
    keys = {c: [case.disk.parameters[c] for case in cases] for c in ("alpha", "beta", "k", "l")}
    keys["p_end"] = [case.p_end for case in cases]
    return dc.table(
        name,
        "Change of the meridional curvature at the contact edge",
        "section 5.3, figure 5",
        {"contact": "adhesive", "adhesion": "locked", "phase": "deflation"},
        [
            *(dc.given(c, v) for c, v in keys.items()),
            *dc.columns(name, ("p", "t0", "lam1_contact_outer"), a, b),
        ],
        notes=f"{text.LOCKED} {text.DEFLATION} Bulging (positive) above this pressure, negative below.",
        model="locked",
        extra={"keys": list(keys)},
    )


TABLES: dict[str, Builder] = {
    "freezing_scheme": partial(freezing_scheme, "freezing_scheme"),
    "continuity_orders": partial(continuity, "continuity_orders"),
    "curvature_change": partial(curvature_change, "curvature_change"),
}
