"""Writes decks, runs them in the codes that are installed, prints verdicts: ``examples/run decks [CODE]...``.

The decks are written by ``./run deck``, which needs DOLFINx or the image. Each code needs only its own
packages: CalculiX is the program ``ccx`` (apt has ``calculix-ccx``), NGSolve and sfepy are Python packages.
With ``--mistakes`` the tube of each code is run with a wrong material, load and clamp; each must fail.
"""

import importlib.metadata
import importlib.util
import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
DECKS = (
    ("calculix", "tube delta1=1.1 --at p=1.5"),
    ("calculix", "circular beta=1.1 --at p=2"),
    ("calculix", "sphere --at P=2"),
    ("ngsolve", "tube delta1=1.1 --at p=1.5 --cells 16"),
    ("ngsolve", "circular beta=1.1 --at p=2 --cells 16"),
    ("ngsolve", "sphere --at P=2 --cells 16"),
    ("ngsolve", "wrinkled_tube M=0.5 load=gas --at p=0.3 --cells 24"),
    ("sfepy", "tube delta1=1.1 --at p=1.5"),
    ("sfepy", "circular beta=1.1 --at p=2"),
    ("sfepy", "sphere --at P=2"),
)
MISTAKES = {
    "material": {
        "deck.inp": (r"(?<=MOONEY-RIVLIN\n500, )50,", "100,"),
        "deck.json": (r"(?<=C2/C1\": )0.1", "0.2"),
    },
    "load": {
        "deck.inp": (r"(?<=WALL, P1, )(.*)", lambda hit: str(0.97 * float(hit[1]))),
        "deck.py": (
            r"-load \* height|load\[0\] \* np\.eye",
            lambda hit: "0.97 * " + hit[0].replace("-", "-1.0 * "),
        ),
    },
    "clamp": {
        "deck.inp": (r"(?<=, 3, 3, )(.*)|(?<=, 2, 2, )(.*)", lambda hit: str(0.9 * float(hit[0]))),
        "deck.json": (r"(?<=\"height\": )([\d.]+)", lambda hit: str(0.99 * float(hit[1]))),
    },
}
"""A pattern in a file of a tube's deck, and what the mistake makes of it, for the files that a deck has."""

LIMIT = 300
"""Seconds that a code may take."""


def version(code: str) -> str | None:
    """The version of a code, or None if it is not installed."""
    if code != "calculix":
        return importlib.metadata.version(code) if importlib.util.find_spec(code) else None
    if not shutil.which("ccx"):
        return None
    said = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    return (re.findall(r"Version (\S+)", said) or ["?"])[0]


def mesh(folder: Path) -> str:
    """Number of cells of a deck's mesh."""
    if (folder / "deck.inp").exists():
        text = (folder / "deck.inp").read_text(encoding="utf-8")
        return f"{text.split('ELSET=WALL')[1].split('*')[0].count(chr(10)) - 1} CAX8R"
    text = (folder / "deck.msh").read_text(encoding="utf-8")
    return f"{len(re.findall(r'^[0-9]+ 9 2 ', text, flags=re.MULTILINE))} triangles of 6 nodes"


def spoil(folder: Path, mistake: str) -> None:
    """Put a mistake into a deck that was written; it is an error if the place is not there."""
    places = {name: change for name, change in MISTAKES[mistake].items() if (folder / name).exists()}
    name, (pattern, wrong) = next(iter(places.items()))
    text, count = re.subn(pattern, wrong, (folder / name).read_text(encoding="utf-8"))
    if not count:
        sys.exit(f"{name}: no place for a mistake in the {mistake}")
    (folder / name).write_text(text, encoding="utf-8")


def run(code: str, words: str, folder: Path, mistake: str = "") -> int:
    """Write a deck, run it, judge its curve; the exit status of the verdict."""
    write = [TREE / "run", "deck", *words.split(), "--for", code, "--out", folder]
    subprocess.run(write, check=True, stdout=subprocess.DEVNULL)
    if mistake:
        spoil(folder, mistake)
    facts = json.loads((folder / "deck.json").read_text(encoding="utf-8"))
    calls = (
        [[sys.executable, "deck.py"]]
        if code != "calculix"
        else [["ccx", "deck"], [sys.executable, "curve.py"]]
    )
    began = time.perf_counter()
    for call in calls:
        try:
            done = subprocess.run(
                call, cwd=folder, capture_output=True, text=True, check=False, timeout=LIMIT
            )
        except subprocess.TimeoutExpired:
            print(f"{code}: not solved in {LIMIT} s")
            return 1
        if done.returncode:
            print(f"{code}: {' '.join(map(str, call))} ended with {done.returncode}: {done.stderr[-300:]}")
            return 1
    took = time.perf_counter() - began
    compare = [sys.executable, "-m", "weakforms", *facts["verdict"].split()[1:], "--json"]
    judged = subprocess.run(compare, cwd=folder, capture_output=True, text=True, check=False)
    if judged.returncode not in (0, 1, 5):
        print(judged.stderr)
        return judged.returncode
    verdict = json.loads(judged.stdout)
    (worst,) = (entry for entry in verdict["verdicts"] if entry["column"] == facts["load"]["name"])
    print(
        f"{mesh(folder)}, {took:.0f} s: error {worst['signed_error']:+.1e} at {worst['where']}, "
        f"claimed {facts['accuracy']:.0e}: {verdict['status']}",
        flush=True,
    )
    return judged.returncode


def main() -> int:
    """Run all decks, or those of the codes named; 1 if one is not as it should be."""
    wanted, bad = set(sys.argv[1:]) - {"--mistakes"}, 0
    plan = [(code, words, "") for code, words in DECKS]
    if "--mistakes" in sys.argv:
        plan = [(*deck, mistake) for deck in DECKS if deck[1].startswith("tube") for mistake in MISTAKES]
    with tempfile.TemporaryDirectory() as scratch:
        for number, (code, words, mistake) in enumerate(plan):
            if wanted and code not in wanted:
                continue
            wrong = f", wrong {mistake}" if mistake else ""
            print(f"\n== {code} {version(code) or ''}: deck {words}{wrong}", flush=True)
            if version(code) is None:
                print(f"not run: {code} is not installed")
            else:
                status = run(code, words, Path(scratch) / f"deck{number}", mistake)
                bad += status != int(bool(mistake))
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
