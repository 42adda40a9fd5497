"""Tables of adhesive contact and peeling of the disk with other laws, by the codes of paper 1."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.tables import Column, Table
from reference_data.solvers.paper1 import cases as dc
from reference_data.solvers.paper1 import tables_contact, tables_peeling, text
from reference_data.solvers.paper1.cases import Case
from reference_data.solvers.paper1.membrane import Disk
from reference_data.solvers.registry import Builder


@dataclass(frozen=True)
class Range:
    """What is tabulated of a law.

    Attributes:
        p_end: Pressure at which deflation starts.
        pressures: Rising pressures of deflation.
        peeling: Pressure of the curve of energy release rates, below first contact.
    """

    p_end: float
    pressures: tuple[float, ...]
    peeling: float


RANGES = {
    "ogden": Range(1.7, (0.2, 0.6, 1.0, 1.4, 1.7), 0.7),
    "gent": Range(3.2, (0.4, 1.2, 2.0, 2.6, 3.2), 1.4),
}
REACH = 0.46
"""Largest front position of adhesive inflation, beyond the end of inflation and of the peeling curves."""
FRONTS = np.array([0.1, 0.2, 0.3, 0.4])
RADII = np.array([0.16, 0.24, 0.32, 0.4, 0.48])
FACTS = {"contact": "adhesive", "adhesion": "locked"}


@cache
def case(model: str) -> Case:
    """The paper's disk without pre-stretch, k = 50 and l = 0.5, of a law with the tables' constants."""
    return Case(Disk(law(model), 1.0), REACH, RANGES[model].p_end)


def made(name: str, title: str, model: str, phase: str, columns: list[Column], **more: object) -> Table:
    """A table with the documentation common to all of them."""
    disk = case(model).disk
    data = {"beta": disk.beta, "k": disk.k, "l": disk.l}
    facts = {"model": model, **CONSTANTS[model], **data, **FACTS, "phase": phase} | more.pop("given", {})
    title = f"{title} of a disk of {model}"
    given = name, title, "the problem with another law", facts, columns
    return dc.table(*given, model="locked", paper="materials", **more)


def inflation(name: str, model: str) -> Table:
    """Adhesive inflation over the front position."""
    columns = tables_contact.adhesive_columns(name, case(model), FRONTS, "locked")
    return made(name, "Adhesive inflation", model, "inflation", columns, notes=text.LOCKED)


def deflation(name: str, model: str) -> Table:
    """Adhesive deflation over the pressure."""
    p = np.array(RANGES[model].pressures)
    columns = tables_contact.deflation_columns(name, case(model), p)
    notes = f"{text.LOCKED} {text.DEFLATION}"
    given = {"p_end": RANGES[model].p_end}
    return made(name, "Adhesive deflation", model, "deflation", columns, notes=notes, given=given)


def peeling(name: str, model: str) -> Table:
    """Energy release rates over the contact radius at a pressure below first contact."""
    p = RANGES[model].peeling
    columns, extra = tables_peeling.rates(name, case(model), p, RADII)
    notes = f"{text.LOCKED} {tables_peeling.SAID}"
    given = {"p": p}
    return made(name, "Energy release rate", model, "peeling", columns, notes=notes, given=given, extra=extra)


def pull_off(name: str, model: str) -> Table:
    """The minimum of that curve."""
    p = RANGES[model].peeling
    columns = [dc.given("p", [p]), *tables_peeling.pull_off_columns(name, [(case(model), p)])]
    notes = f"{text.LOCKED} {tables_peeling.SAID}"
    return made(name, "Pull-off point", model, "peeling", columns, notes=notes)


TABLES: dict[str, Builder] = {}
for _m in RANGES:
    for _kind, _build in (
        ("adhesive", inflation),
        ("deflation", deflation),
        ("peeling", peeling),
        ("pull_off", pull_off),
    ):
        TABLES[f"disk_{_kind}_{_m}"] = partial(_build, f"disk_{_kind}_{_m}", _m)
