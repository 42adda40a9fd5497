"""Conversion between numbers with units and the papers' non-dimensional numbers.

Every paper divides lengths by one radius and forces per length by one stiffness; all other scales follow. A
code that computes in metres and pascals gives its radius, thickness and modulus, and each of its columns is
divided by its scale.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from weakforms.errors import InputError


@dataclass(frozen=True)
class Scaling:
    """The units of the columns of a problem."""

    length: str
    """Constant by which lengths are divided; empty if no column needs it, like the other two."""
    modulus: str
    """Constant by which stresses are divided; forces per length are divided by it times ``thickness``."""
    thickness: str
    kinds: Mapping[str, str]
    """One of :data:`KINDS` for each column; a column that is not listed has no unit."""
    turn: float = 1.0
    """Factor by which energies and volumes are divided too: ``2 pi`` if they are given per radian."""

    @property
    def constants(self) -> tuple[str, ...]:
        """Names of the constants, all in units of one system."""
        return tuple(name for name in (self.length, self.modulus, self.thickness) if name)

    def unit(self, column: str, constants: Mapping[str, float]) -> float:
        """One unit of a column, as a number, from the constants' values.

        Raises:
            InputError: If a constant is missing, not a number or not positive.
        """
        powers, turned = KINDS[self.kinds.get(column, "number")]
        names = (self.length, self.modulus, self.thickness)
        used = {name: power for name, power in zip(names, powers, strict=True) if power}
        values = {name: _constant(name, constants, self) for name in used}
        try:
            unit = math.prod(values[name] ** power for name, power in used.items())
        except OverflowError:
            unit = math.inf
        unit *= self.turn if turned else 1.0
        if not 0 < unit < math.inf:
            stated = ", ".join(f"{name} = {value:g}" for name, value in values.items())
            raise InputError(f"with {stated} a unit of {column} is {unit:g}; it must be positive and finite")
        return unit

    def symbols(self, column: str) -> str:
        """The same unit in symbols, such as ``C1 h_o/R_f``; empty for a column without one."""
        powers, turned = KINDS[self.kinds.get(column, "number")]
        above, below = ["2 pi"] if turned and self.turn != 1 else [], []
        for name, power in zip((self.modulus, self.thickness, self.length), np.roll(powers, -1), strict=True):
            words = above if power > 0 else below
            if power:
                words.append(name if abs(power) == 1 else f"{name}^{abs(power)}")
        if not below:
            return " ".join(above)
        return f"{' '.join(above) or '1'}/{' '.join(below)}"


KINDS: dict[str, tuple[tuple[int, int, int], bool]] = {
    "number": ((0, 0, 0), False),
    "length": ((1, 0, 0), False),
    "curvature": ((-1, 0, 0), False),
    "stress": ((0, 1, 0), False),
    "pressure": ((-1, 1, 1), False),
    "resultant": ((0, 1, 1), False),
    "force": ((1, 1, 1), False),
    "axial": ((1, 1, 1), True),
    "volume": ((3, 0, 0), True),
    "energy": ((2, 1, 1), True),
}
"""Powers of length, modulus and thickness, and whether ``turn`` is a factor too."""


def _of(**columns: str) -> dict[str, str]:
    return {name: kind for kind, names in columns.items() for name in names.split()}


_TUBE = Scaling(
    "R_f",
    "C1",
    "h_o",
    _of(
        pressure="p f_t f_k traction_front traction_max spring_max",
        length="u_max Z rho eta Z_front contact_length",
        resultant="t1_mid t1 t2 line_force line_force_membrane t2_min",
        curvature="kappa",
        volume="V",
        energy="Pi",
    ),
    2 * math.pi,
)
_CIRCULAR = Scaling(
    "R_f",
    "C1",
    "h",
    _of(
        pressure="p sigma sigma_pole sigma_contact",
        length="t0 X X_contact X_iso rho_contact rho eta",
        resultant="t_min G G_difference t1 t2",
        curvature="kappa",
        volume="V",
        energy="Pi",
    ),
    2 * math.pi,
)
_FLUID_TUBE = Scaling(
    "A",
    "mu",
    "H",
    _of(
        length="zw zw_bifurcation zw_bent amplitude r_mid r_max r_front Z_front r_mid_pi "
        "x_quarter_0 x_quarter_pi z_quarter_0 z_quarter_pi "
        "z_min Z r z x y",
        resultant="T1_ring T2_ring T1_mid T2_mid T1 T2 T_min T1_quarter_0 T1_quarter_pi T2_quarter_0 "
        "T2_quarter_pi",
        volume="V V_bifurcation V_bent",
        energy="Pi Pi_bent",
    ),
)
_WRINKLED = Scaling(
    "Ao",
    "C1",
    "h",
    _of(
        pressure="p",
        length="zw r_max Z r z Z_front_1 Z_front_2 Z_front_3 Af_critical",
        resultant="N tension axial",
        volume="V",
        energy="Pi",
    ),
    2 * math.pi,
)

_INFINITE_TUBE = Scaling(
    "R_o",
    "S",
    "h_o",
    _of(pressure="p p_maxwell", axial="force", resultant="Pi"),
    2 * math.pi,
)
_LAW = _of(
    stress=" ".join(
        f"{name}{suffix}"
        for name in ("W", "W1", "W2", "W11", "W12", "W22")
        for suffix in ("", "_relaxed", "_modified")
    )
)
"""Energies per volume, and their derivatives: stresses."""
_SURFACE = Scaling(
    "Ao",
    "C1",
    "h",
    _of(pressure="p", length="zw r_max departure x y z", volume="V", energy="Pi"),
)
_SPHERE = Scaling("r_o", "S", "h_o", _of(pressure="P", resultant="Pi"))
_HEMISPHERE = Scaling(
    "Ao",
    "C1",
    "h",
    _of(
        length="zw z_pole r_max r z",
        force="N",
        resultant="tension axial",
        volume="V",
        energy="Pi",
    ),
    2 * math.pi,
)

SCALINGS: dict[str, Scaling] = {
    "circular": _CIRCULAR,
    "circular_scheme": _CIRCULAR,
    "tube": _TUBE,
    "tube_fold": _TUBE,
    "tube_scheme": _TUBE,
    "fluid_tube": _FLUID_TUBE,
    "wrinkled_tube": _WRINKLED,
    "hemisphere": _HEMISPHERE,
    "sphere": _SPHERE,
    "fluid_tube_coincidence": _FLUID_TUBE,
    "fluid_tube_surface": _FLUID_TUBE,
    "wrinkled_sheet": _WRINKLED,
    "wrinkled_tube_threshold": _WRINKLED,
    "surface": _SURFACE,
    "infinite_tube": _INFINITE_TUBE,
    "homogeneous": Scaling("", "S", "", _of(stress="T Pi")),
    "material": Scaling("", "S", "", _LAW),
    "wrinkled_material": Scaling("", "C1", "", _LAW),
}
"""Scalings by problem; a test compares them with the scalings that the problems state."""


def _constant(name: str, constants: Mapping[str, float], scaling: Scaling) -> float:
    if name not in constants:
        units = "; ".join(_divided(scaling, kind) for kind in _kinds(scaling))
        raise InputError(f"the constant {name} is missing: {units}")
    try:
        value = float(constants[name])
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"constant {name} = {str(constants[name])[:40]!r} is not a number") from None
    if not 0 < value < math.inf:
        raise InputError(f"constant {name} = {value:g} must be positive and finite")
    return value


def _kinds(scaling: Scaling) -> list[str]:
    """Kinds of a problem's columns that have a unit."""
    return [kind for kind in KINDS if kind in scaling.kinds.values()]


