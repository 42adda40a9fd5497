"""Tables of other hemispheres than that of paper 5: under gas, and of uneven thickness."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Column, Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.hemisphere import limit as lim
from reference_data.solvers.paper5.hemisphere import states as hem
from reference_data.solvers.paper5.hemisphere.body import EQUATOR
from reference_data.solvers.paper5.hemisphere.gas import GAS
from reference_data.solvers.paper5.hemisphere.uneven import EXPRESSION, UNEVEN
from reference_data.solvers.paper5.tables_hemisphere import scalars, shot_wrinkling, turned
from reference_data.solvers.registry import Builder

PRESSURES = (0.02, 0.05, *(round(0.1 * k, 1) for k in range(1, 32)))
SHOWN = (0.05, 1.0, 3.0)
MODE_PRESSURES = (0.1, *(round(0.25 * k, 2) for k in range(1, 13)))
PAST = tuple(round(-1.5 - 0.05 * k, 2) for k in range(9))
NEAR_LIMIT = (-1.75, -1.69, -1.63)
SAMPLES = 80
UNEVEN_LEVELS = tuple(round(-1.0 + 0.05 * k, 2) for k in range(11))
DATA: dict[str, object] = {"c2": 0.0, "load": "gas"}
SOURCE = "section 3.3, with gas or another thickness; not in the paper"


def make(name: str, title: str, columns: list[Column], **more: object) -> Table:
    """A table of the hemisphere under gas."""
    given = DATA | more.pop("parameters", {})
    return text.SERIES.table(name, title, SOURCE, given, columns, **({"grid": text.HEMISPHERE_GRID} | more))


def branch(name: str) -> Table:
    """The branch up to near the limit point, with prescribed pressure."""
    found = [rel.gas_hemisphere(x) for x in PRESSURES]
    keys = ("z_pole", "lam_pole", "V")
    values = scalars(name, keys, [f.tracked for f in found], [f.shots for f in found])
    columns = [*text.SERIES.keys(p=PRESSURES), *values]
    return make(name, "The hemisphere under gas up to its limit point", columns)


def past(name: str) -> Table:
    """The branch around and past the limit point, with prescribed height of the pole."""
    a = [list(lim.held(z, hem.GAS_POLES)) for z in PAST]
    b = [lim.shots(z, hem.GAS_POLES) for z in PAST]
    columns = [*text.SERIES.keys(z_pole=PAST), *scalars(name, ("p", "lam_pole", "V"), a, b)]
    return make(name, "The hemisphere under gas past its limit point", columns)


def limit(name: str) -> Table:
    """The limit point."""
    return make(
        name,
        "Limit point of the hemisphere under gas: the largest pressure",
        turned(name, lim.limit(hem.GAS_POLES, NEAR_LIMIT), "p"),
        notes="By shooting: maximum of the quartic through five pressures at heights 0.02 and 0.01 apart.",
    )


def wrinkling(name: str, p: float) -> Table:
    """The wrinkling function along a meridian, above 1 everywhere."""
    found = rel.gas_hemisphere(p)
    t = np.linspace(0, EQUATOR, SAMPLES + 1)
    a = [1 + sta.wrinkling(GAS, t, sta.evaluate(x, t)) for x in found.tracked]
    b = [shot_wrinkling(x, t, GAS) for x in found.shots]
    columns = [*text.SERIES.keys(t=t), cas.agreed(name, "gw", Pair(*a), Pair(*b), text.COLUMNS["gw"])]
    zones = cas.words(found.tracked[1].pattern.signature)
    title = f"Wrinkling function of the hemisphere under gas at p = {p:g}"
    return make(name, title, columns, parameters={"p": p}, extra={"zones": zones})


def modes(name: str, n: int) -> Table:
    """Three lowest eigenvalues over the pressure."""
    rows = [rel.gas_hemisphere(x).spectrum.lowest(n) for x in MODE_PRESSURES]
    columns = [*text.SERIES.keys(p=MODE_PRESSURES), *rel.spectra(name, rows)]
    title = f"Three lowest eigenvalues of wave number {n} of the hemisphere under gas"
    return make(name, title, columns, parameters={"n": n}, extra=text.SCALES)


def uneven(name: str) -> Table:
    """The branch under liquid of a hemisphere that is thin at the equator."""
    found = [rel.hemisphere(x, UNEVEN) for x in UNEVEN_LEVELS]
    keys = ("z_pole", "lam_pole", "V", "t_level")
    values = scalars(name, keys, [f.tracked for f in found], [f.shots for f in found])
    columns = [*text.SERIES.keys(zw=UNEVEN_LEVELS), *values]
    given = {"load": "fluid", "thickness": EXPRESSION}
    return make(name, "The hemisphere of uneven thickness", columns, parameters=given)


TABLES: dict[str, Builder] = {
    "hemisphere_uneven": partial(uneven, "hemisphere_uneven"),
    "hemisphere_gas_branch": partial(branch, "hemisphere_gas_branch"),
    "hemisphere_gas_past_limit": partial(past, "hemisphere_gas_past_limit"),
    "hemisphere_gas_limit": partial(limit, "hemisphere_gas_limit"),
}
for _p in SHOWN:
    TABLES[f"gw_hemisphere_p_{_p:g}"] = partial(wrinkling, f"gw_hemisphere_p_{_p:g}", _p)
for _n in (10, 50):
    TABLES[f"modes_hemisphere_gas_n_{_n}"] = partial(modes, f"modes_hemisphere_gas_n_{_n}", _n)
