"""The free tube of Paper 2, asked for its stability against waves around the axis: does it bend?

Paper 2 shows axisymmetric states, symmetric about the mid-plane. Here each of them is asked for its stability
against bending (n = 1), waves of n = 2, and a bulge that moves to one end (mirror symmetry), under a
prescribed pressure and under a prescribed volume, and for compression. The panels show the paper's figure 2
with lines by the number of negative eigenvalues; the data of figures 3 to 5 are those of panels (a) and (b).
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    decide,
    tube,
)

FAMILIES = (0, 1, 2)
KEYS = ("alpha", "delta1", "lf", "u_end")
ASKED = {"p": 1e-8, "u_max": 1e-8, "V": 1e-8}
"""Ten times sharper than lines of special points are asked to be, so that their order is not in doubt."""
ONSET = {"p": 1e-7, "u_max": 1e-7, "V": 1e-7}
"""Of the onset of wrinkling, whose equation is a stretch at one point: it has the order of stretches."""
BASE = tube(n=FAMILIES).on(degree=6, cells=128, step=0.15)


def at(alpha: float, delta1: float, lf: float, u_end: float = 4.0) -> Spec:
    """One tube; numbers as in the tables."""
    return BASE.at(alpha=float(alpha), delta1=float(delta1), lf=float(lf), u_end=float(u_end))


NEO = {lf: at(0, 1, lf, 2.5 if lf == 10 else 4.0) for lf in (6, 8, 10)}
SOFT, SHORT, LONG = at(0.05, 1, 6), at(0.1, 1, 6), at(0.1, 1, 10)
STRETCHED = {(alpha, d): at(alpha, d, 6) for alpha in (0, 0.1) for d in (1.5, 2)}
FIGURE3 = {d: at(0.1, d, 6) for d in (1.1, 1.15, 1.2)}
ALL = (*NEO.values(), SOFT, SHORT, LONG, *STRETCHED.values(), *FIGURE3.values())
WHOLE, BENT = NEO[6].at(extent="full", u_end=1.45), At("u_max", 1.2)

PRESSURE = ("n_negative_n0", "n_negative_n1", "n_negative_n2")
VOLUME = ("n_negative_volume", "n_negative_n1", "n_negative_n2")
KINDS = ("limit_point", "bifurcation_n1", "bifurcation_n2", "mirror_breaking", "wrinkling_onset")


def counts(solutions: Solutions, spec: Spec, names: tuple[str, ...]) -> list[int]:
    """Numbers of negative eigenvalues along a branch, without repetition."""
    columns = solutions.branch(spec).columns
    return decide.runs(sum(columns[name] for name in names))


def neo_hookean(solutions: Solutions) -> Finding:
    """The order of points on the paper's neo-Hookean tube, in volume."""
    spec = NEO[6]
    v = [
        solutions.point(spec, kind, "V", index)
        for kind, index in (
            ("limit_point", 0),
            ("bifurcation_n1", 0),
            ("mirror_breaking", 0),
            ("wrinkling_onset", 0),
            ("bifurcation_n1", 1),
        )
    ]
    place = solutions.point(spec, "wrinkling_onset", "Z_t_min")
    return decide.all_of(
        decide.less("limit, bends, mirror, wrinkles, straightens", *v),
        decide.less("the first wrinkle lies inside, not at the disk", place, 3.0),
    )


def long_ones(solutions: Solutions) -> Finding:
    """Bending comes before the limit point."""
    return decide.all_of(
        *(
            decide.less(
                f"V of bending and limit point, {spec}",
                solutions.point(spec, "bifurcation_n1", "V"),
                solutions.point(spec, "limit_point", "V"),
            )
            for spec in (NEO[8], NEO[10], LONG)
        )
    )


def printed_parts(solutions: Solutions) -> Finding:
    """Numbers of negative eigenvalues along the curves of figure 2, with growing displacement."""
    expected = {
        NEO[6]: ([0, 1, 2, 3, 2, 3], [0, 1, 2, 1, 2]),
        STRETCHED[0, 1.5]: ([0, 1, 2], [0, 1]),
        STRETCHED[0, 2]: ([0, 1, 2, 3], [0, 1, 2]),
        SHORT: ([0, 1, 0], [0]),
        STRETCHED[0.1, 1.5]: ([0], [0]),
        STRETCHED[0.1, 2]: ([0], [0]),
        FIGURE3[1.1]: ([0, 1, 0], [0]),
        FIGURE3[1.15]: ([0, 1, 0], [0]),
        FIGURE3[1.2]: ([0], [0]),
    }
    return decide.all_of(
        decide.same(f"{spec}, {how}", counts(solutions, spec, names), list(wanted))
        for spec, (by_p, by_v) in expected.items()
        for how, names, wanted in (("at fixed p", PRESSURE, by_p), ("at fixed V", VOLUME, by_v))
    )


def one_removed(solutions: Solutions) -> Finding:
    """Holding the volume removes one negative eigenvalue between the limit points, where p falls with V."""
    found = []
    for spec in ALL:
        columns, limits = solutions.branch(spec).columns, len(solutions.points(spec, "limit_point"))
        removed = columns["n_negative_n0"] - columns["n_negative_volume"]
        found.append(
            decide.same(f"removed, {spec}", decide.runs(removed), [i % 2 for i in range(limits + 1)])
        )
    return decide.all_of(*found)


