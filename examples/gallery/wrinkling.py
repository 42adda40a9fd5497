"""Wrinkling has no shortest wave: a membrane without bending stiffness is unstable to every short wave.

A liquid-filled tube whose membrane is narrower than it would be in plain tension wrinkles. Its lowest
eigenvalue for n waves around the tube falls without end as n grows: tension-field theory gives the mean
shape, but no length of the wrinkles. A bending stiffness beta, however small, adds a term that grows like
n^4: the eigenvalue falls no further from some n on, and this n gives the length (paper 5).
Run: ``./run shell -c "python3 examples/gallery/wrinkling.py wrinkling.svg"``.
"""

import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import weakforms

WAVES = [5, 10, 20, 40, 80]
LEVEL = 5.0
TUBE = {"M": 1.5, "delta": 3, "Af": 0.4362, "n": WAVES, "load_end": 5.2}
QUICK = {"cells": 40, "levels": 2}

# %%
figure = FigureCanvasAgg(Figure(figsize=(6, 3.6), layout="constrained")).figure
axes = figure.subplots()
for beta in (0.0, 1e-6):
    state = weakforms.solve("wrinkled_tube", **TUBE, beta=beta, at={"zw": LEVEL}, numerics=QUICK).states[0]
    lowest = [state.quantities[f"Lambda_n{n}_1"] for n in WAVES]
    label = "no bending stiffness" if beta == 0 else f"bending stiffness beta = {beta:g}"
    axes.plot(WAVES, [q.value for q in lowest], "o-", label=label)
    print(
        f"{label}: lowest eigenvalue for "
        + ", ".join(f"n = {n}: {q}" for n, q in zip(WAVES, lowest, strict=True))
    )

# %%
axes.axhline(0, color="0.6", lw=0.8)
axes.set(xlabel="waves around the tube", ylabel="lowest eigenvalue", xscale="log")
axes.set_title(f"negative: unstable at the fluid level {LEVEL:g}")
axes.set_xticks(WAVES, [str(n) for n in WAVES])
axes.minorticks_off()
axes.set_yscale("symlog", linthresh=0.1)
axes.margins(y=0.1)
axes.legend(frameon=False)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "wrinkling.svg")
