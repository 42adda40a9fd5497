"""How a long tube with held ends loses its shape, and a balloon its own: two planes of two parameters.

A tube that is hardly stretched between its ends bends as soon as the pressure has taken its axial force away.
A tube that is stretched more bulges first, in a wave as long as the tube. Both lines meet (triangle) in the
state of a closed tube at its limit pressure. A balloon of Ogden's rubber turns into a pear between the
maximum and the minimum of its pressure, if its second modulus is small. Run:
``./run shell -c "python3 examples/gallery/long_tubes.py long-tubes.svg pears.svg"``.
"""

import sys

import weakforms
from weakforms.results.diagram import draw_diagram

# %%
tubes = weakforms.solve(
    "diagram", body="infinite_tube", ends="held", x="lam1", alpha=0.1, high=2.0, kind="localisation,n1"
)
both = tubes.points("localisation_n1")[0]
closed = weakforms.solve("infinite_tube", alpha=0.1, lam_end=2.5).points("limit_point")[0]
for title, point in (("held tube that bends and bulges", both), ("closed tube at its limit", closed)):
    lam1, p = (weakforms.Quantity(point.values[n], point.uncertainty[n]) for n in ("lam1", "p"))
    print(f"{title}: lam1 = {lam1}, p = {p}")
draw_diagram(tubes, "lam1", "p").savefig(sys.argv[1] if len(sys.argv) > 1 else "long-tubes.svg")

# %%
plane = {"x": "mu2", "low": 0.0005, "high": 0.012, "lam_end": 6.0, "numerics": {"step": 0.03}}
pears = weakforms.solve("diagram", body="sphere", model="ogden", kind="fold,n1", **plane)
tip = pears.points("tip_n1")[0]
print(f"pears up to mu2 = {weakforms.Quantity(tip.values['mu2'], tip.uncertainty['mu2'])}")
draw_diagram(pears, "mu2", "p").savefig(sys.argv[2] if len(sys.argv) > 2 else "pears.svg")
