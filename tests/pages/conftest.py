"""The run that the tests of the report share, and the folder of its report."""

from pathlib import Path

import pytest
from canned_run import failing_case, hostile_case, passing_case, sample

from weakforms.verification.report.report import write_report


@pytest.fixture(scope="session")
def run():
    return sample(passing_case(), failing_case(), hostile_case())


@pytest.fixture(scope="session")
def folder(run, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report") / "deep" / "out"
    assert write_report(run, folder) == folder / "index.html"
    return folder


@pytest.fixture(scope="session")
def pages(folder):
    """Text of every page by name."""
    return {path.name: path.read_text(encoding="utf-8") for path in sorted(Path(folder).glob("*.html"))}
