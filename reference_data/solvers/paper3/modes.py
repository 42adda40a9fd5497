"""Eigenvalues and critical points of the primary branch by both methods.

The Galerkin matrices name the lowest mode of each family, which then is the first guess of the
collocation method; what either method returns is its own converged solution.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.newton import Secants
from reference_data.solvers.paper3 import canonical as can
from reference_data.solvers.paper3 import galerkin as gal
from reference_data.solvers.paper3 import path
from reference_data.solvers.paper3.canonical import Family, Mode
from reference_data.solvers.paper3.collocation import Array, State, resultants
from reference_data.solvers.paper3.data import FluidTube
from reference_data.solvers.paper3.weak import cut_resultants

FAMILIES: dict[str, Family] = {
    "Lambda_n0": can.AXISYMMETRIC,
    "Lambda_n1": can.family(1),
    "Lambda_n2": can.family(2),
    "Lambda_n3": can.family(3),
    "Lambda_torsion": can.TORSION,
    "LambdaV_n0": can.AXISYMMETRIC_V,
}


def galerkin_mode(shape: gal.Shape, family: Family) -> tuple[float, Array, float]:
    """Lowest eigenvalue of a family, its nodal values (nodes, fields), and the level's part mu."""
    matrices = gal.Matrices(shape, family.n, family.fields)
    if not family.volume:
        value, v = gal.lowest_banded(matrices.stiffness, matrices.mass)
        return value, v.reshape(-1, len(family.fields)), 0.0
    stiffness, mass, basis = matrices.volume_controlled(shape)
    value, v = gal.lowest(stiffness, mass)
    v = basis @ v
    d, radius = matrices.volume, shape.surface_radius
    if radius > 0:
        mu = 2 * shape.tube.gamma / radius**2 * (d @ v)
    else:  # the multiplier of d.v = 0
        mu = -(d @ (matrices.stiffness @ v - value * matrices.mass @ v)) / (d @ d)
    return value, v.reshape(-1, len(family.fields)), float(mu)


def collocation_guess(state: State, shape: gal.Shape, family: Family) -> Mode:
    """The Galerkin mode carried over to the collocation nodes, with its momenta."""
    value, inner, mu = galerkin_mode(shape, family)
    m, mesh, tube = len(family.fields), state.mesh, state.tube
    nodal = np.zeros((len(shape.x), m))
    nodal[1:-1] = inner
    at = mesh.position(tube, state.front)
    q, slope = replace(shape, x=nodal).evaluate(np.clip(at.ravel(), 0, tube.length))
    r, z, l1, psi = state.y[..., :4].reshape(-1, 4).T
    wet = np.broadcast_to(mesh.dampness, at.shape).ravel()
    form = can.form(r, l1, psi, tube.gamma * (state.zw - z) * wet, -tube.gamma * wet, family.n, tube.law)
    idx = np.array(family.fields)
    p = np.einsum("kij,kj->ki", form[:, idx[:, None], idx], slope)
    p += np.einsum("kij,kj->ki", form[:, idx[:, None], idx + 3], q)
    values = [q, p] + [np.zeros((len(q), 1))] * family.volume
    return Mode(state, family, np.concatenate(values, axis=1).reshape(*at.shape, -1), value, mu)


def spectrum(state: State, how: path.Resolution) -> dict[str, tuple[float, float]]:
    """Lowest eigenvalue of each family at a state: by collocation and by Galerkin."""
    shape = path.galerkin(state, how)
    out = {}
    for name, family in FAMILIES.items():
        guess = collocation_guess(state, shape, family)
        out[name] = (can.eigenvalue(guess).eigenvalue, guess.eigenvalue)
    return out


def critical_point(state: State, how: path.Resolution, n: int) -> Mode:
    """Zero of the lowest eigenvalue of wave number n near a state, by collocation.

    Raises:
        RuntimeError: If it does not converge, or to a state that does not exist.
    """
    shape = path.galerkin(state, how)
    found = can.critical_state(collocation_guess(state, shape, can.family(n)))
    crossed = (
        found.state.zw < found.state.tube.L
        if not found.state.partial
        else (not 0 < found.state.front < found.state.tube.length)
    )
    if crossed:  # the zero lies on the other side of the brim
        state = path.at_volume(state, found.state.volume, how)
        shape = path.galerkin(state, how)
        found = can.critical_state(collocation_guess(state, shape, can.family(n)))
    path.checked(found.state)
    return found


