"""The tube in contact that several modules test, and secondary branches with either energy."""

import pytest
from mpi4py import MPI

from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.problem import Requests, Task
from weakforms.problems.tube.contact import ContactData
from weakforms.problems.tube.parameters import SecondaryNumerics, TubeParameters
from weakforms.problems.tube.problem import Tube

MESH = {"cells": 48, "levels": 2}
LONG_STEPS = MESH | {"step": 0.3}
"""For states and ends, which do not depend on how many points the trace has."""


def data(**changes):
    given = {"alpha": 0.1, "delta1": 1.0, "lf": 6.0, "k": 20.0, "s": 1.3} | changes
    return ContactData(mooney_rivlin_of(given.pop("alpha")), **given, cells=12, degree=4, grading=0.6)


def families(tube, numerics, energy):
    """The primary and the secondary branch."""
    given = TubeParameters(**tube, energy=energy), SecondaryNumerics(**numerics)
    return Tube().families(Task(*given, Requests(), MPI.COMM_SELF, lambda *_: None))


def require_alike(relaxed, ordinary, taut):
    """The crossing, and the state at a volume at which the tube is taut, are those of the law."""
    ours, theirs = (family["secondary"].fine for family in (relaxed, ordinary))
    for at in (lambda branch: branch.at_crossing(0), lambda branch: branch.at("V", taut)):
        here, there = at(ours).values, at(theirs).values
        for name in ("p", "u_max", "V", "Pi", "t_min"):
            assert here[name] == pytest.approx(there[name], abs=1e-9)
        assert here["wrinkled_fraction"] == 0
