"""Every case on several ranks stores the same as a serial run."""

from pathlib import Path

import pytest
from on_ranks import allowed, start

from weakforms.cli import app
from weakforms.terminal import guarded
from weakforms.verification.audit.same import Run, runs
from weakforms.verification.cases.discovery import find_cases

pytestmark = [pytest.mark.mpi, pytest.mark.usefixtures("launcher")]
CHEAP = "closed_form.infinite_tube"
"""Bodies that deform homogeneously. The slow tests solve every case on two and on four ranks."""


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """A serial run of a case, made once for all numbers of ranks."""
    known: dict[str, Path] = {}

    def once(case: str) -> Path:
        if case not in known:
            known[case] = tmp_path_factory.mktemp("serial")
            check(case, known[case], 1)
        return known[case]

    return once


def words(case: str, out: Path) -> list[str]:
    return ["check", case, "--out", str(out)]


def check(case: str, out: Path, ranks: int) -> None:
    start(["-m", "weakforms", *words(case, out)], ranks, timeout=7200)


def compare(first: Path, second: Path) -> None:
    both = Run(first), Run(second)
    assert both[0].verdicts == both[1].verdicts
    found = runs(*both)
    numbers = [(item.spec, number) for item in found for number in item.found]
    assert numbers
    far = [f"{spec}: {x}" for spec, x in numbers if not x.relative <= allowed(x.place, spec)]
    assert far == []


def test_a_cheap_case(two_ranks, tmp_path):
    """In processes that have all imports behind them."""
    assert guarded(lambda: app(words(CHEAP, tmp_path / "serial"), standalone_mode=False)) == 0
    assert two_ranks([{"words": words(CHEAP, tmp_path / "ranks")}]) == [0]
    compare(tmp_path / "serial", tmp_path / "ranks")


@pytest.mark.slow
@pytest.mark.parametrize("ranks", [2, 4])
@pytest.mark.parametrize("case", [found.id for found in find_cases()])
def test_case(serial, tmp_path, case, ranks):
    check(case, tmp_path, ranks)
    compare(serial(case), tmp_path)
