"""The state at which a wrinkled membrane first takes a load, from which other problems start."""

from __future__ import annotations

from weakforms.errors import AbsentError, ConvergenceError, InputError
from weakforms.problems.meridian.limits import giving_way
from weakforms.problems.wrinkled.branch import STEP, VOLUME_END, WrinkledBranch
from weakforms.problems.wrinkled.membrane import Membrane
from weakforms.problems.wrinkled.readings import Readings
from weakforms.problems.wrinkled.state import ZonedState


def first_state(membrane: Membrane, load: float, hint: str, volume_end: float = VOLUME_END) -> ZonedState:
    """The state of the plain mesh at which the branch from no load first takes a load, with its zones.

    Args:
        membrane: The membrane.
        load: The load.
        hint: What to change if the branch does not take the load.
        volume_end: Volume over the unloaded one up to which the branch is followed.

    Raises:
        AbsentError: If the branch does not take it, or there is none.
        ConvergenceError: If the branch cannot be followed so far.
    """
    branch = WrinkledBranch(
        membrane, load, volume_end, STEP, Readings(membrane, 2 * membrane.meshes[-1].degree)
    )
    stalled = branch.trace.stalled
    try:
        return membrane.plain(branch.near(membrane.control, load).state)
    except InputError as error:
        end = f", up to {volume_end:g} times the volume without load"
        if stalled:
            why = giving_way(membrane.plain_model, branch.trace.points[-1].state)
            if not why:
                raise ConvergenceError(f"{error}: {stalled}") from error
            end = f"; where the branch ends, {why}"
        what = f"state at {membrane.control} = {load:g}"
        raise AbsentError(what, f"{error}{end}; {hint}") from error
