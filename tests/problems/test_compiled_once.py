"""Sizes and meshes are data: the forms of a problem are compiled once for all of them."""

import pytest

from weakforms import solve
from weakforms.solvers.support import jit_cache


@pytest.mark.parametrize(
    ("problem", "one", "other"),
    [
        ("torus", {"b": 0.3}, {"b": 0.25}),
        ("annulus", {"a": 0.5}, {"a": 0.55}),
        ("membrane", {"numerics": {"cells": 4, "levels": 2}}, {"numerics": {"cells": 6, "levels": 2}}),
    ],
)
def test_another_size_needs_no_other_forms(problem, one, other):
    solve(problem, **one)
    known = set(jit_cache._known)
    solve(problem, **other)
    assert set(jit_cache._known) == known
