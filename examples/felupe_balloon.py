"""Cross-check of another code: a balloon as a thin solid in FElupe, axisymmetric and nearly incompressible.

A neo-Hookean hollow sphere whose wall is 1/200 of its radius, under a following inner pressure, up to a
stretch of 1.25. A solid is not a membrane: its pressure differs by about (h/R)^2 for the wall, and by about
mu/kappa for the bulk modulus kappa. The curve claims the sum of these and of the error of the mesh.
Run: ``python examples/felupe_balloon.py`` (needs felupe and weakforms; no DOLFINx).
"""

import sys

import felupe as fem
import numpy as np
from scipy.interpolate import make_interp_spline

import weakforms

WALL, BULK = 0.005, 5000.0
CLAIM = 1e-3
"""Mesh: (pi/80)^2/2; wall: 2.5e-5; bulk modulus: 2/5000."""

flat = fem.Rectangle(a=(1 - WALL / 2, 0), b=(1 + WALL / 2, np.pi / 2), n=(2, 41))
radius, angle = flat.points.T
mesh = fem.Mesh(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), flat.cells, flat.cell_type)
field = fem.FieldContainer([fem.FieldAxisymmetric(fem.RegionQuad(mesh), dim=2)])
inner = np.flatnonzero(np.isclose(radius, radius.min()))
wet = fem.RegionQuadBoundary(mesh, mask=inner, ensure_3d=True)
balloon = fem.SolidBodyNearlyIncompressible(fem.NeoHooke(mu=2.0), field, bulk=BULK)
gas = fem.SolidBodyPressure(fem.FieldContainer([fem.FieldAxisymmetric(wet, dim=2)]))
held = {
    "equator": fem.dof.Boundary(field[0], fx=0, skip=(0, 1)),
    "axis": fem.dof.Boundary(field[0], fy=0, skip=(1, 0)),
}
stretches, pressures = [1.0], np.linspace(0.0, 2.44, 50)
for pressure in pressures[1:]:
    gas.results.pressure = pressure * WALL
    dofs = fem.dof.partition(field, held)
    fem.newtonraphson(
        items=[balloon, gas], dof0=dofs[0], dof1=dofs[1], ext0=np.zeros(len(dofs[0])), verbose=0
    )
    deformed = np.hypot(*(mesh.points + field[0].values).T) ** 3
    wall = [deformed[np.isclose(radius, side)].mean() for side in (radius.min(), radius.max())]
    stretches.append(float(np.mean(wall) ** (1 / 3)))  # the radius that halves the volume of the wall

lam = np.arange(1.05, 1.26, 0.05)  # rows of the table, so that nothing is interpolated in it
curve = {"lam": lam, "P": make_interp_spline(stretches, pressures, k=5)(lam)}
verdicts = weakforms.compare("closed_form.sphere", curve, "sphere_neo_hookean", CLAIM, only=["P"])
worst = verdicts.verdicts[0]
print(f"{worst.statement}: error {worst.signed_error:+.1e}, bound {worst.bound:.1e} at {worst.where}")
print(f"judged over lam in {verdicts.covered} of {verdicts.table}; the curve reaches {worst.reached:.1e}")
print(verdicts.status)
sys.exit(verdicts.exit_status)
