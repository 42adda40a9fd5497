"""A plane of tubes: where inflation has a limit point, and where it loses its mirror symmetry.

Each point of a line is one tube at one pressure, solved for. Limit points merge in a cusp (star). The points
at which the bulge may leave the middle (mirror breaking) end in tips (diamonds). Run:
``./run shell -c "python3 examples/gallery/diagram.py diagram.svg"``.
"""

import sys

import weakforms
from weakforms.results.diagram import draw_diagram

QUICK = {"cells": 48, "degree": 4, "levels": 2}

# %%
plane = weakforms.solve("diagram", x="alpha", high=0.2, kind="fold,mirror", numerics=QUICK)
for point in plane.special_points:
    alpha, p = (weakforms.Quantity(point.values[n], point.uncertainty[n]) for n in ("alpha", "p"))
    print(f"{point.kind} on the line {point.branch}: alpha = {alpha}, p = {p}")

# %%
for line in plane.branches:
    print(f"{line.name}: {len(line)} points, ends at {line.ended}")
draw_diagram(plane, "alpha", "p").savefig(sys.argv[1] if len(sys.argv) > 1 else "diagram.svg")
