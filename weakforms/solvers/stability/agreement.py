"""Agreement of meshes on the number of negative eigenvalues."""

from __future__ import annotations

from collections.abc import Iterable

from weakforms.errors import ConvergenceError


def same_count(counts: Iterable[int]) -> int:
    """The number of negative eigenvalues that all meshes agree on.

    Raises:
        ConvergenceError: If they do not.
    """
    found = set(counts)
    if len(found) != 1:
        raise ConvergenceError(f"stability depends on the mesh: negative counts {sorted(found)}")
    return found.pop()
