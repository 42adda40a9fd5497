"""XML: JUnit files for continuous integration, and drawings for inclusion in a page."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from xml.etree import ElementTree as ET

from weakforms.verification.judging.outcome import CaseOutcome, RunOutcome, Verdict

_FORBIDDEN = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def clean(text: object) -> str:
    """The text, with every character that is not allowed in XML, HTML or UTF-8 replaced by U+FFFD."""
    return _FORBIDDEN.sub("\N{REPLACEMENT CHARACTER}", str(text))


def inline_svg(drawing: str, ident: str, title: str, description: str, colours: Mapping[str, str]) -> str:
    """A matplotlib drawing, prepared for a page with other drawings.

    Args:
        drawing: The SVG document from matplotlib.
        ident: Every id, and every reference to one, gets this prefix.
        title: Accessible name.
        description: Description of the drawing in words.
        colours: Hexadecimal colour to the CSS variable that may replace it.

    Returns:
        An ``<svg>`` element without document type, metadata, style sheet or fixed size.
    """
    root = ET.fromstring(drawing)
    for parent in root.iter():
        for child in list(parent):
            if child.tag.rpartition("}")[2] in ("metadata", "style"):
                parent.remove(child)
    used = set(re.findall(r"#([\w-]+)", " ".join(v for e in root.iter() for v in e.attrib.values())))
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
        attributes = {key.rpartition("}")[2]: value for key, value in element.attrib.items()}
        element.attrib.clear()
        for key, value in attributes.items():
            if key != "id" or value in used:
                element.set(key, _rewritten(key, value, ident, colours))
    box = root.get("viewBox", "")
    root.attrib.clear()
    root.attrib |= {"xmlns": "http://www.w3.org/2000/svg", "viewBox": box, "role": "img"}
    root.attrib |= {"aria-labelledby": f"{ident}--title {ident}--desc", "class": "figure"}
    root.attrib |= {"stroke-linejoin": "round", "stroke-linecap": "butt"}
    for group in root.iter("g"):
        styles = {use.get("style") for use in group} if all(e.tag == "use" for e in group) else ()
        if len(styles) == 1 and len(group) > 1 and not group.get("style") and None not in styles:
            group.set("style", styles.pop() or "")
            for use in group:
                del use.attrib["style"]
    for place, (tag, text) in enumerate((("title", title), ("desc", description))):
        element = ET.Element(tag, id=f"{ident}--{tag}")
        element.text = clean(text)
        root.insert(place, element)
    return ET.tostring(root, encoding="unicode", short_empty_elements=True)


def _rewritten(key: str, value: str, ident: str, colours: Mapping[str, str]) -> str:
    if key == "id":
        return f"{ident}--{value}"
    if key == "href":
        return value.replace("#", f"#{ident}--")
    if key in ("d", "x", "y"):
        return " ".join(re.sub(r"(\.\d\d)\d+", r"\1", value).split())
    value = value.replace("url(#", f"url(#{ident}--")
    return re.sub(
        "#[0-9a-f]{6}",
        lambda hit: f"var({colours[hit[0]]},{hit[0]})" if hit[0] in colours else hit[0],
        value,
    )


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
