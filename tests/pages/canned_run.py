"""Prepared runs as ``verify`` stores them, one of them hostile, for tests of the report."""

import math
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np

from weakforms.verification.judging.outcome import (
    CaseOutcome,
    Convergence,
    CurveOutcome,
    Marker,
    PanelOutcome,
    Printed,
    RunOutcome,
    SurfaceOutcome,
    Verdict,
)

HOSTILE = '<script>alert("x")</script> \'&amp; \x00\x1b[31m $\\foo{$ \ud800 ∂λ₁ 中 {{ 7*7 }} [red]'
VOID = {"meta", "link", "br", "wbr", "img", "input", "hr"}


def curve(name, delta1, factor=1.0):
    """An S-shaped branch with a reference at every third point; ``factor`` scales its errors."""
    u = np.linspace(0.0, 5.0, 60)
    p = (1 - np.exp(-3.2 * u)) * (1.95 + 0.03 * (u - 1.6) ** 3 - (1.163 - delta1) / 2 * (u - 1.6))
    rows = u[1::3]
    bound = np.full(len(rows), 4e-9)
    errors = bound * factor * np.abs(np.sin(5 * rows))
    errors[0] = 0.0
    return CurveOutcome(
        name,
        rf"$\delta_1 = {delta1}$",
        p.tolist(),
        u.tolist(),
        [False, *(np.diff(p) < 0).tolist()],
        name,
        "independent",
        p[1::3].tolist(),
        rows.tolist(),
        "u_max",
        rows.tolist(),
        errors.tolist(),
        bound.tolist(),
    )


def panel(curves, name="a"):
    markers = [
        Marker("limit_point", "$p = 1.95$", 1.95, 1.3),
        Marker("cusp_point", "cusp", 1.9, 2.0),
        Marker("unheard_of", "", 99.0, 2.0),
    ]
    axes = ("p", "u_max", "$p$", "$u_{max}$", (1.7, 2.05), (0.0, 5.0))
    return PanelOutcome(name, "Limit points", *axes, curves, markers, "A note.")


def verdict(check, passed=True, error=3.2e-10, bound=1.3e-9, **more: object):
    values = {"statement": "The curves agree.", "where": "u_max = 1.25", "asked": 1e-7}
    values |= {"uncertainty": 5e-10, "reference_uncertainty": 4e-10, "reference": check}
    return Verdict(check, "curve", passed, error=error, bound=bound, **values | more)


def surface(name="bulge"):
    """Half of a torus-like shell with a field on it."""
    turns, along = np.meshgrid(np.linspace(0, 2 * np.pi, 13), np.linspace(0, 3, 7))
    radius = 1 + 0.3 * np.sin(along)
    x, y, z = radius * np.cos(turns), radius * np.sin(turns), along
    ranges = [(-1.5, 1.5), (-1.5, 1.5), (0.0, 3.0)]
    return SurfaceOutcome(
        name,
        "Deformed tube",
        [x.tolist(), y.tolist(), z.tolist()],
        ranges,
        ["$x$", "$y$", "$z$"],
        fields={"lam1": radius.tolist()},
    )


def passing_case():
    checks = [
        verdict("fig03a_delta1_1:p", reference="fig03a_delta1_1"),
        verdict("limit:p"),
        Verdict("count", "count", True, "Two limit points.", "found 2", differs="The text has three."),
    ]
    histories = [
        Convergence("limit pressure $p$", degree, [20, 40, 80], errors, order, order, "exact")
        for degree, errors, order in ((1, [1e-2, 2.5e-3, 6e-4], 2.0), (2, [1e-4, 6e-6, 0.0], 4.0))
    ]
    ledger = [
        Printed("cusp $\\delta_1$", "1.163", 1.16299342, 3e-8, "reproduced", "rounds", "fig. 3"),
        Printed("$\\delta_2$", "0.8164", 0.8164965809, None, "misprint"),
        Printed("n", "-", None, None, "not recoverable"),
    ]
    solutions = [
        {
            "problem": "tube",
            "parameters": {"alpha": 0.1, "delta1": d},
            "numerics": {"cells": [160, 320]},
            "provenance": {"versions": {"dolfinx": "0.9.0"}, "wall_s": d},
            "file": f"solutions/{d}.json",
        }
        for d in (1.0, 1.1)
    ]
    panels = [panel([curve("fig03a_delta1_1", 1.0), curve("fig03a_delta1_2", 1.2)])]
    panels.append(PanelOutcome("b", "", "x", "y", "$x$", "$y$", (0.0, 1.0), (0.0, 1.0)))
    return CaseOutcome(
        "paper2.fig03",
        "Limit points",
        "figure 3",
        "First.\n\nSecond.",
        "passed",
        checks,
        panels,
        ledger,
        histories,
        [],
        3.4,
        solutions,
        [surface()],
    )


def failing_case():
    checks = [
        verdict("good:p"),
        verdict("bad:p", passed=False, error=1.3004e-9, bound=1.3e-9, detail="12 rows out of bound"),
        verdict("nan:p", passed=False, error=None, detail="not a number"),
    ]
    panels = [panel([curve("bad", 1.1, factor=3.0)])]
    return CaseOutcome("paper2.fig02", "Free", "figure 2", "", "failed", checks, panels)


def hostile_case():
    text = HOSTILE
    shape = replace(surface(text), title=text, labels=[text] * 3, note=text)
    shape.fields = {text: shape.fields["lam1"]}
    bad = replace(curve("x", 1.0), name=text, label=text, reference_kind=text)
    bad.residual_abscissa = text
    picture = replace(panel([bad]), name=text, title=text, x_label=text, note=text)
    picture.markers = [Marker(text, text, 1.9, 2.0)]
    check = Verdict(text, text, False, text, text, 1e-3, 1e-9, 1e-7, None, None, text, text)
    histories = [Convergence(text, 1, [10, 20], [1e-3, math.nan], None, 2.0, text)]
    ledger = [Printed(text, text, 1.0, 0.1, text, text, text)]
    return CaseOutcome(
        text,
        text,
        text,
        text,
        "error",
        [check, check],
        [picture],
        ledger,
        histories,
        [text],
        1.0,
        [{text: text, "parameters": {text: [text, 1.5]}}],
        [
            replace(
                surface(text),
                title=text,
                labels=[text] * 3,
                note=text,
                fields={text: surface().fields["lam1"]},
            )
        ],
    )


def sample(*cases: CaseOutcome):
    environment = {"dolfinx": "0.9.0", "machine": "x86_64", "git": "1f2e3d4"}
    return RunOutcome("full", "paper2", "2026-08-11T09:41:07Z", 12.7, environment, list(cases))


class Reader(HTMLParser):
    """Collect tags, attributes and text; report elements that are closed out of order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags, self.attributes, self.open, self.words = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):  # noqa: D102
        self.tags.append(tag)
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):  # noqa: D102
        self.tags.append(tag)
        self.attributes += [(tag, name, value) for name, value in attrs]

    def handle_endtag(self, tag):  # noqa: D102
        assert self.open.pop() == tag

    def handle_data(self, data):  # noqa: D102
        self.words.append(data)
