"""Every kind of solution of the cases, serially and on several ranks: all numbers agree.

A kind is a problem with a set of parameters, of which words and switches have one value. The cases have some
1300 solutions of a few hundred kinds; of each kind the one that takes least is solved.
"""

from math import inf
from pathlib import Path

import pytest
from on_ranks import Ranks, allowed, beyond, start

from weakforms import solve
from weakforms.results import Result
from weakforms.verification.audit.same import Run, runs
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.cases.specs import At, Spec
from weakforms.verification.run.plan import Plan
from weakforms.verification.run.usual import usual_times

pytestmark = pytest.mark.mpi
CHEAP = ("paper5.fig02",)
"""A patch, which every rank solves for itself, with a figure: how a run is divided and stored."""
UNKNOWN = 10.0
"""Seconds of a solution that no full run has measured yet."""
STATES = 3
"""Number of states that are compared besides branches and special points."""

OPENED = "energy=standard, load=gas, load_end=0.05"
EARLY = "contact=frictionless, delta1=1.0, energy=relaxed, k=20.0, lf=6.0, p_end=5.6, s=3.0"
ALONG = ("p", "u_max", "V", "lam1_mid", "lam2_mid", "t1_mid", "Z_front_1", "wrinkled_fraction")
ALL_ALONG = (*ALONG, "Z_front_2", "Pi")
ON_LINE = "p", "delta1", "u_max", "lam1_mid", "V", "Pi"
LETS_GO = "phase=deflation, s=1.2, spring=unilateral", "phase=deflation, spring=unilateral"
NO_FRICTION = tuple(
    f"contact=frictionless, {rest}"
    for rest in ("delta1=1, degree=6", "delta1=1.5, k=100", "delta1=2.0, lf=6.0, s=1.3")
)
WRINKLES = "energy=relaxed, lf=6.0, u_end=3.6", "energy=relaxed, extent=full, lf=6.0, u_end=1.9"
LOPSIDED = "energy=relaxed, extent=full, lf=6.0, secondary=True"
UNEVEN = "extent=full, lf=6.0, secondary=True, u_end=2.1, uneven=-0.0001"
JUMP = "eigenvalue_1", "f_w"
WAVES = ("mode_n20 meridional", "mode_n50 meridional", "mode_n50 circumferential", "mode_n50 normal")
ROUND_OFF = (
    ("wrinkled_tube_threshold", " Z", 1e-8),
    *((OPENED, name, 1e-8) for name in (" Z", " Z_front_1", " wrinkled_fraction")),
    ("contact=frictionless, delta1=1.2, energy=relaxed", " wrinkled_fraction", 1e-8),
    ("contact=frictionless, delta1=1.0, energy=relaxed", " wrinkled_fraction", 1e-8),
    *((tube, f"branch primary, {name}", 1e-7) for tube in (*WRINKLES, LOPSIDED) for name in ALL_ALONG),
    (WRINKLES[1], " profile H", 1e-8),
    (LOPSIDED, " length", inf),
    (UNEVEN, "branch primary, t_min", 1e-8),
    ("beta=6.733333333333333e-05, delta=3, load_end=20.0, n=(6, 8, 10, 12)", " wrinkled_fraction", 1e-8),
    *(
        ("sheet(s=1.05)", f"state S_least = 0 (crossing 1, primary), {name}, uncertainty", 0.2)
        for name in JUMP
    ),
    ("contact=frictionless, extent=half, s=2.2", " t2_min, uncertainty", 1e-7),
    *((EARLY, f"branch primary, {name}", 1e-7) for name in ALONG),
    (EARLY, " profile H", 1e-8),
    ("wrinkled_tube(Af=0.4362, M=1.5, delta=3", "(zone_closing, primary), Z", 1e-8),
    *((tube, f" traction_{at}, uncertainty", 2e-6) for tube in NO_FRICTION for at in ("front", "max")),
    ("phase=deflation, spring=unilateral", " kappa", 1e-6),
    *((tube, f" traction_{at}, uncertainty", 1e-5) for tube in LETS_GO for at in ("front", "max")),
    *(("kind=mirror,wrinkling, u_end=4.9", f"branch wrinkling, {name}", 1e-7) for name in ON_LINE),
    *(("kind=fold,mirror,n1, low=5.0", f"branch n1, {name}", 1e-8) for name in ("Pi", "u_max", "lam1_mid")),
    ("load=gas, n=(1, 5, 15, 20)", " Lambda_n20_1", 1e-8),
    *(("n=(1, 20, 50)", f" {name}", 1e-8) for name in WAVES),
    ("hemisphere(low_end=-1.14, n=(10, 50))", " eigenvalue_1", 1e-8),
    *(("rectangle(c=1, gamma=3.783186483", f" t_{x}", 1e-6) for x in "xyz"),
    ("rectangle(c=1, gamma=3.783186483", " profile S_least", 1e-8),
    ("rectangle(edges=strip, gamma=5.0", " t_y", 1e-5),
    ("rectangle(edges=strip, load=gas", " t_y", 1e-8),
    ("rectangle(edges=strip, gamma=5.0", " Y_least, uncertainty", 2.0),
)
"""Numbers of some solutions that multiply round-off, and by how much they may differ.

A resultant is flat where it is least: the place of its smallest value, and fronts beside that place, are not
sharp. The curve is flat at a limit point. Without friction a traction is zero. Curvatures beside a spring
that lets go are second derivatives. Points of a trace that begins with a small zone lie elsewhere along the
branch, by what round-off makes of its first step; states at given values do not. SLEPc stops at a relative
residual of 1e-10, and a mode is known less well than its eigenvalue. A point of a line satisfies one more
condition, which has round-off of its own. Where both stretches of a triangle are nearly equal, as in a sheet
that is nearly flat, the direction of the larger one is not sharp. A strip is alike along its edges: the
component of this direction along them is zero, and the place of the least stress is any. Where a sheet is
about to wrinkle, round-off decides on which meshes its stiffness has jumped. These limits were
set after one run had shown such differences, and are larger.
"""


