"""Every kind of solution of the cases, serially and on two ranks: all numbers agree.

A kind is a problem with a set of parameters, of which words and switches have one value. The cases have some
1300 solutions of a few hundred kinds; of each kind the one that takes least is solved.
"""

import pytest

from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.usual import usual_times

pytestmark = [pytest.mark.mpi, pytest.mark.slow]
UNKNOWN = 10.0
"""Seconds of a solution that no full run has measured yet."""
STATES = 3
"""Number of states that are compared besides branches and special points."""


def kind_of(spec: Spec) -> tuple:
    words = [(name, value) for name, value in spec.parameters if isinstance(value, str | bool)]
    return spec.problem, tuple(words), tuple(name for name, _ in spec.parameters)


def request_for(spec: Spec, states: list[At]) -> dict:
    """Keywords of :func:`weakforms.solve`, with a few of the cases' states on one branch."""
    wanted = [at for at in states if at.crossing == 1 and at.branch == states[0].branch][:STATES]
    asked = {"problem": spec.problem, **dict(spec.parameters), "numerics": dict(spec.numerics)}
    if wanted:
        asked |= {"at": [(at.name, at.value) for at in wanted], "branch": wanted[0].branch}
    return asked


def kinds() -> dict[str, dict]:
    """A request of every kind, by the solution's name."""
    seconds, plan = usual_times(), Plan.of(find_cases())
    least: dict[tuple, Spec] = {}
    for spec in sorted(plan.states, key=lambda spec: (seconds.get(str(spec), UNKNOWN), str(spec))):
        least.setdefault(kind_of(spec), spec)
    return {str(spec): request_for(spec, plan.states[spec]) for spec in least.values()}


KINDS = kinds()


@pytest.mark.parametrize("name", KINDS)
def test_kind(same_on_ranks, name):
    same_on_ranks([KINDS[name]])
