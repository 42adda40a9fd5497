"""The four bodies of the suite, each drawn from a solved state: the picture on the first page of the README.

A pre-stretched tube inflated past its limit point, a disk pressed against a soft substrate, a wrinkled tube
with a buckling mode of 12 waves around it, and a tube that bends under the weight of the liquid in it.
Colour shows the stretch ``lam2``, light where it is large; each body has its own scale.
Run: ``./run shell -c "python3 examples/gallery/shapes.py docs/shapes.png"``.
"""

import sys
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

import weakforms
from weakforms.shapes import surface

QUICK = {"cells": 32, "levels": 2}
COARSE = QUICK | {"secondary_cells": 12, "secondary_levels": 2}
WAVES = 12
AMPLITUDE = 0.04
"""Of the buckling mode, over the tube's radius; a mode has no amplitude of its own."""
LOWER = 2.4
"""Height up to which the wrinkled tube is shown: its mode is near its lower end."""
TITLES = {
    "tube": "a tube bulges past\nits limit point",
    "disk": "a disk presses against\na soft substrate",
    "wrinkled tube": "a tube wrinkles:\nits lower end, 12 waves",
    "bent tube": "liquid bends\na hanging tube",
}
DPI = 100
UP, AROUND = np.radians(16), np.radians(-60)
"""Direction from which the bodies are seen."""


def solved() -> dict[str, weakforms.Result]:
    """One state of each body."""
    return {
        "tube": weakforms.solve("tube", alpha=0.1, delta1=1.1, u_end=2.2, at={"u_max": 2.0}, numerics=QUICK),
        "disk": weakforms.solve("circular", contact="frictionless", at={"p": 3.2}, numerics=QUICK),
        "wrinkled tube": weakforms.solve(
            "wrinkled_tube", M=1.5, delta=3, Af=0.4362, n=[WAVES], load_end=7.0, at={"zw": 6.5}
        ),
        "bent tube": weakforms.solve(
            "fluid_tube", L=8, delta=2, secondary=True, branch="secondary", at={"zw": 7.336}, numerics=COARSE
        ),
    }


def mirrored(points: np.ndarray, colour: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both halves of the tube, which is solved for on one side of its mid-plane z = 0."""
    order = np.argsort(points[:, 0, 2])
    half, shade = points[order], colour[order]
    return np.vstack([(half * [1, 1, -1])[:0:-1], half]), np.vstack([shade[:0:-1], shade])


def buckled(points: np.ndarray, mode: dict[str, np.ndarray]) -> np.ndarray:
    """The surface of revolution, displaced by its mode of :data:`WAVES` waves."""
    theta = np.linspace(0, 2 * np.pi, 20 * WAVES + 1)
    r, z = points[:, 0, 0], points[:, 0, 2]
    slope = np.stack([np.gradient(r), np.gradient(z)]) / np.hypot(np.gradient(r), np.gradient(z))
    along, around, out = (
        AMPLITUDE * mode[name] / np.abs(mode["normal"]).max()
        for name in ("meridional", "circumferential", "normal")
    )
    wave, shifted = np.cos(WAVES * theta), np.sin(WAVES * theta)
    radial = r[:, None] + (along * slope[0] + out * slope[1])[:, None] * wave
    axial = z[:, None] + (along * slope[1] - out * slope[0])[:, None] * wave
    turn = theta + (around / r)[:, None] * shifted
    return np.stack([radial * np.cos(turn), radial * np.sin(turn), axial], axis=-1)


def seen(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position in the picture, and distance from the eye."""
    x, y, z = np.moveaxis(points, -1, 0)
    right = -np.sin(AROUND) * x + np.cos(AROUND) * y
    towards = np.cos(AROUND) * x + np.sin(AROUND) * y
    return np.stack([right, np.cos(UP) * z - np.sin(UP) * towards], -1), -np.cos(UP) * towards - np.sin(
        UP
    ) * z


def draw(axes: Axes, points: np.ndarray, colour: np.ndarray, palette: str) -> None:
    """A surface as shaded quadrilaterals, the far ones first."""
    flat, far = seen(points)
    corners = [(slice(None, -1),) * 2, (slice(1, None), slice(None, -1)), (slice(1, None),) * 2]
    corners.append((slice(None, -1), slice(1, None)))
    quads = np.stack([flat[c] for c in corners], axis=2).reshape(-1, 4, 2)
    depth, value = (sum(a[c] for c in corners).ravel() / 4 for a in (far, colour))
    normal = np.cross(points[1:, 1:] - points[:-1, :-1], points[1:, :-1] - points[:-1, 1:]).reshape(-1, 3)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    light = np.array([0.55, -0.65, 0.55]) / np.linalg.norm([0.55, -0.65, 0.55])
    lit = 0.4 + 0.6 * np.abs((normal / np.where(size > 0, size, 1)) @ light)
    rgb = colormaps[palette](Normalize(value.min(), value.max() + 1e-9)(value))
    rgb[:, :3] *= lit[:, None]
    order = np.argsort(-depth)
    axes.add_collection(
        PolyCollection(quads[order], facecolors=rgb[order], edgecolors=rgb[order], linewidths=0.3)
    )
    axes.update_datalim(flat.reshape(-1, 2))


def ring(axes: Axes, radius: float, height: float, **look: Any) -> None:
    """A circle about the axis."""
    theta = np.linspace(0, 2 * np.pi, 121)
    circle = np.stack([radius * np.cos(theta), radius * np.sin(theta), 0 * theta + height], -1)
    flat, _ = seen(circle)
    axes.add_patch(Polygon(flat, **look))
    axes.update_datalim(flat)


def picture(results: dict[str, weakforms.Result]) -> Figure:
    """The four bodies side by side, each to its own scale."""
    fields = {name: {f.name: f for f in result.states[0].fields} for name, result in results.items()}
    shapes = {name: surface(next(iter(of.values()))) for name, of in fields.items()}
    figure = FigureCanvasAgg(Figure(figsize=(9.6, 3.6))).figure
    for k, (name, (points, data)) in enumerate(shapes.items()):
        axes = figure.add_axes((0.25 * k + 0.015, 0.02, 0.22, 0.82))
        colour, body = data["lam2"], points
        if name == "tube":
            body, colour = mirrored(points, colour)
        if name == "wrinkled tube":
            lower = points[:, 0, 2] < LOWER
            body = buckled(points, fields[name][f"mode_n{WAVES}"].columns)[lower]
            colour = np.tile(colour[lower, :1], (1, body.shape[1]))
        draw(axes, body, colour, "cividis")
        if name == "disk":
            ring(axes, 0.95, 0.5, facecolor="#8888884d", edgecolor="#888888", linewidth=0.8)
        axes.autoscale_view()
        axes.set_aspect("equal")
        axes.set_axis_off()
        figure.text(0.25 * k + 0.125, 0.98, TITLES[name], color="#777777", fontsize=10, ha="center", va="top")
    return figure


if __name__ == "__main__":
    picture(solved()).savefig(sys.argv[1] if len(sys.argv) > 1 else "shapes.png", dpi=DPI, transparent=True)
