"""How the history of a stuck patch is looked for, on a membrane that is stood in for."""

from types import SimpleNamespace

import pytest

from weakforms.errors import ConvergenceError
from weakforms.problems.contact import phases
from weakforms.problems.contact.phases import ContactPhases

FRONT = 0.27
"""Front that is reached at the last pressure."""


class Stretched(ContactPhases):
    """From states without friction a history is found for short patches only, from a shorter one always."""

    name, whole, last_front = "membrane", "radius", 0.97
    p_end, data = 1.0, SimpleNamespace(length=1.0)
    frictionless = SimpleNamespace(points=[SimpleNamespace(monitors={}, state=None)])

    def __init__(self, found_up_to: float) -> None:
        self.found_up_to = found_up_to

    def _slipping_span(self) -> float:
        return FRONT

    def _history(self, span: float, before: object) -> SimpleNamespace:
        if before is None and span > self.found_up_to:
            raise ConvergenceError("not found")
        return SimpleNamespace(model=None, span=span)

    def _follow(self, _model: object, _begin: object) -> SimpleNamespace:
        state = SimpleNamespace(loads={"front": FRONT})
        point = SimpleNamespace(state=state)
        ends = {"crossings": lambda *_: [0], "at": lambda *_: point, "end_at": lambda *_: None}
        return SimpleNamespace(points=[point], **ends)


def test_a_history_that_is_found_for_a_short_patch_first_grows_to_the_whole_one(monkeypatch):
    """A pole of a law that locks, stretched 65 times: eight spans are too long, and six more lead back."""
    monkeypatch.setattr(phases, "stick_guess", lambda *_: None)
    assert Stretched(0.15).history.span >= FRONT
    with pytest.raises(ConvergenceError, match=r"is not found up to a front at .* lower p_end, or k"):
        _ = Stretched(0.0).history
