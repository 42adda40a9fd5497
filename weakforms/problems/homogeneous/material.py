"""Problem ``material``: a law at two stretches, its full and its relaxed energy."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from weakforms.errors import InputError
from weakforms.forms.materials import MATERIALS
from weakforms.problems.homogeneous.about import MATERIAL
from weakforms.problems.homogeneous.material_point import (
    LARGEST,
    NAMES,
    STATES,
    by_metric,
    evaluated,
    stressed,
)
from weakforms.problems.material_choice import Chosen, MaterialChoice
from weakforms.problems.problem import Numerics, Problem, Requests, Task
from weakforms.results import Quantity, Result

ROUND_OFF = 1e-13
"""Relative uncertainty of an expression evaluated at a point, including cancellation in second
derivatives."""


SUFFIXES = {"full": "", "relaxed": "_relaxed", "modified_gradient": "_modified"}
"""Endings of the names of each energy's quantities."""


class MaterialParameters(MaterialChoice):
    """A law and the two principal stretches at which it is evaluated."""

    l1: float = Field(1.5, gt=0, le=100, description="principal stretch 1")
    l2: float = Field(1.5, gt=0, le=100, description="principal stretch 2")
    turn: float = Field(
        0.0, ge=-4, le=4, description="angle of the coordinates of W_metric with direction 1, rad"
    )
    skew: float = Field(0.0, ge=-2, le=2, description="shear of the coordinates of W_metric")
    tilt: float = Field(
        0.0, ge=-4, le=4, description="angle by which the sheet of W_metric is turned in space"
    )


class MaterialProblem(Problem):
    """Energy, stresses and tangent of every law of chapter 3."""

    about = MATERIAL
    parameters = MaterialParameters
    numerics = Numerics
    materials = MATERIALS
    """Text for ``weakforms show``: the laws, their constants and sources."""

    @property
    def scales(self) -> dict[str, str]:
        """Scaling of the numbers, and the stress of each law."""
        states = ", ".join(f"{i}: {name}" for i, name in enumerate(STATES))
        stresses = {name: f"stress S: {material.scale}" for name, material in MATERIALS.items()}
        return {**super().scales, "state": states, **stresses}

    def check(self, parameters: MaterialParameters, requests: Requests) -> None:
        """Refuse requests for states, and stretches at which the law is not defined.

        Raises:
            InputError: If the stretches are beyond a law's full extension, or its thickness would vanish.
        """
        super().check(parameters, requests)
        require_defined(self.name, parameters, parameters.l1, parameters.l2, "l1, l2")

    def fill(self, result: Result, task: Task) -> None:
        """Evaluate the expressions of the forms."""
        parameters, progress = task.parameters, task.progress
        progress("energy", 0, 1)
        found = {}
        for energy, suffix in SUFFIXES.items():
            values = evaluated(parameters.material, parameters.l1, parameters.l2, energy)
            found |= {name + suffix: values[name] for name in NAMES}
        coordinates = parameters.turn, parameters.skew, parameters.tilt
        found |= by_metric(parameters.material, parameters.l1, parameters.l2, coordinates)
        result.quantities |= {k: Quantity(v, ROUND_OFF * max(1.0, abs(v))) for k, v in found.items()}
        result.quantities["state"] = Quantity(values["state"])


def require_defined(
    problem: str, parameters: MaterialChoice, l1: float, l2: float, what: str, energy: str = "full"
) -> None:
    """Refuse stretches at which the chosen law is not defined, or its energy with wrinkling is not.

    Raises:
        InputError: With a message that names them.
    """
    values = evaluated(parameters.material, l1, l2, energy)
    if not all(np.isfinite(values[name]) for name in NAMES):
        raise InputError(
            f"{problem}: model = {parameters.model!r} is not defined at {what} = {l1:g}, {l2:g} "
            "(beyond full extension, or without thickness); smaller stretches are allowed"
        )


def require_reachable(problem: str, parameters: MaterialChoice, l1: float, l2: float, what: str) -> None:
    """Refuse stretches that no branch from rest reaches: beyond a law's end, or under too large stresses.

    A harmonic membrane has no thickness between two equal stretches, and is defined again beyond them.

    Raises:
        InputError: With a message that names them.
    """
    require_defined(problem, parameters, l1, l2, what)
    most = _defined_up_to(parameters.material, l1, l2)
    if most < 1:
        end = 1 + most * ((l2 if l1 == 1 else l1) - 1)
        raise InputError(
            f"{problem}: model = {parameters.model!r} is not defined between rest and {what} = {l1:g}, "
            f"{l2:g} (beyond full extension, or without thickness); set lam_end not beyond {end:.4g}"
        )
    if stressed(parameters.material, l1, l2) > LARGEST:
        raise InputError(
            f"{problem}: model = {parameters.model!r} has stresses of more than {LARGEST:g} times its "
            f"stiffness at rest at {what} = {l1:g}, {l2:g}; choose a lam_end nearer to 1, "
            "or smaller exponents"
        )


STEPS_FROM_REST = 200
"""Number of places between rest and a pair of stretches at which a law must be defined."""


def _defined_up_to(chosen: Chosen, l1: float, l2: float) -> float:
    """Fraction of the way from rest to a pair of stretches on which a law is defined from its start."""

    def defined(share: float) -> bool:
        values = evaluated(chosen, 1 + share * (l1 - 1), 1 + share * (l2 - 1))
        return all(np.isfinite(values[name]) for name in NAMES)

    shares = np.linspace(0.0, 1.0, STEPS_FROM_REST).tolist()
    beyond = next((k for k, share in enumerate(shares) if not defined(share)), None)
    if beyond is None:
        return 1.0
    low, high = shares[beyond - 1 : beyond + 1]
    while high - low > 1e-4 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if defined(middle) else (low, middle)
    return low


MOST_STRETCHED, PLACES = 100.0, 400
"""Largest stretch, and least shortening, at which the force of a strip is looked at; number of stretches."""

NARROWEST = 0.01
"""Width, over that at rest, at which a strip of a compressible law has vanished; that of an incompressible
one is ten times this at the largest stretch."""


def bearable_force(chosen: Chosen, sign: float) -> float:
    r"""The largest force that a strip bears in uniaxial tension or, as a negative number, in compression.

    .. math:: F(\lambda) = w_{,1}(\lambda, \lambda_2(\lambda)), \qquad w_{,2}(\lambda, \lambda_2) = 0

    Args:
        chosen: The law.
        sign: 1 for tension, -1 for compression.

    Returns:
        ``F`` at its first limit along the way from rest, where the strip has no width any more, or at a
        hundredfold stretch; infinite for a law that locks before.
    """
    constants, found = dict(chosen.constants), 0.0
    for stretch in np.geomspace(1.0, MOST_STRETCHED**sign, PLACES)[1:].tolist():
        across = float(chosen.material.width(stretch, **constants))
        force = evaluated(chosen, stretch, across)["W1"]
        if not np.isfinite(force):
            return sign * np.inf
        if sign * (force - found) < 0 or across < NARROWEST:
            break
        found = force
    return found


def require_borne(problem: str, chosen: Chosen, force: float) -> None:
    """Refuse an axial force that no strip of a law bears.

    Raises:
        InputError: With a message that names the force and what is allowed.
    """
    if force == 0:
        return
    most = bearable_force(chosen, float(np.sign(force)))
    if abs(force) > abs(most):
        kind = "tension" if force > 0 else "compression"
        raise InputError(
            f"{problem}: force = {force:g}: model = {chosen.model!r} with these constants bears no more than "
            f"{most:.4g} in {kind}; choose a force nearer to 0, or a stiffer law"
        )
