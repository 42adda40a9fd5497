"""Reads what FEBio logged (watch.csv) and writes curve.csv. Run: python3 curve.py."""

import sys

from reading import DECK, HERE, write_curve

ends, time, found = {}, None, {}
for line in (HERE / "watch.csv").read_text(encoding="utf-8").splitlines():
    if line.startswith("*Time"):
        time, found = float(line.split("=")[1]), {}
        if abs(time - round(time)) < 1e-6:
            ends[round(time)] = found
    elif line and not line.startswith("*"):
        node, *place = line.replace(",", " ").split()
        found[int(node)] = [float(x) for x in place]
stages = DECK["stages"]
if len(ends) < len(stages):
    sys.exit(f"watch.csv has {len(ends)} of {len(stages)} stages: did FEBio end?")
rows = []
for number, stage in enumerate(stages, 1):
    if stage["curve"]:
        pairs = [[ends[number][n] for n in pair] for pair, _ in DECK["stations"]]
        rows.append((stage["load"], tuple([(a[k] + b[k]) / 2 for a, b in pairs] for k in (0, 2))))
write_curve(rows)
