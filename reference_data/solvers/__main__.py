"""Command line: ``python -m reference_data.solvers NAME...`` computes and writes tables."""

from __future__ import annotations

import os

# Tables must be the same in every byte: threaded BLAS may change the order of sums.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import argparse  # noqa: E402
import difflib  # noqa: E402
import sys  # noqa: E402
import time  # noqa: E402
from pathlib import Path  # noqa: E402

from reference_data.solvers.core.tables import folder_of, write  # noqa: E402
from reference_data.solvers.registry import tables  # noqa: E402


def parser() -> argparse.ArgumentParser:
    """Arguments of the command."""
    out = argparse.ArgumentParser(prog="python -m reference_data.solvers", description=__doc__)
    out.add_argument("names", nargs="*", metavar="NAME", help="tables to compute")
    out.add_argument("--list", action="store_true", help="list the tables and stop")
    out.add_argument("--all", action="store_true", help="every table")
    out.add_argument("--paper", type=int, metavar="N", help="only, or every table of, paper N")
    out.add_argument(
        "--out",
        type=Path,
        default=Path(__file__).resolve().parents[1],
        metavar="DIR",
        help="folder for paperN/NAME.csv (default: reference_data)",
    )
    return out


def main(argv: list[str] | None = None) -> int:
    """Run the command; returns its exit status (2: bad input, 3: a table failed)."""
    args = parser().parse_args(argv)
    known = {n: t for n, t in tables().items() if args.paper in (None, t[0])}
    for name in args.names:
        if name not in known:
            close = difflib.get_close_matches(name, known, 1)
            hint = f"; did you mean {close[0]}?" if close else ""
            print(f"unknown table '{name}'{hint} (--list names them all)", file=sys.stderr)
            return 2
    if args.list:
        print("\n".join(f"{folder_of(paper)}  {name}" for name, (paper, _) in known.items()))
        return 0
    wanted = args.names or (list(known) if args.all or args.paper is not None else [])
    if not wanted:
        print("nothing to do: give a table, --paper N or --all (--list names them)", file=sys.stderr)
        return 2
    failed = 0
    for i, name in enumerate(wanted, 1):
        begin = time.perf_counter()
        try:
            path = write(known[name][1](), args.out)
        except (RuntimeError, ValueError) as error:
            failed += 1
            print(f"[{i}/{len(wanted)}] {name}: {error}", file=sys.stderr, flush=True)
            continue
        spent = time.perf_counter() - begin
        print(f"[{i}/{len(wanted)}] {name}: {path} ({spent:.1f} s)", flush=True)
    return 3 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