def galerkin_critical(state: State, how: path.Resolution, n: int) -> gal.Shape:
    """The same zero by the Galerkin method: Newton in the volume, with the slope of its own eigenvalue.

    Args:
        state: First guess.
        how: Elements.
        n: Wave number.

    Raises:
        RuntimeError: If the steps do not converge.
    """
    family = can.family(n)
    near = path.galerkin(state, how)

    def value(volume: float) -> float:
        return galerkin_mode(gal.solve(near, volume), family)[0]

    what = f"Galerkin: zero of n = {n} near V = {state.volume:g} of {state.tube}"
    zero = Secants(offset=1e-4).solve(lambda v: np.array([value(v[0])]), [state.volume], what, stalled=1e-8)
    return gal.solve(near, float(zero[0]))


def zeros(tube: FluidTube, stop: float, step: float, waves: tuple[int, ...] = (0, 1, 2)) -> dict[int, State]:
    """States next to the first zero of the lowest eigenvalue of each wave number, up to a volume.

    Raises:
        RuntimeError: If the branch cannot be followed.
    """
    how = path.SEARCH
    line = path.Path(tube, how)
    before: dict[int, float] = {}
    out: dict[int, State] = {}
    for volume in np.arange(step, stop + step / 2, step):
        state = line.reach(float(volume), step)
        shape = path.galerkin(state, how)
        for n in set(waves) - set(out):
            value = galerkin_mode(shape, can.family(n))[0]
            if before.get(n, 1.0) > 0 >= value:
                t = before[n] / (before[n] - value)
                out[n] = line.at(float(volume) - step * (1 - t))
            before[n] = value
        if len(out) == len(waves):
            break
    return out


def potential(state: State) -> float:
    """Total potential energy Pi of a collocation state."""
    mesh, tube = state.mesh, state.tube
    r, z, l1, psi, _ = np.moveaxis(mesh.rule.value @ state.y, -1, 0)
    fluid = tube.gamma * (state.zw - z) * mesh.dampness * r**2 * l1 * np.sin(psi)
    strain = l1**2 + r**2 + 1 / (l1 * r) ** 2 - 3 if tube.law is None else tube.law.energy(l1, r)
    density = strain - fluid
    return float(np.pi * np.sum(mesh.lengths(tube, state.front) * mesh.weights * density))


def largest(radius: object, slope: object, length: float) -> float:
    """Largest radius of a profile, given as functions of Z with their derivative's sign."""
    at = np.linspace(0, length, 801)
    top = int(np.argmax(radius(at)))
    if top in (0, len(at) - 1):
        return 1.0
    where = brentq(lambda x: float(slope(np.array([x]))[0]), at[top - 1], at[top + 1], xtol=1e-14)
    return float(radius(np.array([where]))[0])


def quantities(state: State) -> dict[str, float]:
    """Columns of a branch at a collocation state."""
    length = state.tube.length
    ring, mid = state.y[0, 0], state.evaluate(np.array(length / 2))
    t_ring, t_mid = (resultants(at[2], at[0], state.tube.law) for at in (ring, mid))
    return {
        "zw": state.zw,
        "V": state.volume,
        "r_mid": float(mid[0]),
        "r_max": largest(
            lambda x: state.evaluate(x)[:, 0], lambda x: np.cos(state.evaluate(x)[:, 3]), length
        ),
        "T1_ring": float(t_ring[0]),
        "T2_ring": float(t_ring[1]),
        "T1_mid": float(t_mid[0]),
        "T2_mid": float(t_mid[1]),
        "Pi": potential(state),
    }


def galerkin_quantities(shape: gal.Shape) -> dict[str, float]:
    """The same columns at a Galerkin state."""
    length = shape.tube.length
    x, slope = shape.evaluate(np.array([0.0, length / 2]))
    t_ring, t_mid = np.transpose(cut_resultants(*gal.tangents(x, slope), shape.tube.law))
    return {
        "zw": shape.zw,
        "V": shape.volume(),
        "r_mid": float(x[1, 0]),
        "r_max": largest(lambda s: shape.evaluate(s)[0][:, 0], lambda s: shape.evaluate(s)[1][:, 0], length),
        "T1_ring": float(t_ring[0]),
        "T2_ring": float(t_ring[1]),
        "T1_mid": float(t_mid[0]),
        "T2_mid": float(t_mid[1]),
        "Pi": shape.potential(),
    }
