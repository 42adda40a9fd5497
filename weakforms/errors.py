"""The errors that the suite raises on purpose, each with the exit status of the command."""

from __future__ import annotations


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


class ConvergenceError(WeakformsError):
    """A solve ended without a converged state; no number of it may be shown."""

    exit_status = 3


class EnvironmentLackError(WeakformsError):
    """Something that the suite needs is not installed; the message names the command that installs it."""

    exit_status = 4
