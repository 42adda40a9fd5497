"""Cross-check of another code: a square airbag by cubic triangles in NGSolve, wrinkled along its seam.

A quarter of one of two sheets is solved, with Saint Venant and Kirchhoff's law in plane stress and without
resistance to compression. Relaxed energy and volume of the gas are functions of the position; NGSolve makes
forces and tangent from them, and steps on which the potential falls lead to a minimum. Each pressure of the
table is solved for on two meshes. The curve claims no accuracy, because the table is less certain than the
difference of the meshes: it must do with what the case asks of the project's own code.
Run: ``python examples/ngsolve_airbag.py`` (needs ngsolve and weakforms; no DOLFINx).
"""

import sys

import numpy as np
from ngsolve import (
    CF,
    H1,
    BilinearForm,
    Cross,
    FESpace,
    GridFunction,
    IfPos,
    InnerProduct,
    Integrate,
    Variation,
    dx,
    grad,
    sqrt,
    x,
    y,
)
from ngsolve.meshes import MakeStructured2DMesh
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import splu

import weakforms
from weakforms.cases import reference

TABLE = reference("beyond", "airbag")
NU, PRESSURES = TABLE.parameters["poisson"], TABLE.columns["p"]
COLUMNS = ("w_c", "V", "Pi", "u_far")
DEGREE, CELLS = 3, (8, 12)
"""Degree, and squares of two triangles along half a side, on the coarse mesh and on the fine one."""

FIRST, LEAST, MOST = 1e-3, 1e-9, 800
"""Weight of the mass matrix in the first step, a weight too small to keep, and the most steps."""


def tangents(position: list[CF]) -> list[CF]:
    """Derivatives of the position in the two directions of the sheet."""
    return [CF(tuple(grad(part)[k] for part in position)) for k in range(2)]


def strains(position: list[CF]) -> tuple[CF, CF, CF]:
    """Energy of a taut sheet over ``E h``, and the principal strains of Green, the larger one first."""
    along, across = tangents(position)
    a, b = (InnerProduct(along, along) - 1) / 2, (InnerProduct(across, across) - 1) / 2
    c = InnerProduct(along, across) / 2
    taut = (a * a + b * b + 2 * NU * a * b + 2 * (1 - NU) * c * c) / (2 * (1 - NU**2))
    radius = sqrt((a - b) ** 2 / 4 + c * c + 1e-30)  # with a slope at zero too
    return taut, (a + b) / 2 + radius, (a + b) / 2 - radius


def energy(position: list[CF]) -> CF:
    """Relaxed energy per area without stress, over ``E h``: a wrinkled sheet is in uniaxial tension."""
    taut, first, second = strains(position)
    return IfPos(first, IfPos(second + NU * first, taut, first * first / 2), 0.0)


def gas(position: list[CF]) -> CF:
    """Volume under the sheet, per area without stress: the height times the area in the plan."""
    return position[2] * Cross(*tangents(position))[2]


def bag(cells: int, pressure: float) -> dict[str, float]:
    """Columns of the table at a minimum of the potential, on one mesh of the quarter ``[0, 1]^2``."""
    mesh = MakeStructured2DMesh(quads=False, nx=cells, ny=cells)
    held = ("left", "bottom", "right|top")  # x and y on mirrors, z at the seam, which slides in its plane
    space = FESpace([H1(mesh, order=DEGREE, dirichlet=edges) for edges in held])
    state, trial, test = GridFunction(space), list(space.TrialFunction()), list(space.TestFunction())
    dome = x * (1 - 0.15 * (1 - y * y)), y * (1 - 0.15 * (1 - x * x)), 0.5 * (1 - x * x) * (1 - y * y)
    for part, value in zip(state.components, dome, strict=True):
        part.Set(value)
    form, mass = BilinearForm(space, symmetric=True), BilinearForm(space, symmetric=True)
    form += Variation((energy(trial) - pressure * gas(trial)).Compile() * dx(bonus_intorder=2))
    mass += sum(a * b for a, b in zip(trial, test, strict=True)) * dx
    mass.Assemble()
    free = np.flatnonzero(list(space.FreeDofs()))
    residual, kept = state.vec.CreateVector(), state.vec.CreateVector()
    values = state.vec.FV().NumPy()

    def of_free(matrix: BilinearForm) -> csr_matrix:
        rows, columns, entries = (np.array(part) for part in matrix.mat.COO())
        return csr_matrix((entries, (rows, columns)), shape=2 * (space.ndof,))[free][:, free]

    shift, weight, moved, potential = of_free(mass), FIRST, True, form.Energy(state.vec)
    for _ in range(MOST):
        if moved:
            form.Apply(state.vec, residual)
            form.AssembleLinearization(state.vec)
            tangent, forces = of_free(form), residual.FV().NumPy()[free].copy()
        factor = splu(
            (tangent + weight * shift).tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        moved, positive = False, (factor.perm_r == factor.perm_c).all() and (factor.U.diagonal() > 0).all()
        if positive:
            if not weight and np.abs(forces).max() < 1e-10 * pressure:
                break  # the tangent itself is positive definite: a minimum on this mesh
            kept.data = state.vec
            values[free] -= factor.solve(forces)
            new = form.Energy(state.vec)
            moved = bool(np.isfinite(new) and new <= potential + 1e-14 * abs(potential))
            if not moved:
                state.vec.data = kept
        if moved:
            potential, weight = new, weight / 4 if weight > LEAST else 0.0
        else:
            weight = max(4 * weight, 4 * LEAST)
    else:
        sys.exit(f"no minimum at pressure {pressure:g} on {cells} squares")
    found, finer = list(state.components), dx(bonus_intorder=2 * DEGREE)
    corner = [part(mesh(1, 1)) for part in found[:2]]
    return {
        "w_c": found[2](mesh(0, 0)),
        "u_far": 2**0.5 - float(np.hypot(*corner)),
        "V": Integrate(gas(found) * finer, mesh),
        "Pi": potential,
    }


def curve(cells: int) -> dict[str, np.ndarray]:
    """Columns at all pressures, on one mesh."""
    rows = [bag(cells, float(pressure)) for pressure in PRESSURES]
    return {name: np.array([row[name] for row in rows]) for name in COLUMNS}


coarse, fine = (curve(cells) for cells in CELLS)
verdicts = weakforms.compare("beyond.airbag", {"p": PRESSURES, **fine}, "airbag", only=COLUMNS)
for found in verdicts.verdicts:
    change = np.abs(coarse[found.column] / fine[found.column] - 1).max()
    print(f"{found.column}: error {found.signed_error:+.1e}, bound {found.bound:.1e} at {found.where}")
    print(f"  changed by at most {change:.1e} from {CELLS[0]} to {CELLS[1]} squares along half a side")
print(verdicts.status)
sys.exit(verdicts.exit_status)
