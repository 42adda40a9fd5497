"""The five conditions of section 3.1.1 on a strain energy, and the laws that do not satisfy them.

Saint Venant-Kirchhoff's energy stays finite as a stretch goes to zero (condition 5), and its stress in
compression comes back to zero; the harmonic material's energy becomes negative in large equibiaxial
stretches (condition 1), and stays finite too (condition 5). This case states these failures, so that it fails
if a change hides them.

Condition 2, invariance under coordinate transformations, holds for a function of the principal stretches.
What is tested is the form that membranes in space use: from the metric of coordinates that are turned against
the principal directions and skew, of a sheet that is turned in space.
"""

import numpy as np

from weakforms.cases import Case, Claim, Finding, Solutions, decide, homogeneous, material, reference

GROWING = (
    "neo_hookean",
    "mooney_rivlin",
    "rivlin",
    "ogden",
    "biderman",
    "rivlin_saunders",
    "beda_chevalier",
    "varga",
)
LIMITED = {"three_chain": 5.1, "arruda_boyce": 6.2, "gent": 7.0}
"""Laws of limited extensibility and an equibiaxial stretch near its limit."""
ALL = (*GROWING, *LIMITED, "saint_venant_kirchhoff", "harmonic")
SMALL, LARGE = (1e-1, 1e-2, 1e-3), (10.0, 30.0, 90.0)
REST = {m: material(model=m, l1=1.0, l2=1.0) for m in ALL}
THIN = {
    m: [material(model=m, l1=x, l2=1.0) for x in SMALL]
    for m in (*GROWING, "saint_venant_kirchhoff", "harmonic")
}
LONG = {m: [material(model=m, l1=x, l2=1.0) for x in LARGE] for m in GROWING}
NEAR = {m: [material(model=m, l1=x, l2=x) for x in (0.6 * end, 0.9 * end, end)] for m, end in LIMITED.items()}
SWOLLEN = [material(model="harmonic", l1=x, l2=x) for x in (2.0, 7.0)]
PRESSED = homogeneous(model="saint_venant_kirchhoff", loading="uniaxial", lam_end=0.3)


SAMPLES = {
    m: [
        material(model=m, l1=float(a), l2=float(b))
        for a, b in zip(*(reference("materials", f"law_{m}").columns[n] for n in ("l1", "l2")), strict=True)
        if (a, b) != (1, 1)
    ]
    for m in ALL
    if m != "harmonic"
}
STRETCHES = ((1.5, 0.9), (2.0, 1.2))
COORDINATES = ((0.7, 0.6, 1.1), (2.5, -1.3, -0.4))
"""Angle and skew of coordinates in the sheet, and an angle by which the sheet is turned in space."""
PLACED = {
    m: [
        material(model=m, l1=a, l2=b, turn=turn, skew=skew, tilt=tilt)
        for a, b in (*STRETCHES, (1.3, 1.3), (2.0, 0.5))
        for turn, skew, tilt in COORDINATES
    ]
    for m in ALL
}
"""Taut, with equal stretches, and wrinkled."""
INCOMPRESSIBLE = tuple(m for m in ALL if m not in ("saint_venant_kirchhoff", "harmonic"))
PERMUTED = {
    m: [
        [material(model=m, l1=x, l2=y) for x, y in ((a, b), (a, 1 / (a * b)), (1 / (a * b), b))]
        for a, b in STRETCHES
    ]
    for m in INCOMPRESSIBLE
}
"""Two of the three stretches, whose product is 1."""
SWAPPED = {
    m: [(material(model=m, l1=a, l2=b), material(model=m, l1=b, l2=a)) for a, b in STRETCHES] for m in ALL
}
EXCHANGED = {"W": "W", "W1": "W2", "W2": "W1", "W11": "W22", "W22": "W11", "W12": "W12"}
NOT_CONSTANT = decide.Stated(0.1, "differ", "section 3.2.4: no number is printed; it would be zero")
POWER = decide.Stated(
    1.5,
    "goes to infinity",
    "section 3.1.1: a power law grows at least by the root of the factor when a stretch is divided by ten or "
    "tripled",
)
STEEPER = decide.Stated(
    3, "without bound", "section 3.1.1: over the last third of the way the stress rises faster than before"
)


def energies(solutions: Solutions, specs: list) -> decide.Number:
    """``W`` at some stretches, exact up to rounding."""
    return decide.stack(solutions.whole(spec, "W") for spec in specs)


def rest(solutions: Solutions) -> Finding:
    """Energy and stresses of all laws at rest."""
    found = [solutions.whole(spec, n).value for spec in REST.values() for n in ("W", "W1", "W2")]
    return decide.exact(f"W, W1, W2 of {len(REST)} laws", found, 0.0)


def not_negative(solutions: Solutions) -> Finding:
    """Energies of all laws but the harmonic one at the stretches of their tables."""
    return decide.all_of(
        decide.positive(f"W of {model}", energies(solutions, specs)) for model, specs in SAMPLES.items()
    )


