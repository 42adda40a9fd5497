"""Fixtures that solve serially and on several ranks and compare all numbers."""

import json
import shutil

import pytest
from on_ranks import allowed, start

from weakforms import solve
from weakforms.results import Result
from weakforms.verification.audit.same import differences

PROGRAM = """
import json, sys
from mpi4py import MPI
from weakforms import solve
requests = json.loads(sys.argv[1])
found = [solve(**{**r, "at": [tuple(item) for item in r.get("at", [])]}).to_json() for r in requests]
if MPI.COMM_WORLD.rank == 0:
    print("RESULT" + json.dumps([*found, MPI.COMM_WORLD.size]))
"""


def run(requests: list[dict], ranks: int) -> list[Result]:
    """Results of :func:`weakforms.solve` for some requests, with several ranks in processes of their own."""
    if ranks == 1:
        return [Result.from_json(solve(**request).to_json()) for request in requests]
    output = start(["-c", PROGRAM, json.dumps(requests)], ranks)
    line = next(text for text in output.splitlines() if text.startswith("RESULT"))
    *found, size = json.loads(line.removeprefix("RESULT"))
    assert size == ranks
    return [Result.from_json(item) for item in found]


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
def same_on_ranks(launcher):
    """Calls :func:`run` serially, in this process, and on several ranks; every number must agree."""

    def check(requests: list[dict], ranks: int = 2) -> list[Result]:
        serial, split = run(requests, 1), run(requests, ranks)
        for a, b in zip(serial, split, strict=True):
            assert a.failures == b.failures == []
            assert beyond(a, b) == []
        return serial

    return check
