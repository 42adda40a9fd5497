"""What leads the iterations of the reference side astray, and how they are to end."""

from dataclasses import dataclass

import numpy as np
import pytest

from reference_data.solvers.core.mooney_rivlin import Tube
from reference_data.solvers.paper4.material import Membrane

TUBE, GAS = Tube(0.1, 1.0, 6.0), Membrane(0.5, 2, load="gas")
AWAY = [1.0, np.nan]
"""Corrections that are no answer."""


def always(answer):
    """Gives the same answer to everything."""
    return lambda *_given, **_named: answer


def refused(words, call, *given, error=RuntimeError, **named):
    """The call ends with this error, of exactly this type, and these words."""
    with pytest.raises(error, match=words) as caught:
        call(*given, **named)
    assert type(caught.value) is error


@dataclass(frozen=True)
class StandIn:
    """Whatever an iteration moves."""

    tube: object = TUBE
    membrane: object = GAS
    x: object = 0.0
    zw: float = 1.0
    y: object = 0.0
    p: float = 0.0
    scalars: object = 0.0
    zones: tuple = ()
    level: float = 1.0
    load: float = 0.0
    volume: float = 20.0
    front: float = 1.0
    pattern: object = None
    rule: object = None
    counts: tuple = ()
    fronts: tuple = ()
    substrate: object = None
    grid: object = None
