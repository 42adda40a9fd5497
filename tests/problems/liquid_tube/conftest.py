"""The axisymmetric branch from which tests of surfaces begin."""

import pytest
from bent_surfaces import DELTA, GAMMA, ONE, L

from weakforms.problems.liquid_tube.critical import PrimaryBranch


@pytest.fixture(scope="module")
def primary():
    return PrimaryBranch(ONE, L, DELTA, GAMMA)
