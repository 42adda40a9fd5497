r"""States of the half tube in contact by front-fitted collocation: frictionless states, and columns.

Frictionless inflation: zones [0, z_1] with the spring and [z_1, L] without, rho(z_1) = s, all
four unknowns continuous. The scalar that is prescribed is p or the front z_1 itself.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core import collocation as free
from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.core.collocation import Array, Mesh
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.collocation import contact as con
from reference_data.solvers.paper2.collocation import critical
from reference_data.solvers.paper2.collocation.contact import Linearised, State, TwoSided, Zone
from reference_data.solvers.paper2.substrate import Substrate, forces, turning


@dataclass(frozen=True)
class Resolution:
    """Meshes of the patch and of the free part, and the terms of the frozen eta'."""

    free: Mesh
    inner: Mesh
    outer: Mesh
    terms: int


RESOLUTIONS = (
    Resolution(critical.MESHES[0], Mesh(6, 12), TwoSided(8, 12, 0.6), 26),
    Resolution(critical.MESHES[1], Mesh(8, 16), TwoSided(10, 16, 0.6), 34),
)


def touch(tube: Tube, substrate: Substrate, mesh: Mesh) -> tuple[free.State, float]:
    """Free state at first touch, rho(0) = s, and its volume."""
    state = critical.start(tube, mesh, "u_max", substrate.s - 1)
    state, system = free.newton(state, "u_max", substrate.s - 1)
    return state, system.volume


def moved(state: State, mesh: Mesh, left: float, right: float) -> Array:
    """Values (rho, eta, l1, b) of a state at the nodes of a mesh on [left, right]."""
    z = con.places(mesh, left, right)[0]
    return profile(state, np.ravel(z))[:, :4].reshape(*z.shape, 4)


def frictionless_near_touch(first: free.State, substrate: Substrate, how: Resolution, z: float) -> State:
    """Guess: the free state at first touch, cut at z."""
    whole = State(first.tube, substrate, (Zone(first.mesh),), (first.y,), np.array([first.p]))
    length = first.tube.length
    y = (moved(whole, how.inner, 0.0, z), moved(whole, how.outer, z, length))
    zones = (Zone(how.inner, spring=True), Zone(how.outer))
    return State(first.tube, substrate, zones, y, np.array([first.p, z]))


def shifted(state: State, fronts: Array) -> State:
    """Guess with other fronts: the same values at the same fractions of each zone."""
    return replace(state, scalars=np.append(state.p, fronts))


def at_front(guess: State, z: float) -> tuple[State, Linearised]:
    """Frictionless state with the front at z."""
    return con.newton(shifted(guess, np.array([z])), [("scalar", 1, z), ("rho", 0, guess.substrate.s)])


def at_pressure(guess: State, p: float) -> tuple[State, Linearised]:
    """Frictionless state at a pressure."""
    return con.newton(guess, [("scalar", 0, p), ("rho", 0, guess.substrate.s)])


def frictionless(first: free.State, substrate: Substrate, how: Resolution, p: Array) -> list[Linearised]:
    """States at rising pressures, reached from first touch over the front position."""
    out: list[Linearised] = []
    z, step = 0.0, 0.04 * first.tube.length
    state = frictionless_near_touch(first, substrate, how, step)
    state, _ = at_front(state, step)
    z = step
    for target in p:
        while state.p < target:
            z = z + min(step, 0.2 * (first.tube.length - z))
            behind, (state, _) = state, at_front(state, z)
            if state.p <= behind.p:
                raise RuntimeError(f"frictionless: p falls at front {z:g}")
        out.append(at_pressure(state, float(target))[1])
    return out


def profile(state: State, z: Array, side: int = 1) -> Array:
    """Columns (rho, eta, l1, b, zone) at positions z; at a front the zone after (side 1) or before."""
    edges = np.array([0.0, *state.fronts, state.tube.length])
    where = np.clip(np.searchsorted(edges, z, side="right" if side > 0 else "left") - 1, 0, len(state.y) - 1)
    out = np.empty((len(z), 5))
    for d, zone in enumerate(state.zones):
        here = where == d
        if not here.any():
            continue
        x = (z[here] - edges[d]) / (edges[d + 1] - edges[d])
        values = free.evaluate(zone.mesh, state.y[d], x)
        if zone.stuck:
            e, eta = state.history.slope(z[here]), state.history.position(z[here])
            rho, a = values.T
            values = np.stack([rho, eta, np.hypot(a, e), np.arctan2(a, e)], axis=-1)
        out[here, :4], out[here, 4] = values, d
    return out


