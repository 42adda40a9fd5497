"""The collocation core: exact solutions, unknown fronts, states side by side, derivatives of the solution."""

from dataclasses import dataclass

import numpy as np
import pytest

from reference_data.solvers.core.collocation import Mesh, Problem, joined


@dataclass(frozen=True)
class Fall:
    """y'' = -g(x) on a part of [0, 2] that ends at the unknown front; (y, y')."""

    mesh: Mesh
    g: float
    first: bool

    def rates(self, y, s, c):
        """Right-hand sides."""
        left, right = (0.0, c[0]) if self.first else (c[0], 2.0)
        return [(right - left) * y[1], -(right - left) * self.g * (1 + 0 * s) + 0 * y[0]]


def thrown(height):
    """Gravity 2 up to the front, where y reaches a height, and 6 beyond; y(0) = y(2) = 0."""
    zones = Fall(Mesh.graded(2, 4), 2.0, True), Fall(Mesh.graded(3, 5, 1.5), 6.0, False)

    def conditions(left, right, c):
        return [left[0][0], right[1][0], *joined(left, right), right[0][0] - height]

    return Problem(zones, conditions)


def guess(front):
    y = tuple(np.stack([np.ones_like(z.mesh.x), np.zeros_like(z.mesh.x)], -1) for z in thrown(0.0).zones)
    return y, np.array([front])


def test_polynomials_and_their_front_are_found_exactly():
    problem = thrown(1.0)
    y, c = problem.solve(*guess(0.6), "fall")
    front, speed = c[0], y[0][0, 0, 1]
    assert speed * front - front**2 == pytest.approx(1.0, abs=1e-14)
    late = 2 - front
    assert 1 + (speed - 2 * front) * late - 3 * late**2 == pytest.approx(0.0, abs=1e-13)
    x = front * problem.zones[0].mesh.x
    assert y[0][..., 0] == pytest.approx(speed * x - x**2, abs=1e-14)


def test_states_side_by_side_are_those_one_by_one():
    heights = np.array([0.8, 1.0, 1.1])
    y, c = guess(0.6)
    many = tuple(np.stack([v] * 3) for v in y), np.stack([c] * 3)
    _, found = thrown(heights).solve(*many, "falls")
    alone = [thrown(h).solve(y, c, "fall")[1][0] for h in heights]
    assert found[:, 0] == pytest.approx(alone, abs=1e-13)


def test_response_and_bend_are_the_derivatives_of_the_solution():
    h = 1e-3
    y, c = thrown(1.0).solve(*guess(0.6), "fall")
    fronts = [thrown(1.0 + k * h).solve(y, c, "fall")[1][0] for k in (-1, 0, 1)]
    system = thrown(1.0).linearised(y, c)
    dy, dc = system.response()
    assert dc[0] == pytest.approx((fronts[2] - fronts[0]) / (2 * h), rel=1e-5)
    second = 2 * system.solve(*thrown(1.0).bent(y, c, dy, dc))[1][0]
    assert second == pytest.approx((fronts[2] - 2 * fronts[1] + fronts[0]) / h**2, rel=1e-4)


def test_values_slopes_and_integrals_of_polynomials_on_a_mesh():
    mesh = Mesh((0.0, 0.3, 1.1, 2.0), 5)
    cubic, slope = (lambda x: x**3 - x), (lambda x: 3 * x**2 - 1)
    at = np.array([0.0, 0.3, 0.77, 2.0])
    assert mesh.evaluate(cubic(mesh.x)[..., None], at)[:, 0] == pytest.approx(cubic(at), abs=1e-13)
    assert mesh.slope(cubic(mesh.x)) == pytest.approx(slope(mesh.x), abs=1e-12)
    assert np.sum(mesh.weights * cubic(mesh.gauss)) == pytest.approx(2.0, abs=1e-13)
