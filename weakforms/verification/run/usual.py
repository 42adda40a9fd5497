"""What solving all cases took before the release: seconds of each solution, and the size of its file.

A first run can then say how long it will take. After a full run on a machine without other work::

    ./run verify --out OUT
    ./run shell -c 'python3 -m weakforms.verification.run.usual OUT'

The times that are shipped now were measured beside other work, and scaled so that their sum is the 20 minutes
on two cores that a run takes without it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from weakforms.results import write_atomically
from weakforms.verification.cases.specs import Spec

SHIPPED = Path(__file__).parent / "usual_times.json"
"""For each solution its seconds and its kilobytes."""


@cache
def _shipped() -> dict[str, list[float]]:
    return json.loads(SHIPPED.read_text("utf-8"))


def usual_times() -> dict[str, float]:
    """Seconds by solution."""
    return {name: seconds for name, (seconds, _) in _shipped().items()}


def usual_megabytes(specs: Iterable[Spec]) -> float:
    """Size of the files of some solutions; one that is not known counts like the others."""
    specs = list(specs)
    sizes = [_shipped()[str(spec)][1] for spec in specs if str(spec) in _shipped()]
    return sum(sizes) / max(1, len(sizes)) * len(specs) / 1e3


def ship(out: Path) -> None:
    """Write the shipped file from the folder of a full run."""
    from weakforms.verification.cases.discovery import find_cases
    from weakforms.verification.run.effort import TIMES
    from weakforms.verification.run.plan import Plan
    from weakforms.verification.run.solving import solution_key

    seconds = json.loads((out / TIMES).read_text("utf-8"))
    found = {}
    for spec, states in Plan.of(find_cases()).states.items():
        size = (out / "solutions" / f"{solution_key(spec, states)}.json").stat().st_size
        found[str(spec)] = [round(seconds[str(spec)], 2), round(size / 1e3, 1)]
    write_atomically(SHIPPED, json.dumps(found, indent=0, sort_keys=True) + "\n")


if __name__ == "__main__":
    ship(Path(sys.argv[1]))
