"""Which tubes bend before they reach their limit point: two lines over the length, and where they meet.

Short tubes reach the limit point of the pressure first, and long ones bend first. Where both lines touch
(star), a tube does both at once. The line of bending turns at its tip (triangle). Past the onset of
wrinkling the lines are faint. Run:
``./run shell -c "python3 examples/gallery/bending_lines.py bending.svg"``.
"""

import sys

import weakforms
from weakforms.results.diagram import draw_diagram

QUICK = {"cells": 48, "degree": 4, "levels": 2}

# %%
plane = weakforms.solve(
    "diagram", x="lf", kind="fold,mirror,n1", alpha=0.0, low=5.0, high=10.0, u_end=2.5, numerics=QUICK
)
for point in plane.special_points:
    lf, p = (weakforms.Quantity(point.values[n], point.uncertainty[n]) for n in ("lf", "p"))
    print(f"{point.kind} on the line {point.branch}: lf = {lf}, p = {p}")

# %%
both = plane.points("fold_n1")[0].values["lf"]
for length in (6.0, 8.0):
    print(f"lf = {length:g}: {'bends' if length > both else 'reaches its limit point'} first")
draw_diagram(plane, "lf", "p").savefig(sys.argv[1] if len(sys.argv) > 1 else "bending.svg")
