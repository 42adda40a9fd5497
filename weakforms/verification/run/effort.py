"""Progress of a run, in the seconds that its solutions took in earlier runs.

Solutions take from a tenth of a second to minutes, so that their number says little about the remaining time.
For what has not been solved into the folder yet there are the times that the package brings
(:mod:`weakforms.verification.run.usual`).
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from pathlib import Path
from statistics import fmean

from weakforms.results import write_atomically
from weakforms.verification.cases.specs import Spec

TIMES = "times.json"
"""File of an output folder with the seconds that its solutions took."""

KNOWN = 0.5
"""Share of the solutions of which a time must be known, for an estimate of all of them."""


class Effort:
    """Seconds that solutions took, from earlier runs into the same folder and from this one.

    Args:
        path: JSON file of seconds by solution; missing or damaged, nothing is known yet.
        specs: What this run solves.
        usual: Seconds of another machine, for solutions that are not in the file. They are scaled by what
            this machine took for others.
    """

    def __init__(self, path: Path, specs: Iterable[Spec], usual: Mapping[str, float] | None = None) -> None:
        self._path, self._specs = path, list(specs)
        self._seconds = _read(path)
        self._usual = dict(usual or {})
        self._done: set[Spec] = set()

    def finish(self, spec: Spec, seconds: float | None = None) -> None:
        """Mark a solution as done, and record its time if it was solved now."""
        self._done.add(spec)
        if seconds is not None and math.isfinite(seconds):
            self._seconds[str(spec)] = round(seconds, 3)

    def keep(self) -> None:
        """Store the times for the next run."""
        write_atomically(self._path, json.dumps(self._seconds, indent=0, sort_keys=True) + "\n")

    def _pace(self) -> float:
        """Times of this machine over the usual ones."""
        both = {str(spec) for spec in self._specs} & self._seconds.keys() & self._usual.keys()
        usual = sum(self._usual[name] for name in both)
        return sum(self._seconds[name] for name in both) / usual if usual else 1.0

    def _known(self) -> dict[str, float]:
        """Seconds of all solutions of which any time is known."""
        pace = self._pace()
        return {name: pace * seconds for name, seconds in self._usual.items()} | self._seconds

    def share(self) -> tuple[float, float]:
        """Seconds done and total seconds; a new solution counts like others of its problem."""
        times = self._known()
        known: dict[str, list[float]] = {}
        for spec in self._specs:
            if str(spec) in times:
                known.setdefault(spec.problem, []).append(times[str(spec)])
        usual = fmean(v for values in known.values() for v in values) if known else 1.0
        means = {problem: fmean(values) for problem, values in known.items()}

        def expected(spec: Spec) -> float:
            return times.get(str(spec), means.get(spec.problem, usual))

        total = sum(map(expected, self._specs))
        return sum(map(expected, self._done)), total

    def expected(self, at_once: int) -> float | None:
        """Seconds that what is not yet done will take, so many at a time; ``None`` if too little is known."""
        times = self._known()
        if sum(str(spec) in times for spec in self._specs) < KNOWN * len(self._specs):
            return None
        done, total = self.share()
        return (total - done) / at_once

    @property
    def is_of_this_machine(self) -> bool:
        """Whether all times are of earlier runs into the folder."""
        return all(str(spec) in self._seconds for spec in self._specs)

    @property
    def count(self) -> str:
        """``3 of 19``: solutions done."""
        return f"{len(self._done)} of {len(self._specs)}"


def _read(path: Path) -> dict[str, float]:
    """The seconds in a file; empty if it is not such a file."""
    try:
        data = json.loads(path.read_text("utf-8"))
        return {str(name): float(value) for name, value in data.items() if math.isfinite(value)}
    except (OSError, ValueError, TypeError, AttributeError):
        return {}
