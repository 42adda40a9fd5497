"""The problems of the benchmark: branches in one, two and three dimensions, by the usual code.

Each problem is set up (which compiles forms if needed), run once, and run again for the measurement. Then its
eigenvalues are computed at the last state.
"""

from __future__ import annotations

import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import partial, wraps
from importlib.util import find_spec
from typing import Any, Protocol

from mpi4py import MPI

from weakforms.problems.liquid_tube.bent.branch import SecondaryBranch, secondary_branch
from weakforms.problems.liquid_tube.bent.surface import SurfaceData
from weakforms.problems.liquid_tube.critical import PrimaryBranch
from weakforms.problems.material_choice import mooney_rivlin_of
from weakforms.problems.tube.model import TubeMesh, TubeModel, free_branch
from weakforms.solvers.equilibrium.linear import Factorization
from weakforms.solvers.equilibrium.system import System
from weakforms.solvers.stability.modes import SecondVariation
from weakforms.solvers.stability.spectra import Stability

PRIMITIVES = {
    (System, "tangent"): "matrix assembly",
    (System, "_vector"): "vector assembly",
    (System, "monitors"): "functionals",
    (System, "_scalar_derivatives"): "functionals",
    (Factorization, "refactor"): "factorisation",
    (Factorization, "solve"): "back substitution",
}
"""The necessary calls of a branch: assemblies and factorisations, each with its stage."""


@dataclass
class Meter:
    """Records calls of these functions and their time, so that the same calls can be repeated."""

    seconds: dict[str, float] = field(default_factory=lambda: defaultdict(float))
    calls: Counter[str] = field(default_factory=Counter)
    again: dict[Any, tuple[int, Callable[[], Any]]] = field(default_factory=dict)
    at: dict[Any, Callable[[], AbstractContextManager]] = field(default_factory=dict)
    """Context of the state that each call belongs to."""
    _inside: bool = False

    def note(self, stage: str, right: Callable, given: tuple, options: dict) -> Any:
        """Make a call and record it, unless it is part of a recorded call."""
        if self._inside:
            return right(*given, **options)
        key = right, id(given[0]), *(a for a in given[1:] if isinstance(a, str))
        if key not in self.at:
            self.at[key] = _lent_again(given[0])
        self._inside, begun = True, time.perf_counter()
        try:
            return right(*given, **options)
        finally:
            self.seconds[stage] += time.perf_counter() - begun
            self.calls[stage] += 1
            self._inside = False
            count, _ = self.again.get(key, (0, None))
            self.again[key] = (count + 1, self._repeated(stage, right, given, options))

    @staticmethod
    def _repeated(stage: str, right: Callable, given: tuple, options: dict) -> Callable[[], Any]:
        def call() -> Any:
            if stage == "factorisation":  # otherwise PETSc would reuse the factors
                given[0].system.matrix.stateIncrease()
            return right(*given, **options)

        return call

    def floor(self) -> None:
        """Repeat the same calls without other work between them."""
        for key, (count, call) in self.again.items():
            with self.at[key]():
                for _ in range(count):
                    call()


def _lent_again(of: System | Factorization) -> Callable[[], AbstractContextManager]:
    """Makes contexts of the state that some forms belong to now."""
    system = of.system if isinstance(of, Factorization) else of
    base = system.base if isinstance(system, SecondVariation) else system
    if not base.is_lent:
        return nullcontext
    return partial(base.at, base.state())


@contextmanager
def metered(primitives: dict[tuple[type, str], str]) -> Iterator[Meter]:
    """Context in which every call of these functions is recorded."""
    meter = Meter()
    kept = {(owner, name): getattr(owner, name) for owner, name in primitives}

    def noted(right: Callable, stage: str) -> Callable:
        return wraps(right)(lambda *given, **options: meter.note(stage, right, given, options))

    for (owner, name), right in kept.items():
        setattr(owner, name, noted(right, primitives[owner, name]))
    try:
        yield meter
    finally:
        for (owner, name), right in kept.items():
            setattr(owner, name, right)


