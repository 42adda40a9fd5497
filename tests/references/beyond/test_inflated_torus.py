"""The two reference methods of the inflated torus."""

import numpy as np
import pytest

from reference_data.solvers.beyond.torus.fourier import Series
from reference_data.solvers.beyond.torus.shooting import Shooting
from reference_data.solvers.beyond.torus.tables import USUAL, _largest
from reference_data.solvers.core.mooney_rivlin import energy, slope

VOLUME = round(1.05 * USUAL.volume, 6)


def test_energies_of_both_methods_are_the_same_function():
    code, (l1, l2) = Series(0.3, 0.1, 4), (1.3, 0.95)
    first, second = np.array(l1**2), np.array(l2**2)
    by_first, by_second = code._partial(first, second)
    assert 2 * l1 * by_first == pytest.approx(slope(l1, l2, 0.1), rel=1e-13)
    assert 2 * l2 * by_second == pytest.approx(slope(l2, l1, 0.1), rel=1e-13)
    e = 1e-6
    assert slope(l1, l2, 0.1) == pytest.approx(
        (energy(l1 + e, l2, 0.1) - energy(l1 - e, l2, 0.1)) / 2 / e, rel=1e-8
    )


def test_both_methods_find_the_same_state():
    ((a, found),) = USUAL.shot(np.array([VOLUME]), 1e-9)
    ((b, x),) = USUAL.fourier(np.array([VOLUME]), 20)
    assert a.keys() == b.keys()
    for name in a:
        assert a[name] == pytest.approx(b[name], abs=1e-7), name
    assert a["virial"] == pytest.approx(3 * a["p"] * VOLUME, rel=1e-7)
    t = np.linspace(0, np.pi, 5)
    first, second = Shooting(0.4, 0.0, 1e-9).meridian(found, t), Series(0.4, 0.0, 20).meridian(x, t)
    for name in first:
        assert first[name] == pytest.approx(second[name], abs=1e-6), name
    assert a["z_top"] > second["z"].max()


def test_the_residual_is_the_slope_of_the_energy():
    """Of the series, in each coefficient, at a pressure that is held."""
    code, volume = Series(0.4, 0.1, 6), 4.0
    _, x = code.state(volume, code.start(1.1))
    rng = np.random.default_rng(3)
    x = x + 0.01 * rng.standard_normal(len(x))

    def potential(x):
        return code._numbers(x)["U"] - x[-1] * code.volume(x)

    e = 1e-6
    for k in range(len(x) - 1):
        unit = e * np.eye(len(x))[k]
        slope_of = (potential(x + unit) - potential(x - unit)) / 2 / e
        assert 2 * np.pi * code.residual(x, volume)[k] == pytest.approx(slope_of, abs=1e-6), k


def test_the_largest_pressure_is_that_of_the_parabola():
    volumes = np.cos(np.pi * np.arange(12, -1, -1) / 12)
    rows = [{"p": 2 - (v - 0.2) ** 2, "r_out": v, "U": v**2} for v in volumes]
    found = _largest(volumes, rows)
    assert found == pytest.approx({"V": 0.2, "p": 2.0, "r_out": 0.2, "U": 0.04}, abs=1e-12)
