"""The tube in contact that several modules test, and coarse numerics for it."""

from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.tube.contact import ContactData

MESH = {"cells": 48, "levels": 2}
LONG_STEPS = MESH | {"step": 0.3}
"""For states and ends, which do not depend on how many points the trace has."""


def data(**changes):
    given = {"alpha": 0.1, "delta1": 1.0, "lf": 6.0, "k": 20.0, "s": 1.3} | changes
    return ContactData(mooney_rivlin_of(given.pop("alpha")), **given, cells=12, degree=4, grading=0.6)
