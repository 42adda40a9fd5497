"""Lines of critical points of balloons and long tubes, whose references are closed forms up to a root.

A balloon has limit points, and between them it may lose its shape to a pear (degree 1), where the tension has
an extremum: the law of Ogden's rubber does if its stiffening term is small. A long tube with free ends bulges
at limit points. With held ends it bulges in long waves without any limit point, and bends where the axial
force is zero; little stretched tubes bend first.
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
    decide,
    diagram,
)

LONG = {"body": "infinite_tube", "alpha": 0.1}
GENT = {"body": "infinite_tube", "model": "gent"}
BALLOON = diagram(body="sphere", x="alpha", kind="fold")
PEARS = diagram(body="sphere", model="ogden", x="mu2", low=0.0005, high=0.11, kind="fold,n1", lam_end=6.0)
FREE = diagram(**LONG, x="force", low=-1.0, kind="fold")
HELD = diagram(**LONG, ends="held", x="lam1", kind="localisation,n1")
CLOSED = diagram(**GENT, x="jm", low=16.0, high=40.0, kind="fold", lam_end=3.0)
TURNING = diagram(**GENT, jm=30.0, ends="held", x="lam1", low=1.8, high=2.2, kind="localisation", lam_end=3.0)
UNLOADED = At("force", 0.0, branch="fold")


def one_tube(solutions: Solutions) -> Finding:
    """The held tube that bends and bulges at once is without axial force, a free tube at its limit point."""
    found = []
    for name in ("p", "lam2", "lam1"):
        free = solutions.number(FREE, UNLOADED, name)
        found.append(decide.agree(name, solutions.point(HELD, "localisation_n1", name, 0), free, 1e-8))
    return decide.all_of(found)


def points(kind: str, spec: object, table: str, *names: str) -> Points:
    """The points of a kind, against a table; each number is asked to 1e-6."""
    return Points(kind, reference=table, base=spec, parameters=(), asked=dict.fromkeys(names, 1e-6))


CASE = Case(
    title="Lines of critical points of balloons and long tubes",
    source="Ogden (1972); Haughton & Ogden (1979); Fu, Pearce & Liu (2008)",
    panels=(
        Panel(
            "a",
            x=Axis("alpha", 0, 0.3),
            y=Axis("p", 1.8, 3.8),
            title="balloon, Mooney-Rivlin",
            markers="cusp_point",
            curves=(Curve(BALLOON, "limit points", "uniform_balloon_alpha", branch="fold"),),
        ),
        Panel(
            "b",
            x=Axis("mu2", 0, 0.1),
            y=Axis("p", 0.4, 1.8),
            title="balloon, Ogden",
            markers="tip_n1",
            curves=(
                Curve(PEARS, "limit points", "uniform_balloon_mu2", branch="fold"),
                Curve(PEARS, "pears", "uniform_pear_mu2", branch="n1"),
            ),
        ),
        Panel(
            "c",
            x=Axis("lam1", 1, 2.2),
            y=Axis("p", 1.2, 2),
            title=r"long tube, held ends, $\alpha = 0.1$",
            markers="localisation_n1",
            curves=(
                Curve(HELD, "long waves", "uniform_long_waves", branch="localisation"),
                Curve(HELD, "bending", "uniform_bending", branch="n1"),
            ),
        ),
        Panel(
            "d",
            x=Axis("force", -1, 3),
            y=Axis("p", 1.2, 2),
            title=r"long tube, free ends, $\alpha = 0.1$",
            curves=(Curve(FREE, "limit points", "uniform_free_ends", branch="fold"),),
        ),
        Panel(
            "e",
            x=Axis("jm", 16, 40),
            y=Axis("p", 1.4, 1.8),
            title="closed tube, Gent",
            markers="cusp_point",
            curves=(Curve(CLOSED, "limit points", "uniform_closed_jm", branch="fold"),),
        ),
    ),
    checks=(
        Count("cusp_point", {BALLOON: 1, PEARS: 1, CLOSED: 1, FREE: 0}, "limit points merge in cusps"),
        Count("localisation_n1", {HELD: 2}, "bending and long waves meet once, on either line"),
        points("cusp_point", BALLOON, "uniform_balloon_cusp_alpha", "alpha", "p", "lam"),
        points("cusp_point", PEARS, "uniform_balloon_cusp_mu2", "mu2", "p", "lam"),
        points("tip_n1", PEARS, "uniform_pear_tip_mu2", "mu2", "p", "lam"),
        points("cusp_point", CLOSED, "uniform_closed_cusp_jm", "jm", "p", "lam1", "lam2"),
        points("tip_localisation", TURNING, "uniform_waves_turn", "lam1", "p", "lam2"),
        points("localisation_n1", HELD, "uniform_both_waves", "lam1", "p", "lam2"),
        Claim(
            "one_tube",
            "the held tube that bends and bulges at once is the free tube without a force at its limit point",
            ((HELD, None), (FREE, UNLOADED)),
            one_tube,
        ),
    ),
    asked=dict.fromkeys(("p", "alpha", "mu2", "lam1", "lam2", "jm", "force"), 1e-7),
    slow=True,
)
