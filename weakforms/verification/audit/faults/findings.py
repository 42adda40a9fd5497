"""What an answer of a probe says: which verdict noticed a fault, and whether all is well without one."""

from __future__ import annotations

from typing import Any

from weakforms.verification.audit.faults.catalogue import Expectation
from weakforms.verification.audit.faults.children import Answer
from weakforms.verification.audit.faults.outcome import Baseline, Finding

_RANK = {"comparison": 0, "test": 0, "not judged": 1, "not solved": 2, "stopped": 3}


def kind_of(verdict: dict[str, Any]) -> str:
    """How a failed verdict notices a fault (see ``KINDS`` in ``outcome.py``)."""
    if verdict["kind"] == "test":
        return verdict.get("raised") or "test"
    detail = str(verdict["detail"])
    if detail.startswith("not solved:"):
        return "not solved"
    return "not judged" if detail.startswith("could not be judged:") else "comparison"


def finding(answer: Answer, in_quick: bool) -> Finding:
    """The failed verdict that says most: a comparison before one that had nothing to compare."""
    where = Expectation(answer.expectation).case
    failed = [verdict for verdict in answer.verdicts if not verdict["passed"]]
    if not failed:
        return Finding("stopped", where, "", in_quick, "; ".join(answer.errors)[:400])
    first = min(failed, key=lambda verdict: _RANK[kind_of(verdict)])
    sizes = {key: first[key] for key in ("error", "bound", "asked")}
    return Finding(kind_of(first), where, first["check"], in_quick, str(first["detail"])[:400], **sizes)


def baseline_of(text: str, answer: Answer | None, failure: str) -> Baseline:
    """What an expectation does without a fault; one that judges nothing vouches for nothing."""
    if answer is None:
        return Baseline(text, False, 0, 0.0, failure or "it was not run")
    good = answer.status == "passed" and bool(answer.verdicts)
    wrong = [f"{v['check']}: {v['detail']}" for v in answer.verdicts if not v["passed"]] + answer.errors
    detail = "; ".join(wrong) or ("" if good else "nothing is judged by it")
    return Baseline(text, good, len(answer.verdicts), round(answer.seconds, 3), detail[:400])
