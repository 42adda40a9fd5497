"""Families of waves around a torus that is symmetric about its equatorial plane."""

from __future__ import annotations

from dataclasses import dataclass

EVEN, ODD = 1, -1


@dataclass(frozen=True)
class Family:
    """Waves (u cos n th, q sin n th, w cos n th) of one parity, of a torus that cannot move as a rigid body.

    Attributes:
        n: Wave number.
        parity: EVEN if the equatorial plane is a mirror of the displaced torus; ODD if the mirror reverses
            the displacement.
    """

    n: int
    parity: int

    @property
    def zero(self) -> tuple[int, ...]:
        """Components of (u, q, w) that vanish at both equators."""
        return (2,) if self.parity == EVEN else (0, 1)

    @property
    def pinned(self) -> tuple[int, ...]:
        """A component held at the outer equator: else the torus shifts, or tilts (n = 1, odd)."""
        if self == Family(1, EVEN):
            return (1,)
        return (2,) if self in (Family(0, ODD), Family(1, ODD)) else ()

    @property
    def everywhere(self) -> tuple[int, ...]:
        """A component that is left out: of n = 0, torsion."""
        return () if self.n else (1,)


def families(most: int) -> tuple[Family, ...]:
    """All families up to a wave number."""
    return tuple(Family(n, parity) for n in range(most + 1) for parity in (EVEN, ODD))
