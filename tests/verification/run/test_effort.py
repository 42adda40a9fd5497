"""How long a run takes: the times of earlier runs, of the release, and the share that is done."""

import re
from pathlib import Path

import pytest

from weakforms import tube
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.run.effort import Effort
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.runner import expectation
from weakforms.verification.run.usual import usual_megabytes, usual_times


def test_a_first_run_is_estimated_by_the_shipped_times_at_the_pace_of_this_machine(tmp_path):
    specs = [tube(alpha=a) for a in (0, 0.1, 0.2)]
    usual = {str(spec): seconds for spec, seconds in zip(specs, (10.0, 20.0, 30.0), strict=True)}
    effort = Effort(tmp_path / "times.json", specs, usual)
    assert (effort.expected(2), effort.is_of_this_machine) == (30.0, False)
    effort.finish(specs[0], 5.0)
    assert effort.share() == (5.0, 30.0), "this machine is twice as fast"
    effort.finish(specs[1], 25.0)
    effort.finish(specs[2], 30.0)
    assert effort.is_of_this_machine


def test_times_of_most_solutions_are_shipped():
    states, shipped = Plan.of(find_cases()).states, usual_times()
    known = [spec for spec in states if str(spec) in shipped]
    assert len(known) >= 0.9 * len(states), "write them again: see weakforms/verification/run/usual.py"
    assert usual_megabytes(known[:10]) == pytest.approx(
        usual_megabytes([*known[:10], tube(alpha=0.77)]) / 1.1
    )
    text = expectation(Effort(Path("nowhere"), states, shipped), [*states], 2)
    assert re.fullmatch(r", about .+ min( .+ s)? by the times of a machine with two cores, \d+ MB", text)


def test_progress_counts_seconds_not_solutions(tmp_path):
    specs = [tube(alpha=a) for a in (0, 0.1, 0.2)]
    first = Effort(tmp_path / "times.json", specs)
    assert first.share() == (0, 3.0)
    first.finish(specs[0], 30.0)
    assert first.share() == (30.0, 90.0), "those not seen yet count as their like"
    first.finish(specs[1], 1.0)
    first.finish(specs[2], 2.0)
    first.keep()
    again = Effort(tmp_path / "times.json", specs)
    again.finish(specs[1])
    assert again.share() == (1.0, 33.0)
    assert again.count == "1 of 3"
    assert again.expected(2) == 16.0
    assert first.expected(1) == 0
    assert Effort(tmp_path / "times.json", [*specs, tube(alpha=0.3)]).expected(1) == 44.0
    new = [tube(alpha=a) for a in (0.3, 0.4, 0.5, 0.6)]
    assert Effort(tmp_path / "times.json", [*specs, *new]).expected(1) is None, "fewer than half are known"
    (tmp_path / "times.json").write_text("[1")
    assert Effort(tmp_path / "times.json", specs).share() == (0, 3.0)
