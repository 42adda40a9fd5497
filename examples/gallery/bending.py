"""A tube hangs between two rings and is filled with liquid: it bulges, and then bends.

The straight state loses its stability to bending (wave number 1) at a bifurcation point, below the level at
which it would reach a limit point. From there a branch of bent states starts; it goes down in the fluid
level, so that the tube jumps (paper 3, figures 4 and 8).
Run: ``./run shell -c "python3 examples/gallery/bending.py bending.svg"`` (a few minutes; ``quick`` as a
second word leaves the bent branch out).
"""

import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import weakforms
from weakforms.results import SpecialPoint

COARSE = {"cells": 32, "levels": 2, "secondary_cells": 12, "secondary_levels": 2}
bent = "quick" not in sys.argv[2:]

# %%
result = weakforms.solve("fluid_tube", L=8, delta=2, secondary=bent, numerics=COARSE)
straight = result.branch("primary")


def number(point: SpecialPoint, name: str) -> weakforms.Quantity:
    """A value of a special point with its uncertainty."""
    return weakforms.Quantity(point.values[name], point.uncertainty[name])


# %%
figure = FigureCanvasAgg(Figure(figsize=(8, 3.6), layout="constrained")).figure
levels, spectrum = figure.subplots(1, 2)
levels.plot(straight["V"], straight["zw"], label="straight")
if bent:
    levels.plot(result.branch("secondary")["V"], result.branch("secondary")["zw"], label="bent")
for kind, mark in (("limit_point", "ko"), ("bifurcation_point", "k*")):
    for point in result.points(kind):
        levels.plot(point.values["V"], point.values["zw"], mark)
        print(f"{kind} at zw = {number(point, 'zw')}")

# %%
for n in range(4):
    spectrum.plot(straight["V"], straight[f"Lambda_n{n}"], label=f"n = {n}")
spectrum.axhline(0, color="0.6", lw=0.8)
spectrum.set(
    xlabel="volume", ylabel="lowest eigenvalue by wave number", title="negative: unstable at held level"
)
levels.set(xlabel="volume", ylabel="fluid level", title="dot: limit point, star: bifurcation")
for axes in (levels, spectrum):
    axes.legend(frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "bending.svg")
