"""Which instability a control removes: a gas of given pressure, of given mass, and of given volume.

The branch of a tube is drawn with lines by the number of negative eigenvalues under each control. A sphere
has closed forms.
"""

from weakforms.cases import (
    Axis,
    Case,
    Claim,
    Count,
    Curve,
    Finding,
    Panel,
    Points,
    Solutions,
    controls,
    decide,
)

KEYS = ("alpha", "delta1", "lf", "kappa", "p_atm", "V_r")
TUBE = controls(alpha=0.0, V_r=20.0)
SMALL, LARGER, LARGE = (TUBE.at(V_r=V_r) for V_r in (10.0, 40.0, 1000.0))
DISK = controls(body="circular", alpha=0.0, V_r=5.0)
SPHERE = controls(body="sphere", alpha=0.0, V_r=20.0)
ALL = (TUBE, SMALL, LARGE, DISK, SPHERE)
HELD = {"pressure": "n_negative", "mass of gas": "n_fixed_m", "volume": "n_fixed_V"}


def in_order(solutions: Solutions) -> Finding:
    """A given volume leaves no more negative eigenvalues than a given mass, which leaves no more than p."""
    found = []
    for spec in ALL:
        columns = solutions.branch(spec).columns
        by = [columns[name] for name in ("n_fixed_V", "n_fixed_m", "n_negative")]
        found.append(
            decide.same(f"in order, {spec}", bool(all(by[0] <= by[1]) and all(by[1] <= by[2])), True)
        )
        found.append(decide.same(f"at given volume, {spec}", int(max(by[0])), 0))
        found.append(decide.same(f"at given pressure, {spec}", int(max(by[2])), 1))
    return decide.all_of(*found)


def exact_sphere(solutions: Solutions) -> Finding:
    """Where a neo-Hookean sphere has an extremum of its mass: (V + V_r) p' + (p + p_atm) V' = 0."""
    found = []
    for index in (0, 1):
        lam = solutions.point(SPHERE, "mass_fold", "lam", index)
        p, slope = 4 * (lam**-1 - lam**-7), 4 * (7 * lam**-8 - lam**-2)
        compressed, filled = (2 * lam**3 / 3 + 20) * slope, (p + 1) * 2 * lam**2
        found.append(decide.agree(f"parts of dm/dlam at mass_fold {index + 1}", filled, -compressed, 1e-7))
    return decide.all_of(*found)


def larger_reservoirs(solutions: Solutions) -> Finding:
    """With a larger reservoir, stability at given mass is lost nearer to the limit point of the pressure."""
    first = [solutions.point(spec, "mass_fold", "u_max") for spec in (LARGE, LARGER, TUBE)]
    limit = solutions.point(TUBE, "limit_point", "u_max")
    return decide.less("u_max of limit point, and of mass_fold as V_r falls", limit, *first)


CASE = Case(
    title="Controls: given pressure, given mass of gas, given volume",
    source="the tube and the disk of papers 1 and 2, and a sphere",
    panels=tuple(
        Panel(
            name,
            x=Axis("V", 0, 30),
            y=Axis("p", 0.8, 1.8),
            title=f"neo-Hookean tube, {held} held",
            markers=("limit_point", "mass_fold"),
            counted=(column,),
            curves=(Curve(TUBE, "$V_r = 20$"),),
        )
        for name, (held, column) in zip("abc", HELD.items(), strict=True)
    ),
    checks=(
        Points(
            "mass_fold", "controls_mass_folds", controls(), KEYS, dict.fromkeys(("p", "u_max", "V"), 1e-7)
        ),
        Count("mass_fold", {SMALL: 0, TUBE: 2, DISK: 1, SPHERE: 2}, "extrema of the mass"),
        Count("volume_fold", dict.fromkeys(ALL, 0), "the volume grows along all branches"),
        Claim(
            "in_order",
            "the more is held, the fewer eigenvalues are negative",
            tuple((s, None) for s in ALL),
            in_order,
        ),
        Claim(
            "exact_sphere",
            "the sphere's extrema of mass are those of its closed form",
            ((SPHERE, None),),
            exact_sphere,
        ),
        Claim(
            "larger_reservoirs",
            "a large reservoir acts like a given pressure",
            tuple((spec, None) for spec in (LARGE, LARGER, TUBE)),
            larger_reservoirs,
        ),
    ),
    asked={"p": 1e-7},
)
