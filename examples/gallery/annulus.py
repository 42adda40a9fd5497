"""A flat annulus whose inner edge is turned in its plane: lines of tension, and the ring that stays taut.

The sheet cannot bear compression. It wrinkles along straight lines, each of which touches one circle around
the centre. Near the outer edge the tension is nearly radial and the held hoops would contract: a ring stays
taut there. If the sheet is stretched first, wrinkles spread from the inner edge outwards.
Run: ``./run shell -c "python3 examples/gallery/annulus.py annulus.svg"``.
"""

import sys

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

import weakforms

ANGLE = 0.35
LINES = 72
CIRCLE = np.exp(2j * np.pi * np.arange(361) / 360)
CASES = {
    "a = 0.4": {"a": 0.4},
    "a = 0.4, stretched by 5 %": {"a": 0.4, "s": 1.05},
    "a = 0.8": {"a": 0.8},
}

# %%
figure = FigureCanvasAgg(Figure(figsize=(12, 4.6), layout="constrained")).figure
shown = figure.subplots(1, len(CASES))
for axes, (name, given) in zip(shown, CASES.items(), strict=True):
    state = weakforms.solve("annulus", alpha=0.0, psi_end=0.4, at={"psi": ANGLE}, **given).states[0]
    columns = state.fields[0].columns
    r, turn, lam1 = (columns[n] for n in ("r", "turn", "lam1"))
    angles = np.linspace(0, 2 * np.pi, 91)
    at = angles[:, None] + turn[None, :]
    colours = axes.contourf(r * np.cos(at), r * np.sin(at), np.broadcast_to(lam1, at.shape), levels=16)
    front = np.interp(state.quantities["R_front"].value, columns["R"], r)
    inner, distance = r[0], columns["line"][0]
    # A line at this distance from the centre, from the inner edge to the front, turned around the centre.
    along = np.sqrt(np.array([inner, front]) ** 2 - distance**2)
    turned = 2 * np.pi * np.arange(LINES) / LINES
    ends = along[None, :] * np.exp(1j * turned)[:, None] + 1j * distance * np.exp(1j * turned)[:, None]
    axes.add_collection(LineCollection(np.stack([ends.real, ends.imag], axis=-1), colors="w", linewidths=0.8))
    for radius, style in ((inner, "k-"), (r[-1], "k-"), (front, "w--"), (abs(distance), "k:")):
        axes.plot(radius * CIRCLE.real, radius * CIRCLE.imag, style, linewidth=1)
    material = r * np.exp(1j * turn)
    axes.plot(material.real, material.imag, color="#c4305a", linewidth=2)
    axes.set(aspect="equal", title=f"{name}\nwrinkled: {state.quantities['f_w'].value:.1%} of the area")
    axes.set_axis_off()
    figure.colorbar(colours, ax=axes, label="larger stretch", shrink=0.8)
    print(f"{name}: wrinkled part {state.quantities['f_w']}, torque {state.quantities['M']}")

# %%
figure.suptitle(
    f"inner edge turned by {ANGLE:g}; white: lines of tension up to the front; red: what was a radius at rest"
)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "annulus.svg")
