"""Solves give what their committed outlines say: every number of a result and every word."""

import re

import pytest
from outlined_solves import SOLVES, solved
from outlines import clean, stored

from weakforms.problems import registry

STORED = stored("problems/outlines.txt")
NUMBER = re.compile(r"(?<![\w.])[-+]?(?:\d+\.?\d*(?:e[-+]?\d+)?|nan|inf)(?![\w.])")

RELATIVE, ABSOLUTE = 1e-7, 1e-9
"""Differences between numbers that another processor or release may make."""

OF_DIFFERENCES = 1e-3
"""The same for uncertainties and orders, relative: they are made of differences of nearly equal numbers."""


def unlike(line: str, was: str) -> bool:
    """Whether two lines differ by more than round-off."""
    if NUMBER.sub("#", line) != NUMBER.sub("#", was):
        return True
    if "DIVERGED" in line:  # its numbers have grown from round-off
        return False
    of_differences = {"uncertainty", "orders"} & set(line.partition(":")[0].split("/"))
    relative = OF_DIFFERENCES if of_differences else RELATIVE
    pairs = zip(NUMBER.findall(line), NUMBER.findall(was), strict=True)
    return any(float(a) != pytest.approx(float(b), relative, ABSOLUTE, nan_ok=True) for a, b in pairs)


def test_every_problem_has_an_outline():
    assert list(STORED) == list(SOLVES)
    assert {title.partition(",")[0] for title in SOLVES} == set(registry.abouts())


@pytest.mark.parametrize("title", list(STORED))
def test_a_result_is_what_its_outline_says(title):
    """After a change that is meant: ``./run shell -c 'python3 tests/outlines.py problems'``."""
    found, was = (text.split("\n") for text in (clean(solved(title)), STORED[title]))
    assert [(a, b) for a, b in zip(found, was, strict=False) if unlike(a, b)] == []
    assert len(found) == len(was)


def test_another_number_or_word_is_noticed():
    line = "branches[0]/columns/p: 12 of 12 0 1.234567891 0.5 0.75"
    assert not unlike(line, line.replace("1.234567891", "1.2345678911"))
    assert not unlike("a/uncertainty/p: 1.2345e-07", "a/uncertainty/p: 1.2347e-07")
    for changed in ("13 of 13 0 1.234567891 0.5 0.75", "12 of 12 0 1.234569 0.5 0.75", "12 of 12 0 0.5 0.75"):
        assert unlike(line, f"branches[0]/columns/p: {changed}")
    assert unlike("warnings[0]: raise cells", "warnings[0]: raise degree")
