"""Prepared results, and what pictures, tables and texts show of them."""

import re
from collections.abc import Callable

import numpy as np
from outlines import drawn

from weakforms.results import Absence, Branch, Ended, Failure, Field, Quantity, Result, SpecialPoint, State
from weakforms.results.diagram import COUNTED, draw, draw_diagram
from weakforms.results.io import branch_csv, dumps
from weakforms.results.model import KINDS
from weakforms.results.plot import draw_results
from weakforms.results.tables import csv_text, field_rows, other_rows, point_rows, state_rows
from weakforms.results.wording import not_crossed

VERSIONS = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "1")


def whole() -> Result:
    """A result with each part: branches, special points, states, and what may be missing."""
    u = np.linspace(0.5, 4.5, 9)
    negative = np.array([0, 0, 1, 1, 1, 2, 0, 0, 0])
    first = Branch(
        "primary",
        "p",
        {"p": u * (5 - u) / 3, "u_max": u, "n_negative": negative, "residual": u / 1e9},
        {"p": u * 1e-9},
        Ended("u_end", "u_max", 4.5),
    )
    back = Branch(
        "secondary",
        "p",
        {"p": 2 - u / 3, "u_max": 5 - u, "turn": np.array([np.nan, *u[1:] ** 2])},
        ended=Ended("failure", "p", 0.5, "diverged"),
    )
    one = {"p": np.array([1.25]), "u_max": np.array([0.75])}
    alone = Branch("single", "p", one, ended=Ended("start", "p", 1.25))
    points = [
        SpecialPoint("limit_point", "primary", "p", {"u_max": 2.5, "p": 25 / 12}, {"p": 1e-8, "u_max": 1e-7}),
        SpecialPoint("limit_point", "primary", "p", {"u_max": 3.5, "p": 1.75}, {"p": 2e-8}),
        SpecialPoint("limit_point", "secondary", "p", {"u_max": 2.5, "p": 1.2}, {"p": 3e-8}),
        SpecialPoint("bifurcation_point", "secondary", "p", {"u_max": 4.0, "n": 3.0, "p": 1.5}, {"n": 0.0}),
        SpecialPoint("front", "secondary", "p", {"p": 1.5}, {}),  # without u_max
    ]
    profile = Field("profile", {"Z": u[:3], "rho": 1 + u[:3] ** 2}, {"Z": 0.0, "rho": 1e-9})
    numbers = {"u_max": Quantity(1.25, 2e-9), "p": Quantity(2.0, 0.0), "n_negative": Quantity(2)}
    states = [
        State({"p": 2.0}, "primary", numbers, (profile,), 1, 3),
        State({"p": 2.0}, "primary", {"u_max": Quantity(3.5)}, (profile,), 2, 3),
        State({"p": 1.75}, "primary", {"u_max": Quantity(3.25, 1e-9)}, (), 1, 2),
        State({"u_max": 1.0}, "secondary", {"p": Quantity(1.5)}, (profile,), 1, 1),
        State({"p": 1.0, "u_max": 2.0}, "secondary", {}, (), 2),
    ]
    return Result(
        "tube",
        {"alpha": 0.1, "n": (1, 2), "contact": "", "k": None, "cost": "$5"},
        {"p": "P R_f/(C1 h_o)", "u_max": "largest displacement, divided by the radius $R_f$ of the plane"},
        {"cells": [8, 16]},
        VERSIONS | {"ranks": 1, "wall_s": 0.5},
        [first, back, alone],
        points,
        {"area": Quantity(2.0, 1e-3), "count": Quantity(3), "order": Quantity(1.0, 1e-6, 3.9)},
        states,
        [Failure("state at p = 9", "diverged")],
        [Absence("cusp", "searched between 1 and 3")],
        ["k = 3 has no effect"],
    )


def plain() -> Result:
    """A result with one stable branch without a known end, and a state that lies on it once."""
    branch = Branch("primary", "p", {"p": np.array([0.0, 1.0]), "u_max": np.array([0.0, 2.0])})
    state = State({"p": 1.0}, "primary", {"u_max": Quantity(2.0)}, (Field("profile", {"Z": branch["p"]}),))
    return Result("sphere", {"alpha": 0.2}, {}, {}, {}, [branch], states=[state])


def every_kind() -> Result:
    """A branch with a special point of each kind."""
    u = np.arange(float(len(KINDS)))
    points = [
        SpecialPoint(kind, "primary", "p", {"p": 2 * at, "u_max": at}, {})
        for kind, at in zip(KINDS, u, strict=True)
    ]
    return Result("tube", {}, {}, {}, {}, [Branch("primary", "p", {"p": 2 * u, "u_max": u})], points)


