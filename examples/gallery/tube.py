"""A tube: a bulge forms at a limit point, and enough pre-stretch prevents it.

A tube between two rigid disks bulges when its pressure reaches a limit point. Axial pre-stretch delta1 brings
the two limit points closer together; they merge in a cusp (paper 2, figure 3), beyond which the pressure only
rises. Run: ``./run shell -c "python3 examples/gallery/tube.py tube.svg"``.
"""

import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import weakforms
from weakforms.results import SpecialPoint

QUICK = {"cells": 32, "levels": 2}


def number(point: SpecialPoint, name: str) -> weakforms.Quantity:
    """A value of a special point with its uncertainty."""
    return weakforms.Quantity(point.values[name], point.uncertainty[name])


# %%
figure = FigureCanvasAgg(Figure(figsize=(8, 3.6), layout="constrained")).figure
curves, folds = figure.subplots(1, 2)
for delta1 in (1.0, 1.1, 1.2):
    result = weakforms.solve("tube", alpha=0.1, delta1=delta1, numerics=QUICK)
    branch = result.branch()
    curves.plot(branch["u_max"], branch["p"], label=f"delta1 = {delta1}")
    for k, point in enumerate(result.points("limit_point"), 1):
        curves.plot(point.values["u_max"], point.values["p"], "ko", ms=4)
        print(f"delta1 = {delta1}: limit point {k} at p = {number(point, 'p')}")

# %%
fold = weakforms.solve("tube_fold", alpha=0.1, numerics=QUICK)
(cusp,) = fold.points("cusp_point")
folds.plot(fold.branch()["delta1"], fold.branch()["p"])
folds.plot(cusp.values["delta1"], cusp.values["p"], "k*", ms=9)
print(f"the limit points merge at delta1 = {number(cusp, 'delta1')}")

# %%
curves.set(xlabel="displacement of the mid-plane", ylabel="pressure p R/(C1 h)", title="dots: limit points")
curves.legend(frameon=False)
folds.set(xlabel="axial pre-stretch delta1", ylabel="pressure of the limit points", title="star: cusp")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "tube.svg")
