"""Over-filled tubes whose bifurcation an imperfection takes apart: tilted gravity, and uneven thickness.

The tube of Paper 3 with delta = 5 bends sideways where its level would still rise. If gravity is tilted, it
hangs to one side from the beginning, and its level and its volume have limits before that. With delta = 7 it
flattens, with two waves around its axis. If its thickness is 1 + e cos(2 Theta), its level has a limit too;
its volume has none, but the detached states have a smallest one. The limits follow Koiter's law: the power of
the imperfection is two thirds, with constants of the even, upright tube. Two other codes have the limits and
the constants.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    decide,
    fluid_tube_imperfect,
    reference,
)


@dataclass(frozen=True)
class Kind:
    """An even tube and its imperfection."""

    name: str
    key: str
    even: Spec
    sizes: tuple[float, ...]
    volume_branch: str
    """The branch with the extrema of the volume."""

    def at(self, size: float) -> Spec:
        """The imperfect tube, with its detached states only where they are judged or shown."""
        detached = self.volume_branch == "secondary" or size < 0
        return self.even.at(**{self.key: size}, secondary=detached).on(**MESHES)

    @property
    def solved(self) -> tuple[tuple[Spec, None], ...]:
        """All tubes."""
        return ((self.even, None), *((self.at(size), None) for size in self.sizes))


BOTH = fluid_tube_imperfect(L=8, delta=5, u_end=0.6, secondary=True)
"""On the default meshes, because curvatures of branches need them."""
MESHES = {"cells": 12, "around": 6, "levels": 2}
TILTED = Kind("tilted", "tilt", BOTH, (0.004, 0.012, 0.036, 0.108), "primary")
LOBED = Kind(
    "lobed", "uneven", BOTH.at(delta=7, n=2, v_end=1.2), (4e-4, 1.2e-3, 3.6e-3, 1.08e-2), "secondary"
)

EXTREMA = {
    "zw": ("limit_point", lambda _: "primary"),
    "V": ("volume_fold", lambda kind: kind.volume_branch),
}
ASKED = {"zw": 1e-7, "V": 1e-5}
"""Of a limit: the level is flat there, the volume is not."""

POWER = 2 / 3
KOITER = 1e-2
"""Asked of the power and of the constants of full solves, which are limits for vanishing imperfections."""
CONSTANTS = 1e-6
"""Asked of the constants of the even tube."""


def distances(solutions: Solutions, kind: Kind, name: str) -> decide.Number:
    """Distances of the extrema from the bifurcation of the even tube."""
    point, branch = EXTREMA[name]
    start = solutions.point(kind.even, "bifurcation_point", name)
    found = []
    for size in kind.sizes:
        points = [p for p in solutions.points(kind.at(size), point) if p.branch == branch(kind)]
        found.append(decide.of_point(points[0], name) - start)
    return decide.stack(found)


def koiter(solutions: Solutions, kind: Kind) -> Finding:
    """The constants of full solves, and those of the even tube, against those of two other methods."""
    sizes, found = np.array(kind.sizes) ** POWER, []
    table = reference("beyond", f"{kind.name}_tube_law")
    for name in EXTREMA:
        constant, expected = f"{name}_{kind.key}", table.number(f"{name}_{kind.key}")[0]
        own = solutions.point(kind.even, "bifurcation_point", constant)
        full = decide.vanishing(distances(solutions, kind, name) * (1 / sizes), sizes)
        found += [
            decide.agree(f"{constant} of full solves", full, expected, KOITER),
            decide.agree(f"{constant} of the even tube", own, expected, CONSTANTS),
        ]
    return decide.all_of(*found)


def power(solutions: Solutions, kind: Kind) -> Finding:
    """The power of the imperfection, from neighbouring pairs, as it vanishes."""
    steps = np.diff(np.log(kind.sizes))
    between = np.sqrt(np.array(kind.sizes[1:]) * kind.sizes[:-1]) ** POWER
    found = []
    for name in EXTREMA:
        away = distances(solutions, kind, name)
        away = away * float(np.sign(away.value[0]))
        observed = decide.vanishing(away.log().diff() * (1 / steps), between)
        found.append(decide.agree(f"power of {name}", observed, POWER, KOITER))
    return decide.all_of(*found)


def stability(solutions: Solutions, kind: Kind) -> Finding:
    """The natural branch is stable up to its limit level, and at fixed volume up to that of the volume."""
    found = []
    for size in kind.sizes:
        branch = solutions.branch(kind.at(size)).columns
        found.append(decide.same(f"{size:g}, level held", decide.runs(branch["n_negative"]), [0, 1]))
        held = [0, 1] if kind is TILTED else [0]
        found.append(decide.same(f"{size:g}, volume held", decide.runs(branch["n_held"]), held))
    return decide.all_of(*found)


def both(what: str, text: str, judge: Callable[[Solutions, Kind], Finding]) -> list[Claim]:
    """A claim for each kind of imperfection."""
    return [
        Claim(f"{what}_{kind.key}", f"{kind.key}: {text}", kind.solved, partial(judge, kind=kind))
        for kind in (TILTED, LOBED)
    ]


SHOWN = {TILTED.key: -TILTED.sizes[-1], LOBED.key: -LOBED.sizes[2]}
"""Imperfections in pictures, which push to the side of positive amplitudes."""


def unfolded(kind: Kind, x: Axis, y: Axis, title: str) -> Panel:
    """The bifurcation of the even tube, and both branches of an imperfect one."""
    apart = kind.at(SHOWN[kind.key])
    return Panel(
        kind.name,
        x=x,
        y=y,
        title=title,
        markers=("bifurcation_point", "limit_point", "volume_fold"),
        counted=("n_negative",),
        note="Not a figure of the thesis. Lines by the number of negative eigenvalues at fixed level.",
        curves=(
            Curve(kind.even, "even, axisymmetric"),
            Curve(kind.even, "even, bent", branch="secondary"),
            Curve(apart, f"{kind.key} = {SHOWN[kind.key]:g}, natural"),
            Curve(apart, f"{kind.key} = {SHOWN[kind.key]:g}, detached", branch="secondary"),
        ),
    )


CASE = Case(
    title="Over-filled tubes with tilted gravity and with uneven thickness",
    source="beyond Patil, Nordmark & Eriksson (2015); Koiter (1945)",
    panels=(
        unfolded(
            TILTED,
            Axis("u_wave", -0.6, 0.6),
            Axis("zw", 8.75, 8.95),
            "delta = 5: sideways displacement, upright and tilted by 0.108 degrees",
        ),
        unfolded(
            LOBED,
            Axis("u_wave", -0.6, 0.6),
            Axis("zw", 9.5, 9.9),
            "delta = 7: flattening, even and uneven by 0.36 percent",
        ),
    ),
    checks=(
        *(
            Count("bifurcation_point", {kind.even: 1} | {kind.at(e): 0 for e in kind.sizes}, kind.key)
            for kind in (TILTED, LOBED)
        ),
        *(
            Points("bifurcation_point", f"{kind.name}_tube_law", kind.even, (), dict.fromkeys(asked, 1e-6))
            for kind in (TILTED, LOBED)
            for asked in [("zw", "V", "zw_2", "V_2")]
        ),
        *(
            Points("limit_point", f"{kind.name}_tube_limits", kind.even, (kind.key,), ASKED, branch="primary")
            for kind in (TILTED, LOBED)
        ),
        Points("volume_fold", "tilted_tube_volumes", BOTH, ("tilt",), {"V": 1e-5}, branch="primary"),
        *both("koiter", "limits follow the two-thirds law with the constants of the even tube", koiter),
        *both("power", "the power of the imperfection is two thirds", power),
        *both("stability", "the natural branch loses its stability at its limits only", stability),
    ),
    asked={"zw": 1e-6, "V": 1e-6},
    slow=True,
)
