"""The membranes of diagrams: their parameters, the lines that they have, and what is refused of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from math import inf

from mpi4py import MPI

from weakforms.problems.diagram.about import WAVES
from weakforms.problems.diagram.bodies.balloon import VariedSphere
from weakforms.problems.diagram.bodies.cap import VariedCap, rest_height
from weakforms.problems.diagram.bodies.liquid import VariedFluidTube
from weakforms.problems.diagram.bodies.long_tube import FreeTube, HeldTube
from weakforms.problems.diagram.bodies.varied import VariedDisk, VariedTube
from weakforms.problems.diagram.bodies.wrinkled import VariedWrinkledTube
from weakforms.problems.diagram.followed import Followed
from weakforms.problems.homogeneous.material import require_borne
from weakforms.problems.material_choice import Chosen
from weakforms.problems.meridian.pre_stretch import (
    require_bearable,
    require_stretched,
    require_taut,
    require_width,
)

GRADING = 0.6
"""Concentration of cells at the disks of a tube, and at the clamp of a hemisphere."""

Values = Mapping[str, float]


@dataclass(frozen=True)
class Subject:
    """What a diagram is drawn of."""

    make: Callable[[MPI.Comm, Chosen, Values, int, int], Followed]
    """The model on one mesh: of ranks, law, values of parameters and constants, cells and degree."""
    depth: str
    """Column of the largest displacement."""
    parameters: tuple[str, ...]
    """Names of the parameters of the body, each of which may be an axis of the plane."""
    end: str
    """Parameter that ends the primary branch, a value of ``depth``."""
    lines: tuple[str, ...]
    """Kinds of lines that are known for it."""
    require: Callable[[str, Chosen, float, str], None] = lambda *_: None
    """Refuses values of its first parameter: of the problem, the law, a value, and the value's name."""
    obstacle: str = ""
    """Parameter with the position of a substrate."""
    touch: Callable[[float], float] = lambda height: height
    """Value of ``depth`` at first contact."""
    rest: Callable[[float], float] = lambda _first: -inf
    """Value of ``depth`` at rest, of its first parameter, if branches begin near it."""
    pole: bool = False
    """Whether the membrane has a pole."""
    without: Mapping[str, str] = field(default_factory=dict)
    """Why there is no line of a kind, and what to change."""
    uniform: bool = False
    """Whether a state is the same all over."""
    load: str = "p"
    """The load, which is the other axis."""
    size: float = 1.0
    """Usual change of ``depth`` over that of the parameter."""


def _fillable(problem: str, law: Chosen, delta: float, name: str) -> None:
    require_bearable(problem, law, delta, 1.0, name)
    require_width(problem, law, delta, name)


def _borne(problem: str, law: Chosen, force: float, _name: str) -> None:
    require_borne(problem, law, force)


ONLY_TUBE = "; allowed with body = 'tube'"
NO_MIRROR = "has no mirror" + ONLY_TUBE
NO_OBSTACLE = "touches nothing; allowed with body = 'tube' or 'circular'"
NO_LONG_WAVES = "is not long; allowed with body = 'infinite_tube', ends = 'held'"
NO_SUCH_WAVES = "has long waves of n1 only; other waves: body = 'tube'"
AT_LIMIT_POINTS = (
    "with ends = 'free' begins to bulge at its limit points (kind = 'fold'); allowed with ends = 'held'"
)
BY_ITS_FORCE = "with ends = 'free' bends where force = 0; allowed with ends = 'held'"
BY_ITS_OWN_PROBLEM = (
    "has no lines of waves around its axis (problem wrinkled_tube with n has their stability); allowed with "
    "body = 'tube' or 'fluid_tube'"
)
TAUT = "is in tension at any pressure"

