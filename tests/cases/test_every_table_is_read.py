"""No reference table lies idle: a curve, a path, a check or a claim of some case reads it."""

import ast
import re

import pytest

from weakforms.verification.cases.discovery import FoundCase, find_cases
from weakforms.verification.cases.references import ROOT, part

TABLES = sorted(path for path in part("reference_data", ROOT).glob("*/*.toml"))


def requested(source: str) -> set[str]:
    """Patterns of the names of tables in a file: every text, and what ``reference(group, f"...")`` reads."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.add(re.escape(node.value))
        called = getattr(getattr(node, "func", None), "id", "")
        if called == "reference" and isinstance(node.args[1], ast.JoinedStr):
            parts = node.args[1].values
            found.add("".join(re.escape(p.value) if isinstance(p, ast.Constant) else ".+" for p in parts))
    return found


def names(found: FoundCase) -> set[str]:
    """The same, and the names of the tables of its curves, paths and checks."""
    drawn = [d for panel in found.case.panels for d in (*panel.curves, *panel.paths)]
    tables = [getattr(c, "reference", None) for c in (*drawn, *found.case.checks)]
    patterns = {re.escape(name.partition("@")[0]) for name in tables if name}
    return patterns | requested(found.path.read_text("utf-8"))


@pytest.fixture(scope="module")
def read() -> set[tuple[str, str]]:
    return {(found.group, pattern) for found in find_cases() for pattern in names(found)}


@pytest.mark.parametrize("group", sorted({path.parent.name for path in TABLES}))
def test_every_table_of_a_group_is_read(read, group):
    patterns = [re.compile(pattern) for folder, pattern in read if folder == group]
    idle = [
        path.stem
        for path in TABLES
        if path.parent.name == group and not any(pattern.fullmatch(path.stem) for pattern in patterns)
    ]
    assert not idle


def test_the_names_in_a_claim_are_found():
    source = 'for name in ("one", "two"):\n    reference(4, f"fd_{load}")\n    reference(4, name)'
    assert {"fd_.+", "one", "two"} <= requested(source)
    assert ".+" not in requested(source)
