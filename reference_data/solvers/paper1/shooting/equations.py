r"""Method (a): shooting. Second-order strong form, Runge-Kutta 8(5,3), Newton on the far end.

With S = W_1/lambda1 the Euler-Lagrange equations of the membrane are

.. math::
   (x S \rho')' = W_2 + p_e\, \rho\, \eta', \qquad (x S \eta')' = -p_e\, \rho\, \rho',
   \qquad p_e = p - k \langle \eta - l \rangle ,

solved here for rho'' and eta'' (the paper's F1 and F2, see :func:`appendix`). State vector
(rho, eta, rho', eta'), optionally followed by the volume -int rho^2 eta'/2 dx and the strain
energy int x W dx. At the pole the solution is started from its series,

.. math::
   \lambda_2 = \lambda_0 + a x^2,\ \lambda_1 = \lambda_0 + b x^2,\ \eta' = -\lambda_0 c x,
   \quad c = p_e \lambda_0^2/(2 W_1),\ 3a - b = -\lambda_0 c^2/2,\
   b(3A - B) + a(3B - A) = -W_1 c^2/2 ,

A = W_11, B = W_12 at (lambda0, lambda0). Source: Patil, DasGupta & Eriksson (2015), equations
(10)-(13) and the algorithm of section 3.1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import ode

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper1.membrane import Disk

Array = np.ndarray
State = Sequence[float]


@dataclass(frozen=True)
class Accuracy:
    """Accuracy of the integration; two of them give an uncertainty.

    Attributes:
        rtol: Relative tolerance of the Runge-Kutta steps (absolute: a tenth of it).
        start: End of the series at the pole, as a fraction of 1/beta.
        history: Relative tolerance of the integration over the front position.
        first: Start of that integration; an error there decays like (first/x*)^2.
    """

    rtol: float
    start: float
    history: float
    first: float


LEVELS = (Accuracy(1e-11, 3e-4, 1e-9, 2e-3), Accuracy(2e-13, 1e-4, 1e-11, 1e-3))


def second(
    x: float, rho: float, eta: float, q: float, w: float, push: float, alpha: float
) -> tuple[float, float]:
    """Second derivatives rho'' and eta'' at x, for the effective pressure ``push``; q = rho', w = eta'."""
    l1, l2 = (q * q + w * w) ** 0.5, rho / x
    w1, w2 = mat.slope(l1, l2, alpha), mat.slope(l2, l1, alpha)
    s, s2 = w1 / l1, mat.mixed(l1, l2, alpha) / l1
    w11 = mat.curvature(l1, l2, alpha)
    fan = s + s2 * (q - l2)  # (x S)' without its lambda1' part
    f = (w2 + push * rho * w - fan * q) / (x * s)
    g = (-push * rho * q - fan * w) / (x * s)
    # (1 + (W11 - S)/S t t^T)^-1 with the unit tangent t = (q, w)/l1
    along = (w11 - s) / (w11 * l1 * l1) * (f * q + g * w)
    return f - along * q, g - along * w


def appendix(x: float, l2: float, v: float, w: float, push: float, alpha: float) -> tuple[float, float]:
    """The paper's F1 = v' and F2 = w' in its variables u = x lambda2, v = x lambda2', w = eta'.

    From rho' = lambda2 + v: F1 = rho'' - v/x, F2 = eta''. The appendix prints A/B and C/B with
    a factor 2 pi in A and C that must not be there.
    """
    bend, drop = second(x, x * l2, 0.0, l2 + v, w, push, alpha)
    return bend - v / x, drop


def shoot(
    disk: Disk,
    p: float,
    spring: bool,
    y: State,
    x: Sequence[float],
    rtol: float,
    totals: bool = False,
    moment: bool = False,
) -> list[Array]:
    """States at x[1:], starting with ``y`` at x[0].

    The state is followed by volume and energy (totals) or by the volume alone (moment).

    Raises:
        RuntimeError: If the integrator fails.
    """
    k, height, alpha = (disk.k if spring else 0.0), disk.l, disk.alpha

    def rates(at: float, y: State) -> list[float]:
        rho, eta, q, w = y[0], y[1], y[2], y[3]
        out = [q, w, *second(at, rho, eta, q, w, p - k * (eta - height), alpha)]
        if totals or moment:
            out.append(-rho * rho * w / 2)
        if totals:
            l1 = (q * q + w * w) ** 0.5
            out.append(at * mat.energy(l1, rho / at, alpha))
        return out

    run = ode(lambda at, y: rates(at, y.tolist()))
    run.set_integrator("dop853", rtol=rtol, atol=rtol / 10, nsteps=20000)
    run.set_initial_value(np.asarray(y, dtype=float), x[0])
    out = []
    for target in x[1:]:
        out.append(run.integrate(target) if target != run.t else run.y.copy())
        if not run.successful() or not np.all(np.isfinite(out[-1])):
            raise RuntimeError(f"shooting: no solution up to x = {target:g} for {disk}, p = {p:g}")
    return out


def pole(disk: Disk, l0: float, t0: float, p: float, x: float, spring: bool) -> list[float]:
    """(rho, eta, rho', eta') near the pole, by the series."""
    push = p - (disk.k * (t0 - disk.l) if spring else 0.0)
    w1 = mat.slope(l0, l0, disk.alpha)
    a11, b12 = mat.curvature(l0, l0, disk.alpha), mat.mixed(l0, l0, disk.alpha)
    c = push * l0 * l0 / (2 * w1)
    first = -l0 * c * c / 2  # 3 a - b
    # b = 3 a - first in b (3A - B) + a (3B - A) = -W1 c^2/2
    a = (-w1 * c * c / 2 + first * (3 * a11 - b12)) / (8 * a11)
    return [l0 * x + a * x**3, t0 - l0 * c * x * x / 2, l0 + 3 * a * x * x, -l0 * c * x]