def symmetric(solutions: Solutions) -> Finding:
    """Energy and its derivatives with both stretches exchanged."""
    found = []
    for model, pairs in SWAPPED.items():
        for one, two in pairs:
            here, there = (solutions.result(spec).quantities for spec in (one, two))
            values = np.array([here[name].value for name in EXCHANGED])
            others = np.array([there[name].value for name in EXCHANGED.values()])
            found.append(decide.exact(model, values, others, 1 + np.abs(values).max()))
    return decide.all_of(found)


def invariant(solutions: Solutions) -> Finding:
    """Energies from the metric of other coordinates of a sheet turned in space, full and relaxed."""
    found = []
    for model, specs in PLACED.items():
        relaxed = model in INCOMPRESSIBLE and model != "three_chain"  # which have a form by the metric
        for name in ("W", "W_relaxed") if relaxed else ("W",):
            other = name.replace("W", "W_metric")
            known, placed = (np.array([solutions.whole(s, n).value for s in specs]) for n in (name, other))
            found.append(decide.exact(f"{name} of {model}", placed, known, 1 + np.abs(known).max()))
    return decide.all_of(found)


def symmetric_in_thickness(solutions: Solutions) -> Finding:
    """Energy with one of the two stretches exchanged with the stretch of the thickness."""
    found = []
    for model, triples in PERMUTED.items():
        for specs in triples:
            w = energies(solutions, specs).value
            found.append(decide.exact(model, w[1:], w[0], 1 + np.abs(w).max()))
    return decide.all_of(found)


def space_and_sheet(solutions: Solutions) -> Finding:
    """(W1 - W2)/(l1 - l2) of the harmonic material: proportional to its thickness, not constant."""
    ratios, thickness = [], []
    for (a, b), (spec, _) in zip(STRETCHES, SWAPPED["harmonic"], strict=True):
        q = solutions.result(spec).quantities
        ratios.append((q["W1"].value - q["W2"].value) / (a - b))
        thickness.append(3 + (a * b - 1) / 2 - a - b)  # f'(i) = l1 l2 with f'' = 2
    over = np.array(ratios) / np.array(thickness)
    return decide.all_of(
        decide.exact("over l3, at two deformations", over[0], over[1], over[1]),
        decide.at_least("ratio without l3", abs(ratios[0] / ratios[1] - 1), NOT_CONSTANT),
    )


def grows(solutions: Solutions) -> Finding:
    """Energies towards vanishing and towards infinite stretches."""
    found = []
    for series in (THIN, LONG):
        for model in GROWING:
            w = energies(solutions, series[model])
            found += [
                decide.positive(f"W of {model}", w),
                decide.at_least("its growth", w[1:] / w[:-1], POWER),
            ]
    return decide.all_of(found)


def locks(solutions: Solutions) -> Finding:
    """Stresses near full extension."""
    found = []
    for model, specs in NEAR.items():
        steps = decide.stack(solutions.whole(spec, "W1") for spec in specs).diff()
        found += [
            decide.positive(f"rises of W1 of {model}", steps),
            decide.at_least("their ratio", steps[1] / steps[0], STEEPER),
        ]
    return decide.all_of(found)


def kirchhoff_stays_finite(solutions: Solutions) -> Finding:
    """Condition 5 does not hold: as l1 tends to zero, the energy tends to a finite limit, like l1^2."""
    w = energies(solutions, THIN["saint_venant_kirchhoff"])
    limit = 2.0 / (1 - 0.5) / 4  # Y/(2 (1 - nu^2)) E1^2 at E1 = -1/2
    return decide.order(f"W less {limit:g}", [1 / x for x in SMALL], w - limit, 2)


def harmonic_stays_finite(solutions: Solutions) -> Finding:
    """Condition 5 does not hold: as l1 tends to zero, the energy tends to 2 mu f(5/2) = 3, like l1."""
    w = energies(solutions, THIN["harmonic"])
    return decide.order("W less 3", [1 / x for x in SMALL], w - 3.0, 1)


def kirchhoff_gives_way(solutions: Solutions) -> Finding:
    """In compression the stress has a limit point at lam = 1/sqrt(3)."""
    found = solutions.points(PRESSED, "limit_point")
    return decide.all_of(
        decide.same("limit points", len(found), 1),
        decide.agree("its stretch", solutions.point(PRESSED, "limit_point", "lam"), 3**-0.5, 5e-10),
    )


def harmonic_is_negative(solutions: Solutions) -> Finding:
    """Condition 1 holds at l1 = l2 = 2 and fails at 7."""
    w = energies(solutions, SWOLLEN)
    return decide.all_of(decide.positive("W at 2", w[0]), decide.negative("W at 7", w[1]))


def moduli() -> dict[str, float]:
    """Small-strain shear moduli over S, in closed form."""
    y = 0.6  # inverse Langevin function of 1/sqrt(26.5), by Newton's method
    x = 26.5**-0.5
    for _ in range(50):
        y -= (1 / np.tanh(y) - 1 / y - x) / (1 / y**2 - 1 / np.sinh(y) ** 2)
    bend = 1 / (1 / y**2 - 1 / np.sinh(y) ** 2)
    return {
        "neo_hookean": 2.0,
        "mooney_rivlin": 2 * 1.1,
        "rivlin": 2 * 1.1,
        "ogden": (1.491 * 1.3 + 0.003 * 5 + 0.023 * 2) / 2,
        "biderman": 2 * 1.1,
        "rivlin_saunders": 2 * 1.2,
        "three_chain": 2 * (y / x + bend) / 6,
        "arruda_boyce": 2 * y / (3 * x),
        "beda_chevalier": 2 * (1 + 2.36 / 3) + 1e-3 * 5 / 2,
        "varga": 2.0,
        "gent": 2.0,
    }


