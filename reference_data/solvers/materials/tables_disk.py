"""Tables of the circular membrane with laws other than Mooney-Rivlin, by the codes of paper 1."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.tables import Array, DisagreementError, Table, prescribed, steps
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import text
from reference_data.solvers.paper1.collocation import rows as rc
from reference_data.solvers.paper1.collocation import states as cs
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.paper1.shooting import rows as rs
from reference_data.solvers.paper1.shooting import states as ss
from reference_data.solvers.paper1.shooting.equations import LEVELS
from reference_data.solvers.registry import Builder

MODELS = ("ogden", "gent", "arruda_boyce")
CURVE = ("p", "lam_pole", "lam1_rim", "V")
TOP = 2.0
FREE = {"contact": "none", "phase": "inflation", "beta": 1.0}
WINDOW, NODES = 0.12, 13
DEEP, IN_CONTACT = 2.8, ("gent", "arruda_boyce")
"""Pressure of the table of contact, and its laws."""
TOUCHING = ("t0", "lam_pole", "lam1_rim", "X_contact", "rho_contact", "lam1_contact", "sigma_pole", "V")


def walked(model: str, t0: Array, i: int) -> tuple[dict[str, Array], dict[str, Array]]:
    """Columns at pole heights by shooting and by collocation, at one level of accuracy."""
    disk = Disk(law(model), 1.0)
    shots = dc.rows_of([rs.shot_row(s) for s in ss.rising(disk, LEVELS[i], t0)])
    batch = cs.joined(cs.rising(disk, cs.RESOLUTIONS[i].free, t0))
    return shots, rc.sliding_rows(batch)


def made(name: str, title: str, model: str, columns: list, **more: object) -> Table:
    """A table with the documentation common to all of them."""
    facts = {"model": model, **CONSTANTS[model], **FREE} | more.pop("parameters", {})
    return dc.table(name, title, "section 2", facts, columns, paper="materials", **more)


def curve(name: str, model: str) -> Table:
    """Free inflation over the pole height."""
    t0 = steps(0.1, TOP, 0.1)
    a, b = zip(*(walked(model, t0, i) for i in dc.BOTH), strict=True)
    columns = [dc.given("t0", t0), *dc.columns(name, CURVE, list(a), list(b))]
    return made(name, f"Free inflation of a disk of {model}", model, columns)


def limits(name: str, model: str) -> Table:
    """The limit point: the maximum of polynomials through states at Chebyshev nodes.

    Raises:
        DisagreementError: If there is not exactly one up to the highest pole.
    """
    coarse = steps(0.1, TOP, 0.1)
    p = walked(model, coarse, 0)[0]["p"]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(p)))) + 1
    if len(turns) != 1:
        raise DisagreementError(f"table {name}: {len(turns)} limit points")
    centre = coarse[turns[0]]
    nodes = centre - WINDOW * np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    t0 = np.concatenate([coarse[coarse < nodes[0] - 0.02], nodes])
    sides: list[list[dict[str, Array]]] = [[], []]
    for i in dc.BOTH:
        for side, found in zip(sides, walked(model, t0, i), strict=True):
            side.append(_turn(nodes, {n: found[n][-NODES:] for n in CURVE}))
    names = ("p", "t0", "lam_pole", "lam1_rim", "V")
    columns = [
        prescribed("order", np.ones(1), ("1", "1: first limit point met")),
        *dc.columns(name, names, *sides),
    ]
    notes = "dp/dt0 = 0 of a polynomial of degree 12 through p at Chebyshev nodes, both methods."
    return made(name, f"Limit point of a disk of {model}", model, columns, notes=notes)


def contact(name: str, model: str) -> Table:
    """Frictionless contact at one pressure."""
    disk, p = Disk(law(model), 1.0), np.array([DEEP])
    a = [dc.rows_of([rs.shot_row(s) for s in dc.sliding_a(disk, p, i)]) for i in dc.BOTH]
    b = [rc.sliding_rows(cs.joined(dc.sliding_b(disk, p, i))) for i in dc.BOTH]
    columns = [dc.given("p", p), *dc.columns(name, TOUCHING, a, b)]
    title = f"Frictionless contact of a disk of {model}"
    facts = {"contact": "frictionless", "k": disk.k, "l": disk.l}
    return made(name, title, model, columns, notes=text.SLIDING, parameters=facts)


def _turn(t0: Array, found: dict[str, Array]) -> dict[str, Array]:
    fits = {n: np.polynomial.Chebyshev.fit(t0, v, NODES - 1) for n, v in found.items()}
    roots = np.real(fits["p"].deriv().roots())
    at = float(roots[np.argmin(np.abs(roots - t0.mean()))])
    return {"t0": np.array([at]), **{n: np.array([fit(at)]) for n, fit in fits.items()}}


TABLES: dict[str, Builder] = {}
for _m in MODELS:
    TABLES[f"disk_{_m}"] = partial(curve, f"disk_{_m}", _m)
    TABLES[f"disk_limits_{_m}"] = partial(limits, f"disk_limits_{_m}", _m)
for _m in IN_CONTACT:
    TABLES[f"disk_contact_{_m}"] = partial(contact, f"disk_contact_{_m}", _m)
