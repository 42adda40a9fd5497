"""A membrane on the mid-surface in NGSolve: curved triangles, quadratic displacements. Run: python3 deck.py.

Energy and load are potentials, from which NGSolve makes residual and tangent. With "relaxed" in deck.json, a
wrinkled part of the membrane bears no compression (tension-field theory).
"""

import sys
from typing import Any

import numpy as np
from netgen.read_gmsh import ReadGmsh
from ngsolve import (
    BND,
    CF,
    H1,
    BilinearForm,
    Cof,
    Det,
    FESpace,
    GridFunction,
    Id,
    IfPos,
    InnerProduct,
    Integrate,
    Mesh,
    OuterProduct,
    Parameter,
    Projector,
    TaskManager,
    Trace,
    Variation,
    ds,
    grad,
    specialcf,
    sqrt,
    x,
    y,
    z,
)
from reading import DECK, HERE, write_curve

mesh = Mesh(ReadGmsh(str(HERE / "deck.msh")))
clamps = [clamp["edge"] for clamp in DECK["clamps"]]
planes = [name for name in ("x0", "y0", "z0") if name in mesh.GetBBoundaries()]
held = [[*clamps, *(name for name in planes if name[0] == axis)] for axis in "xyz"]
parts = [
    H1(mesh, order=2, definedon=mesh.Boundaries(".*"), dirichlet_bbnd="|".join(n) or "none") for n in held
]
V = FESpace(parts)
u = GridFunction(V)
ratio, gamma, shape = DECK["law"]["C2/C1"], DECK["load"]["gamma"], DECK["thickness"]
thickness = shape["at zero"] + shape["slope"] * (z if shape["over"] == "z" else sqrt(x * x + y * y))
load = Parameter(0.0)
n = specialcf.normal(3)
outward = CF((0, 0, 1)) if DECK["pole"] else CF((x, y, 0))
side = 1.0 if Integrate(InnerProduct(n, outward), mesh, BND) > 0 else -1.0


def gradient(v: Any) -> CF:
    """Deformation gradient of the surface, which maps the normal at rest to nothing."""
    rows = CF(tuple(grad(part).Trace()[k] for part in v for k in range(3)), dims=(3, 3))
    return (Id(3) + rows) * (Id(3) - OuterProduct(n, n))


def energy(v: Any) -> CF:
    """Strain energy per area at rest over C1 h: I1 - 3 + C2/C1 (I2 - 3), or that of a wrinkled membrane."""
    F = gradient(v)
    C = F.trans * F
    trace, det = Trace(C), Det(C + OuterProduct(n, n))
    taut = trace + 1 / det - 3 + ratio * (det + trace / det - 3)
    if not DECK["law"]["relaxed"]:
        return taut
    spread = sqrt(trace * trace / 4 - det + 1e-14)
    first, second = trace / 2 + spread, trace / 2 - spread  # squares of the principal stretches
    lam = sqrt(first)
    wrinkled = first + 2 / lam - 3 + ratio * (2 * lam + 1 / first - 3)
    return IfPos(second * lam - 1, taut, wrinkled)


def potential(v: Any) -> CF:
    """The load's potential per area at rest: the flux of Phi(z) e_z with Phi' = -pressure."""
    height = z + v[2]
    phi = gamma / 2 * IfPos(load - height, (load - height) ** 2, 0.0) if gamma else -load * height
    return side * phi * (Cof(gradient(v) + OuterProduct(n, n)) * n)[2]


a = BilinearForm(V, symmetric=True)
trial = V.TrialFunction()
a += Variation((thickness * energy(trial) + potential(trial)).Compile() * ds(bonus_intorder=2))


def newton(tries: int = 60) -> bool:
    """Newton's method; a step is halved until the potential or the residual falls."""
    r, du = u.vec.CreateVector(), u.vec.CreateVector()
    old, first = u.vec.CreateVector(), None
    free = V.FreeDofs()
    onto_free = Projector(free, True)

    def residual() -> float:
        a.Apply(u.vec, r)
        onto_free.Project(r)
        return r.Norm()

    size = residual()
    for _ in range(tries):
        first = first or size
        if size < 1e-11 * max(1.0, first):
            return True
        a.AssembleLinearization(u.vec)
        du.data = a.mat.Inverse(free, inverse="umfpack") * r
        old.data = u.vec
        for k in range(12):
            u.vec.data = old - 0.5**k * du
            new = residual()
            if np.isfinite(new) and (new < size or k == 11):
                break
        size = new
        if not np.isfinite(size):
            return False
    return size < 1e-8


def start() -> None:
    """The membrane evenly stretched into its clamps, a disk bulged a little; or a ball a little larger."""
    if clamps:
        first = DECK["clamps"][0]
        wider = first["radius"] - 1
        longer = 0.0 if DECK["pole"] else first["height"] / max(v.point[2] for v in mesh.vertices) - 1
    else:
        wider = longer = 0.02
    flat = clamps and DECK["pole"]
    lift = 0.01 * (1 - (x * x + y * y) * (1 + wider) ** 2) if flat else longer * z
    for component, value in zip(u.components, (wider * x, wider * y, lift), strict=True):
        component.Set(value, definedon=mesh.Boundaries(".*"))
    if flat:
        for dof, on_edge in enumerate(parts[2].GetDofs(mesh.BBoundaries("|".join(clamps)))):
            if on_edge:
                u.components[2].vec[dof] = 0.0


def stations() -> tuple[list[float], list[float]]:
    """Deformed radius and height of the vertices on the meridian in the plane y = 0."""
    flat = DECK["pole"] and not DECK["mirror"]
    corners = {v.nr for element in mesh.Elements(BND) for v in element.vertices}  # not the middles of edges
    found = [(v.point, v.nr) for v in mesh.vertices if v.nr in corners and abs(v.point[1]) < 1e-9]
    found.sort(key=lambda item: item[0][0] if flat else -item[0][2])
    across, _, up = u.components  # the first degrees of freedom are the values at vertices
    return [p[0] + across.vec[k] for p, k in found], [p[2] + up.vec[k] for p, k in found]


def enclosed() -> float:
    """Volume over 2 pi, as the flux of (x, y, 0)/2; wrinkled parts do not resist ripples between nodes."""
    area = Cof(gradient(u.components) + OuterProduct(n, n)) * n
    across, along, _ = u.components
    flux = side * ((x + across) * area[0] + (y + along) * area[1]) / 2
    return 4 * Integrate(flux, mesh, BND) / (2 * np.pi)


def raise_to(value: float, before: float) -> None:
    """Raise the load, by halves where Newton's method fails."""
    kept = u.vec.CreateVector()
    kept.data = u.vec
    load.Set(value)
    if newton():
        return
    u.vec.data = kept
    if value - before < 1e-4 * value:
        sys.exit(f"Newton's method failed at {DECK['load']['name']} = {value:g}")
    raise_to((before + value) / 2, before)
    raise_to(value, (before + value) / 2)


rows, before = [], 0.0
with TaskManager():
    start()
    for stage in DECK["stages"]:
        raise_to(stage["load"], before)
        if stage["curve"]:
            rows.append((stage["load"], enclosed() if DECK["over"] == "V" else stations()))
        before = stage["load"]
write_curve(rows)
