"""Fixtures that solve serially and on several ranks and compare all numbers."""

import shutil

import pytest
from on_ranks import Ranks, beyond

from weakforms import solve
from weakforms.results import Result


@pytest.fixture(scope="session")
def on_two_ranks(launcher):
    """Solves requests on two ranks, which are started once for all tests, and again if a test ended them."""
    started: list[Ranks] = []

    def solved(requests: list[dict]) -> list[Result]:
        if not started or not started[-1].running:
            started.append(Ranks(2))
        *found, size = started[-1].solve(requests)
        assert size == 2
        return [Result.from_json(item) for item in found]

    yield solved
    for ranks in started:
        ranks.end()


@pytest.fixture(scope="session")
def launcher():
    """Skip unless the MPI launcher is installed."""
    if shutil.which("mpirun") is None:
        pytest.skip("needs an MPI launcher")


@pytest.fixture
def same_on_ranks(on_two_ranks):
    """Solves serially, in this process, and on two ranks; every number must agree.

    Without ``traces``, only states and special points: where a zone of wrinkles has just opened, its fronts
    have round-off, and with them the lengths of steps.
    """

    def check(requests: list[dict], traces: bool = True) -> list[Result]:
        serial = [Result.from_json(solve(**request).to_json()) for request in requests]
        split = on_two_ranks(requests)
        for a, b in zip(serial, split, strict=True):
            assert a.failures == b.failures == []
            assert [item for item in beyond(a, b) if traces or not item.startswith("branch ")] == []
        return serial

    return check
