"""Declarations of the numbers of a problem: name, meaning, dimension and symbol, each in one place.

The scaling texts of results and pages, the units of :mod:`weakforms.scaling` and the labels of figures all
come from them. Nothing here needs dolfinx.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

DIMENSIONS: dict[str, tuple[tuple[int, int, int], bool]] = {
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
"""Powers of length, modulus and thickness in one unit, and whether ``turn`` is a factor too."""


@dataclass(frozen=True)
class Units:
    """The constants by which the numbers of a problem are divided."""

    length: str = ""
    """Constant by which lengths are divided; empty if no number needs it, like the other two."""
    modulus: str = ""
    """Constant by which stresses are divided; forces per length are divided by it times ``thickness``."""
    thickness: str = ""
    turn: float = 1.0
    """Factor by which energies and volumes are divided too: ``2 pi`` if they are given per radian."""

    @property
    def constants(self) -> tuple[str, ...]:
        """Names of the constants, all in units of one system."""
        return tuple(name for name in (self.length, self.modulus, self.thickness) if name)

    def powers(self, dimension: str) -> dict[str, int]:
        """The constants in one unit of a dimension, modulus first, with their powers."""
        (length, modulus, thickness), _ = DIMENSIONS[dimension]
        named = ((self.modulus, modulus), (self.thickness, thickness), (self.length, length))
        return {name: power for name, power in named if power}

    def turns(self, dimension: str) -> float:
        """The numerical factor of one unit of a dimension."""
        return self.turn if DIMENSIONS[dimension][1] else 1.0

    def unit(self, dimension: str) -> str:
        """One unit in symbols, such as ``C1 h_o/R_f``; empty for a number without one."""
        return self._written(dimension, 1)

    def factor(self, dimension: str) -> str:
        """The factor that makes a number non-dimensional, in symbols, such as ``R_f/(C1 h_o)``."""
        return self._written(dimension, -1)

    def _written(self, dimension: str, sign: int) -> str:
        words: dict[int, list[str]] = {1: [], -1: []}
        if self.turns(dimension) != 1:
            words[sign].append("2 pi")
        for name, power in self.powers(dimension).items():
            words[sign if power > 0 else -sign].append(name if abs(power) == 1 else f"{name}^{abs(power)}")
        above, below = " ".join(words[1]), " ".join(words[-1])
        if not below:
            return above
        return f"{above or '1'}/{below}" if len(words[-1]) == 1 else f"{above or '1'}/({below})"


NO_UNITS = Units()


PLACEHOLDER = re.compile(r"{(?:1/)?(\w+)}")


@dataclass(frozen=True)
class Column:
    """A number of a problem: a column of its branches, a parameter, a quantity, or a column of a field."""

    name: str
    text: str = ""
    """Meaning and scaling. ``over {length}`` names the constant by which lengths are divided, ``times
    {1/pressure}`` the factor that makes pressures non-dimensional, and so on for each of :data:`DIMENSIONS`.
    Without a text the number is not listed."""
    symbol: str = ""
    """TeX without dollars, for figures; by default the name."""
    derived: bool = False
    """Whether a column of a branch follows from the state only, so that no state can be requested by it."""
    dimension: str = ""
    """One of :data:`DIMENSIONS`; by default the one in the text, or a number without a dimension."""
    also: tuple[str, ...] = ()
    """Names of further numbers of this dimension that the text covers."""

    def __post_init__(self) -> None:
        """Take the dimension from the text."""
        stated = PLACEHOLDER.search(self.text)
        object.__setattr__(self, "dimension", self.dimension or (stated[1] if stated else "number"))

    def scale(self, units: Units) -> str:
        """The text with the constants of a problem."""
        known = {dimension: units.unit(dimension) for dimension in DIMENSIONS}
        factors = {f"1/{dimension}": units.factor(dimension) for dimension in DIMENSIONS}
        return self.text.format(**known, **factors)


def numbers(**texts: str) -> tuple[Column, ...]:
    """Declarations of numbers by names and texts."""
    return tuple(Column(name, text) for name, text in texts.items())


def derived(*columns: Column) -> tuple[Column, ...]:
    """The same columns, by which no state can be requested."""
    return tuple(replace(column, derived=True) for column in columns)


DIAGNOSTICS = derived(Column("n_negative"), Column("residual"), Column("iterations"))
"""Columns of every branch that is solved for by Newton's method."""

LAM1 = Column("lam1", "meridional stretch, 1", r"\lambda_1")
LAM2 = Column("lam2", "circumferential stretch, 1", r"\lambda_2")
RHO = Column("rho", "deformed radius over {length}", r"\rho")
T1 = Column("t1", "meridional Cauchy resultant over {resultant}")
T2 = Column("t2", "circumferential Cauchy resultant over {resultant}")
PRESSURE = Column("p", "P {1/pressure}", "p")
VOLUME = Column("V", "enclosed volume over {volume}", "V")
MASS = Column("m", "(p + p_atm) (V + V_r)^kappa, by p and V as given here, 1")
OUTSIDE = Column("p_atm", "absolute pressure outside times {1/pressure}")
RESERVOIR = Column("V_r", "volume of a rigid reservoir, for the part whose volume is V, over {volume}")
POTENTIAL = Column("Pi", "total potential over {energy}")
