"""Your own material law: one function of the two stretches, used in every problem.

Stresses, tangent and the relaxed energy of wrinkled membranes follow from the function by differentiation.
Here the law is Fung's exponential of the first invariant, as for soft tissue: a balloon of it has a limit
point only if it stiffens slowly enough. A law is registered before the first solve.
Run: ``./run shell -c "python3 examples/gallery/own_law.py own_law.svg"``.
"""

import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from ufl import exp
from ufl.core.expr import Expr

import weakforms
from weakforms.forms.materials import MATERIALS, Constant, Material
from weakforms.forms.materials.phenomenological import first_invariant
from weakforms.results import SpecialPoint


def fung(lam1: Expr, lam2: Expr, b: Expr) -> Expr:
    """W = (exp(b (I1 - 3)) - 1)/b, which is neo-Hookean for b = 0."""
    return (exp(b * first_invariant(lam1, lam2)) - 1) / b


MATERIALS["fung"] = Material(
    "fung",
    "Fung's exponential of the first invariant",
    fung,
    "w = (exp(b (I1 - 3)) - 1)/b",
    "Demiray (1972)",
    {"b": Constant(0.05, 0.0, 10.0, "rate of stiffening", open_low=True)},
    scale="C1",
)


def number(point: SpecialPoint, name: str) -> weakforms.Quantity:
    """A value of a special point with its uncertainty."""
    return weakforms.Quantity(point.values[name], point.uncertainty[name])


# %%
figure = FigureCanvasAgg(Figure(figsize=(8, 3.6), layout="constrained")).figure
balloons, tubes = figure.subplots(1, 2)
for b in (0.02, 0.05, 0.1):
    result = weakforms.solve("sphere", model="fung", b=b, lam_end=3.5)
    balloons.plot(result.branch()["lam"], result.branch()["P"], label=f"b = {b}")
    pressures = [str(number(p, "P")) for p in result.points("limit_point")]
    print(f"balloon, b = {b}: limit points at P = {', '.join(pressures) or 'none'}")

# %%
quick = {"cells": 32, "levels": 2}
result = weakforms.solve("tube", model="fung", b=0.05, u_end=2.0, numerics=quick)
tubes.plot(result.branch()["u_max"], result.branch()["p"])
print(f"tube, b = 0.05: {len(result.points('limit_point'))} limit points")

# %%
balloons.set(xlabel="stretch", ylabel="pressure", title="balloon")
balloons.legend(frameon=False)
tubes.set(xlabel="displacement of the mid-plane", ylabel="pressure", title="tube, b = 0.05")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "own_law.svg")
