"""The two reference methods of a filled disk."""

import numpy as np
import pytest

from reference_data.solvers.beyond.filled_disk.collocation import Collocation
from reference_data.solvers.beyond.filled_disk.shooting import Shooting
from reference_data.solvers.beyond.filled_disk.tables import UNEVEN_LIQUID, Filled
from reference_data.solvers.core.mooney_rivlin import slope

DELTA = 1.1


@pytest.mark.parametrize("of", [UNEVEN_LIQUID, Filled(0.0, uneven=-0.3)], ids=["liquid", "gas"])
def test_both_methods_find_the_same_state(of):
    (_, shot), (_, series) = of.rows(np.array([0.1]))
    assert shot[0].keys() == series[0].keys()
    for name in shot[0]:
        assert shot[0][name] == pytest.approx(series[0][name], rel=1e-9), name


def test_the_rim_bears_the_liquid():
    """Of the series: the axial force at the rim, 2 pi H w_1 sin(phi), is gamma V_f."""
    code = Collocation(0.1, DELTA, 2.0, 0.4, 20)
    row, y = code.state(0.3, code.start(0.3, 0.3))
    k = np.arange(code.degree + 1)
    a_x, b_x = (2 * (k**2 @ part) for part in np.split(y[:-1], 2))  # at the rim
    l1 = np.hypot(DELTA + 2 * a_x, 2 * b_x)
    force = 2 * np.pi * 1.4 * slope(l1, DELTA, 0.1) * 2 * b_x / l1
    assert force == pytest.approx(2.0 * row["amount"], rel=1e-10)


def test_gas_does_the_work():
    """DU = p dV over the heights."""
    nodes = 0.3 + 0.1 * np.cos(np.pi * np.arange(8, -1, -1) / 8)
    _, (_, rows) = Filled(0.1, uneven=0.4).rows(nodes)
    p, volume, stored = (np.array([row[n] for row in rows]) for n in ("load", "amount", "U"))
    force, amount = (np.polynomial.Chebyshev.fit(nodes, values, 8) for values in (p, volume))
    work = (force * amount.deriv()).integ()
    assert work(nodes[-1]) - work(nodes[0]) == pytest.approx(stored[-1] - stored[0], rel=1e-8)


def test_a_disk_that_is_partly_dry_is_refused():
    code = Collocation(0.1, DELTA, 8.0, 0.0, 16)
    with pytest.raises(RuntimeError, match="is below the rim: a part is dry"):
        code.state(0.05, code.start(0.05, -0.01))


def test_a_shot_that_is_not_integrated_is_an_error():
    with pytest.raises(RuntimeError, match=r"disk at"):
        Shooting(0.1, DELTA, 0.0, 0.0, 1e-6).state(0.5, np.array([1.2, 1e3]))
