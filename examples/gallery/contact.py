"""Contact, adhesion and pull-off: a disk is inflated against a soft substrate, let down, and peeled off.

Where the substrate is sticky, points of the membrane that touch it stay where they touched: the patch is
stretched unevenly, and on deflation it does not return along the same path. At a low pressure the patch
peels; the energy release rate G turns at the point at which it pulls off (paper 1, figures 10 and 11).
Run: ``./run shell -c "python3 examples/gallery/contact.py contact.svg"``.
"""

import sys

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import weakforms
from weakforms.results import SpecialPoint

QUICK = {"cells": 32, "levels": 2}
TO = 3.2
"""Pressure up to which the disk is inflated."""


def number(point: SpecialPoint, name: str) -> weakforms.Quantity:
    """A value of a special point with its uncertainty."""
    return weakforms.Quantity(point.values[name], point.uncertainty[name])


# %%
figure = FigureCanvasAgg(Figure(figsize=(11, 3.4), layout="constrained")).figure
shapes, patches, release = figure.subplots(1, 3)
for contact, colour in (("frictionless", "C0"), ("adhesive", "C1")):
    result = weakforms.solve("circular", contact=contact, p_end=TO, at={"p": 3.0}, numerics=QUICK)
    (touch,) = result.points("contact_onset")
    print(f"{contact}: contact starts at p = {number(touch, 'p')}")
    state = result.states[0]
    print(f"{contact}: radius of the patch at p = 3: {state.quantities['rho_contact']}")
    profile = state.fields[0].columns
    shapes.plot(profile["rho"], profile["eta"], color=colour, label=contact)
    branch = result.branch()
    patches.plot(branch["p"], branch["rho_contact"], color=colour, label=contact)

# %%
back = weakforms.solve("circular", contact="adhesive", phase="deflation", p_end=TO, numerics=QUICK)
patches.plot(back.branch()["p"], back.branch()["rho_contact"], "C1--", label="adhesive, let down")
peeled = weakforms.solve(
    "circular", contact="adhesive", phase="peeling", at={"p": 1.5}, p_end=TO, numerics=QUICK
)
release.plot(peeled.branch()["rho_contact"], peeled.branch()["G"], "C1")
for point in peeled.points("pull_off"):
    release.plot(point.values["rho_contact"], point.values["G"], "k*", ms=9)
    print(f"pull-off at G = {number(point, 'G')}")

# %%
shapes.axhline(0.5, color="0.6", lw=0.8)
shapes.set(xlabel="radius", ylabel="height", title="p = 3, the line is the substrate", aspect="equal")
patches.set(xlabel="pressure", ylabel="radius of the patch")
patches.legend(frameon=False)
release.set(xlabel="radius of the patch", ylabel="energy release rate G", title="star: pull-off")
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "contact.svg")
