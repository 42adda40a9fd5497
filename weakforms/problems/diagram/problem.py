"""Problem ``diagram``: lines of critical points in a plane of two parameters, on a family of meshes."""

from __future__ import annotations

import numpy as np

from weakforms.errors import AbsentError, ConvergenceError, InputError, not_among
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.branch_problem import BranchProblem, Family
from weakforms.problems.diagram.about import BREAKING, DIAGRAM, LINES
from weakforms.problems.diagram.family import LineFamily, orders_of
from weakforms.problems.diagram.lines import LinesOnMesh, Seed
from weakforms.problems.diagram.parameters import DiagramNumerics, DiagramParameters
from weakforms.problems.liquid_tube.branch import STEP
from weakforms.problems.material_choice import require_foldable, require_model
from weakforms.problems.problem import End, Requests, Task
from weakforms.problems.tube.parameters import resolving
from weakforms.results import Absence, Failure, Result

SCANNED = 9
"""Number of values of the parameter at which a critical point is searched, if there is none at the first."""

ROOM = 0.1
"""Least rise of the last state from rest, or, if that is higher than 1, the same fraction of its height. The
first state, at a small pressure, has risen less."""


class Diagram(BranchProblem):
    """Lines of limit points, of broken symmetry, of first wrinkling and of first contact."""

    about, parameters, numerics = DIAGRAM, DiagramParameters, DiagramNumerics

    def check(self, parameters: DiagramParameters, requests: Requests) -> None:
        """Refuse what the ranges of single parameters cannot.

        Raises:
            InputError: For a plane, a range or kinds of lines that the membrane does not have.
        """
        super().check(parameters, requests)
        self._check_axes(parameters)
        self._check_kinds(parameters)
        self._check_range(parameters)
        if parameters.body == "fluid_tube":
            require_model("diagram: body = 'fluid_tube'", parameters, tuple(LAWS))
        if parameters.body == "wrinkled_tube":
            require_foldable("diagram: body = 'wrinkled_tube'", parameters, invariants=False)
        if parameters.waves and parameters.body == "tube":
            require_model("diagram: waves around the axis", parameters, tuple(LAWS))
        subject = parameters.subject
        for own in subject.parameters[:1]:
            values = {own: getattr(parameters, own)}
            if parameters.vary == own:
                values |= {"low": parameters.window.low, "high": parameters.window.high}
            for name, value in values.items():
                subject.require(self.name, parameters.material, value, name)
            # Over the first parameter, lines start within the range, wherever its own value is.
            for name in ("low", "high") if parameters.vary == own else (own,):
                rest = subject.rest(values[name])
                least = rest + ROOM * max(1.0, rest)
                if parameters.window.end < least:
                    raise InputError(
                        f"diagram: {name} = {values[name]:g}: {subject.end} = {parameters.window.end:g} must "
                        f"be at least {least:.4g}, because {subject.depth} is {rest:.4g} at rest; change one "
                        "of both"
                    )

    def _check_axes(self, given: DiagramParameters) -> None:
        x, y = given.axes
        if x == y:
            raise InputError(f"diagram: x = y = {x!r}: a plane has two different parameters; change x or y")
        allowed = [given.load, *given.known]
        if not given.known:
            raise InputError(
                f"diagram: {given.body} with model = {given.model!r} has no parameter besides {given.load}; "
                "choose a model with constants"
            )
        for axis, name in (("x", x), ("y", y)):
            if name not in allowed:
                what = f"{given.body} with model = {given.model!r}"
                raise InputError(
                    f"diagram: {axis} = {name!r} is no parameter of {what}{not_among(name, allowed)}"
                )
        if given.load not in (x, y):
            load = given.load
            raise InputError(
                f"diagram: x = {x!r}, y = {y!r}: one of both must be {load}; set x or y to {load}"
            )

    def _check_kinds(self, given: DiagramParameters) -> None:
        if given.kind == "all":
            return
        if given.unheld and "mirror" in given.kinds:
            raise InputError(f"diagram: kind = {given.kind!r} with {given.unheld}")
        for word in given.kind.split(","):
            name = word.strip()
            if name not in LINES:
                raise InputError(f"diagram: kind = {name!r}{not_among(name, [*LINES, 'all'])}")
            if name not in (*given.kinds, "all"):
                why = given.subject.without[name]
                raise InputError(f"diagram: kind = {name!r}: body = {given.body!r} {why}")

    def _check_range(self, given: DiagramParameters) -> None:
        window, (least, most) = given.window, given.range_of(given.vary)
        named = f"low = {window.low:g}, high = {window.high:g}"
        if not (np.isfinite(window.low) and np.isfinite(window.high)):
            raise InputError(
                f"diagram: set low and high, the range of {given.vary}; allowed: {least:g} to {most:g}"
            )
        if not least <= window.low < window.high <= most:
            raise InputError(
                f"diagram: {named}: the range of {given.vary} must be increasing and between {least:g} and "
                f"{most:g}; change low or high"
            )
        if not window.load_low < window.load_high:
            raise InputError(
                f"diagram: {given.load}_low = {window.load_low:g} must be less than {given.load}_high = "
                f"{window.load_high:g}; change one"
            )
        here = given.known[given.vary]
        if given.vary in given.model_fields_set and not window.low <= here <= window.high:
            raise InputError(
                f"diagram: {given.vary} = {here:g}, where lines start, is outside of {named}; change one of "
                "them"
            )

    def ends(self, parameters: DiagramParameters, branch: str) -> list[End]:
        """The sides of the window, the largest displacement, and the start of a closed line."""
        window, given = parameters.window, parameters
        sides = (("low", given.vary, window.low), ("high", given.vary, window.high))
        load = given.load
        sides += ((f"{load}_low", load, window.load_low), (f"{load}_high", load, window.load_high))
        found = [End(*side) for side in sides if np.isfinite(side[2])]
        if not branch.startswith("end"):  # which has this displacement all along
            found.append(End(given.subject.end, given.subject.depth, window.end))
        if given.body == "fluid_tube":
            found.append(End("brim", given.load, None, "the liquid reaches the upper ring"))
        if given.body == "wrinkled_tube":
            fills = ", or the liquid reaches a ring" if given.load == "zw" else ""
            found.append(End("zones", given.load, None, f"a zone opens or closes{fills}"))
        return [*found, End("closed", given.vary, None, "the line returns to its first point")]

    def families(self, task: Task) -> dict[str, Family]:
        """The lines that pass through critical points of the primary branch.

        Raises:
            AbsentError: If there is no such point.
            ConvergenceError: If there is none where it could be searched, but not everywhere.
        """
        given, numerics = task.parameters, task.numerics
        meshes = [_lines_on(cells, task) for cells in numerics.meshes]
        names, missing = self._seeds(given, meshes[0])
        caps = orders_of(numerics.degree, given.subject.pole)
        found = {}
        for k, (name, seed) in enumerate(names.items()):
            task.progress(f"line {name}", k, len(names))
            found[name] = LineFamily(meshes, seed, name, 2.0 * numerics.degree, caps, given.subject.size)
        first = next(iter(found.values()))
        first.absent.extend(missing)
        first.failures.extend(_failures(meshes[0], given.vary))
        return found

    def _seeds(self, given: DiagramParameters, coarse: LinesOnMesh) -> tuple[dict[str, Seed], list[Absence]]:
        """One critical point for each line, from the coarsest mesh, by the line's name; what is not there."""
        window = given.window
        first = min(max(given.known[given.vary], window.low), window.high)
        places = [first, *np.linspace(window.low, window.high, SCANNED).tolist()]
        names: dict[str, Seed] = {}
        missing = []
        counted = {"fold", *BREAKING, *given.waves} & {*given.kinds}
        for kind in (*given.kinds, *(("end",) if counted else ())):
            seeds = coarse.seeds(kind, places)
            names |= {kind + (f"_{k + 1}" if k else ""): seed for k, seed in enumerate(seeds)}
            failed = any(of == kind for of, _ in coarse.failed)
            if not seeds and kind != "end" and not failed:
                missing.append(Absence(f"lines of kind {kind}", _none(given, kind)))
        if given.kind == "all" and given.unheld:
            missing.append(Absence("lines of kind mirror", f"diagram: {given.unheld}"))
        if names.keys() <= {"end"}:
            for failure in _failures(coarse, given.vary):
                raise ConvergenceError(f"{failure.what}: {failure.reason}")
            raise AbsentError("lines", "; ".join(item.reason for item in missing))
        return names, missing

    def fill(self, result: Result, task: Task) -> None:
        """Solve for the lines; say where each begins."""
        super().fill(result, task)
        given = task.parameters
        result.parameters |= dict(zip("xy", given.axes, strict=True))
        result.parameters |= {"low": given.window.low, "high": given.window.high}
        axes = given.vary, given.load
        begins = {b.name: {n: float(b.columns[n][0]) for n in axes} for b in result.branches}
        result.numerics["begins"] = begins

    def resolving(self, parameters: DiagramParameters, numerics: DiagramNumerics) -> DiagramNumerics:
        """More cells for long tubes; two solutions of what has no mesh, which differ by round-off."""
        if parameters.body == "fluid_tube" and "step" not in numerics.model_fields_set:
            return numerics.model_copy(update={"step": STEP})
        if parameters.subject.uniform and "levels" not in numerics.model_fields_set:
            return numerics.model_copy(update={"levels": 2})
        window = parameters.window
        longest = window.high if parameters.vary == "lf" else parameters.lf
        return resolving(longest, numerics) if parameters.body == "tube" else numerics

    def finer(self, parameters: DiagramParameters, numerics: DiagramNumerics) -> DiagramNumerics | None:
        """Meshes with twice as many cells; none for what has no mesh."""
        return None if parameters.subject.uniform else super().finer(parameters, numerics)

    def points(self, parameters: DiagramParameters) -> np.ndarray:
        """61 fractions of the meridian; one where all places are alike."""
        return np.array([0.5]) if parameters.subject.uniform else np.linspace(0.0, 1.0, 61)


def _lines_on(cells: int, task: Task) -> LinesOnMesh:
    """The membrane on a mesh."""
    given, numerics = task.parameters, task.numerics
    values = {name: getattr(given, name) for name in given.subject.parameters}
    constants = dict(given.material.constants)
    values |= {name: constants[name] for name in (given.vary,) if name in constants}
    model = given.subject.make(task.comm, given.material, values, cells, numerics.degree)
    return LinesOnMesh(model, given.window, given.touch, numerics.step, given.broken)


def _failures(on: LinesOnMesh, vary: str) -> list[Failure]:
    """Where lines could not be searched."""
    return [
        Failure(f"start of lines of kind {kind} at {vary} = {at:.6g}", reason)
        for (kind, at), reason in on.failed.items()
    ]


def _none(given: DiagramParameters, kind: str) -> str:
    """That there are no critical points of a kind, as text."""
    window, subject = given.window, given.subject
    return (
        f"diagram: no point of kind {kind} on the primary branches at {SCANNED} values of {given.vary} from "
        f"{window.low:g} to {window.high:g}, up to {subject.depth} = {window.end:g} or to where the "
        "law is at its limit; change low or "
        f"high, or raise {subject.end}"
    )
