"""Cross-check of another code: a square membrane under gas by high-order finite elements in NGSolve.

A neo-Hookean sheet is stretched by 1.1 before its edges are held. Its squares, of degree 4, become smaller
towards the edges. Strain energy and volume of the gas are written as functions of the position, and NGSolve
makes residual and tangent from them. The height of the centre is prescribed and the pressure is unknown, so
that the curve goes past the limit pressure. The finer of two meshes claims the largest difference from the
coarse one.
Run: ``python examples/ngsolve_square.py`` (needs ngsolve and weakforms; no DOLFINx).
"""

import sys

import numpy as np
from ngsolve import (
    CF,
    H1,
    VERTEX,
    BilinearForm,
    Cross,
    FESpace,
    GridFunction,
    InnerProduct,
    Integrate,
    NodeId,
    Parameter,
    Variation,
    dx,
    grad,
    x,
    y,
)
from ngsolve.meshes import MakeStructured2DMesh

import weakforms

STRETCH, DEGREE = 1.1, 4
SQUARES = (3, 5)
"""Squares along half a side, on the coarse mesh and on the fine one."""

HEIGHTS = np.arange(1, 16) / 10
"""Rows of the table, so that nothing is interpolated in it."""

COLUMNS = ("p", "V", "U")


def tangents(position: list[CF]) -> list[CF]:
    """Derivatives of the position in the two directions of the sheet."""
    return [CF(tuple(grad(part)[k] for part in position)) for k in range(2)]


def energy(position: list[CF]) -> CF:
    """``I1 - 3`` of an incompressible sheet: its energy per area without stress, over ``C1 h``."""
    along, across = tangents(position)
    first, second = InnerProduct(along, along), InnerProduct(across, across)
    mixed = InnerProduct(along, across)
    return first + second + 1 / (first * second - mixed * mixed) - 3


def gas(position: list[CF]) -> CF:
    """Volume under the sheet, per area without stress: the height times the area in the plan."""
    return position[2] * Cross(*tangents(position))[2]


def curve(squares: int) -> dict[str, np.ndarray]:
    """Pressure, volume and energy of the whole sheet at the heights, on one mesh of a quarter."""
    mesh = MakeStructured2DMesh(nx=squares, ny=squares, mapping=lambda s, t: (s * (2 - s), t * (2 - t)))
    held = ("left|right|top", "bottom|right|top", "right|top")  # in x, y and z; the centre is bottom left
    space = FESpace([H1(mesh, order=DEGREE, dirichlet=edges) for edges in held])
    state = GridFunction(space)
    dome = STRETCH * x, STRETCH * y, 0.1 * (1 - x * x) * (1 - y * y)
    for part, value in zip(state.components, dome, strict=True):
        part.Set(value)
    position, p = list(space.TrialFunction()), Parameter(0.1)
    potential, volume = BilinearForm(space, symmetric=True), BilinearForm(space, symmetric=True)
    potential += Variation((energy(position) - p * gas(position)).Compile() * dx(bonus_intorder=4))
    volume += Variation(gas(position).Compile() * dx(bonus_intorder=4))
    centre = space.Range(2).start + space.components[2].GetDofNrs(NodeId(VERTEX, 0))[0]
    free = space.FreeDofs()
    free[centre] = False
    residual, load, step, along, force = (state.vec.CreateVector() for _ in range(5))
    columns: dict[str, list[float]] = {name: [] for name in COLUMNS}
    for height in HEIGHTS:
        state.components[2].vec.data *= height / state.vec[centre]
        for _ in range(30):
            potential.Apply(state.vec, residual)
            volume.Apply(state.vec, load)
            potential.AssembleLinearization(state.vec)
            inverse = potential.mat.Inverse(free, inverse="umfpack")
            step.data = -inverse * residual
            along.data = inverse * load  # change of the position with the pressure
            force.data = residual + potential.mat * step
            needed = force[centre]
            force.data = potential.mat * along - load
            more = -needed / force[centre]  # with it no force holds the centre
            state.vec.data += step + more * along
            p.Set(p.Get() + more)
            if max(step.Norm(), abs(more)) < 1e-9:  # the next step would be its square
                break
        else:
            sys.exit(f"no solution at height {height:g}")
        stored, enclosed = energy(list(state.components)), gas(list(state.components))
        columns["p"].append(p.Get())
        columns["V"].append(4 * Integrate(enclosed, mesh, order=4 * DEGREE))
        columns["U"].append(4 * Integrate(stored, mesh, order=4 * DEGREE))
    return {name: np.array(values) for name, values in columns.items()}


coarse, fine = (curve(squares) for squares in SQUARES)
claim = max(float(np.abs(coarse[name] / fine[name] - 1).max()) for name in COLUMNS)
verdicts = weakforms.compare(
    "beyond.rectangle", {"w_c": HEIGHTS, **fine}, "rectangle_gas_neo_hookean", claim, only=COLUMNS
)
for found in verdicts.verdicts:
    print(f"{found.column}: error {found.signed_error:+.1e}, bound {found.bound:.1e} at {found.where}")
print(f"claimed: {claim:.1e}, the difference of {SQUARES[1]} squares along half a side from {SQUARES[0]}")
print(f"judged over w_c in {verdicts.covered} of {verdicts.table}; rows not judged: {verdicts.unjudged_rows}")
print(verdicts.status)
sys.exit(verdicts.exit_status)
