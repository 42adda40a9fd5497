r"""States of the half tube in contact by front-fitted collocation: frictionless states, and columns.

Frictionless inflation: zones [0, z_1] with the spring and [z_1, L] without, rho(z_1) = s, everything
continuous. Pressure or front is given.
Source: Patil, Nordmark & Eriksson, Proc. R. Soc. A 470 (2014) 20140282.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from reference_data.solvers.core.collocation import Array, Mesh, Resolution, lagrange
from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper2.collocation import critical
from reference_data.solvers.paper2.collocation.equations import (
    State,
    Zone,
    columns,
    places,
    profile,
    recut,
    solve,
)
from reference_data.solvers.paper2.substrate import Substrate, forces, turning


def two_sided(elements: int, degree: int, strength: float = 0.6) -> Mesh:
    """Elements graded to both ends; the strength is below 1."""
    s = np.linspace(0, 1, elements + 1)
    return Mesh(tuple(map(float, s - strength * np.sin(2 * np.pi * s) / (2 * np.pi))), degree)


RESOLUTIONS = (
    Resolution(critical.MESHES[0], Mesh.graded(6, 12, 1.6), two_sided(8, 12), 26),
    Resolution(critical.MESHES[1], Mesh.graded(8, 16, 1.6), two_sided(10, 16), 34),
)


def touch(tube: Tube, substrate: Substrate, mesh: Mesh) -> State:
    """Free state at first touch, rho(0) = s."""
    return replace(critical.start(tube, mesh, "u_max", substrate.s - 1), substrate=substrate)


def frictionless_near_touch(first: State, how: Resolution, z: float) -> State:
    """Guess: the free state at first touch, cut at z."""
    return recut(first, (Zone(how.inner, spring=True), Zone(how.outer)), (z,))


def at_front(guess: State, z: float) -> State:
    """Frictionless state with the front at z."""
    return solve(replace(guess, c=np.array([guess.p, z])), front=z, rho=guess.substrate.s)


def frictionless(first: State, how: Resolution, p: Array) -> list[State]:
    """States at rising pressures, reached from first touch over the front position.

    Raises:
        RuntimeError: If the pressure falls on the way, or Newton's method fails.
    """
    length = first.tube.length
    z = step = 0.04 * length
    state, out = at_front(frictionless_near_touch(first, how, step), step), []
    for target in p:
        while state.p < target:
            z = z + min(step, 0.2 * (length - z))
            behind, state = state, at_front(state, z)
            if state.p <= behind.p:
                raise RuntimeError(f"frictionless: p falls at front {z:g}")
        out.append(solve(state, p=float(target), rho=first.substrate.s))
    return out


def summary(state: State) -> dict[str, float]:
    """Columns of a curve at one state."""
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
        "V": state.volume,
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
    for (left, right), zone, y in zip(state.bounds, state.zones, state.y, strict=True):
        if not zone.stuck:
            continue
        z = places(zone.mesh, left, right)
        rho, a, _ = np.moveaxis(y, -1, 0)
        e = state.history.slope(z)
        l1 = np.hypot(a, e)
        slope = zone.mesh.slope(forces(state.tube, rho, l1, a, e)[1]) / (right - left)
        push = state.substrate.push(rho, state.p) if zone.spring else state.p
        f_k = state.substrate.radial(rho, l1, e) * zone.spring
        out.append(Patch(z, -(slope - push * rho * a) / (rho * l1), f_k))
    return out


def tractions_at(state: State, z: Array) -> tuple[Array, Array]:
    """f_t and f_k at positions z inside the stuck zones."""
    f_t, f_k = np.zeros(len(z)), np.zeros(len(z))
    for d, patch in enumerate(patches(state)):
        left, right = state.bounds[d]
        here = (z >= left) & (z <= right)
        both = np.stack([patch.f_t, patch.f_k], axis=-1)
        f_t[here], f_k[here] = state.zones[d].mesh.evaluate(both, (z[here] - left) / (right - left)).T
    return f_t, f_k


def dense(mesh: Mesh, values: Array, points: int = 201) -> Array:
    """Nodal values sampled densely, ends of the elements included."""
    return values @ lagrange(mesh.rule.nodes, np.linspace(0, 1, points)).T


def at_edge(state: State) -> dict[str, float]:
    """Line force (whole and of the membrane alone) and curvature of the free part at the front."""
    z = np.array([float(state.fronts[-1])])
    rho, _, l1, b, *_ = profile(state, z, side=1)[0]
    _, _, m1, c, _, d = profile(state, z, side=-1)[0]
    outer = forces(state.tube, rho, l1, 0.0, l1 * np.cos(b))[1]
    inner = forces(state.tube, rho, m1, 0.0, m1 * np.cos(c))[1]
    spring = state.substrate.potential(rho, state.p, state.zones[int(d)].spring)
    bare = state.substrate.potential(rho, state.p, False)
    return {
        "line_force": abs((inner - spring) - (outer - bare)) / rho,
        "line_force_membrane": abs(inner - outer) / rho,
        "kappa": float(turning(state.tube, rho, l1, np.cos(b), state.p)),
    }
