"""The machine and the software a run was made with, for the report."""

from __future__ import annotations

import os
import platform
from pathlib import Path

from weakforms.world import world


def environment() -> dict[str, str]:
    """Versions of the stack, revision, machine, cores and memory as readable text."""
    from weakforms.solvers.support.provenance import revision, versions

    return {
        **versions(),
        "weakforms": revision(),
        "system": _system(),
        "machine": f"{platform.system()} {platform.machine()}",
        "processor": _processor(),
        "cores": str(os.cpu_count() or 1),
        "memory": _memory(),
        "ranks": str(world().size),
    }


def _system() -> str:
    """The distribution, with Debian's own version where there is one."""
    name = _field("/etc/os-release", "PRETTY_NAME", "=").strip('"')
    try:
        return f"{name} {Path('/etc/debian_version').read_text('utf-8').strip()}".strip()
    except OSError:
        return name or "unknown"


def _field(path: str, key: str, separator: str = ":") -> str:
    try:
        lines = Path(path).read_text("utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    return next((line.split(separator, 1)[1].strip() for line in lines if line.startswith(key)), "")


def _processor() -> str:
    return _field("/proc/cpuinfo", "model name") or platform.processor() or "unknown"


def _memory() -> str:
    amount = _field("/proc/meminfo", "MemTotal").split()
    return f"{int(amount[0]) / 2**20:.1f} GiB" if amount else "unknown"
