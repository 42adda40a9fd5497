"""Shared by the contact tables: the cases, their states by both methods (computed once), columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.core.tables import Array, Column, Table, agreed
from reference_data.solvers.paper2 import contact_text as text
from reference_data.solvers.paper2.collocation import history as hist
from reference_data.solvers.paper2.collocation import states as st
from reference_data.solvers.paper2.collocation.critical import resolved
from reference_data.solvers.paper2.collocation.equations import State, columns, profile
from reference_data.solvers.paper2.common import given
from reference_data.solvers.paper2.differences import branch as fdb
from reference_data.solvers.paper2.differences import contact as cfd
from reference_data.solvers.paper2.differences import deflation as defl
from reference_data.solvers.paper2.differences import history as fdh
from reference_data.solvers.paper2.substrate import Substrate

P_END = 3.0


@dataclass(frozen=True)
class Case:
    """A tube, its substrate, and the pressure at which inflation ends and deflation starts."""

    tube: Tube
    substrate: Substrate
    p_end: float = P_END

    @property
    def label(self) -> str:
        """Part of a table's name."""
        return f"alpha_{self.tube.alpha:g}_delta1_{self.tube.delta1:g}"

    @property
    def parameters(self) -> dict[str, object]:
        """Parameters as stored with the tables."""
        return given(self.tube) | {"k": float(self.substrate.k), "s": float(self.substrate.s)}

    @property
    def title(self) -> str:
        """Description of the case for headings."""
        names = {"alpha": self.tube.alpha, "delta1": self.tube.delta1, "lf": self.tube.lf}
        names |= {"k": self.substrate.k, "s": self.substrate.s}
        return ", ".join(f"{name} = {value:g}" for name, value in names.items())


SOFT = Substrate(20.0, 1.3)
PAPER = tuple(Case(Tube(a, d, 6.0), SOFT) for a, d in ((0.0, 1.0), (0.0, 2.0), (0.1, 1.0), (0.1, 2.0)))
OFF = (Case(Tube(0.05, 1.3, 8.0), Substrate(50.0, 1.2)), Case(Tube(0.05, 1.5, 6.0), SOFT))
DISTANT = Case(Tube(0.1, 1.5, 6.0), Substrate(100.0, 1.6))
"""Substrates far from the tube, so that at ``P_END`` the patch is still short. Just after contact finite
differences do not resolve the traction at its edge well enough for a table of adhesive inflation."""


@lru_cache(maxsize=4)
def histories(case: Case) -> tuple[hist.Inflation, ...]:
    """Adhesive inflation by collocation at both resolutions."""
    return tuple(hist.Inflation(case.tube, case.substrate, how, case.p_end) for how in st.RESOLUTIONS)


@lru_cache(maxsize=64)
def touching(case: Case) -> tuple[State, ...]:
    """Free state at first touch at both resolutions."""
    return tuple(st.touch(case.tube, case.substrate, how.free) for how in st.RESOLUTIONS)


def pressures(case: Case) -> Array:
    """Round pressures from just above first touch to P_END."""
    onset = touching(case)[-1].p
    near = np.round(np.arange(0, P_END, 0.01), 10)
    near = near[(near > onset + 0.01) & (near < np.ceil((onset + 0.05) * 20) / 20 - 1e-9)]
    rest = np.round(np.arange(0, P_END + 0.01, 0.05), 10)
    return np.concatenate([near, rest[rest > near[-1] + 1e-9]])


def frictionless(case: Case, p: Array) -> list[list[State]]:
    """Collocation states at both resolutions."""
    return [st.frictionless(first, how, p) for first, how in zip(touching(case), st.RESOLUTIONS, strict=True)]


@lru_cache(maxsize=64)
def adhesive(case: Case, p: float) -> tuple[State, ...]:
    """Adhesive inflation at p by collocation, at both resolutions."""
    return tuple(h.at(p) for h in histories(case))


def deflated(case: Case, spring: str, p: Array) -> list[list[State]]:
    """Adhesive deflation at falling pressures by collocation, at both resolutions."""
    starts = adhesive(case, case.p_end)
    if spring == "bilateral":
        return [hist.bilateral(start, p) for start in starts]
    return [hist.unilateral(s, how, p) for s, how in zip(starts, st.RESOLUTIONS, strict=True)]


def deflated_fd(
    case: Case, spring: str, p: Array, step: float = 0.05, grids: Sequence[int] = defl.GRIDS
) -> list[list[defl.Stuck]]:
    """The same by finite differences, on every grid."""
    given, p_end = (case.tube, case.substrate), case.p_end
    starts = [defl.fitted(*given, n, p_end, known=p_end) for n in grids]
    return [defl.deflation(start, p, spring, step) for start in starts]


def interpolated(case: Case, p: Array) -> list[list[dict[str, float]]]:
    """Columns of adhesive inflation by finite differences: per grid, per pressure."""
    out = []
    for n in defl.GRIDS:
        run = defl.followed(case.tube, case.substrate, n, case.p_end)
        known: dict[int, dict[str, float]] = {}
        rows = []
        for target in p:
            x, low = run.position(float(target))
            weights = fdb.lagrange_at(np.arange(low, low + 6, dtype=float), x)
            for i in range(low, low + 6):
                if i not in known:
                    known[i] = fdh.summary(run.glued, run.states[i], i)
            around = [known[i] for i in range(low, low + 6)]
            rows.append(
                {c: float(sum(w * a[c] for w, a in zip(weights, around, strict=True))) for c in around[0]}
            )
        out.append(rows)
    return out


def tractions(state: State) -> dict[str, float]:
    """Largest tractions and smallest t2 of a stuck state."""
    patches = st.patches(state)
    meshes = [z.mesh for z in state.zones if z.stuck]
    f_k = [
        cfd.peak(row)
        for m, patch in zip(meshes, patches, strict=True)
        for row in np.abs(st.dense(m, patch.f_k))
    ]
    z = np.append(np.linspace(0, state.tube.length, 1001), state.fronts)
    t2 = [columns(state.tube, profile(state, z, side))["t2"].min() for side in (1, -1)]
    return {
        "traction_max": max(float(np.abs(patch.f_t).max()) for patch in patches),
        "traction_front": abs(float(patches[-1].f_t[-1, -1])),
        "spring_max": max(f_k),
        "t2_min": float(min(t2)),
    }


def both(
    name: str,
    wanted: tuple[str, ...],
    a: list[list[dict[str, float]]],
    b: list[list[dict[str, float]]],
    powers: tuple[int, ...],
    irregular: bool = False,
    amplified: float = 1.0,
) -> list[Column]:
    """Columns from rows per grid (a) and rows per resolution (b)."""
    out = []
    for c in wanted:
        grids, meshes = ([np.array([row[c] for row in rows]) for rows in side] for side in (a, b))
        # if the largest f_k is inside the patch, its position relative to the nodes matters
        first = cfd.extrapolated(grids, powers, irregular or c == "spring_max", amplified)
        out.append(agreed(name, c, first, resolved(*meshes), text.COLUMNS[c]))
    return out


def table(contact: str, *given: object, **more: object) -> Table:
    """A table of contact with its documentation."""
    name, title, source, parameters, columns = given
    return text.SERIES[contact].table(name, title, source, parameters | {"contact": contact}, columns, **more)
