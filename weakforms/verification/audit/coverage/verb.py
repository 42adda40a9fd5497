"""The body of ``weakforms coverage``: solves the sets, judges every number, keeps both parts in one file."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console

from weakforms.errors import ConvergenceError, InputError
from weakforms.problems.about import Family
from weakforms.results.io import dumps, require_writable, write_atomically
from weakforms.terminal import plain, print_json, require_one_rank
from weakforms.verification.audit.coverage.families import FAMILIES
from weakforms.verification.audit.coverage.families import SEED as TUNED_SEED
from weakforms.verification.audit.coverage.judged import Judged, judged
from weakforms.verification.audit.coverage.outcome import (
    NAME,
    PARTS,
    Coverage,
    FamilyOutcome,
    Missed,
    Part,
    load_coverage,
    outcome,
    print_part,
)
from weakforms.verification.audit.faults.scratch import tree_digest
from weakforms.verification.run.machine import environment


def coverage_verb(
    names: list[str], sets: int, held: bool, out: Path, resume: bool, as_json: bool, screen: Console
) -> int:
    """Solve the tuned sets or those held out; 0 when all that is claimed holds, else 1.

    Args:
        names: Families; empty for all.
        sets: Of each.
        held: Whether those held out.
        out: Folder of ``coverage.json``; the other part in it is kept.
        resume: Take over families stored for the same source and number of sets.
        as_json: Print JSON.
        screen: Where the table goes.

    Raises:
        InputError: For an unknown family, a folder that cannot be written, or a run on several ranks.
    """
    require_one_rank("coverage")
    from weakforms import api

    api.require_environment()
    from weakforms.verification.audit.coverage import hold_out

    known = {family.name: family for family in (hold_out.held_out() if held else FAMILIES)}
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(f"coverage: no family {unknown[0]!r}; there are {'; '.join(known)}")
    seed, key = (hold_out.SEED, "hold_out") if held else (TUNED_SEED, "tuned")
    require_writable(out)
    file = out / NAME
    stored = load_coverage(file) if file.exists() else Coverage()
    part = run_part([known[name] for name in names or known], sets, seed, key, stored, file, resume)
    if as_json:
        print_json(stored.to_json())
    else:
        print_part(part, PARTS[key], screen)
        screen.print(f"outcome: {file}", soft_wrap=True)
    return 1 if any(family.broken for family in part.families) else 0


def run_part(
    families: Iterable[Family], sets: int, seed: int, key: str, stored: Coverage, file: Path, resume: bool
) -> Part:
    """Solve families and store each at once, in the place of the part that was there."""
    begun, started, tree = time.perf_counter(), datetime.now(UTC).isoformat(timespec="seconds"), tree_digest()
    part, before = Part(seed, sets, started, 0.0, tree, environment()), stored.parts.get(key)
    known: dict[str, FamilyOutcome] = {}
    if resume and before is not None and (before.tree, before.sets, before.seed) == (tree, sets, seed):
        known = {family.name: family for family in before.families}
        part = replace(part, started=before.started, seconds=before.seconds)
    earlier = part.seconds
    stored.parts[key] = part
    for family in families:
        part.families.append(known.get(family.name) or examined(family, sets, seed))
        part.seconds = round(earlier + time.perf_counter() - begun, 3)
        write_atomically(file, dumps(stored.to_json()))
        said = f"{family.name}: {part.families[-1].count} numbers, {part.families[-1].solved} of {sets} sets"
        sys.stderr.write(f"weakforms: {plain(said)}\n")
        sys.stderr.flush()
    return part


def examined(family: Family, sets: int, seed: int) -> FamilyOutcome:
    """A family over the first sets of a seed; what cannot be solved is listed, and not drawn again."""
    found: list[Judged] = []
    missed = []
    for given in family.sets(sets, seed):
        try:
            found += judged(family, given)
        except (ConvergenceError, InputError) as error:
            missed.append(Missed(given, str(error)))
    return outcome(family.name, found, sets - len(missed), missed)
