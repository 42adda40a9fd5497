"""States of a front-fitted mesh as guesses for another front, or for a patch that sticks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.interpolate import CubicSpline

from weakforms.problems.contact.model import PatchModel
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State


def moved(model: PatchModel, state: State, front: float) -> State:
    """The same membrane on a differently divided mesh, by splines through nodal values."""
    return transferred(model, state, model, {name: sign * front for name, (_, sign) in model.edges.items()})


def transferred(model: PatchModel, state: State, other: PatchModel, loads: Mapping[str, float]) -> State:
    """The same membrane on the mesh of another model; loads that are not given are those of the state."""
    known = state.loads | loads
    new = State(other.system.initial.u.copy(), {name: known[name] for name in other.system.load_names})
    old = np.repeat(model.material(model.nodes(), state.loads), 2)
    wanted = np.repeat(other.material(other.nodes(), new.loads), 2)
    for component in (slice(0, None, 2), slice(1, None, 2)):
        parts = model.mesh.comm.allgather((old[component], state.u[component]))
        x, first = np.unique(np.concatenate([part[0] for part in parts]), return_index=True)
        values = np.concatenate([part[1] for part in parts])[first]
        new.u[component] = CubicSpline(x, values)(wanted[component])
    return new


def stick_guess(model: PatchModel, slipped: Solved) -> State:
    """A frictionless state as a guess for the model with the same mesh and front whose patch sticks.

    What sticks is not an unknown. Outside, it is measured from its own value at the front, not from that of
    the series, which differs and would cause a jump.
    """
    x = np.repeat(model.nodes() - model.centre, 2)
    s = np.abs(x)
    u = slipped.state.u.copy()
    stuck, outside = np.arange(len(u)) % 2 == model.stuck, s > 1 + 1e-12
    u[stuck & ~outside] = 0.0
    away = stuck & outside
    u[away] -= np.sign(x[away]) * model.at_front(slipped) * (2 - s[away])
    if model.bond.rigid:  # the other unknown is the height of the edge
        u[~stuck & ~outside] = model.data.touch
    return State(u, dict(slipped.state.loads))
