"""Tables of paper 2, contact with a soft substrate: onset, frictionless, adhesive, deflation.

Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282, figures 6, 11 and 13.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Array, Column, Table, agreed, steps
from reference_data.solvers.paper2 import contact_cases as cc
from reference_data.solvers.paper2 import contact_text as text
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.critical import resolved
from reference_data.solvers.paper2.contact_cases import P_END, Case
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import deflation as defl
from reference_data.solvers.paper2.differences import equations as fd
from reference_data.solvers.paper2.substrate import Substrate
from reference_data.solvers.registry import Builder

CURVE = ("u_max", "contact_length", "lam1_mid", "t1_mid", "lam2_mid", "Z_front", "V")
DEFLATION = (
    "u_max",
    "line_force",
    "line_force_membrane",
    "t1_mid",
    "lam1_mid",
    "traction_max",
    "spring_max",
    "t2_min",
    "kappa",
)
LOWEST_SLACK = 0.5  # unilateral deflation of an unstretched tube is tabulated down to here
JUST_BELOW = 2.9  # there the finite differences do not resolve the strip that has lifted
LOW = (0.25, 0.45, 0.05)  # and a few columns of it at these pressures
SLACK_NOTES = (
    " As p falls below 0.5 the free part becomes nearly slack and a boundary layer at the front (curvature "
    "near -100 at p = 0.25) too thin for the finite differences: from there to p = 0.2 only what does not "
    "depend on the layer is tabulated (table ..._unilateral_low_...). Collocation on refined meshes goes on "
    "to p < 0.01, t1 staying positive, t2 being negative at the front below about p = 0.2."
)


def inflation_columns(name: str, case: Case, contact: str, p: Array) -> list[Column]:
    """Columns of inflation in contact at rising pressures, by both methods."""
    columns = text.SERIES[contact].keys(p=p)
    if contact == "frictionless":
        coarse = cfd.walk(case.tube, case.substrate, p)
        per_state = [[cfd.summary(s) for s in cfd.on_grids(state)] for state in coarse]
        a = [list(rows) for rows in zip(*per_state, strict=True)]
        b = [[st.summary(s) for s in states] for states in cc.frictionless(case, p)]
        return columns + cc.both(name, CURVE, a, b, (2, 3, 4))
    a = cc.interpolated(case, p)
    b = [[st.summary(s) | cc.tractions(s) for s in map(h.at, p)] for h in cc.histories(case)]
    return columns + cc.both(name, (*CURVE, "traction_front"), a, b, defl.POWERS)


def inflation(name: str, case: Case, contact: str, source: str) -> Table:
    """Inflation in contact over p."""
    columns = inflation_columns(name, case, contact, cc.pressures(case))
    parameters = case.parameters | {"phase": "inflation", "p_end": P_END}
    title = f"{contact.capitalize()} inflation against a substrate, {case.title}"
    return cc.table(contact, name, title, source, parameters, columns, notes=text.BEFORE)


def deflation_columns(
    name: str, case: Case, spring: str, p: Array, last: int, wanted: tuple[str, ...], step: float = 0.05
) -> list[Column]:
    """Columns of adhesive deflation at the ``last`` of falling pressures (rows by rising p), by both methods.

    Raises:
        RuntimeError: If a method does not find all states.
    """
    found = [states[-last:] for states in cc.deflated(case, spring, p) if len(states) == len(p)]
    by_grid = [states[-last:] for states in cc.deflated_fd(case, spring, p, step) if len(states) == len(p)]
    if (len(found), len(by_grid)) != (2, len(defl.GRIDS)):
        raise RuntimeError(f"table {name}: not all states found down to p = {p[-1]:g}")
    a = [[defl.summary(s) for s in states[::-1]] for states in by_grid]
    b = [[st.summary(s) | st.at_edge(s) | cc.tractions(s) for s in states[::-1]] for states in found]
    columns = text.SERIES["adhesive"].keys(p=p[-last:][::-1])
    return columns + cc.both(name, wanted, a, b, defl.POWERS, irregular=spring == "unilateral", amplified=16)


def deflation(name: str, case: Case, spring: str, source: str, low: bool = False) -> Table:
    """Adhesive deflation over p (rows by rising p); ``low``: a slack tube below the main table."""
    slack = spring == "unilateral" and case.tube.delta1 == 1
    p = steps(LOWEST_SLACK if slack else 0.0, P_END, 0.1)[::-1]
    if spring == "unilateral":
        p = p[np.abs(p - JUST_BELOW) > 1e-9]
    rows = steps(*LOW)[::-1] if low else p
    p = np.append(p, rows) if low else p
    wanted = ("u_max", "t1_mid", "lam1_mid") if low else DEFLATION[:-1] if slack else DEFLATION
    columns = deflation_columns(name, case, spring, p, len(rows), wanted, 0.005 if low else 0.05)
    notes = f"{text.DEFLATION_NOTES} {text.SPRING[spring]}{SLACK_NOTES if slack else ''}"
    parameters = case.parameters | {"phase": "deflation", "spring": spring, "p_end": P_END}
    title = f"Adhesive deflation, {spring} spring, {case.title}"
    return cc.table("adhesive", name, title, source, parameters, columns, notes=notes)


ONSET = (
    *cc.PAPER,
    *cc.OFF,
    Case(Tube(0.0, 1.5, 6.0), cc.SOFT),
    Case(Tube(0.1, 1.0, 6.0), Substrate(20.0, 1.15)),
    Case(Tube(0.1, 1.5, 6.0), cc.SOFT),
)


def onset(name: str) -> Table:
    """Pressure and volume at first touch."""
    cases = sorted(ONSET, key=lambda c: (c.tube.alpha, c.tube.delta1, c.tube.lf, c.substrate.s))
    a, b = [], []
    for case in cases:
        u = case.substrate.s - 1
        grid = fd.Grid(fdb.GRIDS[0])
        guess = fd.newton(case.tube, grid, fd.first_guess(case.tube, grid, u), fd.at_control("u", u))
        states = fdb.on_three_grids(case.tube, guess, fd.at_control("u", u))
        a.append([(p, fd.volume(y)) for y, p in states])
        b.append([(first.p, first.volume) for first in cc.touching(case)])
    keys = {
        "alpha": [c.tube.alpha for c in cases],
        "delta1": [c.tube.delta1 for c in cases],
        "lf": [c.tube.lf for c in cases],
        "s": [c.substrate.s for c in cases],
    }
    columns = text.SERIES["adhesive"].keys(**keys)
    for i, c in enumerate(("p", "V")):
        first = fdb.richardson(*(np.array([row[g][i] for row in a]) for g in range(3)))
        second = resolved(*(np.array([row[m][i] for row in b]) for m in range(2)))
        columns.append(agreed(name, c, first, second, text.COLUMNS[c]))
    return text.tube_text.SERIES.table(
        name,
        "First contact with the substrate",
        "the start of contact in figure 6",
        {"contact": "none", "phase": "inflation"},
        columns,
        notes=text.ONSET_NOTES,
        extra={"keys": list(keys)},
    )


def _tables() -> dict[str, Builder]:
    """Every table of this module."""
    out: dict[str, Builder] = {"contact_onset": partial(onset, "contact_onset")}
    for case in (*cc.PAPER, *cc.OFF):
        off = case in cc.OFF
        tail = f"{case.label}_lf_{case.tube.lf:g}" if off else case.label
        source = "the problem of figure {} at other data" if off else "figure {}"
        name = f"off_contact_frictionless_{tail}" if off else f"fig06a_{tail}"
        out[name] = partial(
            inflation, name, case, "frictionless", source.format("6(a)" if off else "6(a), 11(a)")
        )
        name = f"off_contact_adhesive_{tail}" if off else f"fig06b_{tail}"
        out[name] = partial(
            inflation, name, case, "adhesive", source.format("6(b)" if off else "6(b), 11(b)")
        )
        for spring in ("bilateral", "unilateral"):
            head = "off_contact" if off else "fig06b"
            name = f"{head}_deflation_{spring}_{tail}"
            out[name] = partial(deflation, name, case, spring, source.format("6(b)" if off else "6(b), 13"))
            if spring == "unilateral" and case.tube.delta1 == 1:
                name = f"{head}_deflation_unilateral_low_{tail}"
                out[name] = partial(deflation, name, case, spring, source.format("6(b)"), low=True)
    tail, source = f"{cc.DISTANT.label}_lf_{cc.DISTANT.tube.lf:g}", "the problem of figure {} at other data"
    name = f"off_contact_frictionless_{tail}"
    out[name] = partial(inflation, name, cc.DISTANT, "frictionless", source.format("6(a)"))
    name = f"off_contact_deflation_bilateral_{tail}"
    out[name] = partial(deflation, name, cc.DISTANT, "bilateral", source.format("6(b)"))
    return out


TABLES: dict[str, Builder] = _tables()
