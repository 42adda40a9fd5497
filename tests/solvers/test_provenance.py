"""A result states correctly how it was made."""

import subprocess

import pytest

from weakforms import solve
from weakforms.solvers.support import provenance

SMALL = {"cells": 16, "levels": 2, "degree": 3, "step": 0.3}
TAUT = {"delta1": 1.1, "p_end": 2.1}


@pytest.mark.parametrize(
    ("problem", "given", "numerics", "degree"),
    [
        ("homogeneous", {"lam_end": 1.5}, {}, 0),
        ("tube", {"u_end": 0.3}, SMALL, 8),
        ("tube", {"contact": "frictionless", "p_end": 2.1}, SMALL, 10),
        ("tube", {"contact": "adhesive", "phase": "deflation", "spring": "unilateral"} | TAUT, SMALL, 10),
        ("circular", {"contact": "adhesive", "p_end": 0.5}, SMALL, 10),
        ("wrinkled_tube", {"load": "gas", "load_end": 0.1}, {"cells": 4, "levels": 2, "degree": 4}, 16),
        ("wrinkled_patch", {"e_end": 0.01}, SMALL, 6),
        ("fluid_tube", {"n_max": 1, "zw_end": 0.7}, {"cells": 24, "degree": 4, "levels": 2, "step": 1}, 16),
    ],
)
def test_quadrature_is_that_of_the_form(problem, given, numerics, degree):
    assert solve(problem, numerics=numerics, **given).numerics["quadrature_degree"] == degree


@pytest.mark.parametrize(("answer", "revision"), [("abc123+\n", "abc123+"), (None, "unknown")])
def test_the_revision_is_what_git_says(answer, revision, monkeypatch):
    def run(command, **given):
        if answer is None:
            raise OSError("there is no git")
        out = answer if given.get("capture_output") and given.get("text") else None
        return subprocess.CompletedProcess(command, 0, out, "")

    monkeypatch.setattr(subprocess, "run", run)
    assert provenance.revision.__wrapped__() == revision
