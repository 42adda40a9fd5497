"""Paper 5, extended: a small bending stiffness removes the instability to all short waves.

The paper asks for a modification that makes the model stable. A bending energy of the incremental curvature
does not change the equilibrium. With a stiffness beta H^3 the unstable wave numbers form a finite band, which
is empty above a critical beta. Model B1 contains the circumferential curvature only, model B2 the complete
bending energy of a thin shell.
"""

from weakforms.cases import (
    At,
    Case,
    Claim,
    Finding,
    Points,
    Solutions,
    decide,
    hemisphere,
    reference,
    wrinkled_bending,
    wrinkled_tube,
)

DATA = {"M": 1.5, "delta": 3, "Af": 0.4362}
PAPER = 2 / 3 * 1.01 * 0.01**2
"""Koiter's (2/3)(1 + C2/C1)(h/Ao)^2 for the paper's cylinder."""
THIN = 2 / 3 * 0.001**2
"""The same for the paper's hemisphere, of 0.1 mm and 0.1 m."""
ALL = (0, 1, *sorted({int(n) for n in reference(5, "stability_changes_fluid").columns["n"]}))
WAVES, TRIED = (6, 8, 10, 12), (2, 5, 10, 20, 30, 50, 100)
PLAIN = wrinkled_tube(**DATA, n=ALL, load_end=20.0)
STIFF = wrinkled_tube(**DATA, n=WAVES, load_end=20.0, beta=PAPER)
BOWL = hemisphere(n=TRIED, beta=THIN).on(step=0.2, cells=8)
OF_BOWL = reference(5, "bending_hemisphere")
LEVELS = tuple(float(zw) for zw in reference(5, "bending_critical").columns["zw"])
SMALL = {2.0: 2e-3, 3.0: 1e-4}
"""Relative accuracy asked of beta_c if it is so small that the absolute accuracy of the table is the
limit."""
SPECS = tuple(wrinkled_bending(zw=zw) for zw in LEVELS)
BANDS = tuple(
    wrinkled_bending(zw=float(zw), beta=PAPER) for zw in reference(5, "bending_bands").columns["zw"]
)
MODELS = tuple(
    wrinkled_bending(n=float(n), zw=float(zw), beta=float(beta))
    for n, zw, beta in zip(
        *(reference(5, "bending_models").columns[name] for name in ("n", "zw", "beta")), strict=True
    )
)


MOST = 400
"""Largest wave number of the search for bands."""
NEXT = decide.Stated(0.01, "next to", "no number is printed; a three hundredth of the window's width")
NEARLY_ALL = decide.Stated(0.2, "nearly all", "no number is printed; four fifths and more")


def window(solutions: Solutions, spec: object, n: int) -> list[decide.Number]:
    """Range of levels at which n waves are unstable, if there is one."""
    found = {
        p.values["direction"]: decide.of_point(p, "zw")
        for p in solutions.points(spec, "stability_change")
        if p.values["n"] == n
    }
    return [found[1.0], found[-1.0]] if len(found) == 2 else []


def inside(solutions: Solutions) -> Finding:
    """Ranges with and without bending stiffness: the first is inside the second, or empty."""
    found = []
    for n in WAVES:
        plain, stiff = (window(solutions, spec, n) for spec in (PLAIN, STIFF))
        if stiff:
            found.append(decide.less(f"n = {n}", plain[0], *stiff, plain[1]))
        else:
            found.append(decide.positive(f"n = {n}: eigenvalue", solutions.along(STIFF, f"Lambda_n{n}_1")))
    return decide.all_of(found)


def within_real(solutions: Solutions) -> Finding:
    """Levels of the first and last change over some whole n, and those over all real n."""
    table, found = reference(5, "bending_window"), []
    windows = list(filter(None, (window(solutions, STIFF, n) for n in WAVES)))
    for end, direction in ((0, 1), (1, -1)):
        (row,) = (table.columns["direction"] == direction).nonzero()[0]
        levels = decide.stack(w[end] for w in windows)
        nearest = levels.smallest() if direction == 1 else levels.largest()
        gap = direction * (nearest - table.number("zw")[row])
        found += [decide.positive("inside by", gap), decide.at_most("distance of the ends", gap, NEXT)]
    return decide.all_of(found)


def stiffens(solutions: Solutions) -> Finding:
    """Increase of the lowest eigenvalue by the stiffness, over the levels that both branches have."""
    plain, stiff = (list(solutions.branch(spec).columns["zw"]) for spec in (PLAIN, STIFF))
    common = [i for i, zw in enumerate(stiff) if zw in set(plain)]
    where = [plain.index(stiff[i]) for i in common]
    return decide.all_of(
        decide.every("more than ten levels", [len(common) > 10]),
        *(
            decide.positive(
                f"rise for n = {n}",
                solutions.along(STIFF, f"Lambda_n{n}_1")[common]
                - solutions.along(PLAIN, f"Lambda_n{n}_1")[where],
            )
            for n in WAVES
        ),
    )


