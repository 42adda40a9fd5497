"""What every deck shares: reads deck.json, and writes the curve that `weakforms compare` judges."""

import csv
import json
import math
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
DECK = json.loads((HERE / "deck.json").read_text(encoding="utf-8"))


def volume(r: list[float], z: list[float]) -> float:
    """Volume inside a meridian over 2 pi; each three stations lie on a parabola."""
    total = 0.0
    for k in range(0, len(r) - 2, 2):
        for t, weight in ((-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9)):
            radius = r[k] * t * (t - 1) / 2 + r[k + 1] * (1 - t * t) + r[k + 2] * t * (t + 1) / 2
            slope = z[k] * (t - 0.5) - 2 * t * z[k + 1] + z[k + 2] * (t + 0.5)
            total -= weight * radius**2 / 2 * slope  # stations run downwards
    return total


def reading(r: list[float], z: list[float]) -> float:
    """The number over which the load is judged, from the deformed stations of a meridian."""
    problem = DECK["problem"]
    if problem == "tube":
        return r[-1] - 1.0
    if problem == "circular":
        return z[0]
    if problem == "sphere":
        return sum(math.hypot(a, b) for a, b in zip(r, z, strict=True)) / len(r)
    return volume(r, z)


def write_curve(rows: list[tuple[float, Any]]) -> None:
    """Write curve.csv from pairs of a load and stations (r, z) or a number, beside what is expected."""
    load, over = DECK["load"]["name"], DECK["over"]
    wanted = {round(row["load"], 12): row for row in DECK["expected"]}
    with (HERE / "curve.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow([over, load])
        for value, read in sorted(rows, key=lambda row: row[0]):
            found = reading(*map(list, read)) if isinstance(read, tuple) else read
            table.writerow([repr(float(found)), repr(float(value))])
            row = wanted[round(float(value), 12)]
            print(f"{load} = {value:.6g}: {over} = {found:.9g}, expected {row['value']:.9g}")
    print("judge it with:", DECK["verdict"])