def small_strains(solutions: Solutions) -> Finding:
    """W11 = W22 = 4 mu, W12 = 2 mu at rest; 3 mu, 6 mu, 4 mu are the slopes of the three tests."""
    gaps = []
    for model, mu in moduli().items():
        q = {n: v.value for n, v in solutions.result(REST[model]).quantities.items()}
        slopes = (
            q["W11"] - q["W12"] ** 2 / q["W22"] - 3 * mu,  # uniaxial: no stress across
            q["W11"] + q["W12"] - 6 * mu,  # equibiaxial
            q["W11"] - 4 * mu,  # pure shear
            q["W22"] - 4 * mu,
        )
        gaps += [s / mu for s in slopes]
    nu, f2 = 0.5, 2.0
    for model, mu, poisson in (
        ("saint_venant_kirchhoff", 2.0, nu),
        ("harmonic", 2.0, (f2 - 1) / (2 * f2 - 1)),
    ):
        q = {n: v.value for n, v in solutions.result(REST[model]).quantities.items()}
        stiff = 2 * mu / (1 - poisson)
        gaps += [q["W11"] / stiff - 1, q["W12"] / (poisson * stiff) - 1]
    return decide.exact(f"slopes of {len(REST)} laws over mu", gaps, 0.0)


CASE = Case(
    title="Admissible strain energies, and two that are not",
    source="Patil (2016), section 3.1.1",
    checks=(
        Claim(
            "not_negative",
            "condition 1: the energy is positive at every deformation tried, except at rest",
            tuple((spec, None) for specs in SAMPLES.values() for spec in specs),
            not_negative,
        ),
        Claim(
            "space_and_sheet",
            "the harmonic energy in space (3.25), with its thickness eliminated, is none of the plane ones "
            "(3.26), whose (W1 - W2)/(l1 - l2) is constant: the two theories differ (section 3.2.4)",
            tuple((spec, None) for spec, _ in SWAPPED["harmonic"]),
            space_and_sheet,
        ),
        Claim(
            "invariant",
            "condition 2: the energy is the same in turned and skew coordinates, and for a sheet turned in "
            "space, every law",
            tuple((spec, None) for specs in PLACED.values() for spec in specs),
            invariant,
        ),
        Claim(
            "symmetric_in_thickness",
            "condition 3: the energy of an incompressible sheet is symmetric in all three stretches",
            tuple((s, None) for triples in PERMUTED.values() for specs in triples for s in specs),
            symmetric_in_thickness,
        ),
        Claim(
            "symmetric",
            "condition 3: the energy of an isotropic sheet is symmetric in the principal stretches",
            tuple((spec, None) for pairs in SWAPPED.values() for pair in pairs for spec in pair),
            symmetric,
        ),
        Claim(
            "rest",
            "condition 4: no energy and no stress at rest, every law",
            tuple((s, None) for s in REST.values()),
            rest,
        ),
        Claim(
            "growth",
            "condition 5: the energy goes to infinity with vanishing and with infinite stretches",
            tuple((s, None) for series in (THIN, LONG) for m in GROWING for s in series[m]),
            grows,
        ),
        Claim(
            "locking",
            "condition 5: laws of limited extensibility stiffen without bound before their limit",
            tuple((s, None) for specs in NEAR.values() for s in specs),
            locks,
        ),
        Claim(
            "kirchhoff_condition_5",
            "Saint Venant-Kirchhoff FAILS condition 5: its energy stays finite as a stretch vanishes",
            tuple((s, None) for s in THIN["saint_venant_kirchhoff"]),
            kirchhoff_stays_finite,
        ),
        Claim(
            "kirchhoff_compression",
            "Saint Venant-Kirchhoff has a limit point in uniaxial compression, at lam = 1/sqrt(3)",
            ((PRESSED, None),),
            kirchhoff_gives_way,
        ),
        Claim(
            "harmonic_condition_1",
            "the harmonic material with a quadratic f FAILS condition 1 in large equibiaxial stretches",
            tuple((s, None) for s in SWOLLEN),
            harmonic_is_negative,
        ),
        Claim(
            "harmonic_condition_5",
            "the harmonic material with a quadratic f FAILS condition 5: its energy stays finite as a "
            "stretch vanishes",
            tuple((s, None) for s in THIN["harmonic"]),
            harmonic_stays_finite,
        ),
        Claim(
            "small_strains",
            "small strains: slopes 3 mu, 6 mu and 4 mu of the three tests, Poisson's ratio of the others",
            tuple((s, None) for s in REST.values()),
            small_strains,
        ),
    ),
    slow=True,
)
