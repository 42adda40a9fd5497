"""Table of paper 5: wave numbers of the linearised theory (section 2.2) and the true ones."""

from __future__ import annotations

import numpy as np

from reference_data.solvers.core.tables import Table, prescribed
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.waves import linearised as lin
from reference_data.solvers.paper5.waves.cylinder import FLUID
from reference_data.solvers.paper5.waves.second_variation import Quadratic
from reference_data.solvers.registry import Builder

LEVELS = (1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0, 5.73)


def lowest_unstable(form: Quadratic) -> int:
    """Smallest integer n with a negative eigenvalue; the lowest eigenvalue decreases with n here."""
    low, high = 0, 1
    while form.first(high) >= 0:
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if form.first(middle) < 0 else (middle, high)
    return high


def linearised(name: str) -> Table:
    """A, B, n* for two trial fields per level, and the true lowest unstable n."""
    keys, a, b, true = [], [], [], []
    for zw in LEVELS:
        spectrum = rel.cylinder(FLUID, zw)
        pattern = cas.solved(FLUID, zw).tracked[1].pattern
        level = pattern.surface
        n_true = lowest_unstable(spectrum.forms[1])
        for power in (1, 2):
            a.append([lin.by_matrices(f, level, power) for f in spectrum.forms])
            b.append([lin.by_principal_axes(f, level, power) for f in spectrum.forms])
            keys.append((zw, power))
            true.append(n_true)
    zw, power = np.array(keys, dtype=float).T
    about = {
        "A": ("1/(C1 h Ao^2)", "part of Pi2/pi free of n: elastic and pressure terms"),
        "B": ("1/(C1 h Ao^2)", "coefficient of n in Pi2/pi, -int p r f^2 (r'^2 + z'^2) ds"),
        "n_star": ("1", "A/(-B)"),
    }
    columns = [
        *text.SERIES.keys(zw=zw),
        prescribed("f", power, ("1", "1: f = sin(pi S/S_level) on the wet part; 2: its square")),
    ]
    for key, what in about.items():
        pairs = [
            Pair(
                *np.array([[getattr(y, key) for y in x] for x in side]).T, 1e-9 if key == "n_star" else 1e-10
            )
            for side in (a, b)
        ]
        columns.append(cas.agreed(name, key, *pairs, what))
    what = ("1", "smallest integer n whose lowest eigenvalue is negative")
    columns.append(prescribed("n_true", np.array(true, dtype=float), what))
    return text.SERIES.table(
        name,
        "Linearised theory: wave number above which a trial field lowers the energy",
        "section 2.2",
        text.cylinder("fluid"),
        columns,
        method=(
            "Collocation states; (a) matrices of the metric form between nodal values of the field, (b) sums "
            "over Gauss points of the form in principal axes (named shooting in the uncertainties); two "
            "resolutions. n_true by the eigenvalues of (a)."
        ),
        notes="Field u = f z', q = r f, w = -f r'. The trial space is part of the whole: n_star > n_true - 1",
        extra={"keys": ["zw", "f"]},
    )


TABLES: dict[str, Builder] = {"linearised": lambda: linearised("linearised")}
