"""States asked for at the very ends of a branch."""

from types import SimpleNamespace

import numpy as np
import pytest

from weakforms.results import Branch
from weakforms.solvers.continuation.branch import EquilibriumBranch


class Canned(EquilibriumBranch):
    """A branch with one column, which is given."""

    def __init__(self, values):
        self.values = np.array(values)
        self.loads = ("p",)
        self.system = SimpleNamespace(formulation=SimpleNamespace(monitors={}))

    def over_points(self, _name):
        """The column."""
        return self.values.copy()


@pytest.mark.parametrize("off", [0.0, 3.5e-18, -3.5e-18])
def test_a_value_at_an_end_counts_whatever_its_round_off(off):
    """``X_contact = 0.02``, where contact begins, was refused when the trace began at 0.02 + 3e-18."""
    for values in ([0.02 + off, 0.1, 0.2], [0.3, 0.1, 0.02 + off], [0.01, 0.02 + off, 0.03]):
        assert len(Canned(values).crossings("p", 0.02)) == 1
        assert Branch("primary", "p", {"p": np.array(values)}).crossings("p", 0.02) == 1


def test_a_value_beyond_an_end_does_not_count():
    assert len(Canned([0.02 + 1e-15, 0.1]).crossings("p", 0.02)) == 0
    assert Branch("primary", "p", {"p": np.array([0.02 + 1e-15, 0.1])}).crossings("p", 0.02) == 0


def test_the_interval_of_such_a_value_is_not_searched():
    branch = Canned([0.02 + 3.5e-18, 0.1])
    branch.points = [0, 1]
    branch._column = lambda point, _name: branch.values[point]
    assert branch._fraction(0, "p", 0.02) == 0.0
    branch.values = branch.values[::-1]
    assert branch._fraction(0, "p", 0.02) == 1.0
