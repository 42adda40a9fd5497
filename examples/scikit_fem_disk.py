"""Cross-check of another code: the inflated disk of Paper 1 by finite elements in scikit-fem.

A Mooney-Rivlin disk (alpha = 0.1), stretched by beta = 2 before it is clamped. Residual and tangent are
written by hand, with quadratic elements. The height of the pole is prescribed and the pressure is unknown.
Three meshes show the order of convergence, and their limit is compared with the reference. The curve covers
only a part of the table, as the verdict says.
Run: ``python examples/scikit_fem_disk.py`` (needs scikit-fem and weakforms; no DOLFINx).
"""

import sys
from typing import Any

import numpy as np
from scipy.sparse import bmat, csr_matrix
from skfem import Basis, BilinearForm, ElementLineP2, ElementVector, LinearForm, MeshLine, solve

import weakforms

ALPHA, STRETCH = 0.1, 2.0
CELLS = (25, 50, 100)
HEIGHTS = np.linspace(0.1, 2.5, 25)


def membrane(w: Any) -> tuple:
    """Stretches, and derivatives of energy in them, at the state stored in ``w``."""
    r, slope = w["state"][0], w["state"].grad[:, 0]
    a, b = STRETCH * np.sqrt(slope[0] ** 2 + slope[1] ** 2), STRETCH * r / w.x[0]
    w1 = 2 * (a - 1 / (a**3 * b**2)) + 2 * ALPHA * (a * b**2 - 1 / a**3)
    w2 = 2 * (b - 1 / (b**3 * a**2)) + 2 * ALPHA * (b * a**2 - 1 / b**3)
    w11 = 2 * (1 + 3 / (a**4 * b**2)) + 2 * ALPHA * (b**2 + 3 / a**4)
    w22 = 2 * (1 + 3 / (b**4 * a**2)) + 2 * ALPHA * (a**2 + 3 / b**4)
    w12 = 4 / (a * b) ** 3 + 4 * ALPHA * a * b
    return r, slope, a, (w1, w2, w11, w12, w22), w.x[0] / STRETCH**2


def stretching(v: Any, slope: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Change of the meridional stretch with a displacement."""
    along = v.grad[:, 0]
    return STRETCH**2 * (slope[0] * along[0] + slope[1] * along[1]) / a


@LinearForm
def forces(v: Any, w: Any) -> np.ndarray:
    """First variation of the strain energy."""
    _, slope, a, (w1, w2, *_), weight = membrane(w)
    return weight * (w1 * stretching(v, slope, a) + w2 * STRETCH * v[0] / w.x[0])


@LinearForm
def pressure(v: Any, w: Any) -> np.ndarray:
    """Work of a unit pressure: the change of the enclosed volume per radian."""
    r, slope = w["state"][0], w["state"].grad[:, 0]
    return r * (slope[0] * v[1] - slope[1] * v[0])


@BilinearForm
def stiffness(u: Any, v: Any, w: Any) -> np.ndarray:
    """Second variation of the strain energy and of the pressure's work."""
    _, slope, a, (w1, _, w11, w12, w22), weight = membrane(w)
    da, db = (stretching(x, slope, a) for x in (u, v))
    ha, hb = (STRETCH * x[0] / w.x[0] for x in (u, v))
    du, dv = u.grad[:, 0], v.grad[:, 0]
    bent = STRETCH**2 * (du[0] * dv[0] + du[1] * dv[1]) / a - da * db / a
    elastic = w11 * da * db + w12 * (da * hb + ha * db) + w22 * ha * hb + w1 * bent
    return weight * elastic


@BilinearForm
def following(u: Any, v: Any, w: Any) -> np.ndarray:
    """Change of the pressure's work with the state, for a unit pressure."""
    r, slope = w["state"][0], w["state"].grad[:, 0]
    du = u.grad[:, 0]
    return u[0] * (slope[0] * v[1] - slope[1] * v[0]) + r * (du[0] * v[1] - du[1] * v[0])


def curve(cells: int) -> dict[str, np.ndarray]:
    """Pressure over the height of the pole on a mesh."""
    basis = Basis(MeshLine(np.linspace(0, 1, cells + 1)), ElementVector(ElementLineP2(), 2), intorder=8)
    (r_pole, r_rim), (z_pole, z_rim) = basis.nodal_dofs[:, [0, -1]]
    free = np.setdiff1d(np.arange(basis.N), [r_pole, r_rim, z_pole, z_rim])
    rows = np.append(free, z_pole)  # the pole's equation determines the pressure
    x, state = basis.doflocs[0], np.zeros(basis.N)
    for radial, axial in (basis.nodal_dofs, basis.interior_dofs):
        state[radial], state[axial] = x[radial], 0.05 * (1 - x[axial] ** 2)
    pressures, p = [], 1.0
    for height in HEIGHTS:
        taller = height / state[z_pole]
        for _, axial in (basis.nodal_dofs, basis.interior_dofs):
            state[axial] *= taller
        for _ in range(30):
            at = {"state": basis.interpolate(state)}
            load = pressure.assemble(basis, **at)
            residual = forces.assemble(basis, **at) - p * load
            tangent = (stiffness.assemble(basis, **at) - p * following.assemble(basis, **at)).tocsr()
            matrix = bmat([[tangent[rows][:, free], csr_matrix(-load[rows]).T]], "csr")
            step = solve(matrix, -residual[rows])
            state[free] += step[:-1]
            p += step[-1]
            if np.abs(step).max() < 1e-10:
                break
        else:
            sys.exit(f"no solution at height {height:g}")
        pressures.append(p)
    return {"t0": HEIGHTS, "p": np.array(pressures)}


curves = [curve(cells) for cells in CELLS]
verdicts = weakforms.compare("paper1.free", curves, name="free_alpha_0.1_beta_2", only=["p"])
print(f"cells {', '.join(map(str, CELLS))}: {verdicts.convergence[0].text}")
print(f"judged over t0 in {verdicts.covered} of {verdicts.table}")
print(verdicts.status)
sys.exit(verdicts.exit_status)
