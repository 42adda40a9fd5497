"""A membrane of any shape: gmsh draws an ellipse with a hole, the problem membrane inflates it.

The outer edge and the edge of the hole are held, with a small pre-stretch. The hole is off the centre. The
bulge is highest on the wide side, and the stretch is largest at the edge of the hole that faces it. The mesh
is written as a file, with names for the edges, as any mesh of a user is.
Run: ``./run shell -c "python3 examples/gallery/any_shape.py any_shape.svg"``.
"""

import sys
import tempfile
from pathlib import Path

import gmsh
import numpy as np
from matplotlib import cm, colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import weakforms

DEFLECTION = 0.45
QUICK = {"levels": 2}


# %%
def draw(path: Path, size: float) -> None:
    """Write an ellipse with a hole, in curved triangles (order 2), its edges in groups with names."""
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    occ = gmsh.model.occ
    rim, hole = occ.addEllipse(0, 0, 0, 1.3, 0.9), occ.addCircle(0.45, 0.1, 0, 0.25)
    occ.addPlaneSurface([occ.addCurveLoop([rim]), occ.addCurveLoop([hole])])
    occ.synchronize()
    gmsh.model.addPhysicalGroup(1, [rim], name="rim")
    gmsh.model.addPhysicalGroup(1, [hole], name="hole")
    gmsh.model.addPhysicalGroup(2, [1], name="sheet")
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    gmsh.write(str(path))
    gmsh.finalize()


with tempfile.TemporaryDirectory() as folder:
    part = Path(folder) / "part.msh"
    draw(part, 0.2)
    result = weakforms.solve(
        "membrane",
        mesh=str(part),
        held="rim,hole",
        delta=1.05,
        w_end=0.6,
        at={"w_max": DEFLECTION},
        numerics=QUICK,
    )

# %%
state = result.states[0]
nodes, cells = (next(f for f in state.fields if f.name == n).columns for n in ("sheet", "triangles"))
points = np.column_stack([nodes[n] for n in "xyz"])
corners = points[np.column_stack([cells[n] for n in "abc"]).astype(int)]
along = np.column_stack([cells[f"t_{n}"] for n in "xyz"])
scale = cm.ScalarMappable(Normalize(1, cells["lam1"].max()), colormaps["cividis"].resampled(40))
colours = scale.to_rgba(cells["lam1"])
ends = corners.mean(axis=1)[:, None] + 0.025 * np.array([[[-1.0], [1.0]]]) * along[:, None]

figure = FigureCanvasAgg(Figure(figsize=(11, 4.5), layout="tight")).figure
axes = figure.add_subplot(1, 2, 1, projection="3d")
axes.add_collection3d(Poly3DCollection(corners, facecolors=colours, antialiased=False))
axes.set(xlim=(-1.4, 1.4), ylim=(-1.4, 1.4), zlim=(0, 0.7))
axes.set_box_aspect((2.8, 2.8, 0.7), zoom=1.3)
axes.view_init(elev=32, azim=-70)
axes.set_axis_off()
above = figure.add_subplot(1, 2, 2, aspect="equal", xlim=(-1.45, 1.45), ylim=(-1.05, 1.05))
above.add_collection(PolyCollection(corners[:, :, :2], facecolors=colours, antialiased=False))
above.add_collection(LineCollection(ends[::2, :, :2], colors="w", linewidths=0.7))
above.set(xlabel="x", ylabel="y", title="lines of tension, seen from above")
figure.colorbar(scale, ax=above, label="larger stretch", shrink=0.7)
p, volume = (state.quantities[name] for name in ("p", "V"))
axes.set_title(f"deflection {DEFLECTION:g}: p = {p.value:.4f}, V = {volume.value:.3f}")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "any_shape.svg")
print(f"p = {p}, V = {volume}, wrinkled part {state.quantities['f_w']}")
