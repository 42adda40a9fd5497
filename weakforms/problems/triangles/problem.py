"""Problem ``surface`` (Paper 5): the relaxed membrane on flat triangles in space, its range of instability.

Patil, Nordmark & Eriksson (2016), J. Mech. Phys. Solids 94, 298-315, print the unstable ranges that a finite
element code found on the tube. Here such meshes are assembled in three dimensions, and the inertia of the
whole tangent decides on stability, without decomposition into waves.
"""

from __future__ import annotations

import numpy as np
from mpi4py import MPI

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.material_choice import require_foldable
from weakforms.problems.meridian.limits import relative_stiffness
from weakforms.problems.meridian.pre_stretch import require_bearable, require_carried
from weakforms.problems.problem import End, Problem, Progress, Requests, StateRequest, Task
from weakforms.problems.triangles.about import SURFACE
from weakforms.problems.triangles.branch import Point, SurfaceRun
from weakforms.problems.triangles.fields import fields
from weakforms.problems.triangles.model import Body, SurfaceModel
from weakforms.problems.triangles.parameters import (
    ALLOWED,
    CONTROL,
    DEFAULTS,
    FIRST,
    HANGING,
    HEAVIEST,
    SurfaceNumerics,
    SurfaceParameters,
)
from weakforms.problems.triangles.symmetry import Meridian
from weakforms.results import Absence, Branch, Failure, Quantity, Result, SpecialPoint, State
from weakforms.solvers.equilibrium.newton import STOPPING


class Surface(Problem):
    """The relaxed membrane as a discrete surface in space."""

    about = SURFACE
    parameters = SurfaceParameters
    numerics = SurfaceNumerics

    def check(self, parameters: SurfaceParameters, requests: Requests) -> None:
        """Refuse wrong combinations of parameters; a file is read and checked.

        Raises:
            InputError: With a message that names the value and the allowed ones.
        """
        super().check(parameters, requests)
        require_foldable(self.name, parameters, invariants=True)
        kind, full = parameters.kind, parameters.filled()
        if kind == "tube":
            require_bearable(self.name, full.material, full.delta, full.delta**-0.5, "delta")
            require_carried(self.name, full.material, full.delta, full.M)
            _require_filled(full)
        if kind == "hemisphere":
            _require_hanging(full)
        for name in ("M", "delta", "L", "Af"):
            value = getattr(parameters, name)
            if value is not None and name not in DEFAULTS[kind]:
                raise InputError(f"surface: {name} = {value:g} has no meaning with geometry = {kind!r}")
        if parameters.load == "gas" and kind == "hemisphere":
            raise InputError(
                "surface: load = 'gas' is for the tube or a file; the hemisphere hangs full of fluid"
            )
        if full.load_start is None or full.load_end is None:
            raise InputError("surface: a file needs load_start and load_end, the ends of the branch")
        if full.load_start == full.load_end:
            raise InputError(f"surface: load_start = load_end = {full.load_end:g}; they must differ")
        _require_loads(full, requests)
        if kind == "file":
            given = parameters.triangles()
            Meridian.of(given).require_revolved(parameters.geometry)

    def ends(self, parameters: SurfaceParameters, _branch: str) -> list[End]:
        """The last load."""
        full = parameters.filled()
        return [End("load_end", full.control, full.load_end), End("load_end", full.control, None)]

    def fill(self, result: Result, task: Task) -> None:
        """Follow the load, count negative eigenvalues, locate the ends of the unstable range.

        The numbers belong to the mesh; only located points have an uncertainty.
        """
        parameters, numerics, requests = task.parameters, task.numerics, task.requests
        comm, progress = task.comm, task.progress
        full = parameters.filled()
        result.parameters = full.model_dump()
        result.numerics["stopping"] = f"symmetric states: relative Newton step 1e-11; all: {STOPPING}"
        run = _run(full, comm)
        loads = np.linspace(full.load_start, full.load_end, numerics.scan + 1)
        reached = _walk(run, loads, result, progress)
        _branch(run, reached, numerics, result, progress)
        progress("stability changes", 0, 1)
        try:
            tolerance = numerics.tolerance * max(1.0, abs(full.load_end))
            result.special_points.extend(run.changes([point.load for point in reached], tolerance))
        except ConvergenceError as error:
            result.failures.append(Failure("special points", str(error)))
        result.quantities |= _quantities(run, result.special_points, full.control)
        for i, wanted in enumerate(requests.states):
            progress("states", i, len(requests.states))
            try:
                result.states.append(_state(run, wanted, result.special_points, numerics.eigenvalues))
            except ConvergenceError as error:
                result.failures.append(Failure(f"state at {wanted.name} = {wanted.value:g}", str(error)))


def _require_hanging(full: SurfaceParameters) -> None:
    """Refuse a liquid that is too light or too heavy for a hemisphere of this law."""
    stiffness = relative_stiffness(full.material)
    low, high = (bound * stiffness for bound in HANGING)
    if not low <= full.gamma <= high:
        raise InputError(
            f"surface: gamma = {full.gamma:g}: allowed with geometry = 'hemisphere' and this stiffness of "
            f"the law: {low:.4g} to {high:.4g}"
        )


def _require_filled(full: SurfaceParameters) -> None:
    """Refuse a liquid so heavy that a tube at its first level is far from the one without it."""
    if full.load == "fluid" and full.gamma > HEAVIEST:
        raise InputError(
            f"surface: gamma = {full.gamma:g}: allowed with geometry = 'tube': up to {HEAVIEST:g}"
        )


