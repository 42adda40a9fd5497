"""Numbers with their uncertainties as text."""

from __future__ import annotations

from math import ceil, floor, isfinite, log10

DIGITS = 15
"""Significant digits that a number of double precision has."""

SMALL, LARGE = 1e-4, 1e6
"""Numbers outside of these magnitudes are written with an exponent."""


def uncertain(value: float, uncertainty: float | None) -> str:
    """A number whose last two digits are uncertain: ``2.018852029(20)`` for 2.018852029 +- 0.000000020.

    The uncertainty is rounded up. A number without an uncertainty has up to twelve digits.
    """
    if not uncertainty or not isfinite(uncertainty) or not isfinite(value):
        return f"{value:.12g}"
    size = max(abs(value), uncertainty)
    if not SMALL <= size < LARGE:
        power = floor(log10(size))
        scale = 10.0**power
        return f"{_fixed(value / scale, uncertainty / scale)}e{power:+03d}"
    return _fixed(value, uncertainty)


def _fixed(value: float, uncertainty: float) -> str:
    places = 1 - floor(log10(uncertainty))
    places = min(places, DIGITS - 1 - floor(log10(max(abs(value), uncertainty))))
    last = _last_digits(uncertainty, places)
    if last >= 100:  # rounded up to a further digit
        places -= 1
        last = _last_digits(uncertainty, places)
    if places < 0:
        return f"{round(value, places):.0f}({last * 10**-places})"
    return f"{value:.{places}f}({last})"


def _last_digits(uncertainty: float, places: int) -> int:
    return max(1, ceil(round(uncertainty * 10.0**places, 6)))
