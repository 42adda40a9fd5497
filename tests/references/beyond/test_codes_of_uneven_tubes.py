"""The two codes for tubes of uneven thickness."""

import numpy as np
import pytest

from reference_data.solvers.beyond.lopsided import energy, strong, tables_uneven


def test_both_methods_find_the_same_state():
    state = tables_uneven.detached(-1e-3, 0.1)
    other = energy.at(state.tube, energy.BASES[0], state, "w", 0.1)
    assert other.p == pytest.approx(state.p, abs=1e-10)
    assert other.volume == pytest.approx(state.volume, abs=1e-9)
    assert energy.rates_of(other) == pytest.approx(strong.rates_of(state), abs=1e-8)


def test_the_rates_are_differences():
    state = tables_uneven.detached(-1e-3, 0.1)
    less, more = (strong.follow(state, np.array([w]), "w")[0] for w in (0.0999, 0.1001))
    by_p, by_volume = strong.rates_of(state)
    assert (more.p - less.p) / 2e-4 == pytest.approx(by_p, rel=1e-4)
    assert (more.volume - less.volume) / 2e-4 == pytest.approx(by_volume, rel=1e-4)
