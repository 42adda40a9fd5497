"""The software that computed a number: versions of packages, revision of the code, ranks."""

from __future__ import annotations

import platform
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import basix
import dolfinx
import ffcx
import numpy as np
import scipy
import ufl
from mpi4py import MPI
from petsc4py import PETSc
from slepc4py import SLEPc


@cache
def versions() -> dict[str, str]:
    """Version of every package on which a result depends."""
    return {
        "dolfinx": dolfinx.__version__,
        "ufl": ufl.__version__,
        "ffcx": ffcx.__version__,
        "basix": basix.__version__,
        "petsc": ".".join(map(str, PETSc.Sys.getVersion())),
        "slepc": ".".join(map(str, SLEPc.Sys.getVersion())),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "python": platform.python_version(),
    }


@cache
def revision() -> str:
    """Git revision of the source tree, with ``+`` if it has changes; ``unknown`` outside of a repository."""
    root = Path(__file__).resolve().parents[3]
    command = ["git", "-c", f"safe.directory={root}", "-C", str(root)]
    try:
        described = subprocess.run(
            [*command, "describe", "--always", "--dirty=+", "--abbrev=12"],
            capture_output=True,
            text=True,
            check=True,
            timeout=10,
        )
    except (OSError, subprocess.SubprocessError):
        return "unknown"
    return described.stdout.strip()


def quadrature_degree(form: ufl.Form) -> int:
    """Highest quadrature degree of the integrals of a form."""
    return max(integral.metadata().get("quadrature_degree", 0) for integral in form.integrals())


def provenance(comm: MPI.Intracomm, wall: float) -> dict[str, Any]:
    """Provenance block of a result."""
    return {**versions(), "git": revision(), "ranks": comm.size, "wall_s": round(wall, 3)}
