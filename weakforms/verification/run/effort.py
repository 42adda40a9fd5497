"""Progress of a run, in the seconds that its solutions took in earlier runs.

Solutions take from a tenth of a second to minutes, so that their number says little about the remaining time.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from pathlib import Path
from statistics import fmean

from weakforms.results import write_atomically
from weakforms.verification.cases.specs import Spec

TIMES = "times.json"
"""File of an output folder with the seconds that its solutions took."""


class Effort:
    """Seconds that solutions took, from earlier runs into the same folder and from this one.

    Args:
        path: JSON file of seconds by solution; missing or damaged, nothing is known yet.
        specs: What this run solves.
    """

    def __init__(self, path: Path, specs: Iterable[Spec]) -> None:
        self._path, self._specs = path, list(specs)
        self._seconds = _read(path)
        self._done: set[Spec] = set()

    def finish(self, spec: Spec, seconds: float | None = None) -> None:
        """Mark a solution as done, and record its time if it was solved now."""
        self._done.add(spec)
        if seconds is not None and math.isfinite(seconds):
            self._seconds[str(spec)] = round(seconds, 3)

    def keep(self) -> None:
        """Store the times for the next run."""
        write_atomically(self._path, json.dumps(self._seconds, indent=0, sort_keys=True) + "\n")

    def share(self) -> tuple[float, float]:
        """Seconds done and total seconds; a new solution counts like others of its problem."""
        known: dict[str, list[float]] = {}
        for spec in self._specs:
            if str(spec) in self._seconds:
                known.setdefault(spec.problem, []).append(self._seconds[str(spec)])
        usual = fmean(v for values in known.values() for v in values) if known else 1.0

        def expected(spec: Spec) -> float:
            if str(spec) in self._seconds:
                return self._seconds[str(spec)]
            return fmean(known.get(spec.problem, [usual]))

        total = sum(map(expected, self._specs))
        return sum(map(expected, self._done)), total

    def expected(self, at_once: int) -> float | None:
        """Seconds that what is not yet done will take, so many at a time; ``None`` if a time is not known."""
        left = [self._seconds.get(str(spec)) for spec in self._specs if spec not in self._done]
        return None if None in left else sum(filter(None, left)) / at_once

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
