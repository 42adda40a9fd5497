"""Columns of a table of the tube as a curve of another program."""

import numpy as np

from weakforms.verification.cases import references

CASE, CURVE = "paper2.fig03", "fig03a_delta1_1.1"
ONLY_P = ("compare", CASE, "--curve", CURVE, "--column", "p")


def table(**factors: float) -> dict[str, np.ndarray]:
    columns = references.load(2, CURVE).columns
    return {name: columns[name] * factors.get(name, 1.0) for name in ("u_max", "p")}


def as_csv(path, columns):
    rows = zip(*columns.values(), strict=True)
    path.write_text("\n".join([",".join(columns), *(",".join(repr(float(v)) for v in row) for row in rows)]))
    return path
