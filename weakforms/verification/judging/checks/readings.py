"""Explanations of a printed number by a computed one: reproduced, cut off, from a grid, or a misprint."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, Decimal
from typing import ClassVar

MARGIN = 10
"""Every explanation but "reproduced" needs an uncertainty that is smaller than the deciding distance (half a
printed digit, or the distance within which an input is decoded) by this factor. A large uncertainty then
never proves a misprint."""


class Reading(ABC):
    """Explanation of a printed number that is not the computed one rounded to its digits."""

    status: ClassVar[str]
    """Name in the ledger."""

    @abstractmethod
    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether every number within its small uncertainty would be printed like this."""

    @abstractmethod
    def explained(self) -> str:
        """The explanation in words."""

    def proven(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether a number is accurate enough to prove an explanation.

        Its uncertainty must be ``MARGIN`` times smaller than half a unit of the last printed digit.
        """
        half = float(Decimal(1).scaleb(Decimal(printed).as_tuple().exponent)) / 2
        known = math.isfinite(value) and 0 <= uncertainty <= half / MARGIN
        return known and self.fits(value, uncertainty, printed)


@dataclass(frozen=True)
class CutOff(Reading):
    """Digits were cut off, not rounded."""

    status: ClassVar[str] = "cut off"

    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether both ends of its range are cut off to the printed number."""
        unit = Decimal(printed)
        return all(end.quantize(unit, rounding=ROUND_DOWN) == unit for end in _ends(value, uncertainty))

    def explained(self) -> str:
        """The explanation in words."""
        return "the digits are cut off, not rounded"


@dataclass(frozen=True)
class OnGrid(Reading):
    """A scan was stopped at a value of its grid."""

    step: str
    """Step of the grid; the printed number is a multiple of it."""
    upwards: bool
    """Whether the computed number lies less than a step above the printed one; otherwise below it."""

    status: ClassVar[str] = "grid of a scan"

    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether the printed number is on the grid, and the computed one less than a step beside it."""
        unit, step = Decimal(printed), Decimal(self.step)
        ends = _ends(value, uncertainty)
        away = [(end - unit) if self.upwards else (unit - end) for end in ends]
        return unit % step == 0 and all(0 < distance < step for distance in away)

    def explained(self) -> str:
        """The explanation in words."""
        side = "above" if self.upwards else "below"
        return f"a value of a grid of {self.step} is printed; the number is less than a step {side} it"


@dataclass(frozen=True)
class Misprint(Reading):
    """A printed number that is wrong."""

    correct: str
    """The correct number with all digits, to which the computed number must round."""
    why: str

    status: ClassVar[str] = "misprint"

    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether the computed number rounds to the correct one."""
        return rounds_to(value, uncertainty, self.correct)

    def explained(self) -> str:
        """The explanation in words."""
        return f"should be {self.correct}: {self.why}"


def rounds_to(value: float, uncertainty: float, printed: str) -> bool:
    """Whether every number within the uncertainty rounds to all printed digits."""
    unit = Decimal(printed)
    if not (abs(value) + uncertainty < 1e9 and uncertainty >= 0):  # a NaN does not
        return False
    return all(end.quantize(unit, rounding=ROUND_HALF_EVEN) == unit for end in _ends(value, uncertainty))


def _ends(value: float, uncertainty: float) -> list[Decimal]:
    """Both ends of the range of a number."""
    return [Decimal(end) for end in (value - uncertainty, value + uncertainty)]


def decoding(value: float, uncertainty: float, searched: tuple[float, ...], within: float) -> str:
    """Whether an input is one of the searched round values, none of them, or outside of the search.

    It is none of them only if it lies between two searched values. A number whose uncertainty is not
    ``MARGIN`` times smaller than the distance for a round value is not judged.
    """
    near = min(searched, key=lambda known: abs(value - known))
    distance = within * abs(near)
    if not 0 <= uncertainty <= distance / MARGIN:
        return "input, not judged"
    if abs(value - near) + uncertainty <= distance:
        return "input, decoded"
    between = searched[0] < value < searched[-1] and abs(value - near) - uncertainty > distance
    return "input, not decoded" if between else "input, not judged"
