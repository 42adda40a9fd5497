"""Tables for an extension of paper 5: a small bending energy limits the unstable wave numbers."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from reference_data.solvers.core.tables import Table, prescribed
from reference_data.solvers.paper4 import cases as cas
from reference_data.solvers.paper4.cases import Pair
from reference_data.solvers.paper5 import cases as rel
from reference_data.solvers.paper5 import text
from reference_data.solvers.paper5.waves import bending as ben
from reference_data.solvers.paper5.waves import koiter as koi
from reference_data.solvers.paper5.waves import shots as sht
from reference_data.solvers.paper5.waves.bending import Bent
from reference_data.solvers.paper5.waves.cylinder import FLUID
from reference_data.solvers.paper5.waves.transfer import Transfer
from reference_data.solvers.registry import Builder

KOITER = ben.koiter(0.01, 0.01)  # h/Ao of the paper
GUESSES = {2.0: 200.0, 3.0: 58.0, 4.0: 23.6, 5.0: 11.2, 5.73: 7.0, 6.6: 4.4, 7.0: 11.4, 8.0: 15.0}
BANDS = {5.73: 7.7, 6.0: 7.0, 6.3: 7.0, 6.6: 7.0}
WINDOW = ((5.4, 5.72, 7.7), (6.75, 6.98, 11.0))
MODELS = ((3.0, 10), (4.5, 5), (4.5, 10), (4.5, 20))
HEMISPHERE_LEVELS, HEMISPHERE_N = (-1.1, -1.0, -0.9, -0.8), (10, 20, 50, 100)
OFFSET = 0.02  # of n, in differences of the canonical system's eigenvalue
ABOUT = {
    "beta_c": ("D = beta H^3 over C1 h Ao^2", "least beta that leaves no unstable real n (model B1)"),
    "n_c": ("1", "real wave number that is last to become stable"),
    "n_minus": ("1", "lower end of the band of unstable real n"),
    "n_plus": ("1", "upper end of the band of unstable real n"),
}
NOTES = (
    "Model B1: 2 Pi2_b/pi = int D R k22^2 ds with D = beta H^3 and the incremental hoop curvature k22, "
    "the equilibrium untouched. Koiter's beta of the paper's sheet, (2/3)(1 + c2)(h/Ao)^2, is "
    f"{KOITER:.6g}."
)


def four(zw: float, n: float, beta: float) -> tuple[list[float], list[float]]:
    """Lowest eigenvalue by matrices (coarse, fine) and by the canonical system (coarse, fine)."""
    spectrum = rel.cylinder(FLUID, zw)
    a = [Bent(f).first(n, beta)[0] for f in spectrum.forms]
    b = [float(Transfer(p, n, beta).lowest(1)[0]) for p in spectrum.parts(n)]
    return a, b


def shifted(x: float, values: list[float], slope: float, floor: float = 0.0) -> Pair:
    """Roots near x of functions with these values and this slope there."""
    floor = floor + rel.ROUNDING / abs(slope)
    return Pair(np.array(x - values[0] / slope), np.array(x - values[1] / slope), np.array(floor))


def critical_row(zw: float, guess: float) -> dict[str, tuple[Pair, Pair]]:
    """beta_c and n_c by both methods."""
    spectrum = rel.cylinder(FLUID, zw)
    coarse, bent = (Bent(f) for f in spectrum.forms)
    beta, n = bent.critical(guess)
    a, b = four(zw, n, beta)
    slope = bent.first(n, beta)[1]
    step = OFFSET * n
    bend = (bent.tilt(n + step / 8, beta) - bent.tilt(n - step / 8, beta)) / (step / 4)
    ends = [[float(Transfer(p, n + k * step, beta).lowest(1)[0]) for k in (-2, -1, 1, 2)]
            for p in spectrum.parts(n)]  # fmt: skip
    tilts = [(8 * (e[2] - e[1]) - (e[3] - e[0])) / (12 * step) for e in ends]
    own = [coarse.tilt(n, beta), bent.tilt(n, beta)]
    floor = 3e-6 * n  # of the differences by n
    return {
        "beta_c": (shifted(beta, a, slope), shifted(beta, b, slope)),
        "n_c": (shifted(n, own, bend, 1e-7 * n), shifted(n, tilts, bend, floor)),
    }


def critical(name: str) -> Table:
    """Critical beta and wave number per level."""
    rows = [critical_row(*x) for x in GUESSES.items()]
    columns = text.SERIES.keys(zw=list(GUESSES))
    for key in ("beta_c", "n_c"):
        columns.append(cas.agreed(name, key, *cas.stacked([r[key] for r in rows]), ABOUT[key]))
    return text.SERIES.table(
        name,
        "Bending stiffness that removes every instability, and the last unstable wave number",
        "beyond the paper",
        text.cylinder("fluid"),
        columns,
        notes=NOTES,
    )


def bands(name: str) -> Table:
    """Bands of unstable n with the paper's thickness."""
    rows: dict[str, list[tuple[Pair, Pair]]] = {"n_minus": [], "n_plus": []}
    for zw, guess in BANDS.items():
        bent = Bent(rel.cylinder(FLUID, zw).forms[1])
        for key, n in zip(rows, bent.band(KOITER, guess), strict=True):
            slope = bent.tilt(n, KOITER)
            rows[key].append(tuple(shifted(n, v, slope) for v in four(zw, n, KOITER)))
    columns = text.SERIES.keys(zw=list(BANDS))
    columns += [cas.agreed(name, key, *cas.stacked(pairs), ABOUT[key]) for key, pairs in rows.items()]
    return text.SERIES.table(
        name,
        "Band of unstable real wave numbers with the bending stiffness of the paper's sheet",
        "beyond the paper",
        text.cylinder("fluid") | {"beta": KOITER},
        columns,
        notes=NOTES,
    )


