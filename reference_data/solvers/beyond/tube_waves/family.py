"""Families of waves around a tube that is symmetric about its mid-plane."""

from __future__ import annotations

from dataclasses import dataclass

EVEN, ODD = 1, -1


@dataclass(frozen=True)
class Family:
    """Waves (u cos n th, b sin n th, w cos n th) of one parity.

    Attributes:
        n: Wave number.
        parity: EVEN if u and b are even functions of z and w is odd; ODD the other way round.
    """

    n: int
    parity: int

    @property
    def zero(self) -> tuple[int, ...]:
        """Components of (u, b, w) that vanish at the mid-plane."""
        return (2,) if self.parity == EVEN else (0, 1)

    @property
    def free(self) -> tuple[int, ...]:
        """The other components, whose forces vanish there."""
        return tuple(i for i in range(3) if i not in self.zero)


FAMILIES = (Family(0, ODD), *(Family(n, parity) for n in (1, 2) for parity in (EVEN, ODD)))
"""Families in the tables; the symmetric one of n = 0 is that of the states themselves."""
