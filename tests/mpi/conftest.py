"""Fixtures that solve serially and on several ranks and compare all numbers."""

import shutil

import pytest
from on_ranks import Ranks, allowed

from weakforms import solve
from weakforms.results import Result
from weakforms.verification.audit.same import differences


@pytest.fixture(scope="session")
def run():
    """Solves some requests serially, or on ranks that are started once for all tests."""
    started: dict[int, Ranks] = {}

    def solved(requests: list[dict], ranks: int) -> list[Result]:
        if ranks == 1:
            return [Result.from_json(solve(**request).to_json()) for request in requests]
        if ranks not in started or not started[ranks].running:
            started[ranks] = Ranks(ranks)
        *found, size = started[ranks].solve(requests)
        assert size == ranks
        return [Result.from_json(item) for item in found]

    yield solved
    for of in started.values():
        of.end()


def beyond(first: Result, second: Result) -> list[str]:
    """The numbers of two results that differ by more than allowed, the largest difference first."""
    said = {name: first.parameters.get(name) for name in ("contact", "spring")}
    spec = f"contact={said['contact']}, spring={said['spring']}, degree={first.numerics.get('degree')}"
    return [
        str(item) for item in differences(first, second) if not item.relative <= allowed(item.place, spec)
    ]


@pytest.fixture(scope="session")
def launcher():
    """Skip unless the MPI launcher is installed."""
    if shutil.which("mpirun") is None:
        pytest.skip("needs an MPI launcher")


@pytest.fixture
def same_on_ranks(launcher, run):
    """Solves serially, in this process, and on several ranks; every number must agree."""

    def check(requests: list[dict]) -> list[Result]:
        serial, split = run(requests, 1), run(requests, 2)
        for a, b in zip(serial, split, strict=True):
            assert a.failures == b.failures == []
            assert beyond(a, b) == []
        return serial

    return check
