"""The errors the suite raises on purpose, each with the exit status it ends a command with."""

from __future__ import annotations


class WeakformsError(Exception):
    """Base of all deliberate errors; the message is one line a user can act on."""

    exit_status = 1


class InputError(WeakformsError):
    """An unknown name, a value out of range, an unreadable or altered file."""

    exit_status = 2


class ConvergenceError(WeakformsError):
    """A solve ended without a converged state; nothing of it may be shown as a number."""

    exit_status = 3


class EnvironmentLackError(WeakformsError):
    """Something the suite needs is not installed; the message names the command that gets it."""

    exit_status = 4
