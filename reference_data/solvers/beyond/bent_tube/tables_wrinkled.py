"""Table of bent states of the free tube that are wrinkled beside the disk, with the relaxed energy."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from reference_data.solvers.beyond.bent_tube import energy, strong
from reference_data.solvers.beyond.bent_tube.tables import ASKED, COLUMNS, FLOOR, SERIES, Both, first, read
from reference_data.solvers.beyond.bent_tube.wrinkled import ByEnergy, ByForces
from reference_data.solvers.beyond.tube_waves.ritz import Basis
from reference_data.solvers.core.collocation import Mesh
from reference_data.solvers.core.tables import Column, Table, agreed, rule
from reference_data.solvers.core.two_estimates import on_two_grids

NAME = "neo_hookean"
"""The branch, which is taut up to V = 6.4 or so."""
TAUT = ASKED[NAME].volumes[:3]
"""Volumes of taut states on the way."""
VOLUMES, STEP = (6.6, 6.8, 7.0, 7.2, 7.4), 0.1
"""Volumes of the rows, and largest step between two of them."""
SERIES_OF = energy.Series(1, 8, Basis(7, 9)), energy.Series(1, 10, Basis(8, 9))
NETS = strong.Net(1, 10, Mesh.graded(7, 11, 2.0)), strong.Net(1, 16, Mesh.graded(10, 9, 2.0))
"""Coarse and fine functions of (a), and nets of (b)."""

METHOD = (
    "Two codes on half the tube with the energy of a tension field, which share the data of the tube and no "
    "equation: (a) the energy of a surface in space by Fourier series around the axis and polynomials along "
    "it, with second derivatives by complex steps of its gradient; where the smaller principal stress would "
    "be negative, that of uniaxial tension; (b) collocation of the balance of forces at points of the "
    "surface, from the states of (a) as guesses; where the force across the larger stretch would push, "
    "Mooney's force along that fibre. Neither follows the fronts, at which stresses have kinks: u_a and u_b "
    "are three times the largest difference of two resolutions. " + rule("a")
)
GRID = (
    "(a) 7 and 8 elements of degree 9 with 8 and 10 harmonics, (b) 7 elements of degree 11 with 10 angles of "
    "half the circumference and 10 of degree 9 with 16, graded to the disk"
)


def states() -> Both:
    """Wrinkled states at rising volumes."""
    at = energy.on(first(NAME), SERIES_OF[0])
    for volume in TAUT:
        at = energy.solve(at, "V", float(volume))
    relaxed = ByEnergy(at.tube, at.series, at.x, at.p)
    coarse, volume = [], relaxed.volume
    for target in VOLUMES:
        for between in np.linspace(volume, target, 1 + int(np.ceil((target - volume) / STEP)))[1:]:
            relaxed = energy.solve(relaxed, "V", float(between))
        volume = target
        coarse.append(relaxed)
    pairs = list(zip(coarse, VOLUMES, strict=True))
    fine = [energy.solve(energy.on(state, SERIES_OF[1]), "V", v) for state, v in pairs]
    others = [[strong.solve(strong.on(s, net, ByForces), "V", v) for s, v in pairs] for net in NETS]
    return Both([coarse, fine], others)


def branch(table: str = "bent_tube_wrinkled") -> Table:
    """Wrinkled states over the volume."""
    both, tube = states(), ASKED[NAME].tube
    parts = {"p": "p", "u_max": "u_max", "u_wave": "amplitude"}

    def column(key: str, part: str) -> Column:
        a, b = (on_two_grids(*levels, FLOOR) for levels in read(both, part))
        return agreed(table, key, b, a, COLUMNS[key], "balance of forces", "energy in space")

    found = [column(key, part) for key, part in parts.items()]
    given = {"alpha": tube.alpha, "delta1": tube.delta1, "lf": tube.lf, "n": 1}
    series = replace(SERIES, method=METHOD, grid=GRID)
    title = "Bent states of the inflated tube that are wrinkled at the disk, over their volume"
    return series.table(table, title, "", given, [*series.keys(V=np.array(VOLUMES)), *found])


TABLES = {"bent_tube_wrinkled": partial(branch)}
