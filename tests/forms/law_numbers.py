"""Energy and derivatives of a law with its default constants."""

import numpy as np

from weakforms.forms.materials import MATERIALS
from weakforms.problems.homogeneous.material_point import NAMES, evaluated
from weakforms.problems.material_choice import Chosen


def default(model: str) -> Chosen:
    return Chosen(model, tuple((n, c.default) for n, c in MATERIALS[model].constants.items()))


def numbers(model: str, a: float, b: float, energy: str = "full") -> np.ndarray:
    found = evaluated(default(model), a, b, energy)
    return np.array([found[n] for n in NAMES])