WRINKLED = Subject(
    VariedWrinkledTube,
    VariedWrinkledTube.depth,
    ("M", "delta", "L", "Af"),
    "V_end",
    ("fold", "wrinkling"),
    without={
        "mirror": NO_MIRROR,
        "localisation": NO_LONG_WAVES,
        "contact": NO_OBSTACLE,
        **dict.fromkeys(WAVES, BY_ITS_OWN_PROBLEM),
    },
    size=3.0,
)

SUBJECTS = {
    "wrinkled_tube": WRINKLED,
    "wrinkled_tube, liquid": replace(WRINKLED, parameters=(*WRINKLED.parameters, "gamma"), load="zw"),
    "tube": Subject(
        lambda comm, law, values, cells, degree: VariedTube(comm, law, values, cells, degree, GRADING),
        VariedTube.depth,
        ("delta1", "lf"),
        "u_end",
        ("fold", "mirror", *WAVES, "wrinkling", "contact"),
        require_stretched,
        obstacle="s",
        touch=lambda s: s - 1,
        without={"localisation": NO_LONG_WAVES},
    ),
    "circular": Subject(
        lambda comm, law, values, cells, degree: VariedDisk(comm, law, values, cells, degree, 0.0),
        VariedDisk.depth,
        ("beta",),
        "t_end",
        ("fold", "wrinkling", "contact"),
        require_taut,
        obstacle="l",
        pole=True,
        without={
            "mirror": NO_MIRROR,
            "localisation": NO_LONG_WAVES,
            **dict.fromkeys(WAVES, "has no lines of waves around its axis" + ONLY_TUBE),
        },
    ),
    "hemisphere": Subject(
        lambda comm, law, values, cells, degree: VariedCap(comm, law, values, cells, degree, GRADING),
        VariedCap.depth,
        ("angle",),
        "t_end",
        ("fold", *WAVES, "wrinkling"),
        rest=rest_height,
        pole=True,
        without={"mirror": NO_MIRROR, "localisation": NO_LONG_WAVES, "contact": NO_OBSTACLE},
    ),
    "sphere": Subject(
        lambda _comm, law, values, _cells, _degree: VariedSphere(law, values),
        VariedSphere.depth,
        (),
        "lam_end",
        ("fold", *WAVES),
        without={
            "mirror": NO_MIRROR + " (modes of odd degree: kind = 'n1,n3')",
            "localisation": NO_LONG_WAVES,
            "wrinkling": TAUT,
            "contact": NO_OBSTACLE,
        },
        uniform=True,
    ),
    "infinite_tube": Subject(
        lambda _comm, law, values, _cells, _degree: FreeTube(law, values),
        FreeTube.depth,
        ("force",),
        "lam_end",
        ("fold", "wrinkling"),
        _borne,
        without={
            "mirror": NO_MIRROR,
            "localisation": AT_LIMIT_POINTS,
            **dict.fromkeys(WAVES, NO_SUCH_WAVES),
            "n1": BY_ITS_FORCE,
            "contact": NO_OBSTACLE,
        },
        uniform=True,
    ),
    "infinite_tube, held": Subject(
        lambda _comm, law, values, _cells, _degree: HeldTube(law, values),
        HeldTube.depth,
        ("lam1",),
        "lam_end",
        ("fold", "localisation", "n1"),
        require_stretched,
        without={
            "mirror": NO_MIRROR,
            **dict.fromkeys(WAVES, NO_SUCH_WAVES),
            "wrinkling": TAUT,
            "contact": NO_OBSTACLE,
        },
        uniform=True,
    ),
    "fluid_tube": Subject(
        VariedFluidTube,
        VariedFluidTube.depth,
        ("delta", "L", "gamma"),
        "V_end",
        ("fold", *WAVES, "wrinkling"),
        _fillable,
        without={"mirror": NO_MIRROR, "localisation": NO_LONG_WAVES, "contact": NO_OBSTACLE},
        load="zw",
        size=3.0,
    ),
}
"""Subjects by the name of the body, with what holds its ends, or fills it, if that is another one."""
