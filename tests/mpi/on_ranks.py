"""Run Python on several ranks, and the differences that its numbers may have."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOLERANCE = 1e-9
"""Relative to each number's scale."""
TRACTIONS = ("traction_front", "traction_max", "f_t")
LOOSER = dict.fromkeys(("X_iso", "Lambda_B1", "Lambda_B2", "kappa", *TRACTIONS), 1e-8)
"""Numbers that multiply round-off. ``X_iso`` is the place where lam1 - lam2 is 1e-4, and its slope there
is 1e-3. ``Lambda_B`` has the round-off of the shell's bending stiffness, which is far larger. ``kappa`` and
the axial traction of a patch hold second derivatives.
"""
FRICTIONLESS, OF_DEGREE_6 = 2e-7, 1e-6
"""Without friction that traction is zero, and round-off is all there is, on the cells of a small patch."""
LETTING_GO = 1e-6
"""Where a unilateral spring has just begun to let go, the block that it has left is 3e-6 of the length wide:
slopes in it multiply the round-off of positions."""


def start(arguments: list[str], ranks: int, timeout: float = 900) -> str:
    """Output of Python on several ranks; an error on one rank ends all (mpi4py's runner)."""
    environment = os.environ | {
        "PYTHONPATH": str(ROOT),
        "OMPI_ALLOW_RUN_AS_ROOT": "1",
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
        "OMPI_MCA_btl": "self,sm",
        "OMPI_MCA_mpi_yield_when_idle": "1",  # there may be fewer cores than ranks
        "OMP_NUM_THREADS": "1",
    }
    launch = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    done = subprocess.run(
        [*launch, sys.executable, "-m", "mpi4py", *arguments],
        capture_output=True,
        text=True,
        env=environment,
        timeout=timeout,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def allowed(place: str, spec: str) -> float:
    """Allowed difference of a number of a solution."""
    name = place.removesuffix(", uncertainty").split()[-1]
    if name in TRACTIONS and "contact=frictionless" in spec:
        return OF_DEGREE_6 if "degree=6" in spec else FRICTIONLESS
    if name in (*TRACTIONS, "line_force", "line_force_membrane") and "spring=unilateral" in spec:
        return LETTING_GO
    return LOOSER.get(name, TOLERANCE)
