"""What the audits print and store of prepared numbers, small enough to be checked by hand."""

import json
from collections.abc import Callable
from dataclasses import asdict, replace
from io import StringIO

import numpy as np
from rich.console import Console

from weakforms.results import Absence, Branch, Failure, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.audit.bench import print_bench
from weakforms.verification.audit.bench_history import slower
from weakforms.verification.audit.coverage import outcome as coverage
from weakforms.verification.audit.coverage.judged import Judged, _judged, statistics
from weakforms.verification.audit.diff import diff
from weakforms.verification.audit.same import Number, differences, scales

WIDTH = 120


def result(shift: float = 0.0, points: int = 4, **parameters: object) -> Result:
    """A result whose numbers move by a part of their sizes."""
    u = np.arange(points, dtype=float)
    more = 1 + shift
    columns = {"p": 8 * more * u / 3, "u_max": u, "n_negative": np.arange(points) // 2, "residual": u * more}
    branches = [Branch("primary", "p", columns, {"p": np.full(points, 1e-3)})]
    branches.append(Branch("other", "p", {"p": more * u[:3], "gap": np.array([np.nan, 1.0, np.nan])}))
    field = Field("profile", {"Z": u[:2], "rho": 2 * more + u[:2]}, {"rho": np.array([1e-3, 2e-3])})
    numbers = {"u_max": Quantity(1.5, 1e-6), "iterations": Quantity(3), "n_negative": Quantity(1)}
    numbers |= {"eigenvalue_1": Quantity(-4 * more, 1e-2), "Lambda": Quantity(1e-3 * more, 1e-5)}
    quantities = {
        "area": Quantity(5 * more, 0.02),
        "split": Quantity(3e-12 * more),
        "f_t": Quantity(0.25 * more),
    }
    point = SpecialPoint("limit_point", "primary", "p", {"p": 6 * more, "u_max": 2.0}, {"p": 0.05})
    given = {"alpha": 0.1} | parameters
    states = [State({"p": 2.0}, "primary", numbers, (field,), 2)]
    return Result(
        "tube", given, {}, {"cells": [8], "drawn": shift}, {}, branches, [point], quantities, states
    )


def changed() -> Result:
    """Another result: shifted, with a failure, an absence, and more and fewer numbers."""
    other = result(0.004, beta=2.0)
    other.failures.append(Failure("state at p = 9", "x"))
    other.absent.append(Absence("cusp", "x"))
    del other.quantities["split"]
    other.quantities["new"] = Quantity(1.0)
    other.special_points[0] = replace(other.special_points[0], uncertainty={"p": 0.06})
    return other


def compared(first: Result, second: Result) -> str:
    """All differences, the settings, and what is left out."""
    found = diff(first, second)
    rows = [" | ".join([*pair.cells, str(pair.agrees)]) for pair in found.pairs]
    head = f"same {found.same}, {len(found.different)} differ, {found.settings}, left out {found.left_out}"
    lines = [f"{name}: {scale:.10g}" for name, scale in scales(first, second).items()]
    return "\n".join(
        [head, *rows, *map(str, differences(first, second)), *lines, json.dumps(found.to_json())]
    )


def numbers() -> list[Judged]:
    """Errors inside an uncertainty, between one and two of it, beyond, and of round-off."""
    of = Judged("tube", (("alpha", 0.1),), "quantity p", "quantity", "p", 1e-6, 2e-6, 1e-9, 1e-10)
    return [
        of,
        replace(of, error=3e-6),
        replace(of, error=4.002e-6),
        replace(of, error=2.001e-6, name="V"),
        replace(of, error=1e-12, uncertainty=3e-9, name="x"),
        replace(of, truth=1e-6, name="y"),
        replace(of, truth=2e-6 / 30, name="z", error=1e-7),
        replace(of, kind="field", error=1e-12, uncertainty=1e-12, truth=1.0),
        replace(of, family="disk", error=1e-8, uncertainty=1e-6),
    ]


def judging() -> str:
    """Numbers of several sizes and names as they are judged, and the statistics of others."""
    given = [
        ("quantity p", "p", [100.0], [100.5], 0.1),
        ("quantity q", "q", [0.01], [0.02], 0.1),
        ("state x, profile rho", "rho", [1.0, 2.0, -4.0], [1.1, 2.05, -4.3], [0.2, 0.01, 0.1]),
        ("special point 1", "V", [3.0], [3.5], 0.25),
        ("state x, eigenvalue_1", "eigenvalue_1", [3.0], [2.5], 0.25),
    ]
    rows = []
    for place, name, coarse, fine, spread in given:
        one = Number(place, name, np.array(coarse), np.atleast_1d(spread))
        rows.append(_judged("tube", (), one, Number(place, name, np.array(fine), np.array([1e-3]))))
    rows += numbers()
    shown = [
        f"{asdict(r)}\n  within {r.within}, {r.bounded}, sharp {r.sharp}, ratio {r.ratio:.10g}" for r in rows
    ]
    return "\n".join([*shown, *map(str, statistics(numbers()))])


def covered() -> str:
    """What a test of uncertainties prints."""
    missed = [coverage.Missed({"alpha": 0.3}, "no state")]
    families = [
        coverage.outcome(name, [n for n in numbers() if n.family == name], 3, missed)
        for name in ("tube", "disk")
    ]
    families.append(coverage.outcome("none", [], 0, []))
    part = coverage.Part(7, 4, "2026-11-23T00:00:00+00:00", 83.0, "digest", {}, families)
    screen = Console(file=StringIO(), width=WIDTH)
    coverage.print_part(part, "hold-out", screen)
    counts = f"{part.count} {part.within:.6g} {part.outside} {part.missed}"
    text = coverage.markdown(row for family in families for row in family.rows)
    return "\n".join([screen.file.getvalue(), counts, text])


def row(name: str, ratio: float, **more: object) -> dict:
    """Measurements of a problem of the benchmark."""
    stages = {
        "matrix assembly": {"calls": 40, "seconds": 0.5},
        "factorisation": {"calls": 8, "seconds": 0.02},
    }
    times = {"run_seconds": 3.0, "floor_seconds": 2.0, "eigenvalues_seconds": 0.25, "peak_memory_mib": 123.6}
    head = {"name": name, "title": f"Problem {name}", "unknowns": 1001, "points": 50, "stages": stages}
    rest = {"ratio": ratio, "ratio_spread": 0.05, "ratio_asked": 1.3, "start": {"total": 9.0}}
    return head | times | rest | more


def benchmark() -> str:
    """The table of a benchmark, and what has become slower."""
    problems = [
        row("a", 1.3),
        row("b", 1.31, cold={"total": 75.0}, jit_seconds=61.5),
        row("c", 1.0),
        row("d", 1.0),
    ]
    table = {"ranks": 1, "cores": 2, "load": 0.25, "problems": problems}
    screen = Console(file=StringIO(), width=WIDTH)
    print_bench(table, screen)
    before = {"a": (1.0, 0.02), "b": (1.31 / 1.08, 0.04), "c": (1.25, 0.02)}
    lines, found = slower(table, {n: {"ratio": r, "ratio_spread": s} for n, (r, s) in before.items()})
    return "\n".join([screen.file.getvalue(), *lines, str(found)])


def sections() -> dict[str, Callable[[], str]]:
    """Every outline of audits by its title."""
    return {
        "equal results": lambda: compared(result(), result()),
        "results that differ": lambda: compared(result(), changed()),
        "branches with other points": lambda: compared(result(), result(1e-4, points=5)),
        "judged numbers": judging,
        "a test of uncertainties": covered,
        "a benchmark": benchmark,
    }