def _divided(scaling: Scaling, kind: str) -> str:
    name = next(name for name, found in scaling.kinds.items() if found == kind)
    return f"{kind} is divided by {scaling.symbols(name)}"


def scaling_of(problem: str) -> Scaling:
    """Scaling of a problem.

    Raises:
        InputError: If none is known.
    """
    if problem not in SCALINGS:
        raise InputError(f"no scaling is known of problem {problem!r}; known: {', '.join(SCALINGS)}")
    return SCALINGS[problem]


def nondimensional(
    problem: str, columns: Mapping[str, Sequence[float]], **constants: float
) -> dict[str, np.ndarray]:
    """Convert columns with units to the paper's numbers: each is divided by its unit.

    Args:
        problem: Problem whose scaling applies, such as ``"tube"``.
        columns: Columns by the problem's names; columns with other names are not changed.
        **constants: Radius, modulus and thickness by the paper's symbols, such as ``R_f``, ``C1``, ``h_o``.

    Raises:
        InputError: If the problem has no scaling, or a constant is missing, unknown or not positive.
    """
    return _converted(problem, columns, constants, -1)


def dimensional(
    problem: str, columns: Mapping[str, Sequence[float]], **constants: float
) -> dict[str, np.ndarray]:
    """Convert the paper's numbers to numbers with units: the inverse of :func:`nondimensional`."""
    return _converted(problem, columns, constants, 1)


def _converted(
    problem: str, columns: Mapping[str, Sequence[float]], constants: Mapping[str, float], power: int
) -> dict[str, np.ndarray]:
    scaling = scaling_of(problem)
    unknown = sorted(set(constants) - set(scaling.constants))
    if unknown:
        raise InputError(
            f"{problem} has no constant {unknown[0]!r}; its scaling takes {', '.join(scaling.constants)}"
        )
    for name in constants:
        _constant(name, constants, scaling)
    return {
        name: np.asarray(values, dtype=float) * scaling.unit(name, constants) ** power
        for name, values in columns.items()
    }
