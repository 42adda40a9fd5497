"""Tables of the fluid-loaded tube with laws other than neo-Hookean, by the codes of paper 3.

Both codes use the law's derivatives with respect to the metric (``law_metric``); they share nothing else.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial

from reference_data.solvers.core.laws import CONSTANTS, law
from reference_data.solvers.core.tables import Table, steps
from reference_data.solvers.paper3 import modes, text
from reference_data.solvers.paper3 import tables_primary as paper3
from reference_data.solvers.paper3.common import Rows, columns_of, critical
from reference_data.solvers.paper3.data import GAMMA, FluidTube
from reference_data.solvers.registry import Builder

RANGES = {
    "ogden": (1.0, 65.0),
    "gent": (5.0, 330.0),
    "arruda_boyce": (5.0, 330.0),
    "mooney_rivlin": (8.0, 560.0),
}
"""Step and end of the volumes, a little beyond the first bifurcation with one wave."""
STRIDE = 5
"""Number of steps of the branch for one step of the table of eigenvalues."""
SOURCE = "the problem of figure 2 with another law"


@cache
def tube(model: str) -> FluidTube:
    """The paper's tube, L = 8 and delta = 2, of a law with the tables' constants."""
    return FluidTube(8.0, 2.0, GAMMA, law(model))


def facts(model: str) -> dict[str, object]:
    """Parameters as stored with the table."""
    return {"model": model, **CONSTANTS[model], "L": 8.0, "delta": 2.0, "gamma": GAMMA}


def along(name: str, model: str, build: Callable[..., Table], stride: int) -> Table:
    """The primary branch, or its eigenvalues, over the volume."""
    step, stop = RANGES[model]
    found = build(name, tube(model), steps(step * stride, stop, step * stride), SOURCE)
    found.paper, found.parameters = "materials", facts(model)
    found.title += f", {model}; mu = 2 S"
    return found


def points(name: str, model: str) -> Table:
    """Limit point and first bifurcation with one wave."""
    found = critical(tube(model), RANGES[model][1], (0, 1))
    if set(found) != {0, 1}:
        raise RuntimeError(f"table {name}: zeros of n = {sorted(found)} only")
    a: tuple[Rows, Rows] = ([], [])
    b: tuple[Rows, Rows] = ([], [])
    for n in (0, 1):
        for level, (state, shape) in enumerate(found[n]):
            a[level].append(modes.quantities(state))
            b[level].append(modes.galerkin_quantities(shape))
    columns = text.SERIES.keys(n=[0, 1], order=[1, 1])
    columns += columns_of(name, ("zw", "V", "r_mid", "r_max", "T1_ring", "Pi"), a, b)
    title = f"Critical points of a fluid-loaded tube of {model}; mu = 2 S"
    more = {"paper": "materials", "notes": text.CRITICAL_NOTES}
    return text.SERIES.table(name, title, SOURCE, facts(model), columns, **more)


TABLES: dict[str, Builder] = {}
for _m in RANGES:
    for _kind, _build, _stride in (("", paper3.curve, 1), ("spectrum_", paper3.spectrum, STRIDE)):
        TABLES[f"fluid_tube_{_kind}{_m}"] = partial(along, f"fluid_tube_{_kind}{_m}", _m, _build, _stride)
    TABLES[f"fluid_tube_critical_{_m}"] = partial(points, f"fluid_tube_critical_{_m}", _m)
