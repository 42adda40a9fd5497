"""Paper 3: the symmetry of the circle. The whole circumference has a pair of modes, half of it has one."""

from weakforms.cases import Case, Claim, Finding, Solutions, decide, fluid_tube, fluid_tube_surface

TUBE = fluid_tube(L=8, delta=2)
HALF, FULL = (fluid_tube_surface(L=8, delta=2, extent=extent) for extent in ("half", "full"))
UNEVEN, MIRRORED = FULL.at(uneven=0.2), HALF.at(amplitude=-0.1)
SAME = ("zw_bifurcation", "V_bifurcation", "zw_bent", "V_bent", "Pi_bent")


SAME_ZERO = decide.Stated(
    1e-9, "the same", "the same elements on half and full circumference; SLEPc stops at 1e-10"
)
SAME_POINT = decide.Stated(
    1e-4, "the same point", "the whole surface has a coarse mesh; a hundredth of an error of one percent"
)
BROKEN = decide.Stated(
    1e-4, "splits the pair", "ten thousand times the difference of an exact pair on the even mesh"
)


def quantities(solutions: Solutions, spec) -> dict[str, float]:  # noqa: ANN001
    """The quantities of a solution that has no branch."""
    return {name: q.value for name, q in solutions.result(spec).quantities.items()}


def double_zero(solutions: Solutions) -> Finding:
    """Critical eigenvalues and the bent state on half and full circumference, with the same elements."""
    half, full = (quantities(solutions, spec) for spec in (HALF, FULL))
    return decide.all_of(
        decide.same("multiplicities", [half["multiplicity"], full["multiplicity"]], [1, 2]),
        *(decide.at_most(f"{name} apart", abs(full[name] / half[name] - 1), SAME_ZERO) for name in SAME),
    )


def mirror_branch(solutions: Solutions) -> Finding:
    """Bent states to both sides, with the same elements."""
    one, other = (quantities(solutions, spec) for spec in (HALF, MIRRORED))
    return decide.all_of(
        decide.at_most(f"{name} apart", abs(other[name] / one[name] - 1), SAME_ZERO)
        for name in ("zw_bent", "V_bent", "Pi_bent")
    )


def of_the_branch(solutions: Solutions) -> Finding:
    """Level and volume at which the whole surface bends, compared with the primary branch's bifurcation."""
    whole = quantities(solutions, HALF)
    return decide.all_of(
        decide.at_most(
            f"{name}, relative difference",
            abs(whole[f"{name}_bifurcation"] / solutions.point(TUBE, "bifurcation_point", name) - 1),
            SAME_POINT,
        )
        for name in ("zw", "V")
    )


def mesh_breaks_it(solutions: Solutions) -> Finding:
    """The pair on a mesh that is not uniform around."""
    even, uneven = (quantities(solutions, spec) for spec in (FULL, UNEVEN))
    return decide.all_of(
        decide.at_most(
            "split even over uneven", abs(even["Lambda_split"]) / abs(uneven["Lambda_split"]), BROKEN
        ),
        decide.at_most(
            "force that prevents the rotation, even over uneven",
            abs(even["phase"]) / abs(uneven["phase"]),
            BROKEN,
        ),
    )


CASE = Case(
    title="The symmetry of the circle",
    source="Patil, Nordmark & Eriksson (2015), figures 2, 3, 6 and 8",
    checks=(
        Claim(
            "double_zero",
            "on the full circumference the critical eigenvalue is double, on half of it single, with the "
            "same zero and the same secondary branch",
            ((HALF, None), (FULL, None)),
            double_zero,
        ),
        Claim(
            "mirror_branch",
            "the secondary branch goes on to the other side with the same levels and volumes",
            ((HALF, None), (MIRRORED, None)),
            mirror_branch,
        ),
        Claim(
            "of_the_branch",
            "the whole surface bends where the primary branch has its first bifurcation",
            ((HALF, None), (TUBE, None)),
            of_the_branch,
        ),
        Claim(
            "mesh_breaks_it",
            "a mesh that is not uniform around splits the pair and makes the bifurcation imperfect",
            ((FULL, None), (UNEVEN, None)),
            mesh_breaks_it,
        ),
    ),
)
