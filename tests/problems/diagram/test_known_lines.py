"""Whether a critical point of a primary branch lies on a line that was followed from another one."""

from types import SimpleNamespace

import numpy as np
import pytest

from weakforms.problems.diagram.lines import SAME, LinesOnMesh


class Line:
    """A line that passes ``alpha = 0.1`` twice, at two places."""

    places = (1.0, 1.8), (2.5, 1.6)

    def crossings(self, vary: str, value: float) -> np.ndarray:
        """Its two passages."""
        assert (vary, value) == ("alpha", 0.1)
        return np.arange(2)

    def interpolated(self, i: int, _vary: str, value: float) -> SimpleNamespace:
        """The place of one of them."""
        return state(*self.places[i], value)


def state(depth: float, p: float, alpha: float = 0.1) -> SimpleNamespace:
    return SimpleNamespace(loads={"alpha": alpha}, columns={"u_max": depth, "p": p})


@pytest.mark.parametrize(
    ("depth", "p", "on_line"),
    [
        (1.0, 1.8, True),
        (2.5 + SAME, 1.6, True),
        (2.5 + 10 * SAME, 1.6, False),
        (1.0, 1.6, False),
    ],
)
def test_a_point_is_on_a_line_if_it_is_at_one_of_its_places(depth, p, on_line):
    lines = object.__new__(LinesOnMesh)
    lines.window, lines.depth = SimpleNamespace(vary="alpha", load="p"), "u_max"
    lines._columns = lambda state: state.columns
    assert lines.has(Line(), state(depth, p)) is on_line
