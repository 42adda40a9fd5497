"""Tables of paper 1, peeling: energy release rates of figures 11 and 12, pull-off points.

Patil, DasGupta & Eriksson, Int. J. Solids Struct. 67-68 (2015) 250-262, sections 4 and 5.4.
"""

from __future__ import annotations

from functools import lru_cache, partial

import numpy as np

from reference_data.solvers.core.tables import Column, DisagreementError, Table, round_up, steps
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import peeling as peel
from reference_data.solvers.paper1 import text
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.collocation.equations import Array
from reference_data.solvers.registry import Builder

PANELS: tuple[tuple[str, Case, tuple[float, ...]], ...] = (
    ("fig11a", dc.NH_1, (1.2, 1.4, 1.6, 2.2, 2.4)),
    ("fig11b", dc.MR_1, (1.2, 1.4, 1.6, 2.2, 2.4)),
    ("fig12a", dc.STIFF, (1.4, 1.6, 1.8, 2.3, 2.7)),
    ("fig12b", dc.MR_2, (2.4, 3.2, 3.8, 4.2, 5.6)),
)
OFF = ((dc.OFF[0], (2.0, 2.6)), (dc.OFF[1], (2.4, 3.0)), (dc.OFF[3], (0.6, 0.8)), (dc.OFF[4], (2.4, 3.2)))
GRID = steps(0.06, 0.6, 0.02)
KEYS = ("alpha", "beta", "k", "l", "p")
SAID = (
    "State at p with the patch that inflation left at that radius: G does not depend on the largest "
    "radius reached before. Peeling at fixed pressure, per deformed area."
)


def described(case: Case) -> dict[str, object]:
    """Parameters of a case as stored with the table."""
    return case.disk.parameters | {"contact": "adhesive", "adhesion": "locked", "phase": "peeling"}


@lru_cache(maxsize=64)
def start(case: Case, p: float) -> tuple[tuple[float, float], ...]:
    """(rho_contact, X_contact) of adhesive inflation at p, per method and level."""
    edges = [dc.edge_a(case, p, i).patch for i in dc.BOTH]
    out = [(e.rho, case.disk.beta * e.x) for e in edges]
    for i in dc.BOTH:
        x, batch = dc.edge_b(case, p, i)
        out.append((float(batch.y[0][0, 0, 0, 0]), case.disk.beta * x))
    return tuple(out)


def radii(case: Case, p: float) -> Array:
    """Contact radii of a curve; above first contact those beyond the one inflation reaches."""
    known = GRID[peel.widest(case) > GRID]
    if p < dc.touching(case.disk):
        return known
    return known[known > start(case, p)[-1][0] + 2e-3]


def rates(name: str, case: Case, p: float, rho: Array) -> tuple[list[Column], dict[str, object]]:
    """Columns of G over contact radii at fixed p by both methods, and how far the potential's quotient is.

    Raises:
        DisagreementError: If the closed form is not the difference quotient of the potential.
    """
    a = [
        {"G": peel.rates_a(case, p, i)(rho), "X_contact": case.disk.beta * peel.fronts_a(case, rho, i)}
        for i in dc.BOTH
    ]
    b = [
        {"G": peel.rates_b(case, p, i)(rho), "X_contact": case.disk.beta * peel.fronts_b(case, rho, i)}
        for i in dc.BOTH
    ]
    gap = peel.quotient(case, p, peel.fronts_b(case, rho, 1), 1) - b[-1]["G"]
    worst = float(np.max(np.abs(gap)))
    if worst > 1e-8:
        raise DisagreementError(
            f"table {name}: closed form and difference of the potential differ by {worst:.1e}"
        )
    columns = [dc.given("rho_contact", rho), *dc.columns(name, ("G", "X_contact"), a, b)]
    return columns, {"largest_difference_to_potential_quotient": round_up(worst)}


def curve(name: str, case: Case, p: float, source: str) -> Table:
    """G over the contact radius at fixed p."""
    columns, extra = rates(name, case, p, radii(case, p))
    return dc.table(
        name,
        f"Energy release rate at p = {p:g}, {case.title}",
        source,
        described(case) | {"p": float(p), "p_contact": dc.touching(case.disk)},
        columns,
        notes=f"{text.LOCKED} {SAID}",
        model="locked",
        extra=extra,
    )


