"""Objects without what their constructors compute, and the errors that are wanted of them."""

import pytest

from weakforms.errors import ConvergenceError


def bare(kind, **attributes):
    """An object of a class without what its constructor computes."""
    made = kind.__new__(kind)
    vars(made).update(attributes)
    return made


def refused(what, call, *given, **named):
    """The call ends with a ConvergenceError, and these words."""
    with pytest.raises(ConvergenceError, match=what):
        call(*given, **named)


def always(answer):
    """A function that gives the same answer to everything."""
    return lambda *_given, **_named: answer


def raising(error):
    """A function that raises an error whatever it is asked."""

    def call(*_given, **_named):
        raise error

    return call
