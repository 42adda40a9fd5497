"""Pictures, tables and texts of prepared results show what their committed outlines say."""

import pytest
from outlined_results import sections
from outlines import clean, stored

STORED = stored("results/outlines.txt")


def test_no_outline_is_left_out():
    assert list(STORED) == list(sections())


@pytest.mark.parametrize("title", list(STORED))
def test_what_is_shown_is_what_its_outline_says(title):
    """After a change that is meant: ``./run shell -c 'python3 tests/outlines.py'``."""
    assert clean(sections()[title]()).split("\n") == STORED[title].split("\n")
