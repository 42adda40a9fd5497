"""States at given heights of the centre; a fine mesh starts from those of a coarser one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from dolfinx import fem

from weakforms.errors import ConvergenceError
from weakforms.problems.rectangle.model import RectangleModel
from weakforms.problems.triangles.start import first_under_load
from weakforms.solvers.equilibrium.constraints import Held
from weakforms.solvers.equilibrium.newton import ExtendedNewton
from weakforms.solvers.equilibrium.state import State

COARSEST, COARSER = 16, 4
"""Fewest squares along half the short side of a mesh that a finer one starts from; ratio of their numbers."""

CLOSE = 1e-9
"""Largest distance of a node from the coarser mesh that contains it; round-off of places."""


def states_at(model: RectangleModel, solver: ExtendedNewton, heights: Sequence[float]) -> list[State]:
    """Equilibria with each of the heights ``w_c``, which rise.

    Without a coarser mesh the first one is found by :func:`first_under_load`, and each other one from the
    one before.

    Raises:
        ConvergenceError: If one is not found.
    """
    sheet = model.sheet
    held = [[Held("w_c", height)] for height in heights]
    if sheet.cells >= COARSER * COARSEST:
        coarse = RectangleModel(model.system.comm, replace(sheet, cells=sheet.cells // COARSER))
        known = states_at(coarse, ExtendedNewton(coarse.system, solver.scalars), heights)
        states, missed = [], np.zeros(model.system.size)  # what the coarser mesh missed at the state before
        for guess, at in zip(_transferred(known, coarse, model), held, strict=True):
            states.append(_near(solver, State(guess.u + missed, guess.loads), at))
            missed = states[-1].u - guess.u
        return states
    frame = {"delta": sheet.delta, "delta_y": sheet.delta_y}
    states = [first_under_load(solver, heights[0], frame, model.cosine(heights[0]), model.weight)]
    for at in held[1:]:
        states.append(solver.solve(states[-1], at)[0])
    return states


def _near(solver: ExtendedNewton, guess: State, held: Sequence[Held]) -> State:
    """The state near a guess that is good enough for one factorisation; else by Newton's method."""
    try:
        return solver.solve(guess, held, chord=True)[0]
    except ConvergenceError:
        return solver.solve(guess, held)[0]


def _transferred(states: Sequence[State], coarse: RectangleModel, fine: RectangleModel) -> list[State]:
    """The same displacements on a finer mesh."""
    count = fine.mesh.topology.index_map(2)
    cells = np.arange(count.size_local + count.num_ghosts, dtype=np.int32)
    places = fem.create_interpolation_data(fine.space, coarse.space, cells, CLOSE)
    given, found, out = fem.Function(coarse.space), fem.Function(fine.space), []
    for state in states:
        given.x.array[: coarse.system.size] = state.u
        given.x.scatter_forward()
        found.interpolate_nonmatching(given, cells, places)
        out.append(State(found.x.array[: fine.system.size].copy(), state.loads))
    return out
