"""A square airbag: two sheets joined at their edges inflate, and wrinkle along most of the seam.

A quarter of one sheet is solved, with planes of symmetry and a seam that slides in its plane. The relaxed
energy bears no compression: where the sheet would be compressed across one direction it wrinkles along the
other, and around the middle it stays taut. Lines show the direction of the wrinkles on wrinkled triangles.
Run: ``./run shell -c "python3 examples/gallery/airbag.py airbag.svg"``.
"""

import sys

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

import weakforms

PRESSURE = 6.0128e-3
"""5 kPa over E h/a of a sheet of 0.6 mm with E = 588 MPa, a half the side, 0.424 m."""
POISSON = 0.4
TAUT, WRINKLED, SLACK = "#2c5f8a", "#e0b568", "#c8c8c8"

# %%
result = weakforms.solve(
    "membrane",
    mesh="airbag",
    delta=1,
    model="saint_venant_kirchhoff",
    shear=1 / (2 * (1 + POISSON)),
    poisson=POISSON,
    w_end=0.511,
    at={"p": PRESSURE},
    numerics={"cells": 6, "levels": 2},
)

# %%
state = result.states[0]
nodes, cells = (next(f for f in state.fields if f.name == n).columns for n in ("sheet", "triangles"))
points = np.column_stack([nodes[n] for n in "xyz"])
corners = points[np.column_stack([cells[n] for n in "abc"]).astype(int)]
along = np.column_stack([cells[f"t_{n}"] for n in "xyz"])
folded = cells["state"] == 0
colours = np.select([cells["state"] == 1, folded], [TAUT, WRINKLED], SLACK)
lines = corners.mean(axis=1)[:, None] + 0.028 * np.array([[[-1.0], [1.0]]]) * along[:, None]
four = [np.array([sx, sy, 1.0]) for sx in (1, -1) for sy in (1, -1)]
sheet, folds = (np.concatenate([part * sign for sign in four]) for part in (corners, lines[folded]))
colours = np.tile(colours, 4)

figure = FigureCanvasAgg(Figure(figsize=(11, 4.6), layout="tight")).figure
axes = figure.add_subplot(1, 2, 1, projection="3d", computed_zorder=False)
below = (sheet * (1, 1, -1))[sheet[:, :, 2].min(axis=1) < 0.1]  # the rest of it is not seen
axes.add_collection3d(Poly3DCollection(below, facecolors="#9a9a9a", antialiased=False, zorder=1))
axes.add_collection3d(Poly3DCollection(sheet, facecolors=colours, antialiased=False, zorder=2))
axes.add_collection3d(Line3DCollection(folds + np.array([0, 0, 0.004]), colors="k", linewidths=0.6, zorder=3))
axes.set(xlim=(-0.95, 0.95), ylim=(-0.95, 0.95), zlim=(-0.5, 0.5))
axes.set_box_aspect((1.9, 1.9, 1.0), zoom=1.12)
axes.view_init(elev=38, azim=-62)
axes.set_axis_off()
axes.set_title(f"centre at {state.quantities['w_c'].value:.3f} half sides")
above = figure.add_subplot(1, 2, 2, aspect="equal", xlim=(-1.02, 1.02), ylim=(-1.02, 1.02))
above.add_collection(PolyCollection(sheet[:, :, :2], facecolors=colours, antialiased=False))
above.add_collection(LineCollection(folds[:, :, :2], colors="k", linewidths=0.6))
above.plot([-1, 1, 1, -1, -1], [-1, -1, 1, 1, -1], "k--", linewidth=0.8)
above.set(xlabel="x", ylabel="y", title="blue taut, yellow wrinkled, grey slack; dashed: flat")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "airbag.svg")
for name in ("w_c", "u_far", "V", "f_w"):
    print(name, "=", state.quantities[name])
