"""``examples/run`` installs a code just before its program runs, and goes on if it cannot install one."""

import os
import subprocess
from pathlib import Path

import pytest

RUN = Path(__file__).resolve().parents[2] / "examples" / "run"
PYTHON = """#!/bin/sh
if [ "$2" = venv ]; then
  mkdir -p "$3/bin"
  printf '#!/bin/sh\\necho pip "$@" >> %s/log\\ncase "$*" in *sfepy*) exit 1;; esac' "$HERE" > "$3/bin/pip"
  printf '#!/bin/sh\\necho python "$@" >> %s/log' "$HERE" > "$3/bin/python"
  chmod +x "$3/bin/pip" "$3/bin/python"
fi
"""
"""A python3 whose environments write down what is asked of them, and whose pip has no sfepy."""


@pytest.fixture
def started(tmp_path):
    """``examples/run`` with words; its status, its output, and what it installed and ran, in order."""
    (tmp_path / "python3").write_text(PYTHON)
    (tmp_path / "python3").chmod(0o755)
    settings = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}", "HERE": str(tmp_path)}

    def start(*words):
        done = subprocess.run(
            ["bash", RUN, *words], env=settings, capture_output=True, text=True, check=False, timeout=60
        )
        log = (tmp_path / "log").read_text().splitlines() if (tmp_path / "log").exists() else []
        return done.returncode, done.stdout + done.stderr, [line.split("/")[-1].split()[-1] for line in log]

    return start


def test_a_program_needs_its_own_code_only(started):
    assert started("scipy_tube")[::2] == (0, ["tree", "scipy_tube.py"])


def test_a_code_that_cannot_be_installed_keeps_no_other_from_its_verdict(started):
    status, said, log = started()
    assert status == 1
    assert "not run: sfepy could not be installed" in said
    felupe, scikit = ["felupe>=10.2", "felupe_balloon.py"], ["scikit-fem", "scikit_fem_disk.py"]
    kratos = ["KratosStructuralMechanicsApplication>=10.4", "kratos_square.py"]
    ngsolve = ["ngsolve", "ngsolve_airbag.py", "ngsolve", "ngsolve_square.py"]
    assert log == ["tree", *felupe, *kratos, *ngsolve, *scikit, "scipy_tube.py", "sfepy"]


def test_decks_need_the_codes_named_only(started):
    status, _, log = started("decks", "calculix", "--mistakes")
    assert (status, log) == (0, ["tree", "--mistakes"])
    assert started("decks", "ngsolve")[2][-3:] == ["tree", "ngsolve", "ngsolve"]


def test_a_program_that_there_is_not_is_refused_before_anything_is_installed(started):
    status, said, log = started("scipy")
    assert (status, log) == (2, [])
    assert (
        "there are felupe_balloon kratos_square ngsolve_airbag ngsolve_square scikit_fem_disk scipy_tube"
        in said
    )
