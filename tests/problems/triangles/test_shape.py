"""Fields of a state on triangles: principal stretches and directions from tangents."""

import numpy as np
import pytest

from weakforms.problems.triangles.shape import stretched

SQUARE = np.array([[[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]])
"""Tangents of one flat triangle in space along the axes, ``(1, 3, 2)``."""


@pytest.mark.parametrize("round_off", [1e-17, -1e-17, 0.0])
def test_a_direction_across_x_does_not_turn_with_round_off(round_off):
    # the larger stretch points along (0, 3, 4)/5: its sign must not be that of the round-off in t_x
    deformed = np.array([[[0.5, round_off], [0.0, 1.2], [0.0, 1.6]]])
    found = stretched(SQUARE, deformed, np.zeros(1), (1, 1))
    assert (found["lam1"].item(), found["lam2"].item()) == pytest.approx((2.0, 0.5), rel=1e-14)
    assert (found["t_y"].item(), found["t_z"].item()) == pytest.approx((0.6, 0.8), rel=1e-14)


def test_a_mirrored_copy_has_the_mirrored_direction():
    deformed = np.array([[[0.5, 1.2], [0.0, 0.0], [0.0, 1.6]]])
    here, there = (stretched(SQUARE, deformed, np.zeros(1), (sign, 1)) for sign in (1, -1))
    assert here["t_x"].item() > 0
    assert there["t_x"] == -here["t_x"]
    assert there["t_z"] == here["t_z"]
