"""Where the stability of triangles in space changes, and what is said of the eigenvalues there."""

import pytest

from weakforms import solve

pytestmark = pytest.mark.paper5


@pytest.mark.slow
def test_eigenvalues_beside_a_change_err_by_what_is_left_of_the_bracket():
    """They are those at its ends, and pass through zero somewhere between."""
    mesh = {"meridional": 60, "circumferential": 48, "load_start": 5.0, "load_end": 5.3}
    coarse, fine = (
        solve("surface", **mesh, numerics={"scan": 2, "tolerance": tolerance}).special_points[0]
        for tolerance in (1e-3, 1e-7)
    )
    for name in ("Lambda_1", "Lambda_1_stable"):
        error = abs(coarse.values[name] - fine.values[name])
        assert fine.uncertainty[name] < 0.01 * error
        assert error <= coarse.uncertainty[name] < 10 * error
