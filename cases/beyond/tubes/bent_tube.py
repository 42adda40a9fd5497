"""A long tube under gas bends: the branch that leaves free inflation of Paper 2 before its limit point.

Paper 2 inflates axisymmetric states. A neo-Hookean tube of ten radii without pre-stretch becomes neutral to
bending (n = 1) before its limit point. The branch of bent states is compared over the volume with two codes
for the surface in space, and its curvatures at the beginning with fits of states of small amplitude and with
the solved branch itself.
"""

from weakforms.cases import (
    At,
    Axis,
    Case,
    Claim,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    Spec,
    decide,
    tube,
)

KEYS = ("alpha", "delta1", "lf", "u_end")
BASE = tube(secondary=True, secondary_n=1).on(degree=6, cells=48, step=0.3, secondary_degree=6)
NEO = BASE.at(alpha=0.0, delta1=1.0, lf=10.0, u_end=0.8)
STIFFER = BASE.at(alpha=0.1, delta1=1.0, lf=10.0, u_end=0.95)
SHORT = BASE.at(alpha=0.0, delta1=1.0, lf=6.0, u_end=1.3)
TABLES = {
    NEO: ("bent_tube_neo_hookean", r"$\alpha = 0,\ l_f = 10$"),
    STIFFER: ("bent_tube_alpha_0_1", r"$\alpha = 0.1,\ l_f = 10$"),
}
BRANCH, KIND = "secondary", "bifurcation_n1"
SMALL = tuple(At("u_wave", u, branch=BRANCH) for u in (0.15, 0.3))
EXTRAPOLATED = 2e-3
"""Largest relative error of a limit from two amplitudes of ratio 2, which is of fourth order in them."""


def begins(solutions: Solutions, spec: Spec, name: str) -> decide.Number:
    """A value of the point at which bent states begin, on their branch; free inflation has it too."""
    branches = [point.branch for point in solutions.points(spec, KIND)]
    return solutions.point(spec, KIND, name, branches.index(BRANCH))


def curvatures(solutions: Solutions) -> Finding:
    """(p - p_c)/u^2 and (V - V_c)/u^2 of solved states tend to the expansion's limits."""
    found = []
    for name in ("p", "V"):
        begin, limit = (begins(solutions, NEO, column) for column in (name, f"{name}_2"))
        near, far = ((solutions.number(NEO, small, name) - begin) / small.value**2 for small in SMALL)
        ratio = (4 * near - far) / (3 * limit)
        found.append(decide.between(f"limit of {name}", ratio, 1 - EXTRAPOLATED, 1 + EXTRAPOLATED))
    return decide.all_of(*found)


def signs(solutions: Solutions) -> Finding:
    """The pressure falls and the volume grows with the amplitude."""
    return decide.all_of(
        *(
            decide.all_of(
                decide.negative(f"p_2, {spec}", begins(solutions, spec, "p_2")),
                decide.positive(f"V_2, {spec}", begins(solutions, spec, "V_2")),
            )
            for spec in (NEO, STIFFER, SHORT)
        )
    )


def stability(solutions: Solutions) -> Finding:
    """Among displacements of the states' own symmetry: unstable at fixed p, stable at fixed V."""
    return decide.all_of(
        *(
            decide.same(f"{name}, {spec}", decide.runs(solutions.branch(spec, BRANCH).columns[name]), wanted)
            for spec in TABLES
            for name, wanted in (("n_negative", [1]), ("n_negative_volume", [0]))
        )
    )


def first(solutions: Solutions) -> Finding:
    """The long neo-Hookean tube bends before its limit point."""
    return decide.less(
        "V where it bends, and at the limit point",
        begins(solutions, NEO, "V"),
        solutions.point(NEO, "limit_point", "V"),
    )


CASE = Case(
    title="A long tube under gas bends",
    source="beyond Patil, Nordmark & Eriksson (2014)",
    panels=(
        *(
            Panel(
                letter,
                x=Axis("V", *over),
                y=Axis("p", *values),
                title=f"{label}: axisymmetric, and from the crossing on bent",
                markers=("limit_point", KIND),
                counted=("n_negative",),
                curves=(
                    Curve(spec, "axisymmetric"),
                    Curve(spec, "bent", reference=table, branch=BRANCH),
                ),
            )
            for letter, (spec, (table, label)), over, values in zip(
                "ab", TABLES.items(), ((5.5, 6.7), (6.4, 7.6)), ((1.62, 1.7), (1.88, 1.94)), strict=True
            )
        ),
        Panel(
            "c",
            x=Axis("V", 5.5, 7.6),
            y=Axis("u_wave", 0, 1.6),
            title=r"Amplitude; axisymmetric states have $u_{wave} = 0$",
            markers=(KIND,),
            curves=tuple(
                Curve(spec, label, reference=table, branch=BRANCH) for spec, (table, label) in TABLES.items()
            ),
        ),
    ),
    checks=(
        Points(
            KIND,
            "bent_tube_crossings",
            BASE,
            KEYS,
            # p_2 is nearly zero for the long tubes: 3e-8, the uncertainty of the table, is 1.4e-5 of it.
            {"p": 1e-6, "u_max": 1e-5, "V": 1e-5, "p_2": 5e-5, "V_2": 1e-4},
            branch=BRANCH,
        ),
        Claim(
            "curvatures",
            "the expansion at the crossing gives the first curvature of the solved branch",
            tuple((NEO, small) for small in SMALL),
            curvatures,
        ),
        Claim(
            "signs",
            "p falls and V grows from the crossing on",
            tuple((s, None) for s in (NEO, STIFFER, SHORT)),
            signs,
        ),
        Claim(
            "stability",
            "bent states are stable to displacements of their own symmetry if the volume is held",
            tuple((s, None) for s in TABLES),
            stability,
        ),
        Claim("first", "the long neo-Hookean tube bends before its limit point", ((NEO, None),), first),
    ),
    asked={"p": 1e-6, "u_max": 1e-5, "u_wave": 1e-5},
    slow=True,
)
