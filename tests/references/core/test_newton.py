"""Newton's method, roots without derivatives, and fixed points: what they find, and what they refuse."""

import numpy as np
import pytest
from led_astray import AWAY, refused

from reference_data.solvers.core.newton import Secants, newton, secant, settled


def root_of_two(x: float, steps: list[float] | None = None):
    """Newton's correction for x^2 = 2."""
    step = (2 - x * x) / (2 * x)
    if steps is not None:
        steps.append(abs(step))
    return abs(step), lambda share: x + share * step


def test_one_short_step_follows_the_first():
    steps: list[float] = []
    assert newton(1.0, lambda x: root_of_two(x, steps), "root") == pytest.approx(2**0.5, abs=1e-15)
    assert steps[-1] < 1e-7
    assert steps[-2] < 1e-7 < steps[-3]
    steps.clear()
    newton(1.0, lambda x: root_of_two(x, steps), "root", more=0)
    assert steps[-1] < 1e-7 < steps[-2]


def test_long_steps_are_shortened():
    seen = []

    def correct(x):
        seen.append(x)
        return root_of_two(x)

    newton(5.0, correct, "root", longest=0.5)
    assert np.max(np.abs(np.diff(seen))) == pytest.approx(0.5)


def test_states_side_by_side_have_steps_of_their_own():
    goals = np.array([1.0, 40.0])

    def correct(x):
        return np.abs(goals - x), lambda share: x + share * (goals - x)

    assert newton(np.zeros(2), correct, "both", longest=2.0) == pytest.approx(goals)


@pytest.mark.parametrize("step", AWAY)
def test_corrections_that_lead_nowhere_are_refused(step):
    words = "^the state: Newton's method does not converge$"
    refused(words, newton, 0.0, lambda x: (step, lambda _: x), "the state")


def test_a_singular_matrix_is_refused():
    def correct(_):
        return np.linalg.solve(np.zeros((1, 1)), np.ones(1)), None

    refused("^the state: Newton's method does not converge$", newton, 0.0, correct, "the state")


def test_roots_without_derivatives():
    found = Secants().solve(lambda z: np.array([z[0] ** 2 + z[1] - 3, z[0] - z[1] + 1]), [0.8, 1.7])
    assert found == pytest.approx([1.0, 2.0], abs=1e-13)
    refused("^disk: no root near ", Secants().solve, lambda z: z**2 + 1, [0.7], "disk")


def test_secants():
    assert secant(lambda x: x - 0.25, 0.0, 0.1) == pytest.approx((0.25, 1.0))
    assert secant(lambda x: x - 0.25, 0.0, 0.1, 0.1) == pytest.approx((0.25, 1.0))
    noise = iter(np.cos(np.arange(99.0) ** 2))
    refused("^the secant iteration does not converge$", secant, lambda _: next(noise), 0.0, 1.0)


def test_fixed_points():
    assert settled(lambda z: 0.5 * z + 1, np.zeros(2), 1e-12) == pytest.approx([2.0, 2.0])
    noise = np.random.default_rng(1)
    words = "^history not settled, last change "
    refused(words, settled, lambda z: noise.random(z.shape), np.zeros(2), 1e-9)
