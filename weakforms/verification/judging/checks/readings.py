"""What a printed number is shown to be beside a computed one: reproduced, or what else came about."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_EVEN, Decimal
from typing import ClassVar

PROVEN = 10
"""How many times an uncertainty must fit into what it decides on (half a printed digit, the distance within
which an input counts as decoded) before anything but "reproduced" is said: less than a tenth of a distance
is left to chance then, and no wide bar proves a misprint."""


class Reading(ABC):
    """How a printed number came about that is not the computed one rounded to its digits."""

    status: ClassVar[str]
    """What the ledger calls it."""

    @abstractmethod
    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether a number anywhere within its uncertainty, which is small, would be printed like this."""

    @abstractmethod
    def explained(self) -> str:
        """The reading in words."""

    def proven(self, value: float, uncertainty: float, printed: str) -> bool:
        """Whether a number proves how a printed one came about.

        Its uncertainty must be ``PROVEN`` times smaller than half a unit of the last printed digit.
        """
        half = float(Decimal(1).scaleb(Decimal(printed).as_tuple().exponent)) / 2
        known = math.isfinite(value) and 0 <= uncertainty <= half / PROVEN
        return known and self.fits(value, uncertainty, printed)


@dataclass(frozen=True)
class CutOff(Reading):
    """Digits were cut off, not rounded."""

    status: ClassVar[str] = "cut off"

    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """Both ends of its range are cut off to the printed number."""
        unit = Decimal(printed)
        return all(end.quantize(unit, rounding=ROUND_DOWN) == unit for end in _ends(value, uncertainty))

    def explained(self) -> str:
        """The reading in words."""
        return "the digits are cut off, not rounded"


@dataclass(frozen=True)
class OnGrid(Reading):
    """A scan was stopped at a value of its grid."""

    step: str
    """Step of the grid; the printed number is a multiple of it ..."""
    upwards: bool
    """... and the number itself lies above the printed one, less than a step away; or below it."""

    status: ClassVar[str] = "grid of a scan"

    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """The printed number is on the grid, and the computed one less than a step on the stated side."""
        unit, step = Decimal(printed), Decimal(self.step)
        ends = _ends(value, uncertainty)
        away = [(end - unit) if self.upwards else (unit - end) for end in ends]
        return unit % step == 0 and all(0 < distance < step for distance in away)

    def explained(self) -> str:
        """The reading in words."""
        side = "above" if self.upwards else "below"
        return f"printed is a value of a grid of {self.step}; the number is less than a step {side} it"


@dataclass(frozen=True)
class Misprint(Reading):
    """A printed number that is wrong."""

    correct: str
    """What should be printed, with all digits: the computed number must round to it."""
    why: str

    status: ClassVar[str] = "misprint"

    def fits(self, value: float, uncertainty: float, printed: str) -> bool:
        """The computed number rounds to what should be printed."""
        return rounds_to(value, uncertainty, self.correct)

    def explained(self) -> str:
        """The reading in words."""
        return f"should be {self.correct}: {self.why}"


def rounds_to(value: float, uncertainty: float, printed: str) -> bool:
    """Whether a number, anywhere within its uncertainty, rounds to all printed digits."""
    unit = Decimal(printed)
    if not (abs(value) + uncertainty < 1e9 and uncertainty >= 0):  # nor does anything that is not a number
        return False
    return all(end.quantize(unit, rounding=ROUND_HALF_EVEN) == unit for end in _ends(value, uncertainty))


def _ends(value: float, uncertainty: float) -> list[Decimal]:
    """Both ends of where a number may lie."""
    return [Decimal(end) for end in (value - uncertainty, value + uncertainty)]


def decoding(value: float, uncertainty: float, searched: tuple[float, ...], within: float) -> str:
    """Whether an input is one of the round values searched, none of them, or was not searched for at all.

    It is none of them only between two that were searched; and nothing is said of a number whose uncertainty
    is not ``PROVEN`` times smaller than the distance within which a round value counts.
    """
    near = min(searched, key=lambda known: abs(value - known))
    distance = within * abs(near)
    if not 0 <= uncertainty <= distance / PROVEN:
        return "input, not judged"
    if abs(value - near) + uncertainty <= distance:
        return "input, decoded"
    between = searched[0] < value < searched[-1] and abs(value - near) - uncertainty > distance
    return "input, not decoded" if between else "input, not judged"
