"""Cross-check of another code: the inflated tube of Paper 2 by scipy's boundary value solver.

A pre-stretched Mooney-Rivlin tube between two rigid disks (alpha = 0.1, delta1 = 1.1, lf = 6), past its
limit points. This file contains the equations (balance of forces) and uses only the verdict of weakforms.
Run: ``python examples/scipy_tube.py`` (needs scipy and weakforms; no DOLFINx).
"""

import sys
from typing import Any

import numpy as np
from scipy.integrate import solve_bvp

import weakforms

ALPHA, STRETCH, LENGTH = 0.1, 1.1, 6.0


def energy_slopes(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, ...]:
    """First derivatives of the energy, and the second ones needed, in the principal stretches a, b."""
    first = 2 * (a - 1 / (a**3 * b**2)) + 2 * ALPHA * (a * b**2 - 1 / a**3)
    second = 2 * (b - 1 / (b**3 * a**2)) + 2 * ALPHA * (b * a**2 - 1 / b**3)
    aa = 2 * (1 + 3 / (a**4 * b**2)) + 2 * ALPHA * (b**2 + 3 / a**4)
    ab = 4 / (a * b) ** 3 + 4 * ALPHA * a * b
    return first, second, aa, ab


def equations(_z: np.ndarray, y: np.ndarray, parameters: np.ndarray) -> np.ndarray:
    """Radius, height, angle of the meridian and its stretch, per axial coordinate of the stretched tube."""
    (p,) = parameters
    r, _, angle, a = y
    root = np.sqrt(STRETCH)
    w1, w2, w11, w12 = energy_slopes(a, r / root)
    dr, dz = a / STRETCH * np.cos(angle), a / STRETCH * np.sin(angle)
    turn = (-w2 / STRETCH * np.sin(angle) + p * r * a / STRETCH) / (root * w1)
    stretching = (w2 / STRETCH * np.cos(angle) / root - w12 * dr / root) / w11
    return np.vstack([dr, dz, turn, stretching])


def inflated(bulge: float, guess: Any) -> Any:
    """The state with a prescribed displacement of the mid-plane; its pressure is part of the solution."""

    def ends(middle: np.ndarray, disk: np.ndarray, _p: np.ndarray) -> np.ndarray:
        held = [middle[0] - 1 - bulge, middle[1], middle[2] - np.pi / 2]
        return np.array([*held, disk[0] - 1, disk[1] - LENGTH / 2])

    found = solve_bvp(equations, ends, guess.x, guess.y, guess.p, tol=1e-9, max_nodes=50_000)
    if not found.success:
        sys.exit(f"no solution at u = {bulge:g}: {found.message}")
    return found


class Start:
    """The stretched cylinder."""

    x = np.linspace(0, LENGTH / 2, 41)
    y = np.vstack([np.ones(41), x, np.full(41, np.pi / 2), np.full(41, STRETCH)])
    p = np.array([0.3])


displacements, pressures, state = np.linspace(0.1, 4.0, 40), [], Start
for u in displacements:
    state = inflated(u, state)
    pressures.append(state.p[0])

verdicts = weakforms.compare(
    "paper2.fig03",
    {"bulge": displacements, "pressure": pressures},
    name="fig03a_delta1_1.1",
    columns={"u_max": "bulge", "p": "pressure"},
    only=["p"],  # the table has stretches, a tension and a volume too
)
worst = verdicts.verdicts[0]
print(f"{worst.statement}: error {worst.signed_error:+.1e}, bound {worst.bound:.1e} at {worst.where}")
print(verdicts.status)
sys.exit(verdicts.exit_status)
