"""The errors that the suite raises on purpose, each with the exit status of the command."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import SequenceMatcher, get_close_matches
from itertools import groupby


class WeakformsError(Exception):
    """Base of all deliberate errors; the message is one line that tells the user what to do."""

    exit_status = 1


class InputError(WeakformsError):
    """An unknown name, a value out of range, an unreadable or altered file."""

    exit_status = 2


class AbsentError(InputError):
    """What was asked for is not there; a result says so, or a request that needs it is refused.

    Args:
        what: What was asked for.
        reason: What was searched, and what to change.
    """

    def __init__(self, what: str, reason: str) -> None:
        super().__init__(reason)
        self.what = what

    def __reduce__(self) -> tuple:
        return type(self), (self.what, str(self))  # as it comes back from a worker


class ConvergenceError(WeakformsError):
    """A solve ended without a converged state; no number of it may be shown."""

    exit_status = 3


class EnvironmentLackError(WeakformsError):
    """Something that the suite needs is not installed; the message names the command that installs it."""

    exit_status = 4


EXTRAS = {
    **dict.fromkeys(("matplotlib", "jinja2", "markupsafe"), "pictures"),
    **dict.fromkeys(("markdown_it", "mdit_py_plugins"), "docs"),
}
"""Packages that a plain ``pip install weakforms`` leaves out, with the extra that brings them."""


def lacking(error: ImportError) -> EnvironmentLackError | None:
    """The error of a package that an extra of this package brings; None for any other import that failed."""
    package = (error.name or "").partition(".")[0]
    if package not in EXTRAS:
        return None
    return EnvironmentLackError(
        f"{package} is not installed here. Get it with: pip install 'weakforms[{EXTRAS[package]}]' "
        f"(or use ./run, which has everything)"
    )


def closest(name: object, known: Iterable[str]) -> str:
    """The known name that is most like a wrong one; of equally like ones that with its first letter.

    It is empty if none is like it.
    """
    by_lower, wrong = {word.lower(): word for word in known}, str(name).lower()

    def likeness(word: str) -> tuple[float, bool]:
        return SequenceMatcher(None, word, wrong).ratio(), word[:1] == wrong[:1]

    found = get_close_matches(wrong, list(by_lower), n=3, cutoff=0.6)
    return by_lower[max(found, key=likeness)] if found else ""


MANY = 6
"""Number of neighbours that differ in numbers only from which a message names the first and the last."""


def _in_short(names: list[str]) -> list[str]:
    """Names for a message; of ``Lambda_n0_1``, ``Lambda_n0_2`` and so on the first and the last."""
    out: list[str] = []
    for _, group in groupby(names, key=lambda name: re.sub(r"\d+", "", name)):
        alike = list(group)
        out += [f"{alike[0]} to {alike[-1]}"] if len(alike) >= MANY else alike
    return out


def not_among(name: object, known: Iterable[str], has: str = "it has") -> str:
    """The end of a message on a wrong name: a similar one, if there is one, and all that are known.

    Either ``"; it has p, V"`` or ``"; did you mean 'V'? It has p, V"``.
    """
    names = list(known)
    listed = f"{has} {', '.join(_in_short(names)) or 'none'}"
    similar = closest(name, names)
    return f"; did you mean {similar!r}? {listed[0].upper()}{listed[1:]}" if similar else f"; {listed}"
