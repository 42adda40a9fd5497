"""JUnit files for continuous integration."""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree as ET

from weakforms.verification.judging.outcome import CaseOutcome, RunOutcome, Verdict

_FORBIDDEN = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def clean(text: object) -> str:
    """The text, with every character that is not allowed in XML, HTML or UTF-8 replaced by U+FFFD."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", str(text))


def junit_xml(run: RunOutcome) -> str:
    """The run as JUnit XML: failures with their numbers, errors for cases that could not be solved.

    Args:
        run: Outcome of ``verify``.

    Returns:
        An XML document, declaration included, ending in a newline.
    """
    root = ET.Element("testsuites", name="weakforms", time=_seconds(run.seconds))
    totals = dict.fromkeys(("tests", "failures", "errors"), 0)
    for case in run.cases:
        suite = _suite(case, run)
        root.append(suite)
        for key in totals:
            totals[key] += int(suite.get(key, "0"))
    for key, value in totals.items():
        root.set(key, str(value))
    ET.indent(root)
    body = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{body}\n'


def _suite(case: CaseOutcome, run: RunOutcome) -> ET.Element:
    suite = ET.Element(
        "testsuite", name=clean(case.id), time=_seconds(case.seconds), timestamp=clean(run.started)
    )
    properties = ET.SubElement(suite, "properties")
    facts = {"profile": run.profile, "selection": run.selection, "source": case.source}
    for name, value in {**facts, **run.environment}.items():
        ET.SubElement(properties, "property", name=clean(name), value=clean(value))
    for verdict in case.verdicts:
        _testcase(suite, case, verdict)
    failures = sum(not verdict.passed for verdict in case.verdicts)
    errors = 0
    if case.status == "error":
        errors = 1
        _whole_case(suite, case, "error", "the case could not be judged in full")
    elif case.status == "failed" and not failures:
        failures = 1
        _whole_case(suite, case, "failure", "the case failed without a failed check")
    suite.set("tests", str(len(suite.findall("testcase"))))
    suite.set("failures", str(failures))
    suite.set("errors", str(errors))
    suite.set("skipped", "0")
    return suite


def _testcase(suite: ET.Element, case: CaseOutcome, verdict: Verdict) -> None:
    item = ET.SubElement(suite, "testcase", classname=clean(case.id), name=clean(verdict.check))
    if verdict.passed:
        return
    numbers = [
        f"{name} {value:.6g}"
        for name in ("error", "bound", "asked", "uncertainty", "reference_uncertainty")
        if (value := getattr(verdict, name)) is not None
    ]
    message = "; ".join([", ".join(numbers)] * bool(numbers) + [verdict.where] * bool(verdict.where))
    failure = ET.SubElement(item, "failure", type=clean(verdict.kind))
    failure.set("message", clean(message or verdict.statement))
    lines = [verdict.statement, verdict.detail, message, f"reference: {verdict.reference}"]
    failure.text = clean("\n".join(line for line in lines if line and line != "reference: "))


def _whole_case(suite: ET.Element, case: CaseOutcome, tag: str, fallback: str) -> None:
    item = ET.SubElement(suite, "testcase", classname=clean(case.id), name="(the case as a whole)")
    problem = ET.SubElement(item, tag, type=tag)
    problem.set("message", clean(case.errors[0].splitlines()[0] if any(case.errors) else fallback))
    problem.text = clean("\n".join(case.errors) or fallback)


def _seconds(value: float) -> str:
    return f"{value:.3f}" if math.isfinite(value) else "0.000"
