"""Triangles where the error is: a slack square under gas, whose corners wrinkle, on a mesh that follows them.

The indicator of the error compares the stress of each triangle with a continuous one. It is largest in the
corners, where the square is wrinkled, and along the fronts beside them. There the triangles of the first
mesh are cut, three times; the mesh shown has four triangles for each of these.
Run: ``./run shell -c "python3 examples/gallery/adapted.py adapted.svg"``.
"""

import sys

import numpy as np
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

import weakforms

DEFLECTION = 0.5
CORNER = 0.88
"""Where the enlarged corner begins."""

QUICK = {"cells": 8, "levels": 2, "refine": 3}

# %%
result = weakforms.solve(
    "membrane", mesh="square", delta=1.0, w_end=DEFLECTION + 0.1, at={"w_c": DEFLECTION}, numerics=QUICK
)

# %%
state = result.states[0]
nodes, cells = (next(f for f in state.fields if f.name == n).columns for n in ("sheet", "triangles"))
flat = np.column_stack([nodes["X"], nodes["Y"]])
corners = flat[np.column_stack([cells[n] for n in "abc"]).astype(int)]
middle = corners.mean(axis=1)
along = np.column_stack([cells["t_x"], cells["t_y"]])
size = np.sqrt(np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])))[:, None]
ends = middle[:, None] + 0.3 * np.array([[[-1.0], [1.0]]]) * (size * along)[:, None]
wrinkled = cells["state"] < 1

figure = FigureCanvasAgg(Figure(figsize=(11, 4.6), layout="constrained")).figure
scale = LogNorm(*np.quantile(cells["error"], (0.02, 0.995)))
for k, start in enumerate((0.0, CORNER)):
    axes = figure.add_subplot(1, 2, k + 1, aspect="equal", xlim=(start, 1), ylim=(start, 1))
    seen = corners.max(axis=1).min(axis=1) > start
    mesh = PolyCollection(corners[seen], array=cells["error"][seen], norm=scale, edgecolors="k")
    mesh.set(linewidth=0.2, cmap=colormaps["cividis"].resampled(40))
    axes.add_collection(mesh)
    axes.set(xlabel="X", ylabel="Y")
axes.add_collection(LineCollection(ends[wrinkled & seen], colors="w", linewidths=1.2))
axes.set_title("a corner: white lines along the wrinkles")
figure.axes[0].set_title(f"a quarter of the square, {len(corners) // 4} triangles")
figure.colorbar(mesh, ax=figure.axes, label="error of the stress resultants")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "adapted.svg")
quantities = state.quantities
print(f"p = {quantities['p']}, wrinkled part {quantities['f_w']}, triangles {result.numerics['triangles']}")
