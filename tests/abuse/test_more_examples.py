"""The property-based tests of all inputs again, with many examples."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOORS = ("tests/cli/test_doors.py", "tests/abuse/test_hostile_files.py", "tests/abuse/test_hostile_names.py")


@pytest.mark.slow
@pytest.mark.parametrize("door", DOORS)
def test_many_examples(door):
    environment = os.environ | {"WEAKFORMS_EXAMPLES": "200"}
    words = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-m", "not slow", door]
    done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:]
