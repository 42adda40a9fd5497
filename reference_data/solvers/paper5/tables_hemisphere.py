"""Tables of paper 5: the hanging hemisphere (figures 9 and 10)."""

from __future__ import annotations

from functools import partial

import numpy as np

from reference_data.solvers.core.tables import Array, Column, Table
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper4.methods import shooting_measures as smsr
from reference_data.solvers.paper4.methods import states as sta
from reference_data.solvers.paper4.methods.collocation import State
from reference_data.solvers.paper4.methods.shooting import local
from reference_data.solvers.paper4.methods.shooting_newton import Solution
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.cases import Filled
from reference_data.solvers.paper5.hemisphere import limit as lim
from reference_data.solvers.paper5.hemisphere.body import BODY, EQUATOR, KAPPA, Hemisphere
from reference_data.solvers.registry import Builder

LEVELS = (-1.1, -0.9, -0.7, -0.6, -0.52)
MODE_LOADS = tuple(round(-1.14 + 0.02 * k, 2) for k in range(34))  # to -0.48
BRANCH_LOADS = tuple(round(-1.16 + 0.02 * k, 2) for k in range(35))
FRONT_LOADS = tuple(x for x in BRANCH_LOADS if x < -0.55)
PAST = tuple(round(-1.5 - 0.05 * k, 2) for k in range(13))
CHANGES: dict[int, tuple[tuple[float, float], ...]] = {
    20: ((-1.178, -1.162), (-1.04, -1.03)),
    24: ((-0.98, -0.96),),
    30: ((-0.92, -0.9),),
    50: ((-0.84, -0.82),),
    70: ((-0.81, -0.78),),
    100: ((-0.78, -0.76),),
}
SAMPLES = 80
FRONT_NOTES = "Taut below the first and above the second front."
DATA: dict[str, object] = {"c2": 0.0, "Ao": 0.1, "H": 1e-4, "kappa": KAPPA}


def make(name: str, title: str, source: str, columns: list[Column], **more: object) -> Table:
    """A table of the hemisphere."""
    given = DATA | more.pop("parameters", {})
    return text.SERIES.table(name, title, source, given, columns, **({"grid": text.HEMISPHERE_GRID} | more))


def paired(name: str, column: str, tracked: list[list[float]], shot: list[list[float]]) -> Column:
    """Column from rows of (coarse, fine) by both methods."""
    a, b = np.array(tracked).T, np.array(shot).T
    return cas.agreed(name, column, Pair(*a, 1e-12), Pair(*b, 1e-12), text.COLUMNS[column])


def wrinkling(name: str, zw: float) -> Table:
    """The wrinkling function along a meridian (figure 9)."""
    found = rel.hemisphere(zw)
    t = np.linspace(0, EQUATOR, SAMPLES + 1)
    fronts = found.tracked[1].pattern.fronts
    keep = np.abs(t[:, None] - fronts).min(axis=1, initial=1.0) > 1e-6
    t = t[keep]
    a = [1 + sta.wrinkling(BODY, t, sta.evaluate(x, t)) for x in found.tracked]
    b = [shot_wrinkling(x, t) for x in found.shots]
    columns = [
        *text.SERIES.keys(t=t),
        cas.agreed(name, "gw", Pair(*a), Pair(*b), text.COLUMNS["gw"]),
    ]
    both = [Pair(x[0].pattern.fronts, x[1].pattern.fronts) for x in [found.tracked]]
    both += [Pair(found.shots[0].shot.fronts, found.shots[1].shot.fronts)]
    extra: dict[str, object] = {"zones": cas.words(found.tracked[1].pattern.signature)}
    checked = cas.agreed(name, "t_front", *both, ("rad", "front"))
    extra |= {"fronts": [float(x) for x in checked.values], "fronts_uncertainty": checked.uncertainty}
    extra["t_level"] = found.tracked[1].pattern.surface
    return make(
        name,
        f"Wrinkling function of the hemisphere at zw = {zw:g}",
        "figure 9; the level is chosen here",
        columns,
        parameters={"zw": zw},
        notes="No row stands on a front.",
        extra=extra,
    )


def shot_wrinkling(found: Solution, t: Array, body: Hemisphere = BODY) -> Array:
    """Wrinkling function of a shot; the pole's from its stretch."""
    out = np.full(len(t), found.starts[0, 0] ** 1.5)
    beyond = t >= found.shot.parts[0].s
    s, y, tense, _ = smsr.inside(found.shot, *smsr.located(found.shot, t[beyond]))
    out[beyond] = 1 + local(body, s, y, tense)[1]
    return out


def modes(name: str, n: int) -> Table:
    """Three lowest eigenvalues against the level (figure 10)."""
    rows = [rel.hemisphere(x).spectrum.lowest(n) for x in MODE_LOADS]
    columns = text.SERIES.keys(zw=MODE_LOADS)
    columns += rel.spectra(name, rows)
    return make(
        name,
        f"Three lowest eigenvalues of wave number {n} of the hemisphere",
        "figure 10",
        columns,
        parameters={"n": n},
        extra=text.SCALES,
    )