def every() -> list[tuple[Case, float]]:
    """All cases and pressures, sorted by their keys."""
    pairs = [(case, p) for _, case, pressures in PANELS for p in pressures]
    pairs += [(case, p) for case, pressures in OFF for p in pressures]
    return sorted(pairs, key=lambda c: (c[0].disk.alpha, c[0].disk.beta, c[0].disk.k, c[0].disk.l, c[1]))


def keyed(pairs: list[tuple[Case, float]]) -> list[object]:
    """Key columns of a table: parameters and pressure of each row."""
    values = [{**case.disk.parameters, "p": p} for case, p in pairs]
    return [dc.given(c, [v[c] for v in values]) for c in KEYS]


def pull_off_columns(name: str, pairs: list[tuple[Case, float]]) -> list[Column]:
    """Minima of G over the contact radius by both methods, one row for each case and pressure.

    Raises:
        DisagreementError: If a curve has no interior minimum.
    """
    sides = []
    for rates, points in ((peel.rates_a, 11), (peel.rates_b, 13)):
        side = []
        for i in dc.BOTH:
            found = [peel.minimum(rates(case, p, i), radii(case, p)[::3], points) for case, p in pairs]
            if None in found:
                raise DisagreementError(f"table {name}: no pull-off point for {pairs[found.index(None)]}")
            rho, rate = np.array(found).T
            place = peel.fronts_a if rates is peel.rates_a else peel.fronts_b
            X = [c.disk.beta * place(c, np.array([r]), i)[0] for (c, _), r in zip(pairs, rho, strict=True)]
            side.append({"rho_contact": rho, "G": rate, "X_contact": np.array(X)})
        sides.append(side)
    return dc.columns(name, ("rho_contact", "G", "X_contact"), *sides)


def pull_off(name: str) -> Table:
    """Minimum of G over the contact radius, for pressures below first contact."""
    pairs = [(case, p) for case, p in every() if p < dc.touching(case.disk)]
    columns = [*keyed(pairs), *pull_off_columns(name, pairs)]
    return dc.table(
        name,
        "Pull-off points",
        "figures 11 and 12, points q",
        {"contact": "adhesive", "adhesion": "locked", "phase": "peeling"},
        columns,
        notes=f"{text.LOCKED} {SAID}",
        model="locked",
        extra={"keys": list(KEYS)},
    )


def release_start(name: str) -> Table:
    """Start of the curves above first contact, with G = 0: adhesive inflation at that pressure."""
    pairs = [(case, p) for case, p in every() if p > dc.touching(case.disk)]
    found = np.array([start(case, p) for case, p in pairs])
    rows = [{"rho_contact": found[:, j, 0], "X_contact": found[:, j, 1]} for j in range(4)]
    columns = [*keyed(pairs), *dc.columns(name, ("rho_contact", "X_contact"), rows[:2], rows[2:])]
    return dc.table(
        name,
        "Contact radii at which peeling above first contact starts from G = 0",
        "figures 11 and 12",
        {"contact": "adhesive", "adhesion": "locked", "phase": "inflation"},
        columns,
        notes=text.LOCKED,
        model="locked",
        extra={"keys": list(KEYS)},
    )


def _tables() -> dict[str, Builder]:
    """Every table of this module."""
    out: dict[str, Builder] = {}
    for head, case, pressures in PANELS:
        for p in pressures:
            source = f"figure {head[3:5]}({head[5]})"
            out[f"{head}_p_{p:g}"] = partial(curve, f"{head}_p_{p:g}", case, p, source)
    for case, pressures in OFF:
        name = f"off_peeling_{case.long_label}_p_{pressures[0]:g}"
        out[name] = partial(curve, name, case, pressures[0], "section 5.4 at other data")
    out["pull_off"] = partial(pull_off, "pull_off")
    out["release_start"] = partial(release_start, "release_start")
    return out


TABLES: dict[str, Builder] = _tables()
