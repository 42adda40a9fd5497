"""Paper 1: observed orders of convergence of free inflation.

With elements of degree d, functionals and limit pressures converge with order 2d, the radius in a maximum
norm with order d + 1.
"""

from weakforms.cases import Case, Order, circular

DISK = circular(alpha=0, beta=1, t_end=1.5)

CASE = Case(
    title="Orders of convergence",
    source="Patil, DasGupta & Eriksson (2015), free inflation",
    checks=(
        Order(
            quantity="limit pressure",
            of=DISK,
            expected={1: 2, 2: 4, 3: 6},
            cells=(8, 16),
            kind="limit_point",
            reference="free_limit_points",
            column="p",
        ),
    ),
)