def finite(solutions: Solutions) -> Finding:
    """Unstable band of real n with the paper's thickness at each level, and the levels without a band."""
    found = []
    for spec in BANDS:
        low, last, high, beta = (
            solutions.whole(spec, name) for name in ("n_minus", "n_c", "n_plus", "beta_c")
        )
        found += [decide.less("band", low, last, high, MOST), decide.less("stiffness", PAPER, beta)]
    return decide.all_of(found)


def wavelength(solutions: Solutions) -> Finding:
    """Critical stiffness and last unstable n at each level."""
    found = []
    for spec, zw in zip(SPECS, LEVELS, strict=True):
        found.append(decide.between(f"zw = {zw:g}: beta_c", solutions.whole(spec, "beta_c"), 0, 1))
        found.append(decide.between("n_c", solutions.whole(spec, "n_c"), 2, MOST))
    return decide.all_of(found)


def models_agree(solutions: Solutions) -> Finding:
    """Increase of the lowest eigenvalue by B1 over that by B2."""
    shares = []
    for spec in MODELS:
        base, one, two = (solutions.whole(spec, f"Lambda_{name}") for name in ("membrane", "B1", "B2"))
        shares.append((one - base) / (two - base))
    missing = 1 - decide.stack(shares)
    return decide.all_of(decide.positive("missing", missing), decide.at_most("missing", missing, NEARLY_ALL))


def hemisphere_is_stable(solutions: Solutions) -> Finding:
    """Smallest of the lowest eigenvalues for some n, up to the highest level."""
    stable = solutions.branch(BOWL).columns["n_negative"] == 0
    return decide.all_of(
        decide.same("changes of stability", len(solutions.points(BOWL, "stability_change")), 0),
        *(decide.positive(f"n = {n}", solutions.along(BOWL, f"Lambda_n{n}_1")[stable]) for n in TRIED),
    )


def hemisphere_eigenvalues(solutions: Solutions) -> Finding:
    """Lowest eigenvalues with the circumferential bending energy, against the table."""
    return decide.all_of(
        decide.agree(
            f"n = {n:g}, zw = {zw:g}",
            solutions.number(BOWL, At("zw", float(zw)), f"Lambda_n{n:.0f}_1"),
            OF_BOWL.number("Lambda_B1")[row],
            1e-6,
        )
        for row, (zw, n) in enumerate(zip(OF_BOWL.columns["zw"], OF_BOWL.columns["n"], strict=True))
    )


CASE = Case(
    title="A bending stiffness limits the unstable wave numbers",
    source="extension of Patil, Nordmark & Eriksson (2016), section 5",
    checks=(
        *(
            Points(
                "quantity",
                reference="bending_critical",
                base=wrinkled_bending(),
                parameters=("zw",),
                where={"zw": zw},
                asked={"beta_c": SMALL.get(zw, 1e-5), "n_c": 2e-4},
            )
            for zw in LEVELS
        ),
        Points(
            "quantity",
            reference="bending_bands",
            base=wrinkled_bending(beta=PAPER),
            parameters=("zw",),
            asked={"n_minus": 1e-7, "n_plus": 2e-8},
        ),
        Points(
            "quantity",
            reference="bending_models",
            base=wrinkled_bending(),
            parameters=("n", "zw", "beta"),
            asked={"Lambda_membrane": 1e-5, "Lambda_B1": 5e-8, "Lambda_B2": 1e-5},
        ),
        Claim(
            "hemisphere_eigenvalues",
            "the lowest eigenvalues of the hemisphere with bending agree with the reference",
            tuple((BOWL, At("zw", float(zw))) for zw in sorted(set(OF_BOWL.columns["zw"]))),
            hemisphere_eigenvalues,
        ),
        Claim(
            "inside",
            "with the paper's thickness the unstable levels lie inside those without bending stiffness",
            ((PLAIN, None), (STIFF, None)),
            inside,
        ),
        Claim(
            "within_real",
            "the unstable levels for whole n lie next to the ends of the unstable range for any real n",
            ((STIFF, None),),
            within_real,
        ),
        Claim(
            "stiffens",
            "bending stiffness raises the lowest eigenvalue of every n",
            ((PLAIN, None), (STIFF, None)),
            stiffens,
        ),
        Claim(
            "finite",
            "with bending stiffness the unstable wave numbers are a finite band",
            tuple((spec, None) for spec in BANDS),
            finite,
        ),
        Claim(
            "wavelength",
            "at each level there is a critical stiffness without unstable n; the last unstable n has a "
            "finite wavelength",
            tuple((spec, None) for spec in SPECS),
            wavelength,
        ),
        Claim(
            "models_agree",
            "nearly all of the shell's stiffness against waves comes from the circumferential curvature",
            tuple((spec, None) for spec in MODELS),
            models_agree,
        ),
        Claim(
            "hemisphere_is_stable",
            "with h/Ao = 0.001 the hemisphere is stable for all wave numbers tried",
            ((BOWL, None),),
            hemisphere_is_stable,
        ),
    ),
    slow=True,
)
