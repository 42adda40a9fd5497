r"""Multiple shooting in momenta; fronts and surface are events, and no pattern is given.

Unknowns over s: r, z and the components A, F of the meridional tension per radian, in the form

.. math::
   r' = l A/T,\quad z' = l F/T,\quad A' = H W_2 - P r z',\quad F' = P r r',\qquad
   T = \sqrt{A^2 + F^2} = H R\, W_1(l, r/R),

which is valid in both taut and wrinkled parts (Patil, Nordmark & Eriksson, Eur. J. Mech. A/Solids
54 (2015) 1-10, equilibrium with the relaxed energy), where l follows from T at every stage. The right-hand
side is continuous, so that only a step that contains an event must be cut there. The eighth-order Runge-Kutta
formula of Dormand and Prince takes steps of fixed length, for all segments in parallel. Derivatives are
computed by complex steps.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from reference_data.solvers.core import mooney_rivlin as mat
from reference_data.solvers.paper4 import material as wri
from reference_data.solvers.paper4.material import Array, Body

STEP = 1e-30
SEGMENTS = 32
NO_SIGN = 1e-13  # an event must pass its zero by more than this, which is rounding
NO_ZONE = 1e-11  # shortest zone between a front and a disk
A, B, C = DOP853.A[:12, :12], DOP853.B, DOP853.C[:12]


def stretch(force: Array, l2: Array, tense: Array, c2: float, start: Array | None = None) -> Array:
    """Root l of W_1(l, l2) = force (taut) or W_r'(l) = force (wrinkled); (segments, copies).

    Both rise and are concave in l: from a start to the left of the root, Newton's method converges
    monotonically. This is done for the first, real copy; the others differ by imaginary increments only, for
    which one further step is exact.
    """

    def correction(l1: Array, force: Array, l2: Array) -> Array:
        slope = np.where(tense, mat.slope(l1, l2, c2), wri.relaxed_slope(l1, c2))
        curve = np.where(tense, mat.curvature(l1, l2, c2), wri.relaxed_curvature(l1, c2))
        return (force - slope) / curve

    one, at = np.real(force[:, :1]), np.real(l2[:, :1])
    if start is not None:
        l1 = start
    elif isinstance(c2, float | int):
        l1 = np.maximum(one / np.where(tense, 2 + 2 * c2 * at * at, 2 + 2 * c2), 0.7)
    else:
        l1 = np.full_like(one, 1.2)
    for _ in range(60):
        step = wri.bounded(correction(l1, one, at), c2)
        l1 = l1 + step
        if np.max(np.abs(step)) < 1e-8:  # quadratic: the next step leaves rounding only
            break
    return l1 + correction(l1, force, l2)


def local(membrane: Body, s: Array, y: Array, tense: Array) -> tuple[Array, Array, Array]:
    """Stretch l, gw - 1 and d gw/ds from (r, z, A, F), one row each, with given flags."""
    c2, R, H, (dR, dH) = membrane.c2, membrane.unloaded(s), membrane.eta(s), membrane.slopes(s)
    tension = np.hypot(y[:, 2], y[:, 3])
    l2, force, sine = y[:, 0] / R, tension / (H * R), y[:, 2] / tension
    l1 = stretch(force[:, None], l2[:, None], tense[:, None], c2)[:, 0]
    w11 = np.where(tense, mat.curvature(l1, l2, c2), wri.relaxed_curvature(l1, c2))
    w12 = np.where(tense, mat.mixed(l1, l2, c2), 0.0)
    w2 = np.where(tense, mat.slope(l2, l1, c2), 0.0)
    dl2 = (l1 * sine - l2 * dR) / R
    # T' = H W_2 sin(phi), and T = H R W_1
    dl = (w2 * sine / R - (dR / R + dH / H) * force - w12 * dl2) / w11
    g = l2 * np.sqrt(l1)
    return l1, g - 1, g * (dl2 / l2 + dl / (2 * l1))


def cubic_root(h: float, f0: float, f1: float, d0: float, d1: float) -> float:
    """Zero on [0, h] of the cubic with these values and slopes at the ends, f0 and f1 of unlike sign."""
    low, high = 0.0, 1.0
    for _ in range(40):
        x = (low + high) / 2
        y = 1 - x
        value = y * y * ((1 + 2 * x) * f0 + x * h * d0) + x * x * ((3 - 2 * x) * f1 - y * h * d1)
        low, high = (x, high) if value * f0 > 0 else (low, x)
    return h * (low + high) / 2


@dataclass
class Part:
    """A smooth part of one step: its start, its length, its flags, its first and last values."""

    s: float
    h: float
    tense: bool
    wet: bool
    y: Array
    end: Array


class Shot:
    """All segments shot once from their starting values.

    Attributes:
        ends: Values (r, z, A, F, V) at the segments' ends; V is the volume, per 2 pi, of the segment.
        path: Values at every step, (segments, steps + 1, 5), real.
        parts: The smooth pieces, from the bottom up.
        fronts: Positions of the fronts met.
    """

    def __init__(self, membrane: Body, starts: Array, load: Array, steps: int) -> None:
        self.membrane, self.load = membrane, load
        ends = membrane.segments(len(starts), steps)
        self.h, s = np.diff(ends) / steps, ends[:-1]
        starts = starts.copy()
        starts[0] = membrane.begin(starts[0], load[: starts.shape[1]], s[0])
        y = np.concatenate([starts, np.zeros((*starts.shape[:-1], 1))], axis=-1)
        tense, wet = self.flags(s, y)
        path, parts, fronts = [np.real(y[:, 0])], [], []
        for _ in range(steps):
            s, y = self.step(s, y, tense, wet, parts, fronts)
            path.append(np.real(y[:, 0]))
        self.ends, self.path = y, np.stack(path, axis=1)
        self.parts = sorted(parts, key=lambda p: p.s)
        # if gw = 1 at a disk, rounding may create a front there that separates nothing
        self.fronts = np.sort([x for x in fronts if NO_ZONE < x < membrane.L - NO_ZONE])

    def flags(self, s: Array, y: Array) -> tuple[Array, Array]:
        """Taut and wet at the segments' starts, by the signs there."""
        every = np.ones(len(s), bool)
        tense = every if self.membrane.energy == "standard" else self.switches(s, y, every)[0][:, 0] > 0
        wet = every if self.membrane.load == "gas" else np.real(self.load[0] - y[:, 0, 1]) > 0
        return tense.copy(), wet.copy()

    def switches(self, s: Array, y: Array, tense: Array) -> tuple[Array, Array]:
        """The switches gw - 1 and zw - z, real, each with its derivative by s in the last axis."""
        head = np.real(y[:, 0])
        l1, g, slope = local(self.membrane, s, head, tense)
        rise = l1 * head[:, 3] / np.hypot(head[:, 2], head[:, 3])
        depth = np.real(self.load[0]) - head[:, 1]
        return np.stack([g, slope], axis=-1), np.stack([depth, -rise], axis=-1)

    def rates(self, s: Array, y: Array, tense: Array, wet: Array, start: Array | None) -> tuple[Array, Array]:
        """Right-hand sides for (r, z, A, F, V), and the stretch, to start from at the next stage."""
        membrane = self.membrane
        r, z, a, f = (y[..., i] for i in range(4))
        tension = np.sqrt(a * a + f * f)
        R, H = membrane.unloaded(s)[:, None], membrane.eta(s)[:, None]
        l1 = stretch(tension / (H * R), r / R, tense[:, None], membrane.c2, start)
        dr, dz = l1 * a / tension, l1 * f / tension
        w2 = np.where(tense[:, None], mat.slope(r / R, l1, membrane.c2), 0.0)
        p = membrane.pressure(z, self.load[: y.shape[1]], wet[:, None])
        hoop = H * w2
        out = np.stack([dr, dz, hoop - p * r * dz, p * r * dr, r * r * dz / 2], axis=-1)
        return out, np.real(l1[:, :1])

    @property
    def surface(self) -> float:
        """Position of the fluid's surface."""
        return next(b.s for a, b in pairwise(self.parts) if a.wet and not b.wet)

    def advance(self, s: Array, y: Array, h: Array, tense: Array, wet: Array) -> Array:
        """One Runge-Kutta step of length h (one per segment) with frozen flags."""
        stages: list[Array] = []
        l1 = None
        for i in range(12):
            at = y
            if i:
                at = y + h[:, None, None] * sum(A[i, j] * stages[j] for j in range(i) if A[i, j])
            rates, l1 = self.rates(s + C[i] * h, at, tense, wet, l1)
            stages.append(rates)
        return y + h[:, None, None] * sum(b * k for b, k in zip(B, stages, strict=True) if b)

    def step(
        self, s: Array, y: Array, tense: Array, wet: Array, parts: list[Part], fronts: list[float]
    ) -> tuple[Array, Array]:
        """One step of every segment, cut at events; the flags are changed in place."""
        left = self.h.copy()
        s, y = s.copy(), y.copy()
        for _ in range(8):
            open_ = np.nonzero(left > 0)[0]
            if not len(open_):
                return s, y
            t, w, start, at, h = tense[open_], wet[open_], s[open_], y[open_], left[open_].copy()
            ahead = self.advance(start, at, h, t, w)
            kind = self.crossed(start + h, ahead, t, w)
            for i in np.nonzero(kind)[0]:
                one = slice(i, i + 1)
                begin = start[one], at[one], t[one], w[one]
                h[i], kind[i] = self.event(*begin, h[i], ahead[one], int(kind[i]))
                ahead[one] = self.advance(start[one], at[one], h[one], t[one], w[one])
            for i, e in enumerate(open_):
                values = np.real(at[i, 0]), np.real(ahead[i, 0])
                parts.append(Part(float(start[i]), float(h[i]), bool(t[i]), bool(w[i]), *values))
                s[e], y[e], left[e] = start[i] + h[i], ahead[i], left[e] - h[i]
                if kind[i] == 1:
                    tense[e] = not tense[e]
                    fronts.append(float(s[e]))
                elif kind[i] == 2:
                    wet[e] = not wet[e]
                if not kind[i]:
                    left[e] = 0.0
        raise RuntimeError(f"shooting: too many events in one step for {self.membrane}")

    def crossed(self, s: Array, y: Array, tense: Array, wet: Array) -> Array:
        """The event that a step has passed: 0 none, 1 a front, 2 the surface, 3 both."""
        g, depth = (x[:, 0] for x in self.switches(s, y, tense))
        front = np.where(tense, -g, g) > NO_SIGN
        surface = np.where(wet, -depth, depth) > NO_SIGN
        if self.membrane.energy == "standard":
            front[:] = False
        if self.membrane.load == "gas":
            surface[:] = False
        return front + 2 * surface

    def event(
        self, s: Array, y: Array, tense: Array, wet: Array, h: float, ahead: Array, kind: int
    ) -> tuple[float, int]:
        """Length of the step that ends on the first event, and which that is (1 front, 2 surface).

        Newton's method from the zero of the cubic through both ends.
        """
        found = []
        for which in (0, 1):
            if not kind & (which + 1):
                continue
            sign = 1.0 if (tense, wet)[which][0] else -1.0
            f0, d0 = self.switches(s, y, tense)[which][0]
            f1, d1 = self.switches(s + h, ahead, tense)[which][0]
            if sign * f0 <= 0:
                found.append((0.0, which + 1))
                continue

            def at(x: float, which: int = which) -> Array:
                here = self.advance(s, y[:, :1], np.array([x]), tense, wet)
                return self.switches(s + x, here, tense)[which][0]

            x = cubic_root(h, f0, f1, d0, d1)
            for _ in range(8):
                f, d = at(x)
                step = -f / d
                x = float(np.clip(x + step, 0.0, h))
                if abs(step) < 1e-12:
                    break
            else:  # gw nearly touches 1 here, which is difficult for Newton's method
                x = float(brentq(lambda x, at=at: at(x)[0], 0.0, h, xtol=1e-14))
            found.append((x, which + 1))
        return min(found)
