"""Paper 3: initial slopes of the secondary branch at its bifurcation point, with their uncertainties."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from weakforms.errors import ConvergenceError
from weakforms.problems.liquid_tube.bent.branch import AMPLITUDES, COMPARED, SecondaryBranch
from weakforms.problems.liquid_tube.bent.columns import SLOPES
from weakforms.solvers.continuation.curve import Solved
from weakforms.solvers.equilibrium.state import State
from weakforms.solvers.uncertainty.refinement import estimate

SMALL = 0.125, 0.0625, 0.03125
"""Shares of the usual amplitudes from which initial slopes are extrapolated if another mode changes sign
beside the bifurcation point. At usual amplitudes a tube bends in both modes there."""

FACTOR = 2.0
"""Slopes of different amplitudes agree within this many uncertainties."""


def initial_slopes(
    levels: Sequence[SecondaryBranch], cap: float, share: float = 1.0
) -> dict[str, tuple[float, float]]:
    """The initial slopes with their uncertainties.

    The slopes on the finest mesh are those on the next coarser one plus a difference, which is much smaller
    and needs fewer amplitudes.

    Args:
        levels: The branch on all meshes, coarse to fine.
        cap: Highest order of convergence that is assumed.
        share: Share of the usual amplitudes from which the slopes are extrapolated.
    """
    all_of, compared = (tuple(share * a for a in given) for given in (AMPLITUDES, COMPARED))
    *coarser, fine = levels
    for below, level in pairwise(levels):
        for amplitude in compared if level is fine else all_of:
            level.small[amplitude] = _on_finer_mesh(below, level, amplitude)
    last = coarser[-1]
    slopes = [level.initial(all_of) for level in coarser]
    fewer = last.initial(all_of[:-1])  # for the error of the extrapolation
    near, finest = last.initial(compared), fine.initial(compared)
    out = {}
    for name in (slope.name for slope in SLOPES):
        whole = slopes[-1][name]
        found = estimate([*(s[name] for s in slopes), whole + finest[name] - near[name]], cap)
        out[name] = float(found.value), float(found.uncertainty) + abs(fewer[name] - whole)
    return out


def slopes_beside_another_mode(
    levels: Sequence[SecondaryBranch], cap: float
) -> dict[str, tuple[float, float]]:
    """The same from amplitudes so small that half of them give the same slopes.

    Raises:
        ConvergenceError: If there are none.
    """
    found = [initial_slopes(levels, cap, SMALL[0])]
    for share in SMALL[1:]:
        found.append(initial_slopes(levels, cap, share))
        both = [(found[-2][name], found[-1][name]) for name in found[-1]]
        if all(abs(a - b) <= FACTOR * (u + v) for (a, u), (b, v) in both):
            return {name: (b, v + abs(found[-2][name][0] - b)) for name, (b, v) in found[-1].items()}
    raise ConvergenceError(
        "another mode changes sign so near the bifurcation point that the initial slopes of the branch "
        f"are not found, with {SMALL[-1]:g} of the usual amplitudes neither: change L or delta"
    )


def _on_finer_mesh(below: SecondaryBranch, level: SecondaryBranch, amplitude: float) -> Solved:
    """The state of a small amplitude on a mesh, from the state of the next coarser one."""

    def guess() -> State:
        if amplitude not in below.small:
            below.small[amplitude] = below.at_amplitude(amplitude)
        return level.fitting.taken(below.fitting, below.small[amplitude].state)

    return level.at_amplitude(amplitude, guess)