def _require_loads(full: SurfaceParameters, requests: Requests) -> None:
    """Refuse loads for which the geometry has no state."""
    low, high = ALLOWED.get((full.kind, full.load), (0.0, 100.0) if full.load == "gas" else (-1e6, 1e6))
    asked = [("load_start", full.load_start), ("load_end", full.load_end)]
    asked += [(r.name, r.value) for r in requests.states if r.name in CONTROL.values()]
    for name, value in asked:
        if not low <= value <= high:
            raise InputError(f"surface: {name} = {value:g}: allowed with this geometry: {low:g} to {high:g}")
    for r in requests.states:
        if r.name in CONTROL.values() and r.name != full.control:
            raise InputError(
                f"surface: with load = {full.load!r} there is no {r.name}; the load is {full.control}"
            )


def _run(full: SurfaceParameters, comm: MPI.Intracomm) -> SurfaceRun:
    """The discrete membrane, with a first state at a load for which the first guess converges."""
    own = {name: getattr(full, name) for name in ("M", "delta", "Af") if name in DEFAULTS[full.kind]}
    gamma = full.gamma if full.load == "fluid" else 0.0
    own |= {"c2": full.c2, "gamma": gamma, "rule": full.rule, "potential": full.potential}
    body = Body(full.triangles(), **own, material=full.other_law)
    run = SurfaceRun(SurfaceModel(comm, body), full.control, {"p": 0.0, "zw": 0.0})
    for load in FIRST.get((full.kind, full.load), (full.load_start,)):
        try:
            run.at(float(load))
            return run
        except ConvergenceError as error:
            failed = error
    advice = ["choose another gamma"] if full.load == "fluid" else []
    if full.kind != "hemisphere":
        advice.append(f"bring M closer to 1, or Af to {full.delta**-0.5:.3g}, the radius without load")
    raise ConvergenceError(f"no first state at {full.control} = {load:g}: {failed}; {', or '.join(advice)}")


def _walk(run: SurfaceRun, loads: np.ndarray, result: Result, progress: Progress) -> list[Point]:
    """States at the loads, as far as they can be reached; loads beyond a limit load are left out."""
    out: list[Point] = []
    for i, load in enumerate(loads.tolist()):
        progress("equilibria", i, len(loads))
        if run.is_beyond(load):
            continue
        try:
            out.append(run.at(load))
        except ConvergenceError as error:
            if not _is_explained(run, load, result):
                end = out[-1].load if out else run.first
                why = f"{error}; choose load_start and load_end up to {end:g}, where the branch still is"
                result.failures.append(Failure(f"branch primary, from {run.control} = {load:g}", why))
                break
            out = [point for point in out if not run.is_beyond(point.load)]
    if not out and not result.absent:
        raise ConvergenceError(result.failures[-1].reason)
    return out


def _is_explained(run: SurfaceRun, load: float, result: Result) -> bool:
    """Whether there is a limit load before a load without a state; the result then says so."""
    try:
        turn = None if result.absent else run.turn(load)
    except ConvergenceError:
        turn = None
    if turn is None:
        return False
    side = "below" if run.first < turn else "above"
    why = f"on this mesh the branch turns back at its limit load, about {run.control} = {turn:.3g}"
    why = f"surface: {why}; choose load_start and load_end {side} it"
    result.absent.append(Absence("rest of branch primary", why))
    return True


def _branch(
    run: SurfaceRun, reached: list[Point], numerics: SurfaceNumerics, result: Result, progress: Progress
) -> None:
    """Columns of a part of the states; a state whose eigenvalues are not found is left out and listed."""
    rows, points = [], reached[:: numerics.shown]
    for i, point in enumerate(points):
        progress("eigenvalues", i, len(points))
        try:
            rows.append(run.columns(point, numerics.eigenvalues))
        except ConvergenceError as error:
            result.failures.append(Failure(f"eigenvalues at {run.control} = {point.load:g}", str(error)))
    if rows:
        columns = {name: np.array([row[name] for row in rows]) for name in rows[0]}
        columns["n_negative"] = columns["n_negative"].astype(int)
        columns["iterations"] = columns["iterations"].astype(int)
        result.branches.append(Branch("primary", run.control, columns))


def _quantities(run: SurfaceRun, found: list[SpecialPoint], control: str) -> dict[str, Quantity]:
    given = run.model.body.triangles
    out = {"triangles": Quantity(len(given.triangles)), "unknowns": Quantity(3 * len(given.points))}
    if len(found) > 1 and found[0].values["direction"] > 0 > found[-1].values["direction"]:
        for name, point in (("lower", found[0]), ("upper", found[-1])):
            out[name] = Quantity(point.values[control], point.uncertainty[control])
            out[f"n_{name}"] = Quantity(point.values["n"], 0.0)
        out["gaps"] = Quantity(len(found) // 2 - 1)
    return out


def _state(run: SurfaceRun, wanted: StateRequest, found: list[SpecialPoint], count: int) -> State:
    """A state at a load, or at the ``value``-th stability change, with its fields if requested."""
    load = wanted.value
    if wanted.name == "stability_change":
        if not wanted.value <= len(found):
            raise ConvergenceError(f"this branch has {len(found)} stability changes")
        load = found[int(wanted.value) - 1].values[run.control]
    point = run.at(float(load))
    values = run.columns(point, count)
    quantities = {name: Quantity(float(value)) for name, value in values.items()}
    shown = fields(run, point) if wanted.profile is not None else ()
    return State({wanted.name: wanted.value}, wanted.branch, quantities, shown, wanted.crossing)