def exchanged(solutions: Solutions) -> Finding:
    """At a bifurcation point the eigenvalue of its family is zero, and its state is in equilibrium."""
    return decide.all_of(
        *(
            decide.zero(
                f"Lambda of {spec}", solutions.number(spec, At("bifurcation_n1", 1), "Lambda_n1_1"), 1e-7
            )
            for spec in (NEO[6], NEO[8], LONG)
        )
    )


def both_halves(solutions: Solutions) -> Finding:
    """Waves of both parities on half the tube are those of the whole tube; so is the lost mirror symmetry."""
    names = [f"Lambda_n{n}_{k}" for n in FAMILIES for k in (1, 2, 3)]
    whole, half = ({name: solutions.number(spec, BENT, name) for name in names} for spec in (WHOLE, NEO[6]))
    lost = solutions.point(WHOLE, "bifurcation_point", "p"), solutions.point(NEO[6], "mirror_breaking", "p")
    return decide.all_of(
        decide.agree("p", *lost, 1e-8),
        *(decide.agree(name, whole[name], half[name], 1e-7) for name in names),
    )


def panel(name: str, alpha: float, counted: tuple[str, ...], held: str) -> Panel:
    """Figure 2 with lines by the number of negative eigenvalues."""
    specs = {1: NEO[6] if alpha == 0 else SHORT, **{d: STRETCHED[alpha, d] for d in (1.5, 2)}}
    return Panel(
        name,
        x=Axis("p", 0, 3),
        y=Axis("u_max", 0, 4),
        title=rf"$\alpha = {alpha:g}$, {held} held",
        markers=KINDS,
        counted=counted,
        curves=tuple(Curve(spec, rf"$\delta_1 = {d:g}$") for d, spec in specs.items()),
    )


CASE = Case(
    title="Where the free tube bends, loses its mirror symmetry and wrinkles",
    source="beyond Patil, Nordmark & Eriksson (2014), figures 2 to 5",
    panels=(
        panel("a", 0, PRESSURE, "pressure"),
        panel("b", 0.1, PRESSURE, "pressure"),
        panel("c", 0, VOLUME, "volume"),
        panel("d", 0.1, VOLUME, "volume"),
        Panel(
            "e",
            x=Axis("u_max", 0, 2.5),
            y=Axis("p", 0.9, 2.0),
            title=r"Length: bending comes before the limit point, $\delta_1 = 1$",
            markers=("limit_point", "bifurcation_n1"),
            counted=VOLUME,
            curves=(
                *(Curve(spec, rf"$\alpha = 0,\ l_f = {lf}$") for lf, spec in NEO.items()),
                Curve(LONG, r"$\alpha = 0.1,\ l_f = 10$"),
            ),
        ),
    ),
    checks=(
        Points("bifurcation_n1", "tube_waves", BASE, KEYS, ASKED, {"n": 1.0, "parity": 1.0}),
        Points("bifurcation_n2", "tube_waves", BASE, KEYS, ASKED, {"n": 2.0, "parity": 1.0}),
        Points("mirror_breaking", "tube_waves", BASE, KEYS, ASKED, {"n": 0.0, "parity": -1.0}),
        Points("limit_point", "tube_waves_limits", BASE, KEYS, ASKED),
        Points("wrinkling_onset", "tube_waves_wrinkling", BASE, KEYS, ONSET),
        Claim(
            "neo_hookean",
            "limit point, bending, mirror, wrinkling inside, straight again",
            ((NEO[6], None),),
            neo_hookean,
        ),
        Claim(
            "long",
            "long tubes bend before the limit point",
            tuple((spec, None) for spec in (NEO[8], NEO[10], LONG)),
            long_ones,
        ),
        Claim(
            "printed_parts",
            "negative eigenvalues along the curves of figures 2 to 5, at fixed pressure and at fixed volume",
            tuple((spec, None) for spec in (NEO[6], SHORT, *STRETCHED.values(), *FIGURE3.values())),
            printed_parts,
        ),
        Claim(
            "one_removed",
            "a held volume removes one negative eigenvalue, where the pressure falls with the volume",
            tuple((spec, None) for spec in ALL),
            one_removed,
        ),
        Claim(
            "exchanged",
            "at the bifurcation point the eigenvalue of bending is zero",
            tuple((spec, At("bifurcation_n1", 1)) for spec in (NEO[6], NEO[8], LONG)),
            exchanged,
        ),
        Claim(
            "both_halves",
            "both parities of half the tube give the waves of the whole tube",
            ((WHOLE, BENT), (NEO[6], BENT)),
            both_halves,
        ),
        Count("bifurcation_n1", {NEO[6]: 3, NEO[8]: 2, NEO[10]: 1, SOFT: 0, SHORT: 0, LONG: 2}, "bending"),
        Count(
            "mirror_breaking",
            {**dict.fromkeys(NEO.values(), 1), SOFT: 1, SHORT: 0, LONG: 1},
            "mirror symmetry",
        ),
        Count("bifurcation_n2", {spec: int(spec == STRETCHED[0, 2]) for spec in ALL}, "two waves around"),
        Count("wrinkling_onset", {spec: 0 for spec in (SOFT, SHORT, *STRETCHED.values())}, "no compression"),
    ),
    slow=True,
)
