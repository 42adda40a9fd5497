"""Tables of adhesive contact and deflation of the tube with other laws, by the codes of paper 2."""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial

import numpy as np

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Column, Table
from reference_data.solvers.paper2 import contact_cases as cc
from reference_data.solvers.paper2 import contact_text as text
from reference_data.solvers.paper2 import tables_contact
from reference_data.solvers.paper2.contact_cases import Case
from reference_data.solvers.registry import Builder

PRESSURES = {"ogden": (0.9, 1.1, 1.3), "gent": (1.8, 2.2, 2.6)}
"""Pressures of inflation; the last one is where deflation starts."""
FALLING = {"ogden": (1.1, 0.7, 0.3, 0.0), "gent": (2.2, 1.4, 0.6, 0.0)}
"""Pressures of deflation."""


@cache
def case(model: str) -> Case:
    """The paper's tube without pre-stretch, of a law with the tables' constants."""
    return Case(Tube(law(model), 1.0, 6.0), cc.SOFT, PRESSURES[model][-1])


def made(name: str, title: str, model: str, phase: str, columns: list[Column], **more: object) -> Table:
    """A table with the documentation common to all of them."""
    tube, substrate = case(model).tube, case(model).substrate
    data = {"delta1": tube.delta1, "lf": tube.lf, "k": substrate.k, "s": substrate.s}
    facts = {"model": model, **CONSTANTS[model], **data, "contact": "adhesive", "phase": phase}
    facts |= {"p_end": case(model).p_end} | more.pop("given", {})
    about = replace(text.SERIES["adhesive"], paper="materials")
    title = f"{title} of a tube of {model}"
    return about.table(name, title, "the problem with another law", facts, columns, **more)


def inflation(name: str, model: str) -> Table:
    """Adhesive inflation over the pressure."""
    columns = tables_contact.inflation_columns(name, case(model), "adhesive", np.array(PRESSURES[model]))
    return made(name, "Adhesive inflation", model, "inflation", columns)


def deflation(name: str, model: str) -> Table:
    """Adhesive deflation with the bilateral spring over the pressure."""
    p = np.array(FALLING[model])
    columns = tables_contact.deflation_columns(
        name, case(model), "bilateral", p, len(p), tables_contact.DEFLATION
    )
    notes = f"{text.DEFLATION_NOTES} {text.SPRING['bilateral']}"
    given = {"spring": "bilateral"}
    return made(name, "Adhesive deflation", model, "deflation", columns, notes=notes, given=given)


TABLES: dict[str, Builder] = {}
for _m in PRESSURES:
    TABLES[f"tube_adhesive_{_m}"] = partial(inflation, f"tube_adhesive_{_m}", _m)
    TABLES[f"tube_deflation_{_m}"] = partial(deflation, f"tube_deflation_{_m}", _m)
