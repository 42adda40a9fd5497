"""Corners of a square membrane: slack frames wrinkle there, and a heavy liquid pulls them taut.

A square sheet in a frame that does not stretch it carries gas, a light liquid or a heavy one. Near a corner
it spans the two edges: its lines of tension run from edge to edge, across the diagonal, and it would be
compressed along the diagonal. There it wrinkles. A heavy liquid gathers in the middle and pulls on the
corners from there, along the diagonals, so that they stay taut.
Run: ``./run shell -c "python3 examples/gallery/corners.py corners.svg"``.
"""

import sys

import numpy as np
from matplotlib import cm
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import weakforms

HEIGHT = 0.8
LOADS = {
    "gas": {"load": "gas"},
    "light liquid, gamma = 1": {"gamma": 1},
    "heavy liquid, gamma = 5": {"gamma": 5},
}
QUICK = {"cells": 16, "levels": 2}

# %%
figure = FigureCanvasAgg(Figure(figsize=(11, 6.5), layout="constrained")).figure
for i, (name, load) in enumerate(LOADS.items(), 1):
    given = load | {"delta": 1, "w_end": 0.9}
    state = weakforms.solve("rectangle", **given, at={"w_c": HEIGHT}, numerics=QUICK).states[0]
    nodes, cells = (next(f for f in state.fields if f.name == n).columns for n in ("sheet", "triangles"))
    points = np.column_stack([nodes[n] for n in "xyz"])
    corners = points[np.column_stack([cells[n] for n in "abc"]).astype(int)]
    along = np.column_stack([cells[f"t_{n}"] for n in "xyz"])
    wrinkled = cells["state"] == 0
    colours = cm.cividis((cells["lam1"] - 1) / (cells["lam1"].max() - 1))
    colours[wrinkled] = to_rgba("#c4305a")
    ends = corners.mean(axis=1)[:, None] + 0.012 * np.array([[[-1.0], [1.0]]]) * along[:, None]

    axes = figure.add_subplot(2, 3, i, projection="3d")
    axes.add_collection3d(Poly3DCollection(corners, facecolors=colours, antialiased=False))
    axes.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    axes.set_box_aspect(None, zoom=1.0)
    axes.set_title(f"{name}\nwrinkled: {state.quantities['f_w'].value:.2%}")
    axes.view_init(elev=35, azim=-60)
    axes.set_axis_off()

    above = figure.add_subplot(2, 3, 3 + i, aspect="equal", xlim=(0.75, 1.02), ylim=(0.75, 1.02))
    above.add_collection(PolyCollection(corners[:, :, :2], facecolors=colours, antialiased=False))
    above.add_collection(LineCollection(ends[wrinkled][:, :, :2], colors="w", linewidths=1.2))
    above.set(xlabel="x", ylabel="y")
    print(f"{name}: wrinkled part {state.quantities['f_w']}, least stress {state.quantities['S_least']}")

# %%
figure.suptitle(
    f"height {HEIGHT:g}; light where the stretch is large; red: wrinkled, with the lines of tension"
)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "corners.svg")
