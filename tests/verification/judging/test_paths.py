"""Paths of material points, judged against their tables."""

import numpy as np
import pytest

from weakforms.cases import Path, circular, decide, reference
from weakforms.errors import InputError

POINTS = (0.1, 0.9)
DISK = circular(alpha=0.1, beta=1, contact="frictionless")
PATH = Path(DISK, "paths_fig03a", POINTS, {"rho": 1e-8, "eta": 1e-8})
TABLE = reference(1, "paths_fig03a")


class Solutions:
    """The states of the table, with one number moved."""

    def __init__(self, column="", row=0, by=0.0, uncertainty=1e-12):
        self._moved, self._uncertainty = (column, row, by), uncertainty

    def samples(self, _spec, at, name):
        """A coordinate of both points."""
        row = int(np.flatnonzero(TABLE.columns["p"] == at.value)[0])
        values = [
            TABLE.columns[column][row] + self._moved[2] * ((column, row) == self._moved[:2])
            for column in (f"{name}_{x:g}" for x in POINTS)
        ]
        return decide.Number(values, self._uncertainty)


def test_paths_as_in_the_table_pass():
    verdicts = list(PATH.judge(1, Solutions()))
    assert [v.check for v in verdicts] == PATH.names(1)
    assert len(verdicts) == 4
    assert all(v.passed and v.kind == "curve" for v in verdicts)


@pytest.mark.parametrize("row", [0, 20, 35])
def test_one_moved_point_fails_its_path_alone(row):
    verdicts = {v.check: v for v in PATH.judge(1, Solutions("eta_0.9", row, 1e-9))}
    assert [name for name, v in verdicts.items() if not v.passed] == ["paths_fig03a:eta_0.9"]
    assert verdicts["paths_fig03a:eta_0.9"].where == f"p = {TABLE.columns['p'][row]:g}"


def test_a_wide_bound_does_not_pass():
    assert not any(v.passed for v in PATH.judge(1, Solutions(uncertainty=1e-8)))


def test_the_table_of_another_membrane_is_refused():
    other = Path(circular(alpha=0.1, beta=2, contact="frictionless"), "paths_fig03a", POINTS)
    with pytest.raises(InputError, match="is for beta"):
        other.names(1)


def test_the_states_are_those_of_the_table():
    states = PATH.states(1)
    assert [at.value for at in states] == TABLE.columns["p"].tolist()
    assert {at.profile for at in states} == {POINTS}