def changes(name: str) -> Table:
    """Levels where the lowest eigenvalue changes sign."""
    found = [
        rel.crossing(lambda x: rel.hemisphere(x).spectrum, n, *bracket)
        for n, brackets in CHANGES.items()
        for bracket in brackets
    ]
    columns = rel.turning(name, found, "zw")
    return make(
        name,
        "Levels where the lowest eigenvalue of the hemisphere passes zero",
        "section 3.3 and figure 10",
        columns,
        notes="The lower ends of n >= 24 lie below zw = -1.18, where the sheet hangs almost unstretched.",
        extra={"keys": ["n", "direction"], "slopes": [float(f"{x.slope:.6g}") for x in found]},
    )


def of_state(state: State) -> dict[str, float]:
    """Scalars of a tracked state."""
    _, z, stretch, _ = state.y[0, 0]
    level = {"t_level": state.pattern.surface} if "surface" in state.pattern.kinds else {}
    control = state.membrane.control
    return {control: state.load, "z_pole": z, "lam_pole": stretch, "V": state.volume} | level


def of_shot(found: Solution) -> dict[str, float]:
    """Scalars of a shot."""
    stretch, z = found.starts[0, :2]
    level = {"t_level": found.shot.surface} if found.membrane.crossed(found.load) else {}
    control = found.membrane.control
    return {control: found.load, "z_pole": z, "lam_pole": stretch, "V": found.volume} | level


def scalars(name: str, keys: tuple[str, ...], a: list[list[State]], b: list[list[Solution]]) -> list[Column]:
    """Columns of scalars by both methods."""
    one, other = [[of_state(x) for x in f] for f in a], [[of_shot(x) for x in f] for f in b]
    return [
        paired(name, k, [[y[k] for y in x] for x in one], [[y[k] for y in x] for x in other]) for k in keys
    ]


def branch_columns(name: str, found: list[Filled]) -> list[Column]:
    """Columns of states with prescribed level, by both methods."""
    keys = ("z_pole", "lam_pole", "V", "t_level")
    values = scalars(name, keys, [f.tracked for f in found], [f.shots for f in found])
    return [*text.SERIES.keys(zw=[f.load for f in found]), *values]


def branch(name: str) -> Table:
    """The branch up to the limit point, with prescribed level."""
    columns = branch_columns(name, [rel.hemisphere(x) for x in BRANCH_LOADS])
    return make(name, "The hemisphere up to its limit point", "section 3.3", columns)


def front_columns(name: str, found: list[Filled]) -> list[Column]:
    """Columns of the fronts of one wrinkled zone at prescribed levels, by both methods."""
    columns = text.SERIES.keys(zw=[f.load for f in found])
    for k in (0, 1):
        about = ("rad", f"{('lower', 'upper')[k]} end of the wrinkled zone: material angle")
        pairs = (
            Pair(*np.array([[x.pattern.fronts[k] for x in f.tracked] for f in found]).T, 1e-12),
            Pair(*np.array([[x.shot.fronts[k] for x in f.shots] for f in found]).T, 1e-12),
        )
        columns.append(cas.agreed(name, f"t_front_{k + 1}", *pairs, about))
    return columns


def fronts(name: str) -> Table:
    """Fronts of the wrinkled zone."""
    columns = front_columns(name, [rel.hemisphere(x) for x in FRONT_LOADS])
    title = "Wrinkled zone of the hemisphere"
    return make(name, title, "section 3.3 and figure 9", columns, notes=FRONT_NOTES)


def past(name: str) -> Table:
    """The branch around and past the limit point, with prescribed height of the pole."""
    a, b = [list(lim.held(z)) for z in PAST], [lim.shots(z) for z in PAST]
    columns = [*text.SERIES.keys(z_pole=PAST), *scalars(name, ("zw", "lam_pole", "V"), a, b)]
    return make(name, "The hemisphere past its limit point", "section 3.3; beyond the paper", columns)


def turned(name: str, found: lim.Limit, load: str) -> list[Column]:
    """Load, height of the pole and volume at a limit point."""
    columns = []
    for i, key in ((1, load), (0, "z_pole"), (2, "V")):
        pairs = (
            Pair(*(np.array([x[i]]) for x in found.collocation), 1e-11),
            Pair(*(np.array([x[i]]) for x in found.shooting), 1e-11),
        )
        columns.append(cas.agreed(name, key, *pairs, text.COLUMNS[key]))
    return columns


def limit(name: str) -> Table:
    """The limit point."""
    return make(
        name,
        "Limit point of the hemisphere: the largest level",
        "section 3.3; not in the paper",
        turned(name, lim.limit(), "zw"),
        notes="By shooting: maximum of the quartic through five levels at heights 0.02 and 0.01 apart.",
    )


TABLES: dict[str, Builder] = {}
for _x in LEVELS:
    TABLES[f"gw_hemisphere_zw_{_x:g}"] = partial(wrinkling, f"gw_hemisphere_zw_{_x:g}", _x)
TABLES["hemisphere_branch"] = partial(branch, "hemisphere_branch")
TABLES["hemisphere_fronts"] = partial(fronts, "hemisphere_fronts")
TABLES["hemisphere_past_limit"] = partial(past, "hemisphere_past_limit")
TABLES["hemisphere_limit"] = partial(limit, "hemisphere_limit")
TABLES["stability_changes_hemisphere"] = partial(changes, "stability_changes_hemisphere")
for _n in (10, 50):
    TABLES[f"modes_hemisphere_n_{_n}"] = partial(modes, f"modes_hemisphere_n_{_n}", _n)
