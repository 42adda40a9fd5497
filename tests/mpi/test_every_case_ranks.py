"""Every case on several ranks stores the same as a serial run."""

from pathlib import Path

import pytest
from on_ranks import allowed, start

from weakforms.verification.audit.same import Run, runs
from weakforms.verification.cases.discovery import find_cases

pytestmark = [pytest.mark.mpi, pytest.mark.usefixtures("launcher")]
CHEAP = ("paper5.fig02",)
"""A patch, which every rank solves for itself, with a figure: how a run is divided and stored. The slow
tests solve every case on two and on four ranks."""


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """A serial run of a case, made once for all numbers of ranks."""
    known: dict[tuple[str, ...], Path] = {}

    def once(cases: tuple[str, ...]) -> Path:
        if cases not in known:
            known[cases] = tmp_path_factory.mktemp("serial")
            check(cases, known[cases], 1)
        return known[cases]

    return once


def check(cases: tuple[str, ...], out: Path, ranks: int) -> None:
    start(["-m", "weakforms", "check", *cases, "--out", str(out)], ranks, timeout=7200)


def compare(first: Path, second: Path) -> None:
    both = Run(first), Run(second)
    assert both[0].verdicts == both[1].verdicts
    found = runs(*both)
    numbers = [(item.spec, number) for item in found for number in item.found]
    assert numbers
    far = [f"{spec}: {x}" for spec, x in numbers if not x.relative <= allowed(x.place, spec)]
    assert far == []


def test_a_cheap_case_on_four_ranks(serial, tmp_path):
    check(CHEAP, tmp_path, 4)
    compare(serial(CHEAP), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("ranks", [2, 4])
@pytest.mark.parametrize("case", [found.id for found in find_cases()])
def test_case(serial, tmp_path, case, ranks):
    check((case,), tmp_path, ranks)
    compare(serial((case,)), tmp_path)
