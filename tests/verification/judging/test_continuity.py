"""The order of continuity at a front is measured on fields whose order is known."""

import numpy as np
import pytest

from weakforms.cases import decide, tube
from weakforms.verification.cases.specs import At
from weakforms.verification.judging import continuity

FRONT, WINDOW = 0.7, 0.4
X = np.array(continuity.samples(FRONT, WINDOW))
OFFSET = X - FRONT


def field(order, size=1.0):
    """``exp(x)`` with a jump in the derivative of an order: ``size x^order / order!`` is added beyond it."""
    factorial = np.prod(np.arange(1, order + 1))
    return np.exp(OFFSET) + np.where(OFFSET > 0, size * OFFSET**order / factorial, 0.0)


def test_samples_are_chebyshev_points_of_both_windows():
    assert len(X) == 2 * continuity.NODES
    assert (np.diff(X) > 0).all()
    np.testing.assert_allclose(OFFSET + OFFSET[::-1], 0.0, atol=1e-15)
    angles = np.pi * (np.arange(continuity.NODES) + 0.5) / continuity.NODES
    np.testing.assert_allclose(OFFSET[OFFSET > 0], WINDOW / 2 * (1 - np.cos(angles)))


def test_both_windows_have_the_same_length():
    values = decide.Number(np.exp(3 * np.abs(OFFSET)) * OFFSET, 0.0)
    (left, largest), (right, other) = (continuity.one_sided(OFFSET, values, side, WINDOW) for side in (-1, 1))
    np.testing.assert_allclose(largest, other, rtol=1e-6)
    expected = np.abs(left.value - right.value) / np.maximum(largest, other)
    np.testing.assert_allclose(continuity.jumps(OFFSET, values, WINDOW).value, expected, rtol=1e-12)


@pytest.mark.parametrize("order", range(4))
def test_a_jump_is_measured_relative_to_the_derivative(order):
    found = continuity.jumps(OFFSET, decide.Number(field(order, 0.5), 0.0), WINDOW)
    largest = np.exp(WINDOW / 2) + 0.5 * (WINDOW / 2) ** np.array([max(order - m, 0) for m in range(4)])
    assert found.value[order] == pytest.approx(0.5 / largest[order], rel=2e-3)
    assert np.delete(found.value, order)[:order] == pytest.approx(0.0, abs=1e-3)
    assert (np.abs(found.value[order] - 0.5 / largest[order]) <= 2 * found.uncertainty[order] + 1e-4).all()


def test_one_side_gives_the_derivatives_there_and_their_largest_values_near_it():
    values = decide.Number(OFFSET**3 + 2 * OFFSET, 0.0)
    for side in (-1, 1):
        found, largest = continuity.one_sided(OFFSET, values, side, WINDOW)
        assert found.value == pytest.approx([0, 2, 0, 6], abs=1e-7)
        half = WINDOW / 2
        assert largest == pytest.approx([half**3 + 2 * half, 3 * half**2 + 2, 6 * half, 6], rel=1e-6)


def test_the_uncertainty_of_the_samples_is_passed_on():
    """A derivative of the fit is linear in the samples: noise of a known size gives a known spread."""
    spread = 1e-6
    found, _ = continuity.one_sided(OFFSET, decide.Number(OFFSET**2, spread), 1, WINDOW)
    chance = np.random.default_rng(7)
    draws = [decide.Number(OFFSET**2 + spread * chance.normal(size=len(X)), 0.0) for _ in range(300)]
    noisy = [continuity.one_sided(OFFSET, draw, 1, WINDOW)[0].value for draw in draws]
    assert found.uncertainty == pytest.approx(np.std(noisy, axis=0), rel=0.15)


class Sampled:
    """Fields of known order, whatever the state."""

    def samples(self, _spec, _at, name):
        """``f1`` jumps in its first derivative, and so on; ``half`` jumps by half a per cent in its first."""
        values = field(1, 0.005) if name == "half" else field(int(name[1]))
        return decide.Number(values, 1e-13)


@pytest.mark.parametrize(
    ("expected", "holds"),
    [
        ({"f1": 1, "f2": 2}, True),
        ({"f3": 3}, True),
        ({"f4": 4}, True),
        ({"f0": 0}, True),
        ({"f1": 2}, False),
        ({"f2": 1}, False),
        ({"f1": 1, "f2": 1}, False),
        ({"f1": 4}, False),
        ({"half": 1}, False),
        ({"half": 2}, False),
    ],
)
def test_the_first_derivative_that_jumps_is_the_expected_one(expected, holds):
    at = At("p", 1.0, profile=tuple(X))
    found = continuity.first_jumps(Sampled(), tube(), at, FRONT, WINDOW, expected)
    assert found.holds is holds
    assert any(name in found.detail for name in expected)