def columns(tube: Tube, values: Array) -> dict[str, Array]:
    """Profile columns of a table from (rho, eta, l1, b)."""
    rho, eta, l1 = values[:, 0], values[:, 1], values[:, 2]
    l2 = rho / tube.r0
    t1, t2 = mat.resultants(l1, l2, tube.alpha)
    return {"rho": rho, "eta": eta, "lam1": l1, "lam2": l2, "t1": t1, "t2": t2}


def summary(system: Linearised) -> dict[str, float]:
    """Columns of a curve at one state."""
    state = system.state
    front = float(state.fronts[-1])
    middle, edge = profile(state, np.array([0.0, front]))
    at = columns(state.tube, middle[None, :])
    return {
        "p": state.p,
        "u_max": float(middle[0]) - 1,
        "contact_length": 2 * float(edge[1]),
        "lam1_mid": float(at["lam1"][0]),
        "t1_mid": float(at["t1"][0]),
        "lam2_mid": float(at["lam2"][0]),
        "Z_front": state.tube.delta1 * front,
        "V": system.volume,
    }


@dataclass
class Patch:
    """Tractions of the stuck zone at the nodes of its elements (elements, degree + 1)."""

    z: Array
    f_t: Array
    f_k: Array


def patches(state: State) -> list[Patch]:
    """Tractions in each stuck zone: rho l1 f_t = -[(r0 w_1 eta'/l1)' - P_eff rho rho'], and f_k."""
    out = []
    for (left, right), zone, y in zip(con.bounds(state, state.scalars), state.zones, state.y, strict=True):
        if not zone.stuck:
            continue
        z = con.places(zone.mesh, left, right)[0]
        rho, a = y[..., 0], y[..., 1]
        e = state.history.slope(z)
        l1 = np.hypot(a, e)
        axial = forces(state.tube, rho, l1, a, e)[1]
        width = (zone.mesh.widths * (right - left))[:, None]
        slope = axial @ free.differentiation(zone.mesh.nodes).T / width
        push = state.substrate.push(rho, state.p) if zone.spring else state.p
        f_k = state.substrate.radial(rho, l1, e) * zone.spring
        out.append(Patch(z, -(slope - push * rho * a) / (rho * l1), f_k))
    return out


def tractions_at(state: State, z: Array) -> tuple[Array, Array]:
    """f_t and f_k at positions z inside the stuck zones."""
    f_t, f_k = np.zeros(len(z)), np.zeros(len(z))
    for d, patch in enumerate(patches(state)):
        left, right = con.bounds(state, state.scalars)[d]
        here = (z >= left) & (z <= right)
        both = np.stack([patch.f_t, patch.f_k], axis=-1)
        x = (z[here] - left) / (right - left)
        f_t[here], f_k[here] = free.evaluate(state.zones[d].mesh, both, x).T
    return f_t, f_k


def dense(mesh: Mesh, values: Array, points: int = 201) -> Array:
    """Nodal values sampled densely, ends of the elements included."""
    return values @ free.lagrange(mesh.nodes, np.linspace(0, 1, points)).T


def at_edge(state: State) -> dict[str, float]:
    """Line force (whole and of the membrane alone) and curvature of the free part at the front."""
    z = np.array([float(state.fronts[-1])])
    rho, _, l1, b, _ = profile(state, z, side=1)[0]
    _, _, m1, c, d = profile(state, z, side=-1)[0]
    outer = forces(state.tube, rho, l1, 0.0, l1 * np.cos(b))[1]
    inner = forces(state.tube, rho, m1, 0.0, m1 * np.cos(c))[1]
    spring = state.substrate.potential(rho, state.p, state.zones[int(d)].spring)
    bare = state.substrate.potential(rho, state.p, False)
    return {
        "line_force": abs((inner - spring) - (outer - bare)) / rho,
        "line_force_membrane": abs(inner - outer) / rho,
        "kappa": float(turning(state.tube, rho, l1, np.cos(b), state.p)),
    }
