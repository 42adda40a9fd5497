"""What a report shows besides the run of the cases: outcomes of other verbs in the same folder."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from weakforms.verification.audit.any_parameters.outcome import Audited
from weakforms.verification.audit.bench_ranks import Scaled
from weakforms.verification.audit.coverage.outcome import Covered
from weakforms.verification.audit.elsewhere import Elsewhere, load_elsewhere
from weakforms.verification.audit.faults.outcome import Seeded


@dataclass(frozen=True)
class Beside:
    """Outcomes that lie beside a run."""

    seeded: Seeded = field(default_factory=Seeded)
    """Of seeded faults."""
    others: tuple[Elsewhere, ...] = ()
    """Runs of the same cases on other ranks or releases."""
    audited: Audited = field(default_factory=Audited)
    """Of an audit."""
    covered: Covered = field(default_factory=Covered)
    """Comparison of uncertainties with true errors."""
    scaled: Scaled = field(default_factory=Scaled)
    """Time of large surfaces by their size and by the number of ranks."""

    @classmethod
    def read(cls, folder: Path, others: bool = True) -> Beside:
        """From a report's own folder.

        Args:
            folder: The folder.
            others: Whether its comparison with other runs is of this run.

        Raises:
            InputError: If that comparison is damaged; other damaged files are shown as such.
        """
        found = [kind.beside(folder) for kind in (Seeded, Audited, Covered, Scaled)]
        return cls(found[0], load_elsewhere(folder) if others else (), *found[1:])
