"""A machine on which the script `run` is tested, with programs that record their arguments."""

import shutil
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).parents[3]
TOOLS = """awk bash cat chown chmod cp cut dirname flock grep id mkdir mktemp printf readlink rm sed
    sh sha256sum sleep stat tail timeout tr uname"""
CLI = """
import os, sys, time
def main():
    verb, *rest = sys.argv[1:]
    if verb == "exit":
        return int(rest[0])
    if verb == "env":
        print(*(os.environ.get(name, "-") for name in rest), os.getcwd(), sys.argv[0])
    if verb == "sleep":
        try:
            print("asleep", flush=True)
            time.sleep(30)
        except KeyboardInterrupt:
            return 130
"""


class Machine:
    """A machine that has only what a test installs, with a copy of the script in a small tree."""

    def __init__(self, folder: Path) -> None:
        self.tree = folder / "tree"
        self.bin = folder / "bin"
        self.calls_file = folder / "calls"
        self.environment = {
            "PATH": str(self.bin),
            "HOME": str(folder / "home"),
            "LANG": "C.UTF-8",
            "CALLS": str(self.calls_file),
        }
        (self.tree / "weakforms").mkdir(parents=True)
        (self.tree / "weakforms" / "__init__.py").touch()
        (self.tree / "weakforms" / "cli").mkdir()
        (self.tree / "weakforms" / "cli" / "__init__.py").write_text(CLI)
        for name in ("run", "Dockerfile", "pyproject.toml"):
            shutil.copy(ROOT / name, self.tree)
        self.bin.mkdir()
        for name in TOOLS.split():
            if path := shutil.which(name):
                (self.bin / name).symlink_to(path)
        self.put("python3", "exit 1")  # no dolfinx here
        self.put("ruff", "exit 1")

    def put(self, name: str, body: str = "exit 0") -> None:
        """Install a program that records its arguments and then runs `body`."""
        path = self.bin / name
        path.unlink(missing_ok=True)
        record = f"""{{ printf '%s\\037' {name} "$@"; echo; }} >> "$CALLS" """
        path.write_text(f"#!{shutil.which('bash')}\n{record}\n{body}\n")
        path.chmod(0o755)

    def put_dolfinx(self) -> None:
        """Make this machine look like the inside of the image."""
        path = self.bin / "python3"
        path.unlink()
        path.symlink_to(sys.executable)
        self.environment["WEAKFORMS_IN_IMAGE"] = "1"

    def run(self, *args: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        """Call the script; `cwd` is the tree by default."""
        return subprocess.run(
            [self.tree / "run", *args],
            cwd=cwd or self.tree,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=30,
            check=False,
        )

    def calls(self, *beginning: str) -> list[list[str]]:
        """All calls so far that begin with these words."""
        text = self.calls_file.read_text() if self.calls_file.exists() else ""
        calls = [line.rstrip("\x1f").split("\x1f") for line in text.splitlines()]
        return [call for call in calls if call[: len(beginning)] == list(beginning)]

    def tag(self) -> str:
        """The image used by the last `docker run`."""
        return next(word for word in self.calls("docker", "run")[-1] if word.startswith("weakforms-"))


def status_of_run(status: int) -> str:
    return f"if [[ $1 == run ]]; then exit {status}; fi"


def values(call: list[str], option: str) -> list[str]:
    """The values that follow each occurrence of an option."""
    return [after for before, after in pairwise(call) if before == option]