def plane() -> Result:
    """A diagram with each kind of line, one of them partly wrinkled, and regions between some of them."""
    alpha = np.linspace(0.0, 1.0, 21)
    part, none = alpha[alpha < 0.61], np.zeros(13)
    wrinkled = np.array([*[0] * 4, *[1] * 5, *[0] * 4])
    lines = {
        "fold": (part, 2.0 + none, 1 + none, 0, wrinkled),
        "fold_2": (part, 1.0 + 1.6 * part, 2 + none, 0, None),
        "mirror": (alpha, 2.8 - 0.1 * alpha, 2.5 + 0 * alpha, 0, None),
        "n1": (part, 5 + none, 0.1 * part, 0, None),
        "n2": (part, 5.1 + none, 0.1 * part, 0, None),
        "n3": (part, 5.2 + none, 0.1 * part, 0, None),
        "wrinkling": (alpha, 0.5 + 0 * alpha, 0.2 + 0 * alpha, 0, None),
        "contact": (alpha, 0.6 + 0 * alpha, 0.3 + 0 * alpha, 0, None),
        "end": (alpha, 3.0 + 0 * alpha, 3 + 0 * alpha, 0, None),
    }
    for name in ("n1", "n2", "n3"):  # beyond the range of the regions
        lines[name] = (2 + lines[name][0], *lines[name][1:])
    branches = [
        Branch(
            name,
            "alpha",
            {"alpha": along, "p": p, "u_max": depth}
            | {name: np.full(len(p), count) for name in COUNTED.values()}
            | ({} if flags is None else {"wrinkled": flags}),
        )
        for name, (along, p, depth, count, flags) in lines.items()
    ]
    places = (("cusp_point", 0.6, 1.96), ("fold_mirror", 0.3, 2.5), ("cusp_point", 0.1, 1.0))
    points = [SpecialPoint(k, "fold", "alpha", {"alpha": a, "p": p, "u_max": 1.5}, {}) for k, a, p in places]
    given = {"body": "tube", "vary": "alpha", "low": 0.0, "high": 1.0, "p_low": 0.1, "x": "alpha", "y": "p"}
    return Result("diagram", given, {"p": "P R_f/(C1 h_o)"}, {}, {}, branches, points)


def one_line() -> Result:
    """A diagram of the end of the branches of a disk only, which is a single region."""
    alpha = np.linspace(0.0, 1.0, 5)
    end = Branch("end", "alpha", {"alpha": alpha, "p": 3.0 + alpha, "t0": 2.0 + alpha})
    given = {"body": "disk", "vary": "alpha", "low": 0.0, "high": 1.0, "p_low": 0.5, "x": "alpha", "y": "p"}
    return Result("diagram", given, {}, {}, {}, [end])


def page(result: Result) -> str:
    """What a notebook shows, without the picture."""
    text = result._repr_html_()
    return re.sub(r"(?s)<svg.*</svg>", "a picture", text).replace("><", ">\n<")


def tables() -> str:
    """All tables of a result as CSV."""
    result = whole()
    profile = field_rows(result.states[0].fields[0])
    rows = [point_rows(result), state_rows(result), other_rows(result), profile]
    return "\n".join([branch_csv(result), *map(csv_text, rows)])


def words() -> str:
    """Short texts about results."""
    result = whole()
    empty = Result("tube", {}, {}, {}, {})
    return "\n".join(
        [
            *map(repr, (result, plain(), empty, *result.branches)),
            *(not_crossed("p", 1.5, count + 1, count, [0.25, 3.0, 2.0]) for count in range(3)),
        ]
    )


def sections() -> dict[str, Callable[[], str]]:
    """Every outline of results by its title."""
    other = whole()
    other.parameters = other.parameters | {"alpha": 0.3}
    named = whole()
    named.branches = named.branches[:1]
    return {
        "branches": lambda: drawn(draw_results({"": whole()})),
        "branches over another column": lambda: drawn(draw_results({"": whole()}, "turn", "p")),
        "two results": lambda: drawn(draw_results({"a": whole(), "b": other})),
        "two results of two problems": lambda: drawn(draw({"a": plain(), "b": named})),
        "profiles": lambda: drawn(draw_results({"": whole()}, "Z", "rho")),
        "profiles of two results": lambda: drawn(draw_results({"a": whole(), "b": other}, "rho", "Z")),
        "every kind of special point": lambda: drawn(draw_results({"": every_kind()})),
        "a stable branch": lambda: drawn(plain().plot()),
        "a diagram": lambda: drawn(plane().plot()),
        "a diagram over pressure": lambda: drawn(draw_diagram(plane(), "p", "alpha")),
        "a diagram of one line": lambda: drawn(one_line().plot()),
        "a notebook": lambda: page(whole()),
        "a notebook with a stable branch": lambda: page(plain()),
        "tables": tables,
        "words": words,
        "a file": lambda: dumps(plain().to_json()),
    }
