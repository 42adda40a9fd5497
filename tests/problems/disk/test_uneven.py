"""Free disks of uneven thickness."""

import pytest

from weakforms import solve
from weakforms.errors import ConvergenceError
from weakforms.solvers.continuation import branch as followed
from weakforms.solvers.stability.modes import Singular

DISK = {"cells": 16, "levels": 2}


def test_a_limit_point_whose_extended_system_fails_is_found_by_its_rate(monkeypatch):
    """On a thin pole the turn was so sharp that round-off exceeded the tolerance of the extended system."""
    given, coarse = (
        {"beta": 1.5, "M": 0.5, "t_end": 2.0, "alpha": 0.0},
        {"cells": 16, "levels": 2},
    )
    (usual,) = solve("circular", **given, numerics=coarse).points("limit_point")

    class Failing(Singular):
        def value(self, solver):
            raise ConvergenceError("round-off")

    monkeypatch.setattr(followed, "Singular", Failing)
    result = solve("circular", **given, numerics=coarse)
    assert result.failures == []
    (found,) = result.points("limit_point")
    assert found.values["p"] == pytest.approx(usual.values["p"], rel=1e-12)
    assert found.values["t0"] == pytest.approx(usual.values["t0"], rel=1e-7)


def test_a_thin_pole_that_stretches_without_limit_ends_the_branch():
    result = solve("circular", M=0.3, t_end=10.0, numerics={"cells": 16, "levels": 2})
    assert result.failures == []
    assert 20 < result.branch().columns["lam_pole"][-1] < 60
    assert "the thin pole, M = 0.3, is stretched to more than 20 times beta; lower t_end" in str(
        [part.reason for part in result.absent]
    )


def test_a_disk_in_contact_has_the_same_thickness_everywhere():
    """``M`` is for free inflation, as the warning says; the patch's history is that of a uniform disk."""
    given = {"contact": "adhesive", "p_end": 1.0}
    uniform, uneven = (
        solve("circular", **given, **more, numerics=DISK).branch().columns["t0"][-1]
        for more in ({}, {"M": 0.5})
    )
    assert uneven == uniform
