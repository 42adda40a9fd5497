"""Reads what `ccx deck` printed (deck.dat) and writes curve.csv. Run: python3 curve.py."""

import re
import sys

from reading import DECK, HERE, write_curve

steps, block = [], None
for line in (HERE / "deck.dat").read_text(encoding="utf-8").splitlines():
    if line.strip().startswith("displacements"):
        block = {}
        steps.append((float(line.split()[-1]), block))
    elif block is not None and re.match(r"\s*\d+\s", line):
        node, *values = line.split()
        block[int(node)] = [float(value) for value in values]
stages = DECK["stages"]
ends = {round(time): found for time, found in steps if abs(time - round(time)) < 1e-6}
if len(ends) < len(stages):
    sys.exit(f"deck.dat has {len(ends)} of {len(stages)} steps: did ccx end?")
rows = []
for number, stage in enumerate(stages, 1):
    if stage["curve"]:
        r, z = [], []
        for pair, places in DECK["stations"]:
            moved = [
                [a + b for a, b in zip(p, ends[number][n], strict=False)]
                for n, p in zip(pair, places, strict=True)
            ]
            r.append(sum(m[0] for m in moved) / 2)
            z.append(sum(m[DECK["axis"]] for m in moved) / 2)
        rows.append((stage["load"], (r, z)))
write_curve(rows)
