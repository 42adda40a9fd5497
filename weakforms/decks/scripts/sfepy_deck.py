"""A membrane on the mid-surface in sfepy: flat triangles, linear displacements. Run: python3 deck.py.

Each curved triangle of the mesh is taken as four flat ones, for the term ``dw_tl_membrane`` has no quadratic
displacements. It lives on faces of solid cells. Each flat triangle is therefore the face of a tetrahedron of
its own without stiffness, whose other node is held. The gas acts on the same faces by
``dw_tl_surface_traction``, which depends on the movement of the face only.
"""

import sys
from typing import Any

import meshio
import numpy as np
from reading import DECK, HERE, write_curve
from scipy.sparse.linalg import splu
from sfepy.base.base import output
from sfepy.discrete import Equation, Equations, FieldVariable, Integral, Material, Problem
from sfepy.discrete.conditions import Conditions
from sfepy.discrete.fem import FEDomain, Field, Mesh
from sfepy.terms import Term

output.set_output(quiet=True)
read = meshio.read(HERE / "deck.msh")
points, faces = read.points, read.cells_dict["triangle6"]
faces = faces[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3)
lines, groups = read.cells_dict["line3"], read.cell_data_dict["gmsh:physical"]["line3"]
edges = {name: lines[groups == number] for name, (number, dim) in read.field_data.items() if dim == 1}

a, b, c = points[faces].transpose(1, 0, 2)
inward = -np.cross(b - a, c - a)  # the triangles are counterclockwise from outside
apex = (a + b + c) / 3 + inward / np.linalg.norm(inward, axis=1)[:, None]
cells = np.column_stack([faces[:, [0, 2, 1]], len(points) + np.arange(len(faces))])
solid = Mesh.from_data("deck", np.vstack([points, apex]), None, [cells], [np.zeros(len(cells), int)], ["3_4"])
domain = FEDomain("deck", solid)
omega = domain.create_region("omega", "all")
corners = {"corners": lambda *_, **__: np.unique(faces)}
surface = domain.create_region("surface", "vertices by corners", "facet", functions=corners)
field = Field.from_args("displacement", np.float64, 3, omega, approx_order=1)


def nodes(name: str) -> np.ndarray:
    """The nodes of an edge of the mesh."""
    return np.unique(edges.get(name, np.empty(0, int)))


clamps = np.unique([node for clamp in DECK["clamps"] for node in nodes(clamp["edge"])]).astype(int)
held = np.zeros((len(points) + len(faces), 3), bool)
held[len(points) :] = True
held[clamps] = True
for k, axis in enumerate("xyz"):
    held[nodes(f"{axis}0"), k] = True
free = np.flatnonzero(~held)

shape, load = DECK["thickness"], [0.0]


def thickness(_ts: Any, coordinates: np.ndarray, mode: str = "", **_: Any) -> dict | None:
    """Thickness at the points of quadrature, over its mean, and the constants of the law over C1 h."""
    if mode != "qp":
        return None
    over = coordinates[:, 2] if shape["over"] == "z" else np.hypot(*coordinates.T[:2])
    one = np.ones((len(over), 1, 1))
    h = (shape["at zero"] + shape["slope"] * over)[:, None, None]
    return {"c1": one, "c2": DECK["law"]["C2/C1"] * one, "h": h}


def pressure(_ts: Any, coordinates: np.ndarray, mode: str = "", **_: Any) -> dict | None:
    """The gas, as a stress, at the points of quadrature."""
    return {"p": np.tile(load[0] * np.eye(3), (len(coordinates), 1, 1))} if mode == "qp" else None


u = FieldVariable("u", "unknown", field)
v = FieldVariable("v", "test", field, primary_var_name="u")
rubber, gas = Material("rubber", function=thickness), Material("gas", function=pressure)
rule = Integral("rule", order=4)
inner = Term.new(
    "dw_tl_membrane(rubber.c1, rubber.c2, rubber.h, v, u)", rule, surface, rubber=rubber, v=v, u=u
)
outer = Term.new("dw_tl_surface_traction(gas.p, v, u)", rule, surface, gas=gas, v=v, u=u)
problem = Problem("deck", equations=Equations([Equation("balance", inner - outer)]))
problem.set_bcs(ebcs=Conditions([]))
problem.time_update()
problem.equations.init_state()
evaluator = problem.get_evaluator()
state = np.zeros(held.shape)


def residual() -> np.ndarray:
    """Forces at the nodes that are free."""
    return evaluator.eval_residual(state.ravel())[free]


def newton(tries: int = 60) -> bool:
    """Newton's method; a step is halved until the residual falls."""
    problem.update_materials()
    found = residual()
    size = first = np.linalg.norm(found)
    for _ in range(tries):
        if size < 1e-11 * max(1.0, first):
            return True
        matrix = evaluator.eval_tangent_matrix(state.ravel(), is_full=True)[free][:, free]
        step = splu(matrix.tocsc()).solve(found)
        old = state.ravel()[free].copy()
        for k in range(12):
            state.ravel()[free] = old - 0.5**k * step
            found = residual()
            new = np.linalg.norm(found)
            if np.isfinite(new) and (new < size or k == 11):
                break
        size = new
        if not np.isfinite(size):
            return False
    return size < 1e-8


def start() -> None:
    """The membrane evenly stretched into its clamps, a disk bulged a little; or a ball a little larger."""
    first = next(iter(DECK["clamps"]), None)
    wider = first["radius"] - 1 if first else 0.02
    x, y, z = points.T
    if not first:
        up = wider * z
    elif DECK["pole"]:
        up = 0.01 * (1 - (x * x + y * y) * first["radius"] ** 2)
    else:
        up = (first["height"] / points[:, 2].max() - 1) * z
    state[: len(points)] = np.column_stack([wider * x, wider * y, up])
    if DECK["pole"]:
        state[clamps, 2] = 0.0


def stations() -> tuple[list[float], list[float]]:
    """Deformed radius and height over the meridian.

    A tube's are means around it: between flat cells, nodes find places of their own, which differ with the
    angle. The meridian of a ball or a disk is that in the plane y = 0.
    """
    moved = points + state[: len(points)]
    if DECK["pole"]:
        line = nodes("y0")
        line = line[np.argsort(-points[line, 2] if DECK["mirror"] else points[line, 0])]
        return moved[line, 0].tolist(), moved[line, 2].tolist()
    heights = np.round(points[:, 2], 9)
    rings = [heights == height for height in np.unique(heights)[::-1]]
    turned = np.arctan2(points[:, 1], points[:, 0])
    means = [[], []]
    for ring in rings:
        order = np.argsort(turned[ring])
        for found, values in zip(
            means, (np.hypot(moved[ring, 0], moved[ring, 1]), moved[ring, 2]), strict=True
        ):
            found.append(float(np.trapezoid(values[order], turned[ring][order])) / (np.pi / 2))
    return means[0], means[1]


def raise_to(value: float, before: float) -> None:
    """Raise the load, by halves where Newton's method fails."""
    kept = state.copy()
    load[0] = value
    if newton():
        return
    state[:] = kept
    if value - before < 1e-4 * value:
        sys.exit(f"Newton's method failed at {DECK['load']['name']} = {value:g}")
    raise_to((before + value) / 2, before)
    raise_to(value, (before + value) / 2)


rows, before = [], 0.0
start()
for stage in DECK["stages"]:
    raise_to(stage["load"], before)
    if stage["curve"]:
        rows.append((stage["load"], stations()))
    before = stage["load"]
write_curve(rows)
