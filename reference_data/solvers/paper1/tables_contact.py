"""Tables of paper 1, contact branches: frictionless, adhesive inflation, adhesive deflation.

Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262, sections 3 and 5.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Column, Table, steps
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import text
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.collocation import rows as rc
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.collocation.equations import Array
from reference_data.solvers.paper1.shooting import rows as rs
from reference_data.solvers.registry import Builder

EDGE = ("X_contact", "rho_contact", "lam1_contact")
FRICTIONLESS = ("t0", "lam_pole", "lam1_rim", *EDGE, "sigma_pole", "X_iso", "V")
ADHESIVE = ("p", "t0", "rho_contact", "lam1_contact", "lam1_contact_outer", "lam1_rim", "sigma_pole", "V")
DEFLATION = ("t0", *EDGE, "lam1_contact_outer", "sigma_pole", "sigma_contact", "lam1_rim", "V")
HIGHEST = {"alpha_0.1_beta_2": 9.0, "alpha_0_beta_2": 7.0}  # pressures tabulated (others: 8)
LOWEST = 0.2  # pressure down to which deflation is tabulated


def frictionless(name: str, case: Case, source: str) -> Table:
    """Frictionless contact over the pressure."""
    onset, stop = dc.touching(case.disk), HIGHEST.get(case.label, 8.0)
    first = np.ceil((onset + 0.01) * 50) / 50
    p = np.concatenate([[round(first, 10)], steps(0.0, stop, 0.1)])
    p = np.concatenate([p[:1], p[1:][p[1:] > first + 0.02]])
    a = [dc.rows_of([rs.shot_row(s, iso=True) for s in dc.sliding_a(case.disk, p, i)]) for i in dc.BOTH]
    b = [rc.sliding_rows(cs.joined(dc.sliding_b(case.disk, p, i)), iso=True) for i in dc.BOTH]
    parameters = case.disk.parameters | {"contact": "frictionless", "phase": "inflation"}
    return dc.table(
        name,
        f"Frictionless contact, {case.title}",
        source,
        parameters,
        [dc.given("p", p), *dc.columns(name, FRICTIONLESS, a, b)],
        notes=text.SLIDING,
    )


def positions(case: Case) -> Array:
    """Front positions X of the tables of adhesive inflation."""
    return steps(0.02, np.floor((case.reach - 0.005) * 50) / 50, 0.02)


def adhesive_columns(name: str, case: Case, X: Array, adhesion: str) -> list[Column]:
    """Columns of adhesive inflation at front positions, by both methods."""
    x = X / case.disk.beta
    if adhesion == "locked":
        a = [
            dc.rows_of([rs.edge_row(run.at(float(s)), run.onset.lam) for s in x])
            for run in (dc.inflation_a(case, i) for i in dc.BOTH)
        ]
        b = []
        for i in dc.BOTH:
            run = dc.inflation_b(case, i)
            lam = float(run.onset.y[0][0, 0, 0, 2])
            b.append(rc.patch_rows(run.at(x), run.history.patch(x), lam))
    else:
        a = [
            dc.rows_of([rs.front_row(run, run.at(float(s))) for s in x[::-1]][::-1])
            for run in (dc.radial_a(case, i) for i in dc.BOTH)
        ]
        b = [
            rc.radial_rows(run.at(x), float(run.onset.y[0][0, 0, 0, 2]))
            for run in (dc.radial_b(case, i) for i in dc.BOTH)
        ]
    return [dc.given("X_contact", X), *dc.columns(name, ADHESIVE, a, b)]


def adhesive(name: str, case: Case, source: str, adhesion: str) -> Table:
    """Adhesive inflation over the front position."""
    parameters = case.disk.parameters | {"contact": "adhesive", "adhesion": adhesion, "phase": "inflation"}
    notes = text.LOCKED if adhesion == "locked" else text.RADIAL
    return dc.table(
        name,
        f"Adhesive inflation, {case.title}",
        source,
        parameters,
        adhesive_columns(name, case, positions(case), adhesion),
        notes=f"{notes} {text.FROZEN_POLE}",
        model=adhesion,
    )


def deflation_columns(name: str, case: Case, p: Array) -> list[Column]:
    """Columns of adhesive deflation at rising pressures, by both methods."""
    falling, a, b = p[::-1], [], []
    for i in dc.BOTH:
        lam = dc.onset_a(case.disk, i).lam
        a.append(dc.rows_of([rs.edge_row(e, lam) for e in dc.deflated_a(case, falling, i)][::-1]))
        x, states = dc.deflated_b(case, falling, i)
        patch = dc.inflation_b(case, i).history.patch(np.array([x]))
        lam = float(dc.onset_b(case.disk, i).y[0][0, 0, 0, 2])
        b.append(rc.patch_rows(cs.joined(states[::-1]), patch, lam))
    return [dc.given("p", p), *dc.columns(name, DEFLATION, a, b)]


def deflation(name: str, case: Case, source: str) -> Table:
    """Adhesive deflation over the pressure (rows by rising p)."""
    p = np.append(steps(LOWEST, 10.0, 0.2), case.p_end)
    p = np.unique(p[p <= case.p_end])
    parameters = case.disk.parameters | {
        "contact": "adhesive",
        "adhesion": "locked",
        "phase": "deflation",
        "p_end": case.p_end,
    }
    return dc.table(
        name,
        f"Adhesive deflation from p = {case.p_end:g}, {case.title}",
        source,
        parameters,
        deflation_columns(name, case, p),
        notes=f"{text.LOCKED} {text.DEFLATION}",
        model="locked",
    )


def _tables() -> dict[str, Builder]:
    """Every table of this module."""
    out: dict[str, Builder] = {}
    for case in (*dc.PAPER, *dc.OFF):
        off = case in dc.OFF
        head, tail = ("off_", case.long_label) if off else ("", case.label)
        other = " at other data" if off else ""
        out[f"{head}frictionless_{tail}"] = partial(
            frictionless, f"{head}frictionless_{tail}", case, f"figures 3 and 7{other}"
        )
        out[f"{head}adhesive_{tail}"] = partial(
            adhesive, f"{head}adhesive_{tail}", case, f"figures 4 and 8{other}", "locked"
        )
        out[f"{head}deflation_{tail}"] = partial(
            deflation, f"{head}deflation_{tail}", case, f"figures 5 and 9{other}"
        )
    for case in (dc.MR_1, dc.MR_2):
        name = f"adhesive_radial_{case.label}"
        source = "section 3.2 with the radius alone stuck"
        out[name] = partial(adhesive, name, case, source, "radial")
    return out


TABLES: dict[str, Builder] = _tables()