def kind_of(spec: Spec) -> tuple:
    words = [(name, value) for name, value in spec.parameters if isinstance(value, str | bool)]
    return spec.problem, tuple(words), tuple(name for name, _ in spec.parameters)


def request_for(spec: Spec, states: list[At]) -> dict:
    """Keywords of :func:`weakforms.solve`, with a few of the cases' states on one branch."""
    wanted = [at for at in states if at.crossing == 1 and at.branch == states[0].branch][:STATES]
    asked = {"problem": spec.problem, **dict(spec.parameters), "numerics": dict(spec.numerics)}
    if wanted:
        asked |= {"at": [(at.name, at.value) for at in wanted], "branch": wanted[0].branch}
    return asked


def kinds() -> dict[str, dict]:
    """A request of every kind, by the solution's name; what takes least comes first."""
    seconds, plan = usual_times(), Plan.of(find_cases())
    least: dict[tuple, Spec] = {}
    for spec in sorted(plan.states, key=lambda spec: (seconds.get(str(spec), UNKNOWN), str(spec))):
        least.setdefault(kind_of(spec), spec)
    return {str(spec): request_for(spec, plan.states[spec]) for spec in least.values()}


KINDS = kinds()
PROBLEMS = {request["problem"]: name for name, request in reversed(KINDS.items())}
"""Of each problem the solution that takes least."""


def apart(name: str, found: Result) -> list[str]:
    """The numbers of a solution on ranks that are not those of a serial one."""
    serial = Result.from_json(solve(**KINDS[name]).to_json())
    assert serial.failures == found.failures == []
    return beyond(serial, found, [(place, most) for part, place, most in ROUND_OFF if part in name])


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_kind(on_two_ranks, name):
    assert apart(name, *on_two_ranks([KINDS[name]])) == []


@pytest.fixture(scope="module")
def four(launcher):
    """Four ranks."""
    ranks = Ranks(4)
    yield ranks
    ranks.end()


@pytest.mark.slow
@pytest.mark.parametrize("problem", PROBLEMS)
def test_problem_on_four_ranks(four, problem):
    found, size = four.solve([KINDS[PROBLEMS[problem]]])
    assert size == 4
    assert apart(PROBLEMS[problem], Result.from_json(found)) == []


def check(cases: tuple[str, ...], out: Path, ranks: int) -> None:
    start(["-m", "weakforms", "check", *cases, "--out", str(out)], ranks, timeout=900)


def test_a_cheap_case_on_four_ranks(launcher, tmp_path):
    check(CHEAP, tmp_path / "serial", 1)
    check(CHEAP, tmp_path / "ranks", 4)
    both = Run(tmp_path / "serial"), Run(tmp_path / "ranks")
    assert both[0].verdicts == both[1].verdicts
    numbers = [(item.spec, number) for item in runs(*both) for number in item.found]
    assert numbers
    far = [f"{spec}: {x}" for spec, x in numbers if not x.relative <= allowed(x.place, spec)]
    assert far == []
