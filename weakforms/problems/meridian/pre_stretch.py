"""Pre-stretches, disks and heights that a law bears, and those that are refused before anything is solved."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.optimize import bisect

from weakforms.errors import ConvergenceError, InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems.homogeneous.material_point import LARGEST, evaluated, stressed
from weakforms.problems.material_choice import MOONEY_RIVLIN, Chosen
from weakforms.problems.meridian.limits import limit_of
from weakforms.problems.meridian.thickness import PLACES, Thickness


def require_taut(problem: str, law: Chosen, stretch: float, name: str) -> None:
    """Refuse an equal pre-stretch in both directions beyond a law's limit, or at which it gives no tension.

    Raises:
        InputError: With a message that names the parameter.
    """
    why = limit_of(law, [(stretch, stretch)])
    if not why and stretch > 1 and evaluated(law, stretch, stretch)["W1"] <= 0:
        why = f"model = {law.model!r} gives no tension at this stretch in both directions"
    if why:
        raise InputError(f"{problem}: {name} = {stretch:g}: {why}; lower {name}")


def require_stretched(problem: str, law: Chosen, delta1: float, name: str) -> None:
    """Refuse an axial pre-stretch of a tube on disks of its contracted radius (:func:`require_bearable`).

    Its circumferential stretch is that of an incompressible law in uniaxial tension, ``1/sqrt(delta1)``. A
    compressible law may not be defined there, though it is for a circumference that keeps its length; and its
    own width is another one (:func:`require_width`).
    """
    require_bearable(problem, law, delta1, delta1**-0.5, name)
    require_width(problem, law, delta1, name)


def require_bearable(problem: str, law: Chosen, l1: float, l2: float, name: str) -> None:
    """Refuse an axial pre-stretch at which a law has stresses without measure.

    Args:
        problem: Name of the problem, for the message.
        law: The law.
        l1: The pre-stretch.
        l2: Circumferential stretch with it.
        name: The parameter of the pre-stretch.

    Raises:
        InputError: With a message that names the parameter.
    """
    if law.model == MOONEY_RIVLIN:
        return
    stress = stressed(law, l1, l2)
    if not np.isfinite(stress):
        raise InputError(
            f"{problem}: {name} = {l1:g} alone stretches the membrane beyond what model = {law.model!r} with "
            f"these constants allows; lower {name}, or choose constants that allow more"
        )
    if stress > LARGEST:
        raise InputError(
            f"{problem}: {name} = {l1:g}: model = {law.model!r} has stresses of more than {LARGEST:g} times "
            f"its stiffness at rest; lower {name}, or the exponents"
        )


NARROWEST = 0.05
"""Width, over that at rest, down to which the natural width of a compressible law is sought."""


def require_width(problem: str, law: Chosen, delta: float, name: str) -> None:
    """Refuse an axial pre-stretch at which a tube of a compressible law is not stable without load.

    Between the width at rest, at its rings, and its natural width, where ``w,2 = 0``, the law must be defined
    and resist a change of the width: ``w,22 > 0``. If it does not, the tube narrows without bound, or folds
    around its axis as finely as any mesh allows. At the natural width the force of a strip must grow with the
    stretch: ``w,11 w,22 > w,12^2``. Beyond its largest force a tube necks at one place.

    Args:
        problem: Name of the problem, for the message.
        law: The law; an incompressible one has the width ``delta^(-1/2)`` and is not looked at.
        delta: The pre-stretch.
        name: The parameter of the pre-stretch.

    Raises:
        InputError: With a message that names the parameter.
    """
    if MATERIALS[law.model].incompressible:
        return
    why = ""
    for width in np.geomspace(1.0, NARROWEST, POINTS // 4).tolist():
        here = evaluated(law, delta, width)
        if not here["W22"] > 0:
            why = f"does not resist a change of its width where that is {width:.2g} of the width at rest"
        elif here["W2"] <= 0 and here["W11"] * here["W22"] <= here["W12"] ** 2:
            why = "bears less force the more it is stretched, and a tube of it necks at one place"
        if why or here["W2"] <= 0:
            break
    if why:
        raise InputError(
            f"{problem}: {name} = {delta:g}: at this pre-stretch, without load, a strip of model = "
            f"{law.model!r} {why}; lower {name}, or choose another law or its constants"
        )


Uneven = float | tuple[Thickness, float]
"""A thickness: ``M`` of a linear one, or one given as text and the length of the meridian."""

FARTHEST, STRETCHES, POINTS = 1e7, 2000, 400
"""Largest stretch of a law whose force is looked at, number of stretches up to it, points along a tube."""


@lru_cache(maxsize=256)
def _uniaxial(law: Chosen) -> tuple[np.ndarray, np.ndarray]:
    """Stretches up to the first one at which a law has no force, and the largest force up to each of them."""
    stretches = np.geomspace(1.0, FARTHEST, STRETCHES)
    force = np.array([evaluated(law, l1, l1**-0.5)["W1"] for l1 in stretches])
    defined = np.logical_and.accumulate(np.isfinite(force))
    return stretches[defined], np.maximum.accumulate(force[defined])


def unloaded_heights(law: Chosen, M: float, delta: float, s: np.ndarray) -> np.ndarray:
    r"""Heights along an unloaded tube of linear thickness in uniaxial tension, of one force everywhere.

    .. math:: z(S) = \int_0^S f^{-1}\left(\frac{N}{h(S)}\right) \mathrm{d}S, \qquad z(1) = \delta

    with the force per thickness of :func:`mean_stretch_limit`.

    Args:
        law: An incompressible law.
        M: Thickness at the lower end over its mean; ``2 - M`` at the upper one.
        delta: Mean stretch.
        s: Places along the undeformed tube, ascending, over its length.

    Returns:
        Heights at these places over that length, zero at the first one.

    Raises:
        ConvergenceError: If the law does not take this stretch.
    """
    stretches, forces = _uniaxial(law)
    lengths, middle = np.diff(s), (s[1:] + s[:-1]) / 2
    thickness = M + 2 * (1 - M) * middle

    def stretched(force: float) -> np.ndarray:
        return np.interp(force / thickness, forces, stretches) * lengths

    most = float(forces[-1] * thickness.max())
    if stretched(most).sum() < delta * (s[-1] - s[0]):
        raise ConvergenceError(f"no force stretches model = {law.model!r} by delta = {delta:g}")
    force = bisect(lambda n: stretched(n).sum() / (s[-1] - s[0]) - delta, 0.0, most, rtol=1e-10)
    return np.concatenate([[0.0], np.cumsum(stretched(force))])


@lru_cache(maxsize=256)
def mean_stretch_limit(law: Chosen, thickness: Uneven) -> float:
    r"""Largest mean stretch of a tube of uneven thickness in uniaxial tension; infinite if a law locks.

    Without load the force is the same along the tube. If the law's force per thickness
    :math:`f(\lambda) = w_{,1}(\lambda, \lambda^{-1/2})` is bounded, the thinnest place limits the
    force, and the stretch elsewhere follows from it (:math:`h` is linear from :math:`M` to :math:`2 - M`):

    .. math:: \bar\lambda = \int_0^1 f^{-1}\left(\frac{h_{min}}{h(S)} \max f\right) \mathrm{d}S

    Args:
        law: An incompressible law.
        thickness: Thickness at one end over its mean, between which it is linear; or any, with the length.
    """
    stretches, force = _uniaxial(law)
    if len(stretches) < STRETCHES:
        return float("inf")
    s = (np.arange(POINTS) + 0.5) / POINTS
    if isinstance(thickness, tuple):
        own, length = thickness
        found, weight = own.at(length * s, L=length), 1.0
        thin = float(own.at(np.linspace(0.0, length, PLACES), L=length).min())
    else:
        thin, thick = sorted((thickness, 2.0 - thickness))
        # With S = s^3 from the thin end the integrand is smooth where the stretch has no bound.
        found, weight = thin + (thick - thin) * s**3, 3 * s**2
    return float(np.mean(weight * np.interp(force[-1] * thin / found, force, stretches)))


def require_carried(problem: str, law: Chosen, delta: float, thickness: Uneven) -> None:
    """Refuse an axial pre-stretch that a tube of uneven thickness has at no force.

    Raises:
        InputError: With a message that names both parameters.
    """
    if law.model == MOONEY_RIVLIN:
        return
    most = mean_stretch_limit(law, thickness)
    if delta > most:
        linear = not isinstance(thickness, tuple)
        uneven = f"M = {thickness:g}" if linear else f"thickness = {thickness[0].text!r}"
        thin, even = ("end", "bring M closer to 1") if linear else ("place", "choose a more even thickness")
        raise InputError(
            f"{problem}: delta = {delta:g}: with model = {law.model!r} and {uneven} the thin {thin} gives "
            f"way: no force stretches the membrane by more than {most:.4g} in the mean; lower delta, "
            f"or {even}"
        )


BOUNDED, WIDEST_BOUNDED, HIGHEST_BOUNDED = 1e-3, 1.0, 1.0
"""A force that grows by less than this fraction over the last decade of stretches is bounded. The largest
radius of disks, over that of the undeformed tube, between which a membrane of such a law is clamped, and the
largest deflection of a sheet of such a law, over half its width, if it bears compression."""


def has_bounded_force(law: Chosen, across: float = 1.0) -> bool:
    """Whether the force of a law hardly grows with the stretch, at a stretch across it."""
    if law.model == MOONEY_RIVLIN:
        return False
    before, last = (evaluated(law, l1, across)["W1"] for l1 in (FARTHEST / 10, FARTHEST))
    return bool(np.isfinite(last) and last < (1 + BOUNDED) * before)


def require_held(problem: str, law: Chosen, radius: float | str) -> None:
    """Refuse disks at which the force of a law is not large enough, because it is bounded.

    Towards a disk wider than the tube the meridian turns away from the axis, and the component of its force
    along the axis stays the same. The force therefore grows and, if it cannot, the stretch beyond all bounds.

    Args:
        problem: Name of the problem, for the message.
        law: The law.
        radius: Radius of the disks over that of the undeformed tube; text if it is to be found.

    Raises:
        InputError: With a message that names the radius and what is allowed.
    """
    if not isinstance(radius, str) and radius > WIDEST_BOUNDED and has_bounded_force(law, radius):
        raise InputError(
            f"{problem}: Af = {radius:g}: the force of model = {law.model!r} is bounded, and the membrane "
            f"gives way where it widens to such disks; allowed with this law: Af up to {WIDEST_BOUNDED:g}"
        )


def require_low(problem: str, law: Chosen, height: float, relaxed: bool) -> None:
    """Refuse high sheets of a law of bounded force that bears compression: many modes grow at once there.

    Args:
        problem: Name of the problem, for the message.
        law: The law.
        height: Largest deflection over half the width.
        relaxed: Whether the energy is relaxed.

    Raises:
        InputError: With a message that names the deflection and what is allowed.
    """
    if not relaxed and height > HIGHEST_BOUNDED and has_bounded_force(law):
        raise InputError(
            f"{problem}: w_end = {height:g}: the force of model = {law.model!r} is bounded, and many modes "
            f"of a high sheet grow at once; allowed with energy = 'full': w_end up to {HIGHEST_BOUNDED:g}"
        )
