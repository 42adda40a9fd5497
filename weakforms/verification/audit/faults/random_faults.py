"""Faults that nobody chose: mutants drawn from the whole source, reproducible from number, seed and tree."""

from __future__ import annotations

import hashlib
import random
import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from weakforms.errors import InputError
from weakforms.verification.audit.faults.catalogue import FOLDER, REASONS, Fault
from weakforms.verification.audit.faults.mutations import Mutation, mutations
from weakforms.verification.cases.references import ROOT

GROUPS = {
    "forms": ("weakforms/forms",),
    "problems": ("weakforms/problems",),
    "solvers": ("weakforms/solvers",),
    "results": ("weakforms/results", "weakforms/scaling.py", "weakforms/api.py"),
    "verification": ("weakforms/verification",),
    "references": ("reference_data/solvers",),
}
"""Parts of the source that mutants are drawn from in turn."""

WITHOUT = "weakforms/verification/audit/faults/"
"""What runs and judges the mutants is not changed: it would judge itself."""

MOST = 2000
"""Mutants in one draw; each takes minutes."""

VERDICTS = ("equivalent", "harmless")
"""Of a mutant looked at: nothing can notice it; something can, but no number or statement changes."""


@dataclass(frozen=True)
class Mutant(Fault):
    """A change that was drawn, at one place of its file."""

    at: int = 0
    """Where in the file's text ``find`` begins."""
    line: int = 0
    verdict: str = ""
    """One of :data:`VERDICTS` where it was looked at by hand; ``reason`` then says why."""

    def applied(self, text: str) -> str:
        """The file's text with the change in it.

        Raises:
            InputError: When the file is another one than it was drawn from.
        """
        end = self.at + len(self.find)
        if text[self.at : end] != self.find:
            raise InputError(f"{self.name}: {self.file} changed since it was drawn")
        return text[: self.at] + self.replace + text[end:]


@dataclass(frozen=True)
class LookedAt:
    """What was found of a mutant by hand; it is known again by the text of its line."""

    file: str
    line: str
    mutation: str
    """As :func:`describe` writes it."""
    verdict: str
    reason: str


def describe(text: str, mutation: Mutation) -> str:
    """A change in words, such as ``arithmetic: `*` -> `/` in column 12`` of its line without indentation."""
    begin = text.rfind("\n", 0, mutation.start) + 1
    line = text[begin : mutation.start]
    column = len(line.lstrip()) + 1
    old = " ".join(text[mutation.start : mutation.end].split())
    return f"{mutation.kind}: `{old}` -> `{mutation.replace}` in column {column}"


@cache
def looked_at(folder: Path = FOLDER) -> tuple[LookedAt, ...]:
    """Mutants that were looked at by hand.

    Raises:
        InputError: When an entry is not sound.
    """
    path = folder / REASONS
    try:
        entries = tomllib.loads(path.read_text("utf-8")).get("mutant", [])
        found = tuple(LookedAt(**entry) for entry in entries)
    except (OSError, ValueError, TypeError) as error:
        raise InputError(f"{REASONS}: {error}") from error
    for entry in found:
        if entry.verdict not in VERDICTS or not entry.reason:
            raise InputError(
                f"{REASONS}: {entry.file}: {entry.line!r} needs a reason and a verdict of {VERDICTS}"
            )
    return found


def sources(group: str, root: Path = ROOT) -> list[Path]:
    """Files of a group, in the order of their names."""
    paths = [root / name for name in GROUPS[group]]
    found = [p for path in paths for p in ([path] if path.is_file() else sorted(path.rglob("*.py")))]
    return [path for path in found if not path.relative_to(root).as_posix().startswith(WITHOUT)]


def candidates(group: str, root: Path = ROOT) -> dict[tuple[str, int], list[Mutation]]:
    """Every change of a group of files, by file and line."""
    found: dict[tuple[str, int], list[Mutation]] = {}
    for path in sources(group, root):
        name = path.relative_to(root).as_posix()
        for mutation in mutations(path.read_text("utf-8")):
            found.setdefault((name, mutation.line), []).append(mutation)
    return found


def draw(number: int, seed: int, root: Path = ROOT) -> tuple[list[Mutant], int]:
    """Mutants at random: the groups in turn, in each any line alike, on it any of its changes alike.

    The first ``n`` of a longer draw with the same seed are the draw of ``n``; none is drawn twice.

    Args:
        number: How many.
        seed: What the draw depends on, besides the tree.
        root: The tree.

    Returns:
        The mutants, and how many there are to draw from.

    Raises:
        InputError: When the number is out of range, or there are fewer.
    """
    if not 0 < number <= MOST:
        raise InputError(f"--random {number}: allowed are 1 to {MOST}")
    groups = {group: candidates(group, root) for group in GROUPS}
    there_are = sum(len(found) for lines in groups.values() for found in lines.values())
    streams = {group: _stream(group, found, seed, root) for group, found in groups.items()}
    order = list(GROUPS)
    return [next(streams[order[k % len(order)]]) for k in range(number)], there_are


def _stream(
    group: str, lines: dict[tuple[str, int], list[Mutation]], seed: int, root: Path
) -> Iterator[Mutant]:
    chance, taken = random.Random(f"{seed} {group}"), set()
    places = sorted(lines)
    while len(taken) < sum(map(len, lines.values())):
        place = chance.choice(places)
        mutation = chance.choice(lines[place])
        if (place, mutation) in taken:
            continue
        taken.add((place, mutation))
        text = (root / place[0]).read_text("utf-8")
        if mutation.is_sound(text):
            yield _mutant(group, place[0], text, mutation)
    raise InputError(f"there are no more mutants of {group}")


def _mutant(group: str, file: str, text: str, mutation: Mutation) -> Mutant:
    line = text.split("\n")[mutation.line - 1].strip()
    said = describe(text, mutation)
    known = next((e for e in looked_at() if (e.file, e.line, e.mutation) == (file, line, said)), None)
    stem = re.sub("[^a-z0-9]+", "-", Path(file).stem.lower()).strip("-")
    mark = hashlib.sha256(f"{file} {mutation}".encode()).hexdigest()[:6]
    return Mutant(
        name=f"{stem}-{mutation.line}-{mark}",
        area=mutation.kind,
        subject=group,
        description=f"line {mutation.line}, {said}: {line}",
        file=file,
        find=text[mutation.start : mutation.end],
        replace=mutation.replace,
        expected=(),
        reason=known.reason if known else "",
        at=mutation.start,
        line=mutation.line,
        verdict=known.verdict if known else "",
    )