def window(name: str) -> Table:
    """Range of levels at which the sheet with its bending stiffness is unstable for some real n."""
    rows, numbers = [], []
    for low, high, guess in WINDOW:
        at = [guess]

        def least(zw: float, at: list[float] = at) -> float:
            value, at[0] = Bent(rel.cylinder(FLUID, float(zw)).forms[1]).lowest(KOITER, at[0])
            return value

        zw = float(brentq(least, low, high, xtol=1e-10))
        h = 1e-4
        slope = (least(zw + h) - least(zw - h)) / (2 * h)
        least(zw)
        rows.append(tuple(shifted(zw, v, slope) for v in four(zw, at[0], KOITER)))
        numbers.append(at[0])
    columns = [
        *text.SERIES.keys(direction=[1.0, -1.0]),
        cas.agreed(name, "zw", *cas.stacked(rows), text.COLUMNS["zw"]),
    ]
    return text.SERIES.table(
        name,
        "Levels between which the sheet with its own bending stiffness is unstable",
        "beyond the paper",
        text.cylinder("fluid") | {"beta": KOITER},
        columns,
        notes=NOTES + " All real n are admitted.",
        extra={"keys": ["direction"], "n": [float(f"{n:.6g}") for n in numbers]},
    )


def models(name: str) -> Table:
    """Lowest eigenvalue without bending, with model B1 and with Koiter's complete energy B2."""
    plain, hoop, whole = [], [], []
    for zw, n in MODELS:
        spectrum = rel.cylinder(FLUID, zw)
        plain.append(tuple(Pair(p.coarse[0], p.fine[0], p.floor[0]) for p in spectrum.lowest(n, 1)))
        hoop.append(tuple(Pair(np.array(v[0]), np.array(v[1]), rel.ROUNDING) for v in four(zw, n, KOITER)))
        states = [cas.solved(FLUID, zw).tracked[i] for i in (0, 1)]
        a = [koi.spectral(rel.cyl.quadratic(x), n, KOITER) for x in states]
        b = [koi.hermitian(spectrum.forms[0], n, KOITER, k) for k in (150, 300)]
        # fourth derivatives on polynomials of degree 18 cost digits
        whole.append(tuple(Pair(np.array(v[0]), np.array(v[1]), 1e-8) for v in (a, b)))
    zw, n = np.array(MODELS, dtype=float).T
    about = {
        "Lambda_membrane": (plain, "lowest eigenvalue without bending"),
        "Lambda_B1": (hoop, "with the hoops' bending energy (B1)"),
        "Lambda_B2": (whole, "with Koiter's bending energy (B2), edges simply supported"),
    }
    columns = [
        *text.SERIES.keys(n=n, zw=zw),
        prescribed("beta", np.full(len(n), KOITER), ("D = beta H^3 over C1 h Ao^2", "bending stiffness")),
    ]
    for key, (pairs, meaning) in about.items():
        columns.append(cas.agreed(name, key, *cas.stacked(pairs), (text.EIGENVALUE, meaning)))
    return text.SERIES.table(
        name,
        "Lowest eigenvalue by two models of bending",
        "beyond the paper",
        text.cylinder("fluid"),
        columns,
        notes=NOTES
        + " B2: (a) polynomials with continuous slopes, dense; (b) cubic Hermite elements, 150 and "
        "300, with the second variation in principal axes.",
        extra={"keys": ["n", "zw"]},
    )


def hemisphere(name: str) -> Table:
    """Lowest eigenvalues of the hemisphere with the hoops' bending energy of its own thickness."""
    beta = ben.koiter(0.0, 1e-3)
    keys = [(zw, n) for zw in HEMISPHERE_LEVELS for n in HEMISPHERE_N]
    pairs = []
    for zw, n in keys:
        found = rel.hemisphere(zw)
        a = [Bent(f).first(n, beta)[0] for f in found.spectrum.forms]
        # bending varies faster along the meridian, so that parts are a half and a quarter as long
        parts = [sht.hemisphere_parts(x, n, k) for x, k in zip(found.shots, (2, 4), strict=True)]
        b = [float(Transfer(p, n, beta).lowest(1)[0]) for p in parts]
        pairs.append(tuple(Pair(np.array(v[0]), np.array(v[1]), rel.ROUNDING) for v in (a, b)))
    zw, n = np.array(keys, dtype=float).T
    about = (text.EIGENVALUE, "lowest eigenvalue with the hoops' bending energy (B1)")
    columns = [
        *text.SERIES.keys(zw=zw, n=n),
        cas.agreed(name, "Lambda_B1", *cas.stacked(pairs), about),
    ]
    return text.SERIES.table(
        name,
        "Lowest eigenvalues of the hemisphere with bending, h/Ao = 1/1000",
        "beyond the paper",
        {"c2": 0.0, "h_over_Ao": 1e-3, "beta": beta},
        columns,
        grid=text.HEMISPHERE_GRID,
        extra={"keys": ["zw", "n"]},
    )


TABLES: dict[str, Builder] = {
    "bending_hemisphere": lambda: hemisphere("bending_hemisphere"),
    "bending_critical": lambda: critical("bending_critical"),
    "bending_bands": lambda: bands("bending_bands"),
    "bending_window": lambda: window("bending_window"),
    "bending_models": lambda: models("bending_models"),
}
