"""Which identities hold for the columns of which problem; scalings are those of the problems' ``scales``."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from weakforms.verification.judging.consistency import identity_formulas as formulas
from weakforms.verification.judging.consistency.identities import (
    Given,
    Identity,
    equal,
    of_events,
    positive,
    slope,
    stable,
    total,
    work,
    zero,
)
from weakforms.verification.judging.consistency.identity_profiles import (
    at_front,
    derived,
    enclosed,
    end,
    extreme,
    field,
    middle,
    one_at,
    origin,
    rate,
    read,
    wetted,
    zone,
)

LARGEST, SMALLEST = np.argmax, np.argmin


def _free(given: Given) -> bool:
    return given.get("contact", "none") == "none"


def _smooth_in_contact(given: Given) -> bool:
    # A wrinkled zone has kinks at its ends, which the points of a profile do not resolve.
    return not _free(given) and given.get("phase") != "peeling" and given.get("energy") != "relaxed"


def _inflating(given: Given) -> bool:
    return not _free(given) and given.get("phase") not in ("peeling", "deflation")


def _half(given: Given) -> bool:
    return _free(given) and given.get("extent", "half") == "half"


def _conserves(given: Given) -> bool:
    return given.get("phase") != "peeling"


def _of_paper(given: Given) -> bool:
    return "model" not in given


def _of_tube(given: Given) -> bool:
    return given.get("body", "tube") == "tube"


def _uniform(given: Given) -> bool:
    return given.get("body", "tube") in ("sphere", "infinite_tube")


def _not_uniform(given: Given) -> bool:
    return not _uniform(given)


def _balanced(given: Given) -> bool:
    return _uniform(given) and given.get("ends", "free") == "free"


def _sheared(given: Given) -> bool:
    return given.get("loading", "shear") == "shear"


def _bent(given: Given) -> bool:
    return given.get("loading") == "bend"


def _pulled(given: Given) -> bool:
    return given.get("loading") in ("stretch", "strip")


def _gas(given: Given) -> bool:
    return given.get("load") == "gas"


def _liquid(given: Given) -> bool:
    return not _gas(given)


def _over(identity: Identity, over: Any, name: str = "") -> Identity:
    return replace(identity, over=over, name=name or identity.name)


def _end(which: int, name: str) -> Any:
    """A number of the first or the last change of stability."""
    return lambda result: formulas.stability_change(result, which, name)


LOAD = of_events("load", "load is the control's value", lambda point: point.values.get(point.control))


SMALLEST_RESULTANT = "the smallest resultant is that of the profile"

OF_BODY = (
    read("u_max", "displacement of the middle", formulas.middle_displacement, _of_tube),
    read("lam1_mid", "meridional stretch of the middle", end("lam1", 0)),
    read("t0", "height of the pole", end("eta", 0)),
    read("lam_pole", "stretch of the pole", end("lam1", 0)),
    read("V", "volume within the profile", enclosed("rho", "eta", 0.5), _of_tube),
)
"""Of problems that take a tube or a disk by name."""

IDENTITIES: dict[str, tuple[Identity, ...]] = {
    "circular": (
        _over(work("p", lambda _, c: -c["V"]), _conserves),
        # In peeling the front is among the freedoms counted, and the eigenvalues are those at a held front.
        _over(stable(), lambda given: given.get("phase") != "peeling"),
        field("lam2", "lam2 = rho beta/X", lambda r, _, c: c["rho"] * r.parameters["beta"] / c["X"]),
        read("t0", "height of the pole", end("eta", 0)),
        read("lam_pole", "stretch of the pole", end("lam1", 0)),
        read("lam1_rim", "stretch of the rim", end("lam1", -1)),
        read("sigma_pole", "contact stress of the pole", end("sigma", 0)),
        read("t_min", SMALLEST_RESULTANT, extreme(SMALLEST, "t1", "t2"), _free),
        read("V", "volume below the profile", enclosed("rho", "eta", -0.5), _free),
        read("rho_contact", "radius of the profile at the front", at_front("X_contact", "rho")),
        read("kappa", "curvature of the profile outside the front", formulas.meridional_curvature),
        _over(field("t1", "t1 is that of the law at the stretches", formulas.cauchy_resultant(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", formulas.cauchy_resultant(2)), _of_paper),
    ),
    "tube": (
        work("p", lambda _, c: -c["V"]),
        stable(),
        read("u_max", "displacement of the middle", formulas.middle_displacement, _half),
        read("lam1_mid", "meridional stretch of the middle", end("lam1", 0), _half),
        read("lam2_mid", "hoop stretch of the middle", origin("lam2")),
        field("lam2", "lam2 = rho/sqrt(delta1)", formulas.hoop_stretch),
        read("t1_mid", "resultant of the middle", end("t1", 0), _half),
        read("t2_min", SMALLEST_RESULTANT, extreme(SMALLEST, "t2"), _smooth_in_contact),
        read("V", "volume within the profile", enclosed("rho", "eta", 0.5), _half),
        read("spring_max", "largest of the springs", extreme(SMALLEST, "f_k", factor=-1.0), _inflating),
        read(
            "kappa", "curvature by the balance of the free part at the front", formulas.curvature_by_balance
        ),
        read(
            "Pi",
            "potential of the profile",
            formulas.tube_potential,
            # At a front the energy has a kink, which the points of a profile do not resolve.
            lambda g: _half(g) and _of_paper(g) and g.get("energy") != "relaxed",
        ),
        _over(field("t1", "t1 is that of the law at the stretches", formulas.cauchy_resultant(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", formulas.cauchy_resultant(2)), _of_paper),
        _over(field("H", "H = w - lam1 w_1", formulas.hamiltonian), lambda g: _of_paper(g) and _free(g)),
        _over(
            field("F_axial", "axial force at the middle", formulas.axial_force),
            lambda g: _of_paper(g) and _half(g),
        ),
    ),
    "tube_fold": (
        read("u_max", "displacement of the middle", formulas.middle_displacement),
        field("lam2", "lam2 = rho/sqrt(delta1)", formulas.hoop_stretch),
        _over(field("H", "H = w - lam1 w_1", formulas.hamiltonian), _of_paper),
        _over(field("F_axial", "axial force at the middle", formulas.axial_force), _of_paper),
        read("lam1_mid", "meridional stretch of the middle", end("lam1", 0)),
        read("t1_mid", "resultant of the middle", end("t1", 0)),
        read("V", "volume within the profile", enclosed("rho", "eta", 0.5)),
        read("Pi", "potential of the profile", formulas.tube_potential, _of_paper),
        _over(field("t1", "t1 is that of the law at the stretches", formulas.cauchy_resultant(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", formulas.cauchy_resultant(2)), _of_paper),
    ),
    "diagram": (
        *(
            _over(identity, identity.over if identity.name in ("u_max", "V") else _not_uniform)
            for identity in OF_BODY
        ),
        _over(
            formulas.of_uniform("volume", "V", "volume of the balloon or tube", formulas.uniform_volume),
            _uniform,
        ),
        _over(
            formulas.of_uniform("balance", "t_min", "tension balances pressure", formulas.uniform_tension),
            _balanced,
        ),
    ),
    "controls": (work("p", lambda _, c: -c["V"]), stable(), *OF_BODY),
    "hemisphere": (
        stable(),
        _over(work("p", lambda _, c: -c["V"]), _gas),
        _over(rate("zw", wetted("r", "z", 0.5), formulas.weight_of), _liquid),
        read("V", "volume within the profile", enclosed("r", "z", 0.5)),
        read("N", "tension at the equator", end("tension", -1)),
        read("z_pole", "height of the pole", end("z", 0)),
        read("lam_pole", "stretch of the pole", end("lam1", 0)),
        read("r_max", "largest radius of the profile", extreme(LARGEST, "r")),
        read("gw_max", "largest value of the profile's gw", extreme(LARGEST, "gw")),
        read("gw_min", "smallest value of the profile's gw", extreme(SMALLEST, "gw")),
        read("wrinkled_fraction", "zones between the fronts where gw < 1", zone("t_front")),
        field("gw", "gw = lam2 sqrt(lam1)", lambda _, __, c: c["lam2"] * np.sqrt(c["lam1"])),
        field("lam2", "lam2 = r/sin t", lambda _, __, c: c["r"] / np.sin(c["t"])),
        derived("lam1", "lam1 is the slope of the profile", formulas.meridional_slope, "r", "z"),
        one_at("t_front", "gw"),
        LOAD,
        derived("axial", "axial = N cos(phi) - P r^2/2", formulas.axial_by_slopes, "r", "z"),
        _over(
            field("tension", "tension is that of the law at the stretches", formulas.sphere_tension),
            _of_paper,
        ),
    ),
    "wrinkled_tube": (
        stable(),
        _over(work("p", lambda _, c: -c["V"]), _gas),
        _over(rate("zw", wetted("r", "z", 0.5), formulas.weight_of), _liquid),
        read("V", "volume within the profile", enclosed("r", "z", 0.5)),
        read("N", "tension at the lower end", end("tension", 0)),
        read("r_max", "largest radius of the profile", extreme(LARGEST, "r")),
        read("gw_max", "largest value of the profile's gw", extreme(LARGEST, "gw")),
        read("gw_min", "smallest value of the profile's gw", extreme(SMALLEST, "gw")),
        read("wrinkled_fraction", "zones between the fronts where gw < 1", zone("Z_front")),
        field("gw", "gw = lam2 sqrt(lam1)", lambda _, __, c: c["lam2"] * np.sqrt(c["lam1"])),
        field("lam2", "lam2 = r over the undeformed radius", lambda _, __, c: c["r"]),
        _over(
            field("axial", "axial = N cos(phi) - P r^2/2", formulas.axial_under_liquid),
            lambda given: "load_end" not in given,
        ),
        derived("lam1", "lam1 is the slope of the profile", formulas.meridional_slope, "r", "z"),
        derived("slope", "slope is dr/dz of the profile", lambda _, __, ___, r, z: r / z, "r", "z"),
        LOAD,
        one_at("Z_front", "gw"),
    ),
    "fluid_tube": (
        work("zw", lambda result, c: -result.parameters["gamma"] * c["V"]),
        read("T1_ring", "tension at the ring", end("T1", 0)),
        read("T2_ring", "hoop tension at the ring", end("T2", 0)),
        read("r_mid", "radius of the middle", middle("r")),
        read("T1_mid", "tension of the middle", middle("T1")),
        read("T2_mid", "hoop tension of the middle", middle("T2")),
        derived("lam1", "lam1 is the slope of the profile", formulas.meridional_slope, "r", "z"),
        read("r_max", "largest radius of the profile", extreme(LARGEST, "r")),
        read("r_front", "radius of the profile at the free surface", at_front("Z_front", "r", kink=False)),
        read("zw", "height of the profile at the free surface", at_front("Z_front", "z", kink=False)),
        read("V", "volume of the liquid in the profile", wetted("r", "z", np.pi)),
        field("lam2", "lam2 = r", lambda _, __, c: c["r"]),
        _over(field("H", "H = w - lam1 w_1", lambda r, s, c: formulas.hamiltonian(r, s, c) / 2), _of_paper),
        zero("Lambda_rotation"),
    ),
    "fluid_tube_imperfect": (work("zw", lambda result, c: -result.parameters["gamma"] * c["V"]),),
    "sphere": (
        _over(work("P", lambda _, c: -(c["lam"] ** 3) / 3), lambda given: not given.get("vary")),
        equal("lam1", "both stretches are one", lambda c: c["lam"]),
        equal("lam2", "both stretches are one", lambda c: c["lam"]),
        read("lam1", "the profile's stretch", end("lam1", 0)),
        read("lam2", "the profile's stretch", end("lam2", 0)),
        stable(),
    ),
    "infinite_tube": (
        work("p", lambda _, c: -c["V"] / 2),
        positive("lam1", "lam2"),
        read("lam1", "the profile's stretch", end("lam1", 0)),
        read("lam2", "the profile's stretch", end("lam2", 0)),
        equal("V", "volume of the cylinder", lambda c: c["lam1"] * c["lam2"] ** 2),
        _over(formulas.maxwell(), lambda given: not given.get("force")),
        stable(),
    ),
    "homogeneous": (
        work("T", lambda result, c: -formulas.directions(result) * c["lam"]),
        equal("lam1", "the stretch along the piece", lambda c: c["lam"]),
        read("lam1", "the profile's stretch", end("lam1", 0)),
        read("lam2", "the profile's stretch", end("lam2", 0)),
        positive("lam1", "lam2", "lam_across"),
        stable(),
    ),
    "wrinkled_patch": (
        slope("U", "e", "U_e"),
        slope("W", "e", "W_e"),
        slope("W_e", "e", "W_ee"),
    ),
    "wrinkled_linear": (zero("curved"),),
    "wrinkled_sheet": (zero("twist"),),
    "torus": (
        work("p", lambda _, c: -c["V"]),
        stable(),
        equal("virial", "3 p V, because lengths scale", lambda c: 3 * c["p"] * c["V"]),
        equal("Pi", "U - p V", lambda c: c["U"] - c["p"] * c["V"]),
        read("v", "V/(2 pi^2 b^2)", formulas.swelling),
        read("r_out", "outer radius of the profile", end("r", 0)),
        read("r_in", "inner radius of the profile", end("r", -1)),
        field("lam2", "lam2 = r/(1 + b cos t)", lambda r, _, c: c["r"] / formulas.ring(r, c)),
        _over(field("t1", "t1 is that of the law at the stretches", formulas.cauchy_resultant(1)), _of_paper),
        _over(field("t2", "t2 is that of the law at the stretches", formulas.cauchy_resultant(2)), _of_paper),
    ),
    "annulus": (
        slope("U", "psi", "M"),
        stable(),
        equal("U_edges", "U by stretches and stresses at the edges", lambda c: c["U"]),
        equal("M_in", "the stress at the inner edge gives the torque", lambda c: c["M"]),
        equal("M_out", "the stress at the outer edge gives the torque", lambda c: c["M"]),
        *(
            read(f"{name}_{edge}", f"{name} of the profile at that edge", end(name, index))
            for name in ("lam1", "gw")
            for edge, index in (("in", 0), ("out", -1))
        ),
        read("f_w", "area inside of the front", formulas.inside_of_front),
        _over(
            field("gw", "gw = lam2 sqrt(lam1)", lambda _, __, c: c["lam2"] * np.sqrt(c["lam1"])),
            lambda given: given.get("model") != "saint_venant_kirchhoff",
        ),
    ),
    "sheet": (
        _over(work("gam", lambda r, c: r.parameters["c"] * c["tau"]), _sheared, "shear"),
        _over(work("lam", lambda r, c: r.parameters["c"] * c["T_x"]), _pulled, "pull"),
        _over(work("kap", lambda r, c: r.parameters["c"] * c["M"]), _bent, "bending"),
    ),
    # Traces over a level that turns twice are too coarse for its work; a claim integrates it by polynomials.
    "membrane": (_over(work("p", lambda _, c: -c["V"]), _gas),),
    "rectangle": (_over(work("p", lambda _, c: -c["V"]), _gas),),
    "surface": tuple(
        _over(identity, lambda given: given.get("geometry", "tube") == "tube")
        for identity in (
            total("lower", "lower is the first change of stability", _end(0, "zw")),
            total("upper", "upper is the last change of stability", _end(-1, "zw")),
            total("n_lower", "n_lower is the first change's wave number", _end(0, "n")),
            total("n_upper", "n_upper is the last change's wave number", _end(-1, "n")),
            total("triangles", "two triangles a rectangle", lambda r: formulas.times_grid(r, 2, 0)),
            total("unknowns", "three displacements a node", lambda r: formulas.times_grid(r, 3, 1)),
            Identity(
                "direction", "direction is the sign of the change in the count", formulas.change_direction
            ),
            Identity(
                "surface",
                "r_max and z are the surface's, modes are 1 at their largest",
                formulas.surface_shape,
            ),
        )
    ),
}
"""By problem; each verdict of a case's solution states all that apply."""
