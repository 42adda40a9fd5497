"""The two codes for over-filled tubes with an imperfection."""

import numpy as np
import pytest

from reference_data.solvers.beyond.bowed.limits import State, solve
from reference_data.solvers.beyond.imperfect.collocation import LiquidCollocation
from reference_data.solvers.beyond.imperfect.galerkin import LiquidGalerkin
from reference_data.solvers.beyond.imperfect.tables import LOBED, TILTED

SIZES = {LiquidGalerkin: (20, 5), LiquidCollocation: (30, 5)}
LARGE = {TILTED: 2.0, LOBED: 0.05}


def start(of, kind):
    """A state of the code near a straight tube."""
    code = kind(of, *SIZES[kind])
    z = code.nodes * of.tube.length
    meridian = 1 + np.sin(np.pi * code.nodes), of.tube.delta * z
    return State(code, code.tube(*meridian), 9.0, LARGE[of])


@pytest.mark.parametrize("kind", SIZES)
@pytest.mark.parametrize("of", [TILTED, LOBED])
def test_the_matrices_are_differences(of, kind):
    state, rng, h = start(of, kind), np.random.default_rng(1), 1e-6
    code, free = state.of, state.of.free
    x = state.x + 0.01 * rng.standard_normal(state.x.shape) * free
    along = np.where(free, rng.standard_normal(x.shape), 0.0)
    _, matrix, load, other = code.evaluate(x, state.p, state.uneven)
    moves = {
        "x": (matrix @ along[free], (along, 0, 0)),
        "level": (load, (0, 1, 0)),
        "imperfection": (other, (0, 0, 1)),
    }
    for name, (rate, (dx, dp, de)) in moves.items():
        ends = [
            code.evaluate(x + s * h * dx, state.p + s * h * dp, state.uneven + s * h * de)[0] for s in (-1, 1)
        ]
        found = (ends[1] - ends[0]) / (2 * h)
        assert found == pytest.approx(rate, abs=1e-5 * np.abs(rate).max()), name


@pytest.mark.parametrize("of", [TILTED, LOBED])
def test_both_methods_find_the_same_state(of):
    """A state that is far from axisymmetric, at a given mean radius."""
    shape, found = of.near(), []
    for kind, sizes in SIZES.items():
        code = kind(of, *sizes)
        guess = State(code, code.tube(*shape.evaluate(code.nodes * of.tube.length)[0].T), shape.zw)
        radius = float(code.radius @ guess.x[code.free]) - 0.3
        straight = solve(guess, code.radius, radius, bows=False)
        found.append(solve(State(code, straight.x, straight.p, LARGE[of] / 4), code.radius, radius))
    one, other = found
    assert abs(one.offset) > 0.02
    for name in ("p", "offset", "volume"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-4), name
