"""The reference of the square airbag: its energy, its equations, and small meshes."""

import numpy as np
import pytest

from reference_data.solvers.beyond.airbag.bag import Bag
from reference_data.solvers.beyond.airbag.sheet import SLACK, TAUT, WRINKLED, relaxed, stresses

NU = 0.4
STRAINS = {(0.1, 0.05): TAUT, (0.1, -0.039): TAUT, (0.1, -0.041): WRINKLED, (-0.01, -0.1): SLACK}


def turned(a, b, angle=0.7):
    q = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    c = q @ np.diag([1 + 2 * a, 1 + 2 * b]) @ q.T
    return np.array([[c[0, 0]], [c[1, 1]], [c[0, 1]]])


@pytest.mark.parametrize(("strains", "kind"), STRAINS.items())
def test_the_energy_of_each_state_and_its_derivatives(strains, kind):
    a, b = strains
    c, e = turned(a, b), 1e-6
    point = relaxed(c, NU)
    full = (a * a + b * b + 2 * NU * a * b) / 2 / (1 - NU**2)
    assert point.state == kind
    assert point.energy == pytest.approx({TAUT: full, WRINKLED: a * a / 2, SLACK: 0.0}[kind], rel=1e-13)
    for i in range(3):
        step = e * np.eye(3)[:, i : i + 1]
        up, down = relaxed(c + step, NU), relaxed(c - step, NU)
        assert (up.energy - down.energy) / (2 * e) == pytest.approx(point.gradient[i], abs=1e-9)
        slope = (up.gradient - down.gradient) / (2 * e)
        assert slope[:, 0] == pytest.approx(point.hessian[i, :, 0], abs=1e-7)


def test_moduli_are_the_slopes_of_stresses():
    rng = np.random.default_rng(1)
    x = rng.normal(size=(2, 3, 4)) * 0.1 + np.array([[1.1, 0, 0], [0, 0.98, 0]])[:, :, None]

    def stress(x):
        return stresses(
            *x, relaxed(np.array([(x[i] * x[j]).sum(0) for i, j in ((0, 0), (1, 1), (0, 1))]), NU)
        )

    _, moduli = stress(x)
    for s in range(2):
        for j in range(3):
            step = np.zeros_like(x)
            step[s, j] = 1e-6
            slope = (stress(x + step)[0] - stress(x - step)[0]) / 2e-6
            assert slope == pytest.approx(moduli[:, :, s, j], abs=1e-7)


@pytest.mark.parametrize("degree", [2, 3])
def test_forces_and_matrix_are_slopes_of_the_potential(degree):
    bag = Bag(2, degree, NU)
    rng = np.random.default_rng(2)
    u, way = bag.dome(), np.zeros(3 * bag.nodes.shape[1])
    u[bag.free] += 0.02 * rng.normal(size=len(bag.free))
    way[bag.free] = rng.normal(size=len(bag.free))
    e, p = 1e-6, 0.3
    (up, more, *_), (down, less, *_) = bag.equations(u + e * way, p), bag.equations(u - e * way, p)
    _, forces, matrix, about = bag.equations(u, p)
    assert (up - down) / (2 * e) == pytest.approx(forces @ way[bag.free], rel=1e-6)
    assert (more - less) / (2 * e) == pytest.approx(matrix @ way[bag.free], abs=1e-4)
    assert abs(matrix - matrix.T).max() < 1e-13
    assert about["Pi"] == pytest.approx(about["U"] - p * about["V"], rel=1e-14)


def test_small_meshes_of_both_families_come_close():
    a, b = Bag(4, 2, NU).least(6e-3), Bag(3, 3, NU).least(6e-3)
    for name, close in (("w_c", 1e-2), ("V", 2e-2), ("Pi", 2e-2), ("u_far", 0.15)):
        assert a[name] == pytest.approx(b[name], rel=close), name


def test_a_minimum_that_is_not_reached_is_an_error(monkeypatch):
    monkeypatch.setattr("reference_data.solvers.beyond.airbag.bag.MOST", 2)
    with pytest.raises(RuntimeError, match=r"no minimum at p = 0\.006 on 2 squares of degree 2"):
        Bag(2, 2, NU).least(6e-3)
