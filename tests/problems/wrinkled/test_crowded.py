"""Spectra of waves so short that their bending stiffness alone makes all eigenvalues nearly equal."""

import pytest

from weakforms.api import solve_requests


@pytest.mark.slow
def test_crowded_eigenvalues_of_short_waves_are_found():
    """``beta n^4`` is a billion times the other stiffness: SLEPc's usual basis did not converge."""
    shape = {"M": 1.803, "delta": 4.272, "c2": 0.2296, "L": 4.985, "Af": "critical"}
    given = {
        "load": "gas",
        "energy": "standard",
        "load_end": 18.48,
        "n": (244,),
        "beta": 0.3321,
        "volume_end": 302.4,
    }
    result = solve_requests("wrinkled_tube", shape | given, {}, [], branch_uncertainty=False)
    assert result.failures == []
    columns = result.branch().columns
    assert (columns["Lambda_n244_1"] > 1e4).all()
    assert not [point for point in result.special_points if point.kind == "stability_change"]