class Work(Protocol):
    """One problem of the benchmark."""

    title: str
    asked: float
    """Largest accepted ratio of a run to its floor."""
    primitives: dict[tuple[type, str], str]

    def set_up(self, comm: MPI.Intracomm) -> None:
        """Mesh, forms, first equilibrium."""

    def run(self) -> int:
        """Follow the branch; returns its number of points."""

    def eigenvalues(self) -> int:
        """Compute the lowest three at the last state, with inertia; returns their number."""

    @property
    def system(self) -> System:
        """The discrete equations."""


class Tube:
    """Paper 2: a free Mooney-Rivlin tube, inflated past both its limit points."""

    title = "1-D: free tube past both limit points"
    asked = 1.3
    primitives = PRIMITIVES
    cells, degree, step, end = 150, 4, 0.07, 5.0

    def set_up(self, comm: MPI.Intracomm) -> None:
        """The half tube."""
        mesh = TubeMesh(self.cells, self.degree, 0.6)
        self.system = TubeModel.free(comm, mooney_rivlin_of(0.1), 1.0, 6.0, mesh).system

    def run(self) -> int:
        """The branch by arc-length."""
        self.branch = free_branch(self.system, 1.0, self.end, self.step)
        return len(self.branch.points)

    def eigenvalues(self) -> int:
        """Axisymmetric eigenvalues."""
        spectrum = Stability(self.system).spectrum(self.branch.points[-1].state, 3)
        return len(spectrum.eigenvalues)


class BentTube:
    """Paper 3: the bent fluid-filled tube on half its surface, from its bifurcation on."""

    title = "2-D: secondary branch of the fluid-loaded tube"
    asked = 1.1
    primitives = PRIMITIVES
    cells, degree, step, end = 16, 3, 0.1, 0.9

    def set_up(self, comm: MPI.Intracomm) -> None:
        """Locate the bifurcation point on the surface, and follow the branch once."""
        primary = PrimaryBranch(comm, 8.0, 2.0)
        data = SurfaceData(8.0, 2.0, 0.116, 0.0, self.cells, self.cells, self.degree)
        self.first = secondary_branch(comm, data, primary, self.step, self.end)
        self.system = self.first.system

    def run(self) -> int:
        """The branch by arc-length."""
        first = self.first
        count = first.points[0].n_negative
        self.branch = SecondaryBranch(first.model, first.bifurcation, first.mode, count, self.step, self.end)
        return len(self.branch.points)

    def eigenvalues(self) -> int:
        """Mirror-symmetric eigenvalues."""
        spectrum = Stability(self.system).spectrum(self.branch.points[-1].state, 3)
        return len(spectrum.eigenvalues)


class Triangles:
    """Paper 5: the wrinkled tube on flat triangles, filled further."""

    asked = 1.1
    loads = (1.0, 2.0, 3.0)

    def __init__(self, meridional: int, circumferential: int) -> None:
        from weakforms.solvers.equilibrium.subspace import Subspace

        self.shape = meridional, circumferential
        self.title = f"3-D: wrinkled tube on {meridional} x {circumferential} x 2 triangles"
        self.primitives = PRIMITIVES | {(Subspace, "_jacobian"): "matrix assembly"}

    def set_up(self, comm: MPI.Intracomm) -> None:
        """The surface with a small amount of fluid."""
        from weakforms.problems.triangles.problem import SurfaceParameters, _run

        meridional, circumferential = self.shape
        full = SurfaceParameters(meridional=meridional, circumferential=circumferential).filled()
        self.walk = _run(full, comm)
        self.system = self.walk.system

    def run(self) -> int:
        """Equilibria at higher levels, each with its inertia."""
        del self.walk._known[1:]
        self.points = [self.walk.at(load) for load in self.loads]
        return len(self.points)

    def eigenvalues(self) -> int:
        """Eigenvalues in the whole space."""
        self.walk.columns(self.points[-1], 3)
        return 3


def works() -> dict[str, Callable[[], Work]]:
    """The problems of the benchmark by name."""
    found: dict[str, Callable[[], Work]] = {"tube": Tube, "bent": BentTube}
    if find_spec("weakforms.problems.triangles.problem") is not None:
        for name, shape in {"small": (60, 24), "medium": (120, 48), "large": (160, 96)}.items():
            found[f"surface-{name}"] = lambda shape=shape: Triangles(*shape)
    return found
