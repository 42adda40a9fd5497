"""Every seeded fault is caught; this takes half an hour."""

import pytest

from weakforms.verification.audit.faults.catalogue import select
from weakforms.verification.audit.faults.runner import run_faults

pytestmark = pytest.mark.slow


def test_every_fault_is_caught(tmp_path):
    run = run_faults(select(), tmp_path, jobs=2)
    assert [found.expectation for found in run.baseline if not found.passed] == []
    assert [fault.name for fault in run.faults if fault.status != "caught"] == []
    compared = [fault for fault in run.faults if fault.caught_by.kind in ("comparison", "test")]
    assert len(compared) > 0.9 * len(run.faults), "by what it is, not because nothing works any more"
