r"""Perturbations of an axisymmetric state in canonical form: eigenvalues and critical points.

The perturbation u cos(n Theta) e_r + beta sin(n Theta) e_theta + w cos(n Theta) e_z of an equilibrium
has the second variation pi int Q dZ (2 pi for n = 0), Q a quadratic form in (q', q), q = (u, beta, w).
With Q = q'.C q' + 2 q'.B q + q.A q, the eigenproblem d2Pi = Lambda M, M = int |dx|^2, is the
Hamiltonian system

.. math::
   q' = C^{-1}(p - B q),\qquad p' = B^T q' + (A - \Lambda) q + \mu\, d,\qquad q(0) = q(l) = 0,

q and p being continuous at the free surface (the pressure vanishes there). n = 0 splits into (u, w),
whose zero is a limit point in the level, and torsion, beta. For given volume instead of given level
(n = 0 only) the level's change mu enters as a load, d = (r z', -r r') below the surface, with
int d.q dZ = A_s mu/(2 pi gamma), A_s = pi r_f^2 or, over-filled, 0.

Critical points solve the equations of the state and those of the perturbation (Lambda = 0) at once,
level, front and volume being unknowns; eigenvalues take the state as given.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_data.solvers.core.law_metric import metric
from reference_data.solvers.paper3.collocation import (
    BASE,
    Array,
    Region,
    State,
    base_conditions,
    base_rates,
    solve_on,
)

DR, DB, DW, R, B, W = range(6)  # places of u', beta', w', u, beta, w in a form's 6-vector


def form(r: Any, l1: Any, psi: Any, pressure: Any, slope: Any, n: int, law: Any = None) -> Any:
    """Matrix (..., 6, 6) of Q over (u', beta', w', u, beta, w).

    Args:
        r: Radius.
        l1: Meridional stretch.
        psi: Slope angle.
        pressure: P at the point.
        slope: dP/dz at the point.
        n: Circumferential wave number.
        law: Another law than the neo-Hookean one.
    """
    c, s = l1 * np.cos(psi), l1 * np.sin(psi)  # r', z'
    sq, rr = l1 * l1, r * r
    j0 = sq * rr
    shape = np.broadcast(r, pressure).shape

    def linear(**parts: Any) -> Any:
        out = np.zeros((*shape, 6), dtype=np.result_type(r, l1, psi, pressure))
        for name, value in parts.items():
            out[..., PLACES[name]] = value
        return out

    def square(a: Any, b: Any | None = None) -> Any:
        b = a if b is None else b
        return (a[..., :, None] * b[..., None, :] + b[..., :, None] * a[..., None, :]) / 2

    g11, g22 = linear(DR=2 * c, DW=2 * s), linear(R=2 * r, B=2 * n * r)
    g12 = linear(R=-n * c, B=-c, W=-n * s, DB=r)
    hoop, spin, lift = linear(R=1, B=n), linear(R=n, B=1), linear(W=n)
    meridian = square(linear(DR=1)) + square(linear(DB=1)) + square(linear(DW=1))
    ring = square(hoop) + square(spin) + square(lift)

    def scaled(x: Any, q: Any) -> Any:
        return np.asarray(x)[..., None, None] * q

    j1 = scaled(1 / j0**3, square(_times(rr, g11) + _times(sq, g22)))
    elastic = scaled(1 - rr / j0**2, meridian) + scaled(1 - sq / j0**2, ring) + j1
    elastic = elastic - scaled(1 / j0**2, square(g11, g22) - square(g12))
    if law is not None:  # twice the second-order energy, which is half the law's
        m = metric(law, l1, r)
        elastic = scaled(m.f1, meridian) + scaled(m.f2, ring) + scaled(m.f12, square(g11, g22))
        elastic = elastic + (scaled(m.f11, square(g11)) + scaled(m.f22, square(g22))) / 2
        elastic = elastic + scaled(m.fy, square(g12))
    u, b, w, du, dw = (linear(**{name: 1}) for name in ("R", "B", "W", "DR", "DW"))
    height = scaled(slope, square(w, linear(R=r * s, W=-r * c)))
    follow = scaled(s, square(u) + square(b) + 2 * n * square(u, b))
    follow = follow - scaled(c, square(u, w) + 2 * n * square(b, w))
    follow = follow + scaled(r, square(u, dw) - square(w, du))
    return elastic - height - scaled(pressure, follow)


PLACES = {"DR": DR, "DB": DB, "DW": DW, "R": R, "B": B, "W": W}


def _times(x: Any, v: Any) -> Any:
    return np.asarray(x)[..., None] * v


@dataclass(frozen=True)
class Family:
    """A family of perturbations.

    Attributes:
        n: Circumferential wave number.
        fields: Which of (u, beta, w) take part.
        volume: True when the fluid volume instead of the level is held.
    """

    n: int
    fields: tuple[int, ...] = (0, 1, 2)
    volume: bool = False


AXISYMMETRIC = Family(0, (0, 2))
TORSION = Family(0, (1,))
AXISYMMETRIC_V = Family(0, (0, 2), volume=True)


def family(n: int) -> Family:
    """The level-controlled family of wave number n, without torsion."""
    return AXISYMMETRIC if n == 0 else Family(n)


@dataclass
class Mode:
    """A state with a perturbation: nodal (q, p) (and, volume held, int d.q), and its eigenvalue."""

    state: State
    family: Family
    values: Array
    eigenvalue: float
    mu: float = 0.0


@dataclass
class Coefficients:
    """C, B, A of the form at points of a state, the volume's gradient d and the regions' lengths."""

    c: Any
    b: Any
    a: Any
    d: tuple[Any, Any]
    h: Any


def coefficients(base: list[Any], zw: Any, front: Any, mode: Mode, region: Region) -> Coefficients:
    """Coefficients of the canonical system at a state's (r, z, l1, psi)."""
    tube, fam = mode.state.tube, mode.family
    r, z, l1, psi = base[:4]
    wet = region.wet
    q = form(r, l1, psi, tube.gamma * (zw - z) * wet, -tube.gamma * wet, fam.n, tube.law)
    i, j = np.array(fam.fields)[:, None], np.array(fam.fields)
    d = wet * r * l1 * np.sin(psi), -wet * r * l1 * np.cos(psi)
    return Coefficients(q[..., i, j], q[..., i, j + 3], q[..., i + 3, j + 3], d, region.length(tube, front))


def mode_rates(y: list[Any], k: Coefficients, eigenvalue: Any, mu: Any, family: Family) -> list[Any]:
    """Derivatives of (q, p[, int d.q]) with respect to s."""
    m = len(family.fields)
    q, p = np.stack(y[:m], axis=-1), np.stack(y[m : 2 * m], axis=-1)
    dq = np.linalg.solve(k.c, (p - np.einsum("...ij,...j->...i", k.b, q))[..., None])[..., 0]
    dp = np.einsum("...ji,...j->...i", k.b, dq) + np.einsum("...ij,...j->...i", k.a, q) - eigenvalue * q
    if not family.volume:
        return [k.h * x for x in (*np.moveaxis(dq, -1, 0), *np.moveaxis(dp, -1, 0))]
    dp = [dp[..., i] + mu * k.d[i] for i in (0, 1)]
    return [k.h * x for x in (dq[..., 0], dq[..., 1], *dp, k.d[0] * q[..., 0] + k.d[1] * q[..., 1])]


def mode_conditions(
    start: list[Any], end: list[Any], mu: Any, area: float, family: Family, scale: Array
) -> list[Any]:
    """Clamped rings, the normalisation and, volume held, int d.q = area mu."""
    m = len(family.fields)
    out = [*start[:m], *end[:m]]
    momenta = [*start[m : 2 * m], *end[m : 2 * m]]
    out.append(sum(a * b for a, b in zip(scale, momenta, strict=True)) - 1)
    return [*out, start[-1], end[-1] - area * mu] if family.volume else out


def _normalised(mode: Mode) -> tuple[Mode, Array]:
    """Scaled so that the momenta at both rings have norm 1 together, with the weights that keep it so."""
    m = len(mode.family.fields)
    p = np.concatenate([mode.values[0, 0, m : 2 * m], mode.values[-1, -1, m : 2 * m]])
    size = float(np.linalg.norm(p))
    scaled = Mode(mode.state, mode.family, mode.values / size, mode.eigenvalue, mode.mu / size)
    return scaled, p / size


def eigenvalue(guess: Mode) -> Mode:
    """Eigenvalue and perturbation of a given state, near a guess.

    Raises:
        RuntimeError: If Newton's iteration does not converge.
    """
    guess, scale = _normalised(guess)
    state, fam, mesh = guess.state, guess.family, guess.state.mesh
    at = mesh.rule.value @ state.y
    fixed = {
        r.wet: coefficients(list(np.moveaxis(at[r.at], -1, 0)), state.zw, state.front, guess, r)
        for r in mesh.regions
    }
    area = state.y[mesh.wet - 1, -1, 0] ** 2 / (2 * state.tube.gamma) if state.partial else 0.0

    def rates(y: list[Any], par: list[Any], region: Region) -> list[Any]:
        return mode_rates(y, fixed[region.wet], par[0], par[1] if fam.volume else 0.0, fam)

    def conditions(start: list[Any], _: list[Any], end: list[Any], par: list[Any]) -> list[Any]:
        return mode_conditions(start, end, par[1] if fam.volume else 0.0, area, fam, scale)

    par = np.array([guess.eigenvalue, *[guess.mu] * fam.volume])
    what = f"eigenvalue, n = {fam.n}, of {state.tube} at V = {state.volume:g}"
    y, par = solve_on(mesh, rates, conditions, guess.values, par, what)
    return Mode(state, fam, y, float(par[0]), float(par[1]) if fam.volume else 0.0)


def critical_state(guess: Mode) -> Mode:
    """State whose level-controlled eigenvalue is zero: state, perturbation and volume together.

    Raises:
        RuntimeError: If Newton's iteration does not converge.
    """
    guess, scale = _normalised(guess)
    state, fam = guess.state, guess.family
    tube, partial = state.tube, state.partial

    def rates(y: list[Any], par: list[Any], region: Region) -> list[Any]:
        front = par[1] if partial else tube.length
        out = base_rates(y[:BASE], par[0], front, tube, region)
        k = coefficients(y[:BASE], par[0], front, guess, region)
        return out + mode_rates(y[BASE:], k, 0.0, 0.0, fam)

    def conditions(start: list[Any], front: list[Any], end: list[Any], par: list[Any]) -> list[Any]:
        out = base_conditions(start, front, end, par[0], par[-1], tube, partial)
        return out + mode_conditions(start[BASE:], end[BASE:], 0.0, 0.0, fam, scale)

    par = np.array([state.zw, *[state.front] * partial, state.volume])
    y = np.concatenate([state.y, guess.values], axis=-1)
    what = f"critical point, n = {fam.n}, of {tube} near V = {state.volume:g}"
    y, par = solve_on(state.mesh, rates, conditions, y, par, what)
    front = float(par[1]) if partial else tube.length
    return Mode(State(tube, state.mesh, y[..., :BASE], float(par[0]), front), fam, y[..., BASE:], 0.0)
