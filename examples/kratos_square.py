"""Cross-check of another code: a square membrane under gas by bilinear elements in Kratos Multiphysics.

A quarter of the square is solved with membrane elements of Kratos, its law of Saint Venant and Kirchhoff in
plane stress, and pressures that follow the surface. Three meshes, each twice as fine as the one before, are
extrapolated; the claim is what the last extrapolation changed.
Run: ``python examples/kratos_square.py`` (needs KratosMultiphysics, KratosStructuralMechanicsApplication and
weakforms; no DOLFINx).
"""

import sys

import KratosMultiphysics as Kratos
import KratosMultiphysics.StructuralMechanicsApplication as Mechanics
import numpy as np

import weakforms

POISSON, STRETCH = 0.4, 1.1
PRESSURES = np.linspace(0.1, 1.2, 12)
"""Over ``E h/a`` with ``a`` half the side; the centre rises from 0.18 to 0.78."""

CELLS = (8, 16, 32)
GAUSS = (0.5 - 0.5 / 3**0.5, 0.5 + 0.5 / 3**0.5)
Kratos.Logger.GetDefaultOutput().SetSeverity(Kratos.Logger.Severity.WARNING)


def quarter(cells: int) -> Kratos.ModelPart:
    """The quarter ``[0, 1]^2``: the frame, pre-stretched, is ``X = 1`` and ``Y = 1``."""
    part = MODEL.CreateModelPart(f"square_{cells}", 2)
    for variable in (
        *(Kratos.DISPLACEMENT, Kratos.REACTION, Kratos.VOLUME_ACCELERATION),
        *(Kratos.POSITIVE_FACE_PRESSURE, Kratos.NEGATIVE_FACE_PRESSURE, Mechanics.SURFACE_LOAD),
    ):
        part.AddNodalSolutionStepVariable(variable)
    sheet = part.CreateNewProperties(1)
    for variable, value in (
        *((Kratos.YOUNG_MODULUS, 1.0), (Kratos.POISSON_RATIO, POISSON), (Kratos.THICKNESS, 1.0)),
        *((Kratos.DENSITY, 0.0), (Kratos.CONSTITUTIVE_LAW, Mechanics.LinearElasticPlaneStress2DLaw())),
    ):
        sheet.SetValue(variable, value)
    number = np.arange(1, (cells + 1) ** 2 + 1).reshape(cells + 1, cells + 1)
    moved = Kratos.DISPLACEMENT_X, Kratos.DISPLACEMENT_Y, Kratos.DISPLACEMENT_Z
    forces = Kratos.REACTION_X, Kratos.REACTION_Y, Kratos.REACTION_Z
    for (i, j), k in np.ndenumerate(number):
        x, y = i / cells, j / cells
        node = part.CreateNewNode(int(k), x, y, 0.0)
        framed = cells in (i, j)
        dome = (STRETCH - 1) * x, (STRETCH - 1) * y, 0.05 * (1 - x * x) * (1 - y * y)
        held = framed or i == 0, framed or j == 0, framed
        for variable, force, value, fixed in zip(moved, forces, dome, held, strict=True):
            node.AddDof(variable, force)
            node.SetSolutionStepValue(variable, 0, value)
            if fixed:
                node.Fix(variable)
    corners = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    for k, nodes in enumerate(np.array(corners).reshape(4, -1).T.tolist(), 1):
        part.CreateNewElement("MembraneElement3D4N", k, nodes, sheet)
        part.CreateNewCondition("SurfaceLoadCondition3D4N", k, nodes, sheet)
    return part


def volume(position: np.ndarray) -> float:
    """Volume under the whole sheet; ``position`` has the shape (n, n, 3)."""
    a, b, c, d = position[:-1, :-1], position[1:, :-1], position[1:, 1:], position[:-1, 1:]
    found = 0.0
    for s in GAUSS:
        for t in GAUSS:
            height = ((1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d)[..., 2]
            along, across = (1 - t) * (b - a) + t * (c - d), (1 - s) * (d - a) + s * (c - b)
            found += (height * np.cross(along, across)[..., 2]).sum() / 4
    return 4 * found


def curve(cells: int) -> np.ndarray:
    """Height of the centre and volume at the pressures, shape (2, n)."""
    part = quarter(cells)
    strategy = Kratos.ResidualBasedNewtonRaphsonStrategy(
        part,
        Kratos.ResidualBasedIncrementalUpdateStaticScheme(),
        Kratos.ResidualCriteria(1e-9, 1e-12),
        Kratos.ResidualBasedBlockBuilderAndSolver(Kratos.SkylineLUFactorizationSolver()),
        *(50, True, False, True),  # iterations; reactions, no new set of unknowns, a mesh that moves
    )
    strategy.Initialize()
    rows = []
    for step, pressure in enumerate(PRESSURES, 1):
        part.CloneTimeStep(float(step))
        for node in part.Nodes:
            node.SetSolutionStepValue(Kratos.NEGATIVE_FACE_PRESSURE, 0, float(pressure))
        strategy.InitializeSolutionStep()
        if not strategy.SolveSolutionStep():
            sys.exit(f"no solution at pressure {pressure:g} on {cells} squares")
        strategy.FinalizeSolutionStep()
        position = np.array([[node.X, node.Y, node.Z] for node in part.Nodes])
        position = position.reshape(cells + 1, cells + 1, 3)
        rows.append((position[0, 0, 2], volume(position)))
    return np.array(rows).T


MODEL = Kratos.Model()
coarse, middle, fine = (curve(cells) for cells in CELLS)
first, last = middle + (middle - coarse) / 3, fine + (fine - middle) / 3
claim = 3 * float(np.abs(first / last - 1).max())  # the pressure grows at most like the cube of the height
print(f"order {np.log2(np.abs((coarse - middle) / (middle - fine)).min()):.2f} at least")
verdicts = weakforms.compare(
    "beyond.membrane",
    {"w_c": last[0], "V": last[1], "p": PRESSURES},
    "square_kirchhoff",
    claim,
    only=["p", "V"],
)
for found in verdicts.verdicts:
    print(f"{found.column}: error {found.signed_error:+.1e}, bound {found.bound:.1e} at {found.where}")
print(f"claimed: {claim:.1e}; judged over w_c in {verdicts.covered} of {verdicts.table}")
print(verdicts.status)
sys.exit(verdicts.exit_status)
